//! Divides a face into cells along the segments in which other faces meet it.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::segments::{Cover, Line, MeetingPoint, Segment};
use super::surfaces::Surfaces;
use super::windings::Probe;
use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::geometry::edge::{LatticeEdge, Ring};
use crate::geometry::outline::BareEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Carrier;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::merge::division::{axes, Defect, Division, PositionInPolygon, Triangulation};
use crate::merge::profile::Declined;
use crate::mesh::handle::VertexId;

/// The exact points and planes that the divisions of all faces share.
#[derive(Debug)]
pub(super) struct SharedGeometry<'a> {
    pub(super) surfaces: &'a Surfaces<'a>,
    pub(super) points: &'a [MeetingPoint],
    /// For each point its exact position.
    pub(super) vertices: Vec<Arc<Vertex>>,
    /// The planes of the divided faces, by face number (faces of both operands are numbered together).
    pub(super) planes: Planes,
}

/// Planes of faces, by face number (faces of both operands are numbered together).
pub(super) type Planes = HashMap<u32, Arc<Plane>>;

/// A face to be divided, with the segments that divide it and the coplanar faces that cover it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face<'a> {
    pub(super) number: u32,
    pub(super) operand: usize,
    pub(super) corners: [Lattice; 3],
    pub(super) vertices: [VertexId; 3],
    pub(super) plane: &'a Arc<Plane>,
    pub(super) segments: &'a [Segment],
    pub(super) covers: &'a [Cover],
}

/// A face divided into triangular cells, with the winding numbers on both sides of each cell.
#[derive(Debug)]
pub(super) struct Arrangement<'a> {
    pub(super) face: Face<'a>,
    division: Division,
    pub(super) cells: Vec<CellNumbers>,
}

/// The winding numbers in front of and behind a cell of a face: the other operand's, or for one mesh its own.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellNumbers {
    /// The winding number in front of the cell, minus the number in front of the face's first cell.
    pub(super) in_front: i32,
    /// The winding number behind the cell, minus the number in front of it, without the contribution of the
    /// face itself.
    pub(super) behind: i32,
    /// The number of other faces of the same plane that cover the triangular cell.
    pub(super) covers: u32,
    /// Whether a covering face has a lower number than the divided face (faces of both operands are numbered
    /// together).
    pub(super) is_of_earlier: bool,
}

impl<'a> Arrangement<'a> {
    /// Divides a face along its segments and computes the winding numbers of its cells.
    ///
    /// # Errors
    /// `Defect` if a segment leaves the face.
    pub(super) fn new(face: Face<'a>, shared: &SharedGeometry) -> Result<Self, Declined> {
        let mut made = Self {
            division: divided(&face, shared)?,
            face,
            cells: Vec::new(),
        };
        made.cells = made.numbers_in_front();
        made.cover(shared);
        Ok(made)
    }

    /// Returns the winding number in front of the face at one of its corners, minus the number in front of
    /// the face's first triangular cell.
    pub(super) fn at_corner(&self, corner: u32) -> i32 {
        self.cells[self.division.cell_at_corner(corner as usize)].in_front
    }

    /// Returns a triangular cell of the divided face for which `count` finds a winding number at a point
    /// inside the cell, with this number; `None` if there is none.
    pub(super) fn count_in_cell(
        &mut self,
        count: impl FnMut(&Probe) -> Option<i32>,
    ) -> Option<(usize, i32)> {
        cell_with_number(self.division.triangulation(), self.face.plane, count)
    }

    /// Returns for each triangular cell of the divided face the winding number in front of it, relative to
    /// the first cell.
    fn numbers_in_front(&self) -> Vec<CellNumbers> {
        let numbers = self
            .division
            .spread(0, |here, cell, edge| here - self.change(cell, edge));
        let cell = |in_front: i32| CellNumbers {
            in_front,
            ..CellNumbers::default()
        };
        numbers.into_iter().map(cell).collect()
    }

    /// Returns the winding number in front of a triangular cell of the face minus the number in front of its
    /// neighbour across an edge: the left of a segment is behind the other face, where the number is larger.
    fn change(&self, cell: usize, edge: usize) -> i32 {
        let change = |(segment, is_along): (usize, bool)| match self.face.segments[segment].line {
            Line::Directed | Line::Touching { in_front: true, .. } => {
                if is_along {
                    1
                } else {
                    -1
                }
            }
            Line::Touching { .. } | Line::Edge(_) => 0,
        };
        self.division.along_edge(cell, edge).map(change).sum()
    }

    /// Records which triangular cells of the face are covered by other faces of the same plane, and how these
    /// change the number behind.
    fn cover(&mut self, shared: &SharedGeometry) {
        let axis = self.face.plane.main_axis();
        let is_up = self.face.plane.normal()[axis] > 0;
        for Cover { other, .. } in self.face.covers {
            let corners = shared.surfaces.corners(*other);
            let outer =
                [0, 1, 2].map(|i| Plane::beside_edge(&corners[i], &corners[(i + 1) % 3], axis));
            let turn = LatticeEdge::new(corners[0], corners[1]).sign_beside(&corners[2], axis);
            // The third corner lies inside the other face, and shows on which side of its first edge the
            // inside is.
            let is_same = (turn == Sign::Negative) == is_up;
            let outside = Side::from_sign(-turn);
            for cell in 0..self.cells.len() {
                let is_out = |v: &Vertex| outer.iter().any(|plane| v.side_of(plane) == outside);
                if !self.division.corners_of(cell).into_iter().any(is_out) {
                    let cell = &mut self.cells[cell];
                    cell.behind += if is_same { 1 } else { -1 };
                    cell.covers += 1;
                    cell.is_of_earlier |= *other < self.face.number;
                }
            }
        }
    }

    /// Returns the outline of the face's triangular cells for which `is_kept` is true; collinear consecutive
    /// edges are merged.
    pub(super) fn outline(&mut self, is_kept: impl Fn(&CellNumbers) -> bool) -> Vec<BareEdge> {
        let is_kept: Vec<bool> = self.cells.iter().map(is_kept).collect();
        self.division.outline(&is_kept)
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
    cell_with_number(&mut face, plane, count).map(|(_, number)| number)
}

/// Returns a triangular cell of a face for which `count` finds a winding number at a point inside the cell,
/// with this number. Tries the widest cells first, and several points of each, because another surface may
/// touch the cell at a point.
fn cell_with_number(
    cells: &mut Triangulation,
    plane: &Arc<Plane>,
    mut count: impl FnMut(&Probe) -> Option<i32>,
) -> Option<(usize, i32)> {
    const WEIGHTS: [[f64; 3]; 4] = [
        [1.0, 1.0, 1.0],
        [5.0, 3.0, 2.0],
        [2.0, 5.0, 3.0],
        [3.0, 2.0, 5.0],
    ];
    let mut order: Vec<u32> = (0..as_number(cells.cells().len())).collect();
    order.sort_by(|a, b| cells.size(*b).total_cmp(&cells.size(*a)));
    let points = order
        .into_iter()
        .flat_map(|cell| WEIGHTS.map(|w| (cell, w)));
    points.into_iter().find_map(|(cell, weights)| {
        let probe = Probe::at_coordinates(cells.mean(cell, weights), plane)?;
        let is_inside = cells.contains(cell, Arc::clone(&probe.point));
        let number = if is_inside { count(&probe) } else { None };
        Some((cell as usize, number?))
    })
}

/// Returns a plane that cuts a face along a segment.
fn cut(segment: &Segment, face: &Face, shared: &SharedGeometry) -> Arc<Plane> {
    match segment.line {
        Line::Directed | Line::Touching { .. } => Arc::clone(&shared.planes[&segment.other]),
        Line::Edge(edge) => {
            let corners = shared.surfaces.corners(segment.other);
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
