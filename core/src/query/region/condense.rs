//! Rebuilds a set on the line from its boundary, so that the size of its tree fits the boundary.

use crate::error::Result;
use crate::geometry::spaces::dim1::Dim1;
use crate::tree::partition::{classify_corner, enclosed, walls, Facet, Label, PartitionTree, Plan};

/// Returns the same set of the line with a balanced tree, made from the set's boundary.
///
/// # Errors
/// `Internal` for a broken tree.
pub fn condensed_line(tree: &PartitionTree<Dim1>) -> Result<PartitionTree<Dim1>> {
    let base = i32::from(classify_corner(tree) == Label::In);
    let facet = |(source, fragment)| Facet { fragment, source };
    let pieces = walls(tree)?.into_iter().map(|wall| wall.fragment);
    let facets = (0..).zip(pieces).map(facet).collect();
    enclosed(facets, base, |number| number > 0, &Plan::BALANCED)
}
