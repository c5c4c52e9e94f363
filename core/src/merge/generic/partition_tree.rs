//! Rebuilds a partition tree with a chosen hyperplane at its root.

use std::sync::Arc;

use super::split_tree::split_tree;
use crate::error::Result;
use crate::geometry::spaces::space::Space;
use crate::tree::partition::{PartitionTree, SubHyperplane};

/// Returns a tree of the same set whose root is cut by the hyperplane of `span`.
///
/// `span` is the part of the hyperplane inside the region of the tree's root. If both halves are leaves with
/// equal labels, the result is a leaf.
///
/// # Errors
/// `Internal` if `span` is not the part of its hyperplane inside the tree's region.
///
/// # Source
/// Naylor, Amanatides, Thibault 1990, section 4.
pub fn partition_tree<S: Space>(
    tree: &PartitionTree<S>,
    span: S::Fragment,
) -> Result<PartitionTree<S>> {
    let halves = split_tree(tree, &span)?;
    let facets = halves.coplanar;
    let sub_hyperplane = Arc::new(SubHyperplane { span, facets });
    Ok(PartitionTree::cut(
        sub_hyperplane,
        halves.minus,
        halves.plus,
    ))
}
