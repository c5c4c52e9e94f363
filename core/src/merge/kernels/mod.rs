//! Kernels: they evaluate an expression in a cell that the descent does not halve further.
//!
//! A kernel is a folder with a type that implements [`problem::Kernel`] and is listed in [`ALL`].
//! `merge/descent/descend.rs` also asks single kernels about larger cells, which `merge/descent/choice.rs`
//! chooses.

pub mod counts;
pub mod general;
pub(super) mod kept;
pub mod orthogonal;
pub mod problem;
pub(super) mod stays;
pub mod trees;

use problem::Kernel;

/// All kernels, in the order in which they are asked to solve a small cell. The last one never refuses.
pub const ALL: [&dyn Kernel; 3] = [
    &orthogonal::Orthogonal,
    &general::GeneralPosition,
    &trees::LocalTrees,
];
