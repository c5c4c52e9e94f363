//! Collects the parts of a cell's elements that bound a kernel's result.

use std::sync::Arc;

use super::kept::KeptPart;
use crate::geometry::outline::BareEdge;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::mesh::handle::{Slot, SourceFace};
use crate::tree::node::Part;

/// The part of a face, or of a convex piece of a cut face, that bounds the result in one orientation.
pub enum StayingRegion {
    /// No part of the face bounds the result.
    Nothing,
    /// All of the face inside the cell bounds the result.
    All,
    /// These convex pieces of the face bound the result.
    Pieces(Vec<Polygon>),
    /// The region of the face inside an outline; no two consecutive edges lie on one line.
    Outline(Vec<BareEdge>),
}

/// Whether a face in a cell is an original face or a piece of a cut one.
#[derive(Clone, Copy)]
pub enum Owner {
    /// This whole face of a source.
    Face(SourceFace),
    /// A convex piece of the part with this number.
    Part(usize),
}

/// A face, or convex piece of a cut face, that meets the cell: its number, the source face or part that it
/// comes from, and its regions that bound the result in the source's orientation and in the opposite one.
pub type StayingElement = (usize, Owner, [StayingRegion; 2]);

impl StayingRegion {
    /// Makes the region of these convex pieces; `Nothing` if there are none.
    pub fn of(pieces: Vec<Polygon>) -> Self {
        if pieces.is_empty() {
            Self::Nothing
        } else {
            Self::Pieces(pieces)
        }
    }

    fn kept(self, face: SourceFace, orientation: Orientation) -> Option<KeptPart> {
        match self {
            Self::Nothing => None,
            Self::All => Some(KeptPart::whole(face, orientation)),
            Self::Pieces(polygons) => Some(KeptPart::pieces(face, orientation, polygons)),
            Self::Outline(edges) => Some(KeptPart::outlined(face, orientation, edges)),
        }
    }
}

/// Returns the regions of all faces and parts of faces that bound the result. `parts` has the parts with the
/// slots of their sources, and `polygon` returns the face or piece with a given number.
pub fn kept(
    elements: impl Iterator<Item = StayingElement>,
    parts: &[(&Arc<Part>, Slot)],
    polygon: impl Fn(usize) -> Option<Polygon>,
) -> Vec<KeptPart> {
    let mut kept = Vec::with_capacity(elements.size_hint().0);
    let mut pieces: Vec<[Vec<(usize, StayingRegion)>; 2]> = Vec::new();
    pieces.resize_with(parts.len(), Default::default);
    for (i, owner, stays) in elements {
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
        kept.extend(sides.filter_map(|(pieces, orientation)| {
            kept_from_part(*part, pieces, orientation, &polygon)
        }));
    }
    kept
}

/// Returns a part of a face unchanged if all its convex pieces stay, otherwise the pieces that stay; `None`
/// if there are none.
fn kept_from_part(
    (part, slot): (&Arc<Part>, Slot),
    pieces: Vec<(usize, StayingRegion)>,
    orientation: Orientation,
    polygon: impl Fn(usize) -> Option<Polygon>,
) -> Option<KeptPart> {
    let face = SourceFace::new(slot, part.face);
    if !pieces.is_empty() && pieces.iter().all(|p| matches!(p.1, StayingRegion::All)) {
        return Some(KeptPart::part(face, orientation, Arc::clone(part)));
    }
    let (mut polygons, mut edges) = (Vec::new(), Vec::new());
    for (i, stays) in pieces {
        match stays {
            StayingRegion::Nothing => {}
            StayingRegion::All => polygons.extend(polygon(i)),
            StayingRegion::Pieces(pieces) => polygons.extend(pieces),
            StayingRegion::Outline(outline) => edges.extend(outline),
        }
    }
    let some = !(polygons.is_empty() && edges.is_empty());
    some.then(|| KeptPart::joined(face, orientation, polygons, edges))
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
        let edges = BareEdge::edges_of(&polygon).collect();
        let part = Arc::new(Part::new(Arc::clone(source), FaceId(0), scene.cell, edges));
        let parts = [(&part, Slot(0))];
        let left = |second: StayingRegion| {
            let of_part = |i: usize, stays| (i, Owner::Part(0), [stays, StayingRegion::Nothing]);
            let elements = [of_part(0, StayingRegion::All), of_part(1, second)];
            let kept = kept(elements.into_iter(), &parts, |_| Some(polygon.clone()));
            assemble(kept, 0, false, &scene.cell, &scene.sources)
        };
        let shared = |node: &Node| match node {
            Node::Deferred(leaf) => leaf.parts.iter().any(|p| Arc::ptr_eq(&p.part, &part)),
            Node::Leaf(_) | Node::Cut(_) => false,
        };
        assert!(shared(&left(StayingRegion::All)));
        assert!(!shared(&left(StayingRegion::Nothing)));
    }

    #[test]
    fn no_pieces_are_nothing() {
        assert!(matches!(
            StayingRegion::of(Vec::new()),
            StayingRegion::Nothing
        ));
    }
}
