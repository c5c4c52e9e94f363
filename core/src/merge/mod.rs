//! Set operations: one descent over trees and deferred leaves, and generic tree merging.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

mod bins;
pub mod choice;
mod crossings;
mod cutting;
pub mod descend;
pub mod evaluate;
pub mod expression;
mod general;
mod join;
mod kept;
pub mod leaf;
pub mod list;
pub mod local_tree;
pub mod merge_trees;
pub mod op;
mod orthogonal;
mod overlay;
pub mod pairs;
pub mod partition_tree;
pub mod separation;
pub mod simple;
pub mod split_tree;
mod star;
mod state;
mod stays;
mod window;

pub use merge_trees::merge;
pub use op::{Outcome, SetOp};
pub use partition_tree::partition_tree;
pub use split_tree::{split_case, split_tree, Halves, SplitCase};
