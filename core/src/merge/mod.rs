//! Set operations on solids, on sets of the plane, and on partition trees of any dimension.

pub mod arrangement;
pub mod descent;
mod division;
pub mod evaluate;
pub mod expression;
pub mod generic;
pub mod kernels;
pub mod lists;
pub mod op;
mod overlaps;
pub mod pairs;
pub mod plane;
pub mod profile;
pub mod residual;
pub mod rule;
#[cfg(test)]
pub(crate) mod scenes;
mod twins;

pub use generic::case::SplitCase;
pub use generic::merge_trees::{merge, merge_watched};
pub use generic::partition_tree::partition_tree;
pub use generic::split_tree::{split_case, split_tree, split_tree_watched, Halves};
pub use op::{Outcome, SetOp};
