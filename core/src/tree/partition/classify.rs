//! Tests whether a point lies inside a tree's set, outside or on its boundary.

use super::node::{Label, PartitionTree};
use crate::geometry::side::{Half, Side};
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;

/// The location of a point relative to a set: inside, outside or on the boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// In the interior of the set.
    In,
    /// On the boundary of the set.
    On,
    /// Outside the set and its boundary.
    Out,
}

/// Finds whether a point lies inside a tree's set, outside or on its boundary.
///
/// Visits all leaves whose regions touch the point: it is inside if all of them are In, outside if all are
/// Out, and else on the boundary.
///
/// # Exactness
/// The location is exact.
///
/// # Cost
/// One path from the root to a leaf, unless the point lies in a cut.
pub fn classify<S: Space>(tree: &PartitionTree<S>, point: &S::Point) -> Location {
    let mut pending = vec![tree.clone()];
    let mut seen = None;
    while let Some(next) = pending.pop() {
        poll();
        match next {
            PartitionTree::Leaf(label) if seen.is_some_and(|other| other != label) => {
                return Location::On;
            }
            PartitionTree::Leaf(label) => seen = Some(label),
            PartitionTree::Cut(cut) => {
                let side = S::side(cut.hyperplane(), point);
                if side != Side::Plus {
                    pending.push(cut.child(Half::Minus));
                }
                if side != Side::Minus {
                    pending.push(cut.child(Half::Plus));
                }
            }
        }
    }
    match seen {
        Some(Label::In) => Location::In,
        _ => Location::Out,
    }
}

/// The label of the tree at the frame's corner of least coordinates.
pub fn classify_corner<S: AxisSpace>(tree: &PartitionTree<S>) -> Label {
    let mut at = tree.clone();
    loop {
        at = match at {
            PartitionTree::Leaf(label) => return label,
            PartitionTree::Cut(cut) => cut.child(S::side_of_corner(cut.hyperplane())),
        };
    }
}
