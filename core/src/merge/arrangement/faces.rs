//! The arrangement in one face: the cells into which the other operand's surface divides it.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::segments::{Crossing, Segment};
use super::triangulation::{Special, Triangulation, NONE};
use crate::arith::convert::as_number;
use crate::geometry::edge::{LatticeEdge, Ring};
use crate::geometry::outline::BareEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Carrier;
use crate::geometry::vertex::Vertex;
use crate::mesh::handle::{FaceId, VertexId};

/// The points and planes that the arrangements of all faces share.
#[derive(Debug)]
pub(super) struct Shared<'a> {
    pub(super) crossings: &'a [Crossing],
    /// The points of the crossings.
    pub(super) vertices: Vec<Arc<Vertex>>,
    /// For each operand the planes of its candidates that are cut.
    pub(super) planes: [Planes; 2],
}

/// The planes of faces, by their numbers among the candidates.
pub(super) type Planes = HashMap<u32, Arc<Plane>>;

/// A face that is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face<'a> {
    pub(super) operand: usize,
    pub(super) id: FaceId,
    pub(super) corners: [Lattice; 3],
    pub(super) vertices: [VertexId; 3],
    pub(super) plane: &'a Arc<Plane>,
    pub(super) segments: &'a [Segment],
}

/// A face divided into cells.
#[derive(Debug)]
pub(super) struct Arrangement<'a> {
    face: Face<'a>,
    ring: Arc<Ring>,
    cells: Triangulation,
    /// For each cell by how much the other operand's winding number exceeds that in the first cell.
    numbers: Vec<i32>,
}

impl<'a> Arrangement<'a> {
    /// The arrangement of a face's segments.
    ///
    /// # Errors
    /// `Special` if segments cross, or points coincide: then the other operand overlaps itself.
    pub(super) fn new(face: Face<'a>, shared: &Shared) -> Result<Self, Special> {
        let corners = face.corners.map(|c| Arc::new(Vertex::lattice(c)));
        let mut cells = Triangulation::new(corners, axes(face.plane));
        let local = insert(&mut cells, &face, shared)?;
        for (number, segment) in (0..).zip(face.segments) {
            cells.constrain(segment.ends.map(|p| local.of(p)), number)?;
        }
        let numbers = numbers(&cells);
        let ring = Arc::new(Ring::from_slice(&face.corners));
        Ok(Self {
            face,
            ring,
            cells,
            numbers,
        })
    }

    /// The face.
    pub(super) fn face(&self) -> &Face<'a> {
        &self.face
    }

    /// At each corner of the face by how much the number exceeds that in the first cell.
    pub(super) fn at_corners(&self) -> [i32; 3] {
        [0, 1, 2].map(|corner| self.numbers[self.cells.cell_at(corner) as usize])
    }

    /// The numbers of all cells.
    pub(super) fn numbers(&self) -> &[i32] {
        &self.numbers
    }

    /// The outline of the cells with some numbers; no two of its edges continue each other.
    pub(super) fn outline(&self, holds: impl Fn(i32) -> bool, planes: &Planes) -> Vec<BareEdge> {
        let mut next = self.borders(holds);
        let mut edges = Vec::new();
        for start in 0..as_number(next.len()) {
            let mut at = start;
            let mut ring: SmallVec<[BareEdge; 8]> = SmallVec::new();
            while let Some(border) = next[at as usize].take() {
                join(&mut ring, self.edge(at, border, planes));
                at = border.to;
            }
            close(&mut ring);
            edges.extend(ring);
        }
        edges
    }

    /// For each point the border between the cells with some numbers and all others that leaves it: in
    /// general position there is one at most.
    fn borders(&self, holds: impl Fn(i32) -> bool) -> Vec<Option<Border>> {
        let mut next = vec![None; self.cells.len()];
        let held = |cell: u32| cell != NONE && holds(self.numbers[cell as usize]);
        for (number, cell) in (0..).zip(self.cells.cells()) {
            let inside = held(number);
            for i in (0..3).filter(|i| inside && !held(cell.mates[*i])) {
                let (to, mark) = (cell.corners[(i + 1) % 3], cell.marks[i]);
                next[cell.corners[i] as usize] = Some(Border { to, mark });
            }
        }
        next
    }

    fn edge(&self, from: u32, border: Border, planes: &Planes) -> BareEdge {
        let carrier = if border.mark == 0 {
            let edge = self.cells.rim([from, border.to]);
            Carrier::Edge(LatticeEdge::of_ring(&self.ring, as_number(edge)))
        } else {
            let segment = border.mark.unsigned_abs() as usize - 1;
            let other = self.face.segments[segment].other;
            // What is behind the other face lies on the segment's left.
            Carrier::Cut(Arc::clone(&planes[&other]), border.mark < 0)
        };
        BareEdge {
            from: Arc::clone(self.cells.vertex(from)),
            to: Arc::clone(self.cells.vertex(border.to)),
            carrier,
        }
    }
}

/// A border of cells on its left.
#[derive(Clone, Copy, Debug)]
struct Border {
    to: u32,
    /// As a cell's.
    mark: i32,
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
fn insert(cells: &mut Triangulation, face: &Face, shared: &Shared) -> Result<Places, Special> {
    let mut points: SmallVec<[u32; 16]> = face.segments.iter().flat_map(|s| s.ends).collect();
    points.sort_unstable();
    points.dedup();
    let mut places = SmallVec::with_capacity(points.len());
    for edge in 0..3 {
        let on: SmallVec<[u32; 8]> = points
            .iter()
            .copied()
            .filter(|p| face.rim(&shared.crossings[*p as usize]) == Some(edge))
            .collect();
        insert_on_border(cells, face, shared, edge, on, &mut places);
    }
    for point in points {
        if face.rim(&shared.crossings[point as usize]).is_none() {
            let vertex = Arc::clone(&shared.vertices[point as usize]);
            places.push((point, cells.insert(vertex)?));
        }
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
    for point in points {
        last = cells.divide_border([last, end], Arc::clone(vertex(point)));
        places.push((point, last));
    }
}

impl Face<'_> {
    /// The edge of the face that a crossing lies on.
    fn rim(&self, crossing: &Crossing) -> Option<usize> {
        let is_it = |i: &usize| {
            let [a, b] = [self.vertices[*i], self.vertices[(i + 1) % 3]];
            crossing.edge == [a.min(b), a.max(b)]
        };
        (0..3).find(is_it).filter(|_| crossing.of == self.operand)
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

/// For each cell the number beyond that of the first: it changes by one across each segment.
fn numbers(cells: &Triangulation) -> Vec<i32> {
    let cells = cells.cells();
    let mut numbers = vec![None; cells.len()];
    numbers[0] = Some(0);
    let mut open = vec![0u32];
    while let Some(at) = open.pop() {
        let cell = &cells[at as usize];
        let here = numbers[at as usize].unwrap_or(0);
        for (mate, mark) in cell.mates.iter().zip(cell.marks) {
            if *mate != NONE && numbers[*mate as usize].is_none() {
                // A cell on the left of a segment is behind the other face, its mate is in front.
                numbers[*mate as usize] = Some(here - mark.signum());
                open.push(*mate);
            }
        }
    }
    numbers.into_iter().map(|n| n.unwrap_or(0)).collect()
}

/// Adds an edge to a loop, or makes the last one longer by it.
fn join(ring: &mut SmallVec<[BareEdge; 8]>, edge: BareEdge) {
    match ring.last_mut() {
        Some(last) if continues(last, &edge) => last.to = edge.to,
        _ => ring.push(edge),
    }
}

/// Joins the last edge of a loop to the first one, if it is continued by that.
fn close(ring: &mut SmallVec<[BareEdge; 8]>) {
    if let [first, .., last] = &mut ring[..]
        && continues(last, first)
    {
        first.from = Arc::clone(&last.from);
        ring.pop();
    }
}

/// Return whether two edges that follow each other in a face lie on one line.
fn continues(edge: &BareEdge, next: &BareEdge) -> bool {
    match (&edge.carrier, &next.carrier) {
        (Carrier::Cut(p, _), Carrier::Cut(q, _)) => Arc::ptr_eq(p, q) || p.coincides(q).is_some(),
        _ => false,
    }
}
