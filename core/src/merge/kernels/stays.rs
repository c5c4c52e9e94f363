//! Collects the parts of a cell's elements that bound a kernel's result.

use std::sync::Arc;

use super::kept::Kept;
use crate::geometry::outline::BareEdge;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::mesh::handle::{Slot, SourceFace};
use crate::tree::node::Part;

/// The part of an element (a face or a convex piece of a part) that bounds the result in one orientation.
pub enum Stays {
    /// Nothing of the element.
    Nothing,
    /// All of the element in the cell.
    All,
    /// These convex pieces of the element.
    Pieces(Vec<Polygon>),
    /// The region of the element inside an outline; no two consecutive edges lie on one line.
    Outline(Vec<BareEdge>),
}

/// The face or the part that an element comes from.
pub enum Owner {
    /// The element is this whole face.
    Face(SourceFace),
    /// The element is a convex piece of the part with this number.
    Part(usize),
}

/// An element that meets the cell: its number, the face or part that it comes from, and the parts of it that
/// bound the result in the source's orientation and in the opposite one.
pub type Settled = (usize, Owner, [Stays; 2]);

impl Stays {
    /// Makes the value for these convex pieces; `Nothing` if there are none.
    pub fn of(pieces: Vec<Polygon>) -> Self {
        if pieces.is_empty() {
            Self::Nothing
        } else {
            Self::Pieces(pieces)
        }
    }

    fn kept(self, face: SourceFace, orientation: Orientation) -> Option<Kept> {
        match self {
            Self::Nothing => None,
            Self::All => Some(Kept::whole(face, orientation)),
            Self::Pieces(polygons) => Some(Kept::pieces(face, orientation, polygons)),
            Self::Outline(edges) => Some(Kept::outlined(face, orientation, edges)),
        }
    }
}

/// Returns the regions of all faces and parts that bound the result. `parts` has the parts with the slots of
/// their sources, and `polygon` returns the element with a given number.
pub fn kept(
    settled: impl Iterator<Item = Settled>,
    parts: &[(&Arc<Part>, Slot)],
    polygon: impl Fn(usize) -> Option<Polygon>,
) -> Vec<Kept> {
    let mut kept = Vec::with_capacity(settled.size_hint().0);
    let mut pieces: Vec<[Vec<(usize, Stays)>; 2]> = Vec::new();
    pieces.resize_with(parts.len(), Default::default);
    for (i, owner, stays) in settled {
        poll();
        let sides = stays.into_iter().zip(Orientation::BOTH);
        match owner {
            Owner::Face(face) => {
                kept.extend(sides.filter_map(|(stays, orientation)| stays.kept(face, orientation)));
            }
            Owner::Part(part) => {
                sides.for_each(|(stays, orientation)| {
                    pieces[part][usize::from(orientation.is_opposite())].push((i, stays));
                });
            }
        }
    }
    for (part, sides) in parts.iter().zip(pieces) {
        poll();
        let sides = sides.into_iter().zip(Orientation::BOTH);
        kept.extend(
            sides.filter_map(|(pieces, orientation)| {
                kept_part(*part, pieces, orientation, &polygon)
            }),
        );
    }
    kept
}

/// Returns the part unchanged if all its pieces stay, otherwise the pieces that stay; `None` if there are
/// none.
fn kept_part(
    (part, slot): (&Arc<Part>, Slot),
    pieces: Vec<(usize, Stays)>,
    orientation: Orientation,
    polygon: impl Fn(usize) -> Option<Polygon>,
) -> Option<Kept> {
    let face = SourceFace::new(slot, part.face);
    if !pieces.is_empty() && pieces.iter().all(|p| matches!(p.1, Stays::All)) {
        return Some(Kept::part(face, orientation, Arc::clone(part)));
    }
    let (mut polygons, mut edges) = (Vec::new(), Vec::new());
    for (i, stays) in pieces {
        match stays {
            Stays::Nothing => {}
            Stays::All => polygons.extend(polygon(i)),
            Stays::Pieces(pieces) => polygons.extend(pieces),
            Stays::Outline(outline) => edges.extend(outline),
        }
    }
    let some = !(polygons.is_empty() && edges.is_empty());
    some.then(|| Kept::joined(face, orientation, polygons, edges))
}

#[cfg(test)]
mod tests {
    use super::super::kept::assemble;
    use super::*;
    use crate::merge::scenes::crossing;
    use crate::mesh::handle::FaceId;
    use crate::tree::node::Node;

    #[test]
    fn a_part_of_which_all_pieces_stay_is_kept_as_it_is() {
        let scene = crossing();
        let source = scene.sources.get(Slot(0));
        let polygon = source
            .clip(FaceId(0), &scene.cell)
            .expect("it is in the cell");
        let edges = BareEdge::all_of(&polygon).collect();
        let part = Arc::new(Part::new(Arc::clone(source), FaceId(0), scene.cell, edges));
        let parts = [(&part, Slot(0))];
        let left = |second: Stays| {
            let of_part = |i: usize, stays| (i, Owner::Part(0), [stays, Stays::Nothing]);
            let settled = [of_part(0, Stays::All), of_part(1, second)];
            let kept = kept(settled.into_iter(), &parts, |_| Some(polygon.clone()));
            assemble(kept, 0, false, &scene.cell, &scene.sources)
        };
        let shared = |node: &Node| match node {
            Node::Deferred(leaf) => leaf.parts.iter().any(|p| Arc::ptr_eq(&p.part, &part)),
            Node::Leaf(_) | Node::Cut(_) => false,
        };
        assert!(shared(&left(Stays::All)));
        assert!(!shared(&left(Stays::Nothing)));
    }

    #[test]
    fn no_pieces_are_nothing() {
        assert!(matches!(Stays::of(Vec::new()), Stays::Nothing));
    }
}
