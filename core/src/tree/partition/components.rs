//! The connected parts of a set and of its complement, and the walls between these parts.

use super::flat::Flat;
use super::node::{Label, PartitionTree};
use crate::error::Result;
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::NodeId;

/// A piece of a set's boundary and the connected parts on its two sides.
#[derive(Clone, Debug)]
pub struct Wall<S: Space> {
    /// The convex piece of the boundary, with the set on its minus side.
    pub fragment: S::Fragment,
    /// The connected part of the set on the minus side, by its first leaf.
    pub inside: NodeId,
    /// The connected part of the complement on the plus side, by its first leaf.
    pub outside: NodeId,
}

/// The boundary of a tree's set, each piece with the two connected parts that it separates.
///
/// Parts are open: regions that touch only in points, or in space along edges, are not connected. A part is
/// named by its first leaf, only to distinguish it from others.
///
/// # Order
/// By inner node, breadth first.
///
/// # Errors
/// `Internal` if a cut lies in the border of its own region.
pub fn walls<S: Space>(tree: &PartitionTree<S>) -> Result<Vec<Wall<S>>> {
    let flat = Flat::new(tree);
    let mut parts = DisjointSets::of_one(flat.len());
    let mut walls = Vec::new();
    for contact in flat.contacts()? {
        poll();
        let (minus, plus) = (contact.minus, contact.plus);
        if flat.label(minus) == flat.label(plus) {
            parts.join(minus.0, plus.0);
        } else if flat.label(minus) == Some(Label::In) {
            walls.push((contact.fragment, minus, plus));
        } else {
            walls.push((S::reversed(&contact.fragment), plus, minus));
        }
    }
    let mut part = |leaf: NodeId| NodeId(parts.least(leaf.0));
    let numbered = |(fragment, inside, outside)| Wall {
        fragment,
        inside: part(inside),
        outside: part(outside),
    };
    Ok(walls.into_iter().map(numbered).collect())
}
