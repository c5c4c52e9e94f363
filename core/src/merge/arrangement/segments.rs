//! Finds the segments in which faces meet, and the ends of these segments.

use std::sync::atomic::{AtomicUsize, Ordering};

use rustc_hash::FxHashMap as HashMap;

use super::candidates::Candidates;
use super::contact::{contact, CommonPoint, Contact, PiercingPoint, Touching};
use super::surfaces::Surfaces;
use super::MAX_PAIRS_PER_FACE;
use crate::arith::convert::as_number;
use crate::geometry::doubles::{Facing, Triangle};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Side;
use crate::interrupt::{poll, spend};
use crate::merge::profile::Declined;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::tasks::{each, WorkSize};

/// The number of pairs of faces of one mesh that are intersected in one task.
const PAIRS_PER_BLOCK: usize = 1 << 9;

/// An edge: its operand (0 or 1), and the vertex numbers of its ends, the lower first.
pub(super) type Edge = (usize, [VertexId; 2]);

/// A point in which faces meet, named by the corner, the edge and face, or the edges that define it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum MeetingPoint {
    /// A corner of a face, at this lattice point.
    Corner(Lattice),
    /// The point in which an edge passes through the inside of a face; the face is given by its number (faces
    /// of both operands are numbered together).
    Through(Edge, u32),
    /// The point in which two edges cross.
    Edges([Edge; 2]),
}

/// A segment in which a face meets another face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// The number of the face that the segment divides (faces of both operands are numbered together).
    pub(super) face: u32,
    /// The number of the face that meets the divided face in the segment (faces of both operands are numbered
    /// together).
    pub(super) other: u32,
    /// The indices of the points at the ends of the segment.
    pub(super) ends: [u32; 2],
    /// The line that contains the segment, and the position of the other face relative to this line.
    pub(super) line: Line,
}

/// The line that contains a segment in which a face meets another face.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    /// The common line of both faces' planes. The segment is directed so that, seen from in front of the
    /// face, its left is behind the other face.
    Directed,
    /// The common line of both faces' planes, for faces that touch; the segment has no particular direction.
    Touching {
        /// The index of a corner of the face that does not lie on the line.
        corner: usize,
        /// The side of the other face's plane on which this corner lies.
        side: Side,
        /// Whether a part of the other face lies in front of the face.
        in_front: bool,
    },
    /// The line of an edge of the other face, which lies in the same plane; the edge is given by the index of
    /// its first corner.
    Edge(usize),
}

/// A pair of faces in one plane that have an area in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cover {
    /// The number of the first face of the pair (faces of both operands are numbered together).
    pub(super) face: u32,
    /// The number of the second face of the pair (faces of both operands are numbered together).
    pub(super) other: u32,
}

/// The points, segments and areas in which faces meet.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// The points in which faces meet; each name occurs once.
    pub(super) points: Vec<MeetingPoint>,
    /// The segments, sorted by face; a segment is listed once for each face that it divides.
    pub(super) segments: Vec<Segment>,
    /// The pairs of coplanar faces with a common area, ascending, each in both orders.
    pub(super) covers: Vec<Cover>,
    /// The numbers of the faces that touch others without simply crossing them, ascending; faces of both
    /// operands are numbered together.
    pub(super) touched: Vec<u32>,
    /// For each operand and each of its vertices, whether a face without this vertex may reach its point;
    /// empty if no vertex is reached.
    pub(super) touching: [Vec<bool>; 2],
    numbers: HashMap<MeetingPoint, u32>,
}

/// Two faces that meet, by their numbers (faces of both operands are numbered together), and how they meet.
struct MeetingFaces {
    pair: [u32; 2],
    kind: MeetingKind,
}

enum MeetingKind {
    Crossing([PiercingPoint; 2]),
    Touching(Box<Touching>),
}

/// Finds the contacts between the candidate faces of two operands.
///
/// # Errors
/// `Crowded` if more than `MAX_PAIRS_PER_FACE` pairs of boxes meet for each face.
pub(super) fn contacts_of(
    surfaces: &Surfaces,
    candidates: &[Candidates; 2],
    work_size: WorkSize,
) -> Result<Contacts, Declined> {
    let [first, second] = candidates;
    let left =
        AtomicUsize::new(MAX_PAIRS_PER_FACE * (first.triangles.len() + second.triangles.len()));
    let visit = |block: &[[u32; 2]]| -> Result<Vec<MeetingFaces>, Declined> {
        let take = |left: usize| left.checked_sub(block.len());
        left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
            .map_err(|_| Declined::Crowded)?;
        let triangle = |k: usize| move |face: u32| candidates[k].triangles[face as usize];
        Ok(meeting_faces(
            [&triangle(0), &triangle(1)],
            block,
            surfaces.second,
        ))
    };
    let met = first.tree.each_block(&second.tree, work_size, visit)?;
    Ok(Contacts::new(surfaces, met))
}

/// Finds the contacts of the given pairs of faces of one mesh.
pub(super) fn contacts_among(
    surfaces: &Surfaces,
    pairs: &[[u32; 2]],
    work_size: WorkSize,
) -> Contacts {
    let blocks = pairs.chunks(PAIRS_PER_BLOCK).collect();
    let operand = &surfaces.operands[0];
    let triangle = |face: u32| operand.triangle(FaceId(face));
    let met = each(work_size, blocks, |block: &[[u32; 2]]| {
        meeting_faces([&triangle, &triangle], block, 0)
    });
    Contacts::new(surfaces, met)
}

fn meeting_faces(
    [ours, theirs]: [&dyn Fn(u32) -> Triangle; 2],
    pairs: &[[u32; 2]],
    second: u32,
) -> Vec<MeetingFaces> {
    spend(pairs.len());
    let mut found = Vec::new();
    for run in pairs.chunk_by(|p, q| p[0] == q[0]) {
        let first = Facing::of(&ours(run[0][0]));
        for &[f, g] in run {
            let other = Facing::of(&theirs(g));
            let kind = match contact(&first, &other) {
                Contact::Apart => continue,
                Contact::Crossing(ends) => MeetingKind::Crossing(ends),
                Contact::Touching(touching) => MeetingKind::Touching(touching),
            };
            let pair = [f, second + g];
            found.push(MeetingFaces { pair, kind });
        }
    }
    found
}

impl Contacts {
    /// Returns the number of segments, counted once for each face that they divide.
    pub(super) fn len(&self) -> usize {
        self.segments.len()
    }

    /// Marks the vertices of the first operand for which `touching` is true as reached by other faces.
    pub(super) fn with_touching_vertices(mut self, touching: &[bool]) -> Self {
        self.touching[0].resize(touching.len(), false);
        for (touches, more) in self.touching[0].iter_mut().zip(touching) {
            *touches |= more;
        }
        self
    }

    /// Returns true if no face divides or covers another one.
    pub(super) fn divide_nothing(&self) -> bool {
        self.segments.is_empty() && self.covers.is_empty()
    }

    fn new(surfaces: &Surfaces, met: Vec<Vec<MeetingFaces>>) -> Self {
        let mut contacts = Self::default();
        for MeetingFaces { pair, kind } in met.into_iter().flatten() {
            poll();
            match kind {
                MeetingKind::Crossing(ends) => contacts.cross(surfaces, pair, ends),
                MeetingKind::Touching(touching) => contacts.touch(surfaces, pair, &touching),
            }
        }
        contacts.sort();
        contacts
    }

    fn cross(&mut self, surfaces: &Surfaces, pair: [u32; 2], ends: [PiercingPoint; 2]) {
        let [from, to] = ends.map(|end| self.point(surfaces, pair, CommonPoint::Through(end)));
        for (k, ends) in [[from, to], [to, from]].into_iter().enumerate() {
            self.segments.push(Segment {
                face: pair[k],
                other: pair[1 - k],
                ends,
                line: Line::Directed,
            });
        }
    }

    fn touch(&mut self, surfaces: &Surfaces, pair: [u32; 2], touching: &Touching) {
        let are_neighbours = || {
            let is_common = |common: &CommonPoint| is_common_vertex(surfaces, pair, *common);
            touching.points.iter().all(is_common)
        };
        if !touching.overlap && are_neighbours() {
            return;
        }
        self.touched.extend(pair);
        for common in &touching.points {
            self.mark_corners(surfaces, pair, *common);
        }
        let is_beside = !touching.overlap && touching.sides[0].iter().all(|s| *s == Side::On);
        if is_beside {
            return;
        }
        for segment in &touching.segments {
            let ends = segment
                .ends
                .map(|common| self.point(surfaces, pair, common));
            for (k, (face, other)) in [(pair[0], pair[1]), (pair[1], pair[0])]
                .into_iter()
                .enumerate()
            {
                let line = match segment.along {
                    Some((of, edge)) if of != k => Line::Edge(edge),
                    Some(_) => continue,
                    None => line(&touching.sides[k], &touching.sides[1 - k]),
                };
                self.segments.push(Segment {
                    face,
                    other,
                    ends,
                    line,
                });
            }
        }
        if touching.overlap {
            let [face, other] = pair;
            self.covers.extend([
                Cover { face, other },
                Cover {
                    face: other,
                    other: face,
                },
            ]);
        }
    }

    /// Marks the vertices of both faces at a common corner as reached by other faces.
    fn mark_corners(&mut self, surfaces: &Surfaces, pair: [u32; 2], common: CommonPoint) {
        let CommonPoint::Corner(of, corner) = common else {
            return;
        };
        let point = surfaces.corner(pair[of], corner);
        for face in pair {
            if let Some(corner) = surfaces.corners(face).iter().position(|p| *p == point) {
                let operand = surfaces.operand_of(face);
                let touching = &mut self.touching[operand];
                touching.resize(surfaces.operands[operand].mesh.vertices.len(), false);
                touching[surfaces.vertices(face)[corner].index()] = true;
            }
        }
    }

    /// Returns the index of a common point of two faces, the same for all pairs of faces for which it has the
    /// same name.
    fn point(&mut self, surfaces: &Surfaces, pair: [u32; 2], common: CommonPoint) -> u32 {
        let edge = |of: usize, ends: [usize; 2]| {
            let corners = surfaces.vertices(pair[of]);
            let [a, b] = ends.map(|i| corners[i]);
            (surfaces.operand_of(pair[of]), [a.min(b), a.max(b)])
        };
        let edge_from = |of: usize, i: usize| edge(of, [i, (i + 1) % 3]);
        let point = match common {
            CommonPoint::Corner(of, corner) => {
                MeetingPoint::Corner(surfaces.corner(pair[of], corner))
            }
            CommonPoint::Through(end) => {
                MeetingPoint::Through(edge(end.of, end.edge), pair[1 - end.of])
            }
            CommonPoint::Edges(first, second) => {
                let mut edges = [edge_from(0, first), edge_from(1, second)];
                edges.sort_unstable();
                MeetingPoint::Edges(edges)
            }
        };
        *self.numbers.entry(point).or_insert_with(|| {
            self.points.push(point);
            as_number(self.points.len() - 1)
        })
    }

    fn sort(&mut self) {
        self.segments
            .sort_unstable_by_key(|s| (s.face, s.other, s.ends));
        self.covers.sort_unstable();
        self.touched.sort_unstable();
        self.touched.dedup();
    }
}

/// Returns true if a common point of two faces of one mesh is a vertex that both share by number, so that the
/// faces are connected there.
fn is_common_vertex(surfaces: &Surfaces, pair: [u32; 2], common: CommonPoint) -> bool {
    let CommonPoint::Corner(of, corner) = common else {
        return false;
    };
    let [ours, others] = [pair[of], pair[1 - of]];
    let vertex = surfaces.vertices(ours)[corner];
    let is_one = surfaces.operand_of(ours) == surfaces.operand_of(others);
    is_one && surfaces.vertices(others).contains(&vertex)
}

/// Describes the common line of two faces' planes for one of the faces; `ours` has the sides of the other
/// plane on which its corners lie, `theirs` the sides of its own plane on which the other face's corners lie.
fn line(ours: &[Side], theirs: &[Side]) -> Line {
    let corner = ours.iter().position(|s| *s != Side::On).unwrap_or(0);
    Line::Touching {
        corner,
        side: ours[corner],
        in_front: theirs.contains(&Side::Plus),
    }
}
