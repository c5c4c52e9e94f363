//! A set rebuilt from its boundary, with a tree whose size fits that boundary.

use crate::error::Result;
use crate::geometry::spaces::dim1::Dim1;
use crate::tree::partition::{classify_corner, enclosed, walls, Facet, Label, PartitionTree, Plan};

/// The same set on the line as a balanced tree.
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
