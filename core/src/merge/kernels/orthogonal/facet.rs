//! The faces of a cell that are perpendicular to axes, as rectangles cut by slanted edges (facets).

use std::sync::Arc;

use smallvec::SmallVec;

use crate::geometry::cell::Cell;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::interrupt::poll;
use crate::merge::kernels::problem::ListedOperand;
use crate::merge::kernels::stays::Owner;
use crate::merge::lists::list::{FaceRecord, PartRecord, Sources};
use crate::mesh::handle::{FaceId, Slot, SourceFace};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::Part;

/// For each axis, the two axes of a plane perpendicular to it: first the axis along which rows of rectangles
/// follow each other, then the axis along which a row's bits do.
pub(super) const OTHER_AXES: [(usize, usize); 3] = [(1, 2), (0, 2), (0, 1)];

/// A face, or a convex piece of a part of a face, that is perpendicular to an axis.
pub(super) struct Facet<'a> {
    pub(super) operand: usize,
    pub(super) axis: usize,
    /// The lattice coordinate of the facet's plane on its axis.
    pub(super) at: i64,
    /// True if the normal points to larger coordinates.
    pub(super) upward: bool,
    /// The winding number behind the face minus the number in front of it.
    weight: i32,
    slanted_edges: SmallVec<[SlantedEdge; 1]>,
    pub(super) origin: FacetOrigin<'a>,
}

/// The face or part of a face that a facet comes from.
pub(super) enum FacetOrigin<'a> {
    /// A triangle of a mesh, with its corners.
    Face(&'a Source, SourceFace, [Lattice; 3]),
    /// The face of a half-space.
    Plane(&'a Source, Slot),
    /// A convex piece of a part of a face: the part's number in `Facets::parts`, and the piece.
    Piece(usize, &'a Polygon),
}

/// An edge of a facet that is not parallel to an axis, in the two coordinates of the facet's plane; the facet
/// is on its left.
#[derive(Clone, Copy)]
struct SlantedEdge {
    from: [i64; 2],
    to: [i64; 2],
}

/// The facets of a cell, sorted by operand, and the parts of faces that facets are pieces of, with the slots
/// of their sources.
pub(super) struct Facets<'a> {
    pub(super) all: Vec<Facet<'a>>,
    pub(super) parts: Vec<(&'a Arc<Part>, Slot)>,
}

impl<'a> Facets<'a> {
    /// Makes the facets of all operands; `None` if a listed element (a face or part of a face) is not
    /// perpendicular to an axis, or has a slanted edge that is no edge of its face.
    pub(super) fn new(
        cell: &Cell,
        operands: &'a [ListedOperand],
        sources: &'a Sources,
    ) -> Option<Self> {
        let mut facets = Self {
            all: Vec::with_capacity(operands.iter().map(|l| l.list.len()).sum()),
            parts: Vec::new(),
        };
        for (operand, listed) in operands.iter().enumerate() {
            for record in &listed.list.records {
                poll();
                let facet = Facet::of_record(operand, record, sources)?;
                facets.all.extend(Some(facet).filter(|f| f.may_meet(cell)));
            }
            for part in &listed.list.parts {
                poll();
                facets.add_part(operand, part, cell, sources)?;
            }
        }
        Some(facets)
    }

    fn add_part(
        &mut self,
        operand: usize,
        record: &'a PartRecord,
        cell: &Cell,
        sources: &Sources,
    ) -> Option<()> {
        let slot = sources.slot(&record.element.part.source);
        let part = self.parts.len();
        self.parts.push((&record.element.part, slot));
        let weight = record.element.orientation.signed(1);
        for piece in record.pieces() {
            let facet = Facet::of_piece(operand, weight, part, &piece.polygon)?;
            self.all.extend(Some(facet).filter(|f| f.may_meet(cell)));
        }
        Some(())
    }
}

impl<'a> Facet<'a> {
    fn of_record(operand: usize, record: &FaceRecord, sources: &'a Sources) -> Option<Self> {
        let weight = record.orientation().signed(1);
        let (slot, source) = (record.slot(), &**sources.get(record.slot()));
        match source.shape() {
            Shape::Mesh(mesh) => {
                let corners = mesh.corners(record.face);
                let origin = FacetOrigin::Face(source, SourceFace::new(slot, record.face), corners);
                Self::of_triangle(operand, weight, &corners, origin)
            }
            Shape::HalfSpace(plane) => {
                let (axis, at, upward) = upright(plane)?;
                Some(Self {
                    operand,
                    axis,
                    at,
                    upward,
                    weight,
                    slanted_edges: SmallVec::new(),
                    origin: FacetOrigin::Plane(source, slot),
                })
            }
        }
    }

    fn of_triangle(
        operand: usize,
        weight: i32,
        corners: &[Lattice; 3],
        origin: FacetOrigin<'a>,
    ) -> Option<Self> {
        let [a, b, c] = corners;
        let axis = (0..3).find(|i| a[*i] == b[*i] && b[*i] == c[*i])?;
        let (row, bit) = OTHER_AXES[axis];
        let flat = corners.map(|p| [p[row], p[bit]]);
        let counterclockwise = turn(&flat[0], &flat[1], &flat[2]) > 0;
        let edges = (0..3).map(|i| SlantedEdge::new(flat[i], flat[(i + 1) % 3], counterclockwise));
        Some(Self {
            operand,
            axis,
            at: a[axis],
            upward: counterclockwise != (axis == 1),
            weight,
            slanted_edges: edges.flatten().collect(),
            origin,
        })
    }

    fn of_piece(operand: usize, weight: i32, part: usize, piece: &'a Polygon) -> Option<Self> {
        let (axis, at, upward) = upright(piece.support())?;
        let (row, bit) = OTHER_AXES[axis];
        let counterclockwise = upward != (axis == 1);
        let mut slanted_edges = SmallVec::new();
        for corner in piece.corners() {
            match &corner.edge {
                Carrier::Edge(edge) => {
                    let (a, b) = edge.ends();
                    let (a, b) = ([a[row], a[bit]], [b[row], b[bit]]);
                    slanted_edges.extend(SlantedEdge::new(a, b, counterclockwise));
                }
                Carrier::Cut(plane, _) => {
                    plane.only_axis()?;
                }
            }
        }
        Some(Self {
            operand,
            axis,
            at,
            upward,
            weight,
            slanted_edges,
            origin: FacetOrigin::Piece(part, piece),
        })
    }

    /// Returns true if the facet's plane meets the cell, and the bounding box of a triangle does.
    fn may_meet(&self, cell: &Cell) -> bool {
        let (low, high) = (cell.low(), cell.high());
        let within = |i: usize, p: &Lattice| p[i] >= low[i];
        let below = |i: usize, p: &Lattice| p[i] <= high[i];
        let bounded = match &self.origin {
            FacetOrigin::Face(_, _, corners) => (0..3).all(|i| {
                corners.iter().any(|p| within(i, p)) && corners.iter().any(|p| below(i, p))
            }),
            FacetOrigin::Plane(..) | FacetOrigin::Piece(..) => true,
        };
        bounded && (low[self.axis]..=high[self.axis]).contains(&self.at)
    }

    pub(super) fn owner(&self) -> Owner {
        match &self.origin {
            FacetOrigin::Face(_, face, _) => Owner::Face(*face),
            FacetOrigin::Plane(_, slot) => Owner::Face(SourceFace::new(*slot, FaceId::ONLY)),
            FacetOrigin::Piece(part, _) => Owner::Part(*part),
        }
    }

    /// Returns the change of the winding number across the facet in the direction of its axis.
    pub(super) fn change(&self) -> i32 {
        if self.upward {
            -self.weight
        } else {
            self.weight
        }
    }

    /// Returns true if the point just above `corner` in both coordinates, given in half lattice steps, is on
    /// the inner side of all slanted edges of the facet.
    pub(super) fn contains(&self, corner: [i64; 2]) -> bool {
        self.slanted_edges.iter().all(|s| s.is_left(corner))
    }

    /// Returns true if a part of the rectangle from `low` to `high` is on the inner side of all slanted edges
    /// of the facet.
    pub(super) fn touches(&self, low: [i64; 2], high: [i64; 2]) -> bool {
        self.slanted_edges.iter().all(|s| s.reaches(low, high))
    }

    /// Returns true if the facet has no slanted edge.
    pub(super) fn is_rectangle(&self) -> bool {
        self.slanted_edges.is_empty()
    }

    /// Returns the part of the facet inside the cell; `None` if there is none.
    pub(super) fn polygon_in(&self, cell: &Cell) -> Option<Polygon> {
        match &self.origin {
            FacetOrigin::Face(source, face, _) => source.clip(face.id, cell),
            FacetOrigin::Plane(source, _) => source.clip(FaceId::ONLY, cell),
            FacetOrigin::Piece(_, polygon) => (*polygon).clone().clipped(cell),
        }
    }
}

/// Returns the axis that a plane is perpendicular to, its lattice coordinate on this axis, and whether its
/// normal points to larger coordinates; `None` if it is not such a plane at a lattice coordinate.
fn upright(plane: &Plane) -> Option<(usize, i64, bool)> {
    let axis = plane.only_axis()?;
    let at = plane.lattice_coordinate(axis)?;
    Some((axis, at, plane.normal()[axis] > 0))
}

/// Returns twice the signed area of a triangle of the plane.
fn turn(a: &[i64; 2], b: &[i64; 2], c: &[i64; 2]) -> i128 {
    let d = |p: &[i64; 2], i: usize| i128::from(p[i]) - i128::from(a[i]);
    d(b, 0) * d(c, 1) - d(b, 1) * d(c, 0)
}

impl SlantedEdge {
    /// Makes an edge with the facet on its left; `left` says whether the facet is on the left of the
    /// direction given. `None` if the edge is parallel to an axis.
    fn new(from: [i64; 2], to: [i64; 2], left: bool) -> Option<Self> {
        let (from, to) = if left { (from, to) } else { (to, from) };
        let (from, to) = (from.map(|c| 2 * c), to.map(|c| 2 * c));
        (from[0] != to[0] && from[1] != to[1]).then_some(Self { from, to })
    }

    /// Returns true if a point, given in half lattice steps and moved by (ε, ε²), lies on the left of the
    /// edge.
    fn is_left(&self, point: [i64; 2]) -> bool {
        match turn(&self.from, &self.to, &point) {
            0 => self.to[1] < self.from[1],
            area => area > 0,
        }
    }

    /// Returns true if a part of the rectangle from `low` to `high` is on the left of the edge.
    fn reaches(&self, low: [i64; 2], high: [i64; 2]) -> bool {
        // If the edge rises along the bits, its left has smaller row coordinates.
        let row = if self.to[1] > self.from[1] {
            low[0]
        } else {
            high[0]
        };
        let bit = if self.to[0] > self.from[0] {
            high[1]
        } else {
            low[1]
        };
        turn(&self.from, &self.to, &[row, bit]) > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn the_winding_number_rises_behind_lower_facets_and_falls_behind_upper_ones() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let operands = scene.operands();
        let facets = Facets::new(&scene.cell, &operands, &scene.sources).expect("upright");
        assert_eq!(facets.all.len(), 12);
        let change = |f: &Facet| if f.at == 1 { 1 } else { -1 };
        assert!(facets.all.iter().all(|f| f.change() == change(f)));
    }

    #[test]
    fn each_place_beside_a_diagonal_is_held_by_one_of_its_triangles() {
        let scene = Shared::of(&[cuboid([0; 3], [4; 3])]);
        let operands = scene.operands();
        let facets = Facets::new(&scene.cell, &operands, &scene.sources).expect("upright");
        for pair in facets.all.chunks(2) {
            for corner in (0..8).flat_map(|row| (0..8).map(move |bit| [row, bit])) {
                assert_eq!(pair.iter().filter(|f| f.contains(corner)).count(), 1);
            }
        }
    }
}
