//! The location of a point.

use super::node::{Label, PartitionTree};
use crate::geometry::side::{Half, Side};
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;

/// The location of a point relative to a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// In the set's interior.
    In,
    /// On its boundary.
    On,
    /// Outside.
    Out,
}

/// Classifies a point of the tree's region.
///
/// Visits the leaves that touch the point: a point in a cut is interior if all of them are In, and on the
/// boundary if they differ.
///
/// # Exactness
/// Exact.
///
/// # Cost
/// One path, unless the point lies in a cut.
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

/// The label at the frame's lowest corner.
pub fn classify_corner<S: AxisSpace>(tree: &PartitionTree<S>) -> Label {
    let mut at = tree.clone();
    loop {
        at = match at {
            PartitionTree::Leaf(label) => return label,
            PartitionTree::Cut(cut) => cut.child(S::side_of_corner(cut.hyperplane())),
        };
    }
}
