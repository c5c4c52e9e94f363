//! Divides a face into cells along the segments in which other faces meet it.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::{smallvec, SmallVec};

use super::contacts::{Cover, Line, MeetingPoint, Segment};
use super::facets::{FacetId, Facets};
use super::keep_rule::{Numbers, Sides};
use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::geometry::edge::{LatticeEdge, Ring};
use crate::geometry::outline::BareEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Carrier;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::merge::division::{
    axes, cell_with_probe, Defect, Division, PositionInPolygon, Probe, Triangulation,
};
use crate::merge::profile::Declined;
use crate::mesh::handle::VertexId;

/// The exact points and planes that the divisions of all faces share.
#[derive(Debug)]
pub(super) struct SharedGeometry<'a> {
    pub(super) facets: &'a Facets<'a>,
    pub(super) points: &'a [MeetingPoint],
    /// For each point its exact position.
    pub(super) vertices: Vec<Arc<Vertex>>,
    /// The planes of the divided facets.
    pub(super) planes: Planes,
}

pub(super) type Planes = HashMap<FacetId, Arc<Plane>>;

/// A face to be divided, with the segments that divide it and the coplanar faces that cover it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face<'a> {
    pub(super) facet: FacetId,
    pub(super) operand: usize,
    pub(super) corners: [Lattice; 3],
    pub(super) vertices: [VertexId; 3],
    pub(super) plane: &'a Arc<Plane>,
    pub(super) segments: &'a [Segment],
    pub(super) covers: &'a [Cover],
}

/// A face divided into triangular cells, with winding numbers on both sides of each cell.
#[derive(Debug)]
pub(super) struct Arrangement<'a> {
    pub(super) face: Face<'a>,
    division: Division,
    /// The winding numbers of each operand.
    numbers: SmallVec<[CellNumbers; 2]>,
    /// For each cell, whether a facet of the same operand with a lower number covers it; empty if none does.
    is_of_earlier: Vec<bool>,
}

/// The winding numbers of one operand at the cells of a divided face; a table is empty if all its entries are
/// zero.
#[derive(Clone, Debug, Default)]
struct CellNumbers {
    /// The number in front of a cell, minus the number in front of the face's first cell.
    in_front: Vec<i32>,
    /// The number behind a cell, minus the number in front of it, without the contribution of the face
    /// itself.
    behind: Vec<i32>,
    /// The number of faces of the operand that cover a cell.
    covers: Vec<u32>,
}

/// Returns the entry of a table in which missing entries are zero.
fn entry<T: Copy + Default>(table: &[T], cell: usize) -> T {
    table.get(cell).copied().unwrap_or_default()
}

impl<'a> Arrangement<'a> {
    /// Divides a face along its segments and computes the winding numbers of its cells.
    ///
    /// # Errors
    /// `Defect` if a segment leaves the face.
    pub(super) fn new(face: Face<'a>, shared: &SharedGeometry) -> Result<Self, Declined> {
        let operands = shared.facets.operands.len();
        let mut made = Self {
            division: divided(&face, shared)?,
            face,
            numbers: smallvec![CellNumbers::default(); operands],
            is_of_earlier: Vec::new(),
        };
        for operand in 0..operands {
            made.numbers[operand].in_front = made.numbers_in_front(operand, shared.facets);
        }
        for cover in face.covers {
            made.cover(cover.other, shared.facets);
        }
        Ok(made)
    }

    /// Returns the number of triangular cells.
    pub(super) fn len(&self) -> usize {
        self.division.len()
    }

    /// Returns an operand's winding number in front of a cell, minus the number in front of the first cell.
    pub(super) fn in_front(&self, operand: usize, cell: usize) -> i32 {
        entry(&self.numbers[operand].in_front, cell)
    }

    /// Returns an operand's winding number in front of the face at one of its corners, minus the number in
    /// front of the face's first cell.
    pub(super) fn at_corner(&self, operand: usize, corner: usize) -> i32 {
        self.in_front(operand, self.division.cell_at_corner(corner))
    }

    /// Returns a triangular cell of the divided face for which `count` finds a winding number at a point
    /// inside the cell, with this number; `None` if there is none.
    pub(super) fn count_in_cell(
        &mut self,
        count: impl FnMut(&Probe) -> Option<i32>,
    ) -> Option<(usize, i32)> {
        cell_with_probe(self.division.triangulation(), self.face.plane, count)
    }

    /// Returns an operand's winding numbers in front of the cells, minus the number in front of the first
    /// cell; empty if the operand has no face along a segment.
    fn numbers_in_front(&self, operand: usize, facets: &Facets) -> Vec<i32> {
        let is_of = |segment: &Segment| facets.operand_of(segment.other) == operand;
        if !self.face.segments.iter().any(is_of) {
            return Vec::new();
        }
        // The left of a segment is behind the other face, where the number is larger.
        let change = |(segment, is_along): (usize, bool)| match &self.face.segments[segment] {
            segment if !is_of(segment) || !segment.line.changes_number() => 0,
            _ if is_along => 1,
            _ => -1,
        };
        self.division.spread(0, |here, cell, edge| {
            here - self
                .division
                .along_edge(cell, edge)
                .map(change)
                .sum::<i32>()
        })
    }

    /// Records which cells a facet of the same plane covers, and how it changes the number behind them.
    fn cover(&mut self, other: FacetId, facets: &Facets) {
        let axis = self.face.plane.main_axis();
        let is_up = self.face.plane.normal()[axis] > 0;
        let corners = facets.corners(other);
        let outer = [0, 1, 2].map(|i| Plane::beside_edge(&corners[i], &corners[(i + 1) % 3], axis));
        let turn = LatticeEdge::new(corners[0], corners[1]).sign_beside(&corners[2], axis);
        // The third corner lies inside the other face, and shows on which side of its first edge the inside
        // is.
        let is_same = (turn == Sign::Negative) == is_up;
        let outside = Side::from_sign(-turn);
        let is_out = |v: &Vertex| outer.iter().any(|plane| v.side_of(plane) == outside);
        let operand = facets.operand_of(other);
        let is_earlier = operand == self.face.operand && other < self.face.facet;
        let cells = self.division.len();
        let numbers = &mut self.numbers[operand];
        numbers.behind.resize(cells, 0);
        numbers.covers.resize(cells, 0);
        self.is_of_earlier.resize(cells, false);
        for cell in 0..cells {
            if !self.division.corners_of(cell).into_iter().any(is_out) {
                numbers.behind[cell] += if is_same { 1 } else { -1 };
                numbers.covers[cell] += 1;
                self.is_of_earlier[cell] |= is_earlier;
            }
        }
    }

    /// Returns the winding numbers on both sides of a cell, given those in front of the face's first cell.
    pub(super) fn sides(&self, cell: usize, first: &Numbers) -> Sides {
        let with = |numbers: &Numbers, table: fn(&CellNumbers) -> &Vec<i32>| -> Numbers {
            let pairs = numbers.iter().zip(&self.numbers);
            pairs.map(|(n, of)| n + entry(table(of), cell)).collect()
        };
        let in_front = with(first, |of| &of.in_front);
        let mut behind = with(&in_front, |of| &of.behind);
        behind[self.face.operand] += 1;
        Sides { in_front, behind }
    }

    /// Returns the number of faces of an operand that cover a cell.
    pub(super) fn covers(&self, operand: usize, cell: usize) -> u32 {
        entry(&self.numbers[operand].covers, cell)
    }

    /// Returns true if a face of the same operand that precedes this one covers a cell.
    pub(super) fn is_of_earlier(&self, cell: usize) -> bool {
        entry(&self.is_of_earlier, cell)
    }

    /// Returns the outline of the cells for which `is_kept` is true; collinear consecutive edges are merged.
    pub(super) fn outline(&mut self, is_kept: &[bool]) -> Vec<BareEdge> {
        self.division.outline(is_kept)
    }
}

/// Divides a face along its segments.
fn divided(face: &Face, shared: &SharedGeometry) -> Result<Division, Defect> {
    let ring = Arc::new(Ring::from_slice(&face.corners));
    let corner = |(i, at): (u32, &Lattice)| {
        let side = Carrier::Edge(LatticeEdge::of_ring(&ring, i));
        (Arc::new(Vertex::lattice(*at)), side)
    };
    let corners: SmallVec<[_; 3]> = (0..).zip(&face.corners).map(corner).collect();
    let mut division = Division::of(face.plane, corners.into_iter())?;
    let places = insert(&mut division, face, shared)?;
    for segment in face.segments {
        let ends = segment.ends.map(|p| places.of(p));
        let cut = cut(segment, face, shared);
        let ends = directed(division.triangulation(), ends, segment.line, &cut, face);
        division.cut_along(ends, cut)?;
    }
    Ok(division)
}

/// Returns the winding number that `count` finds at a point inside a face; `None` if the face is too thin for
/// such a point.
pub(super) fn count_in_face(
    corners: &[Lattice; 3],
    plane: &Arc<Plane>,
    count: impl FnMut(&Probe) -> Option<i32>,
) -> Option<i32> {
    let corners = corners.map(|c| Arc::new(Vertex::lattice(c)));
    let mut face = Triangulation::new(corners.into_iter(), axes(plane));
    cell_with_probe(&mut face, plane, count).map(|(_, number)| number)
}

/// Returns a plane that cuts a face along a segment.
fn cut(segment: &Segment, face: &Face, shared: &SharedGeometry) -> Arc<Plane> {
    match segment.line {
        Line::Directed | Line::Touching { .. } => Arc::clone(&shared.planes[&segment.other]),
        Line::Edge(edge) => {
            let corners = shared.facets.corners(segment.other);
            let (a, b) = (&corners[edge], &corners[(edge + 1) % 3]);
            let plane = Plane::through_edge(a, b, face.plane.main_axis());
            Arc::new(plane.expect("no edge of a face is parallel to the main axis of its plane"))
        }
    }
}

/// Returns the ends of a segment, ordered so that its left in the face is on the minus side of the plane
/// `cut`.
fn directed(
    cells: &mut Triangulation,
    [from, to]: [u32; 2],
    line: Line,
    cut: &Plane,
    face: &Face,
) -> [u32; 2] {
    let (corner, side) = match line {
        Line::Directed => return [from, to],
        Line::Touching { corner, side, .. } => (corner, side),
        Line::Edge(_) => {
            let sides = face.corners.each_ref().map(|c| cut.side_of_lattice(c));
            let corner = (0..3).find(|i| sides[*i] != Side::On).unwrap_or(0);
            (corner, sides[corner])
        }
    };
    let is_left = cells.turn([from, to, as_number(corner)]) == Sign::Positive;
    if is_left == (side == Side::Minus) {
        [from, to]
    } else {
        [to, from]
    }
}

/// The numbers in a face's triangulation of the points in which faces meet, by the index of the point.
struct PointNumbers(SmallVec<[(u32, u32); 16]>);

impl PointNumbers {
    fn of(&self, point: u32) -> u32 {
        let at = self.0.binary_search_by_key(&point, |p| p.0);
        at.map_or(0, |i| self.0[i].1)
    }
}

/// Inserts the ends of a face's segments into its triangulation, and returns their numbers there.
fn insert(
    division: &mut Division,
    face: &Face,
    shared: &SharedGeometry,
) -> Result<PointNumbers, Defect> {
    let mut points: SmallVec<[u32; 16]> = face.segments.iter().flat_map(|s| s.ends).collect();
    points.sort_unstable();
    points.dedup();
    let end = |p: &u32| {
        let position = face.position_of(&shared.points[*p as usize]);
        (&shared.vertices[*p as usize], position)
    };
    let ends: SmallVec<[_; 16]> = points.iter().map(end).collect();
    let places = division.insert(&ends)?;
    Ok(PointNumbers(points.into_iter().zip(places).collect()))
}

impl Face<'_> {
    /// Returns whether a point is a corner of the face, lies on one of its sides, or is not known to lie on
    /// its border, as its name tells.
    fn position_of(&self, point: &MeetingPoint) -> PositionInPolygon {
        let side = |(operand, ends): &(usize, [VertexId; 2])| {
            let is_it = |i: &usize| {
                let [a, b] = [self.vertices[*i], self.vertices[(i + 1) % 3]];
                *ends == [a.min(b), a.max(b)]
            };
            (0..3).find(is_it).filter(|_| *operand == self.operand)
        };
        let side = match point {
            MeetingPoint::Corner(at) => {
                let corner = self.corners.iter().position(|c| c == at);
                return corner.map_or(PositionInPolygon::Inside, PositionInPolygon::Corner);
            }
            MeetingPoint::Through(edge, _) => side(edge),
            MeetingPoint::Edges(edges) => edges.iter().find_map(side),
        };
        side.map_or(PositionInPolygon::Inside, PositionInPolygon::Side)
    }
}
