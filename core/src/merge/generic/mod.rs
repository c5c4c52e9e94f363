//! Splits and merges partition trees of any dimension, node by node.

pub mod case;
pub mod merge_trees;
pub mod partition_tree;
pub mod split_tree;
pub mod trace;
