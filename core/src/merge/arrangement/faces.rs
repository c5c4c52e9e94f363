//! The arrangement in one face: the cells into which the surfaces that meet it divide it.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::segments::{Cover, Line, Point, Segment};
use super::surfaces::Surfaces;
use super::triangulation::{Triangulation, NONE};
use super::windings::Probe;
use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::geometry::edge::{LatticeEdge, Ring};
use crate::geometry::outline::BareEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Carrier;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::merge::profile::Declined;
use crate::mesh::handle::VertexId;

/// The points and planes that the arrangements of all faces share.
#[derive(Debug)]
pub(super) struct Shared<'a> {
    pub(super) surfaces: &'a Surfaces<'a>,
    pub(super) points: &'a [Point],
    /// The places of the points.
    pub(super) vertices: Vec<Arc<Vertex>>,
    /// The planes of the faces that are divided.
    pub(super) planes: Planes,
}

/// The planes of faces.
pub(super) type Planes = HashMap<u32, Arc<Plane>>;

/// A face that is divided, and what divides it.
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

/// A face divided into cells.
#[derive(Debug)]
pub(super) struct Arrangement<'a> {
    pub(super) face: Face<'a>,
    ring: Arc<Ring>,
    triangulation: Triangulation,
    /// For each segment the plane that has what is on its left on the minus side.
    cuts: Vec<Arc<Plane>>,
    pub(super) cells: Vec<CellNumbers>,
}

/// The winding numbers around a cell: of the other operand, or of the mesh that is compared with itself.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellNumbers {
    /// By how much the number in front exceeds that in front of the first cell.
    pub(super) in_front: i32,
    /// By how much the number behind exceeds that in front, but for the face itself.
    pub(super) behind: i32,
    /// The number of other faces in the same plane that have the cell, too.
    pub(super) covers: u32,
    /// True if one of these comes before the face.
    pub(super) is_of_earlier: bool,
}

impl<'a> Arrangement<'a> {
    /// The arrangement in a face.
    ///
    /// # Errors
    /// `Defect` if a segment leaves the face: there is a defect.
    pub(super) fn new(face: Face<'a>, shared: &Shared) -> Result<Self, Declined> {
        let corners = face.corners.map(|c| Arc::new(Vertex::lattice(c)));
        let mut triangulation = Triangulation::new(corners, axes(face.plane));
        let places = insert(&mut triangulation, &face, shared)?;
        let mut cuts: Vec<Arc<Plane>> = Vec::with_capacity(face.segments.len());
        for (number, segment) in (0..).zip(face.segments) {
            let ends = segment.ends.map(|p| places.of(p));
            let cut = cut(segment, &face, shared);
            let ends = directed(&mut triangulation, ends, segment.line, &cut, &face);
            cuts.push(cut);
            let meet = |other: u32| {
                let other = &cuts[other as usize];
                let vertex = Vertex::meet(face.plane, &cuts[number as usize], other);
                Arc::new(vertex.expect("segments that cross lie in different planes"))
            };
            triangulation.constrain(ends, number, meet)?;
        }
        let mut made = Self {
            ring: Arc::new(Ring::from_slice(&face.corners)),
            face,
            triangulation,
            cuts,
            cells: Vec::new(),
        };
        made.cells = made.numbered();
        made.cover(shared);
        Ok(made)
    }

    /// At a corner of the face by how much the number in front exceeds that in front of the first cell.
    pub(super) fn at_corner(&self, corner: u32) -> i32 {
        self.cells[self.triangulation.cell_at(corner) as usize].in_front
    }

    /// A cell, and the number that is counted at a point inside it.
    pub(super) fn counted(
        &mut self,
        count: impl FnMut(&Probe) -> Option<i32>,
    ) -> Option<(usize, i32)> {
        counted(&mut self.triangulation, self.face.plane, count)
    }

    /// The corners of a cell.
    fn corners_of(&self, cell: usize) -> [&Vertex; 3] {
        let corners = self.triangulation.cells()[cell].corners;
        corners.map(|c| &**self.triangulation.vertex(c))
    }

    /// The cells, with the numbers in front of them.
    fn numbered(&self) -> Vec<CellNumbers> {
        let cells = self.triangulation.cells();
        let mut numbers = vec![None; cells.len()];
        numbers[0] = Some(0);
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let here = numbers[at as usize].unwrap_or(0);
            for (edge, mate) in cells[at as usize].mates.into_iter().enumerate() {
                if mate != NONE && numbers[mate as usize].is_none() {
                    numbers[mate as usize] = Some(here - self.change(at, edge));
                    open.push(mate);
                }
            }
        }
        let cell = |n: Option<i32>| CellNumbers {
            in_front: n.unwrap_or(0),
            ..CellNumbers::default()
        };
        numbers.into_iter().map(cell).collect()
    }

    /// By how much the number in front of a cell exceeds that across an edge: what lies on the left of a
    /// segment is behind the other face.
    fn change(&self, cell: u32, edge: usize) -> i32 {
        let change =
            |(segment, is_along): (u32, bool)| match self.face.segments[segment as usize].line {
                Line::Directed | Line::Touching { in_front: true, .. } => {
                    if is_along {
                        1
                    } else {
                        -1
                    }
                }
                Line::Touching { .. } | Line::Edge(_) => 0,
            };
        self.triangulation.along_edge(cell, edge).map(change).sum()
    }

    /// Notes which cells other faces have, too, that lie in the same plane.
    fn cover(&mut self, shared: &Shared) {
        let axis = self.face.plane.main_axis();
        let is_up = self.face.plane.normal()[axis] > 0;
        for Cover { other, .. } in self.face.covers {
            let corners = shared.surfaces.corners(*other);
            let outer =
                [0, 1, 2].map(|i| Plane::beside_edge(&corners[i], &corners[(i + 1) % 3], axis));
            let turn = LatticeEdge::new(corners[0], corners[1]).sign_beside(&corners[2], axis);
            // The third corner lies inside, and so does all on its side of the first edge.
            let is_same = (turn == Sign::Negative) == is_up;
            let outside = Side::from_sign(-turn);
            for cell in 0..self.cells.len() {
                let is_out = |v: &Vertex| outer.iter().any(|plane| v.side_of(plane) == outside);
                if !self.corners_of(cell).into_iter().any(is_out) {
                    let cell = &mut self.cells[cell];
                    cell.behind += if is_same { 1 } else { -1 };
                    cell.covers += 1;
                    cell.is_of_earlier |= *other < self.face.number;
                }
            }
        }
    }

    /// The outline of some cells; no two of its edges continue each other.
    pub(super) fn outline(&mut self, holds: impl Fn(&CellNumbers) -> bool) -> Vec<BareEdge> {
        let holds: Vec<bool> = self.cells.iter().map(holds).collect();
        let is_border = |this: &Self, (cell, edge): (u32, usize)| {
            let mate = this.triangulation.cells()[cell as usize].mates[edge];
            mate == NONE || !holds[mate as usize]
        };
        let mut is_done = vec![[false; 3]; holds.len()];
        let mut edges = Vec::new();
        for start in (0..as_number(holds.len())).flat_map(|c| [(c, 0), (c, 1), (c, 2)]) {
            if !holds[start.0 as usize]
                || is_done[start.0 as usize][start.1]
                || !is_border(self, start)
            {
                continue;
            }
            let mut ring: SmallVec<[(u32, usize); 8]> = SmallVec::new();
            let mut at = start;
            while !std::mem::replace(&mut is_done[at.0 as usize][at.1], true) {
                ring.push(at);
                at = (at.0, (at.1 + 1) % 3);
                while !is_border(self, at) {
                    at = self.triangulation.across(at);
                    at.1 = (at.1 + 1) % 3;
                }
            }
            self.add_ring(&ring, &mut edges);
        }
        edges
    }

    /// Adds a loop of borders, those that continue each other as one.
    fn add_ring(&mut self, ring: &[(u32, usize)], edges: &mut Vec<BareEdge>) {
        let turns = |this: &mut Self, i: usize| {
            let before = ring[(i + ring.len() - 1) % ring.len()];
            if this.have_one_cut(before, ring[i]) {
                return false;
            }
            let ((from, at), (_, to)) = (
                this.triangulation.ends(before),
                this.triangulation.ends(ring[i]),
            );
            this.triangulation.turn([from, at, to]) != Sign::Zero
        };
        let corners: SmallVec<[usize; 8]> = (0..ring.len()).filter(|i| turns(self, *i)).collect();
        for (k, first) in corners.iter().enumerate() {
            let (from, _) = self.triangulation.ends(ring[*first]);
            let (to, _) = self
                .triangulation
                .ends(ring[corners[(k + 1) % corners.len()]]);
            edges.push(BareEdge {
                from: Arc::clone(self.triangulation.vertex(from)),
                to: Arc::clone(self.triangulation.vertex(to)),
                carrier: self.carrier(ring[*first]),
            });
        }
    }

    /// Return whether two edges of cells lie in one plane that cuts the face; may return false negatives.
    fn have_one_cut(&self, first: (u32, usize), second: (u32, usize)) -> bool {
        let cut = |(cell, edge)| self.triangulation.along_edge(cell, edge).next();
        let cuts = cut(first).zip(cut(second));
        cuts.is_some_and(|((p, _), (q, _))| {
            let [p, q] = [p, q].map(|segment| &self.cuts[segment as usize]);
            Arc::ptr_eq(p, q) || p.coincides(q).is_some()
        })
    }

    fn carrier(&self, (cell, edge): (u32, usize)) -> Carrier {
        let (from, to) = self.triangulation.ends((cell, edge));
        if self.triangulation.cells()[cell as usize].mates[edge] == NONE {
            let rim = self.triangulation.rim([from, to]);
            return Carrier::Edge(LatticeEdge::of_ring(&self.ring, as_number(rim)));
        }
        let mut along = self.triangulation.along_edge(cell, edge);
        let (segment, is_along) = along
            .next()
            .expect("cells that differ are parted by a segment");
        Carrier::Cut(Arc::clone(&self.cuts[segment as usize]), !is_along)
    }
}

/// The number that is counted at a point inside a face; `None` if it is too thin.
pub(super) fn counted_in_face(
    corners: &[Lattice; 3],
    plane: &Arc<Plane>,
    count: impl FnMut(&Probe) -> Option<i32>,
) -> Option<i32> {
    let corners = corners.map(|c| Arc::new(Vertex::lattice(c)));
    let mut face = Triangulation::new(corners, axes(plane));
    counted(&mut face, plane, count).map(|(_, number)| number)
}

/// A cell and the number that is counted at a point inside it; the widest cells are tried first, and
/// several points of each: another surface may touch the cell in one of them.
fn counted(
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
        let probe = Probe::above(cells.mean(cell, weights), plane)?;
        let is_inside = cells.holds(cell, Arc::clone(&probe.point));
        let number = if is_inside { count(&probe) } else { None };
        Some((cell as usize, number?))
    })
}

/// The plane that cuts a face along a segment.
fn cut(segment: &Segment, face: &Face, shared: &Shared) -> Arc<Plane> {
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

/// The ends of a segment in the order in which what lies on its left is on the minus side of its cut.
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

/// The places of a face's points in its triangulation, by their numbers.
struct Places(SmallVec<[(u32, u32); 16]>);

impl Places {
    fn of(&self, point: u32) -> u32 {
        let at = self.0.binary_search_by_key(&point, |p| p.0);
        at.map_or(0, |i| self.0[i].1)
    }
}

/// Inserts the ends of a face's segments, those on its border first.
fn insert(cells: &mut Triangulation, face: &Face, shared: &Shared) -> Result<Places, Declined> {
    let mut points: SmallVec<[u32; 16]> = face.segments.iter().flat_map(|s| s.ends).collect();
    points.sort_unstable();
    points.dedup();
    let mut places = SmallVec::with_capacity(points.len());
    let rims: SmallVec<[Option<usize>; 16]> = points
        .iter()
        .map(|p| face.rim(&shared.points[*p as usize]))
        .collect();
    let on = |rim: Option<usize>| points.iter().zip(&rims).filter(move |p| *p.1 == rim);
    for edge in 0..3 {
        let on: SmallVec<[u32; 8]> = on(Some(edge)).map(|p| *p.0).collect();
        insert_on_border(cells, face, shared, edge, on, &mut places);
    }
    for (point, _) in on(None) {
        let place = match &shared.points[*point as usize] {
            Point::Corner(at) => face.corners.iter().position(|c| c == at),
            Point::Through(..) | Point::Edges(_) => None,
        };
        let place = match place {
            Some(corner) => as_number(corner),
            None => cells.insert(Arc::clone(&shared.vertices[*point as usize]))?,
        };
        places.push((*point, place));
    }
    places.sort_unstable();
    Ok(Places(places))
}

/// Inserts points of an edge of the face, in their order along it.
fn insert_on_border(
    cells: &mut Triangulation,
    face: &Face,
    shared: &Shared,
    edge: usize,
    mut points: SmallVec<[u32; 8]>,
    places: &mut SmallVec<[(u32, u32); 16]>,
) {
    let (from, to) = (&face.corners[edge], &face.corners[(edge + 1) % 3]);
    let length = |axis: &usize| (to[*axis] - from[*axis]).abs();
    let axis = (0..3).max_by_key(length).unwrap_or(0);
    let vertex = |point: u32| &shared.vertices[point as usize];
    points.sort_by(|p, q| vertex(*p).compare_along(vertex(*q), axis));
    if to[axis] < from[axis] {
        points.reverse();
    }
    let (mut last, end) = (as_number(edge), as_number((edge + 1) % 3));
    for (i, point) in points.iter().enumerate() {
        let is_known = i > 0 && vertex(points[i - 1]).same(vertex(*point));
        if !is_known {
            last = cells.divide_border([last, end], Arc::clone(vertex(*point)));
        }
        places.push((*point, last));
    }
}

impl Face<'_> {
    /// The edge of the face that a point is named by.
    fn rim(&self, point: &Point) -> Option<usize> {
        let of = |(operand, ends): &(usize, [VertexId; 2])| {
            let is_it = |i: &usize| {
                let [a, b] = [self.vertices[*i], self.vertices[(i + 1) % 3]];
                *ends == [a.min(b), a.max(b)]
            };
            (0..3).find(is_it).filter(|_| *operand == self.operand)
        };
        match point {
            Point::Corner(_) => None,
            Point::Through(edge, _) => of(edge),
            Point::Edges(edges) => edges.iter().find_map(of),
        }
    }
}

/// The axes along which a face turns left.
fn axes(plane: &Plane) -> [usize; 2] {
    let axis = plane.main_axis();
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    if plane.normal()[axis] > 0 {
        [u, v]
    } else {
        [v, u]
    }
}
