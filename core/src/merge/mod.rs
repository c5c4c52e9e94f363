//! Set operations: one descent over trees and deferred leaves, and generic tree merging.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub mod descend;
pub mod evaluate;
pub mod expression;
mod join;
pub mod leaf;
pub mod list;
pub mod local_tree;
mod overlay;
