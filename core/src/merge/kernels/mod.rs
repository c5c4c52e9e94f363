//! Leaf kernels: evaluate an expression in a cell that is no longer halved.
//!
//! A kernel is a folder with a type that implements [`problem::Kernel`], and a place in [`ALL`].
//! `merge/descent/descend.rs` also tries some on larger cells, which `merge/descent/choice.rs` chooses.

pub mod general;
pub(super) mod kept;
pub mod orthogonal;
pub mod problem;
pub(super) mod stays;
pub mod trees;

use problem::Kernel;

/// All kernels, in the order in which small cells are offered to them. The last one takes every cell.
pub const ALL: [&dyn Kernel; 3] = [
    &orthogonal::Orthogonal,
    &general::GeneralPosition,
    &trees::LocalTrees,
];
