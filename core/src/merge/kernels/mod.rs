//! Leaf kernels: what an expression leaves of its operands in a cell that is not halved any more.
//!
//! A kernel is a folder with a type that implements [`problem::Kernel`], and a place in [`ALL`].
//! `merge/descent/descend.rs` asks some about larger cells, too, which `merge/descent/choice.rs`
//! chooses.

pub mod general;
pub(super) mod kept;
pub mod orthogonal;
pub mod problem;
pub(super) mod stays;
pub mod trees;

use problem::Kernel;

/// All kernels in the order in which small cells are offered to them. The last one takes every cell.
pub const ALL: [&dyn Kernel; 3] = [
    &orthogonal::Orthogonal,
    &general::GeneralPosition,
    &trees::LocalTrees,
];
