//! Leaf kernels: what an expression leaves of its operands in a cell that is not halved any more.

pub(super) mod cutting;
pub(super) mod general;
pub(super) mod kept;
pub mod leaf;
pub mod local_tree;
pub(super) mod orthogonal;
pub(super) mod overlay;
pub(super) mod stays;
