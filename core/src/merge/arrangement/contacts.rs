//! The segments in which faces meet, and the ends of these segments.

use std::sync::atomic::{AtomicUsize, Ordering};

use rustc_hash::FxHashMap as HashMap;

use super::candidates::Candidates;
use super::contact::{contact, CommonPoint, Contact, PiercingPoint, Touching};
use super::facets::{FacetId, Facets};
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

/// An edge: the index of its operand, and the vertex numbers of its ends, the lower first.
pub(super) type Edge = (usize, [VertexId; 2]);

/// A point in which faces meet, named by the corner, the edge and facet, or the edges that define it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum MeetingPoint {
    /// A corner of a face, at this lattice point.
    Corner(Lattice),
    /// The point in which an edge passes through the inside of a facet.
    Through(Edge, FacetId),
    /// The point in which two edges cross.
    Edges([Edge; 2]),
}

/// A segment in which a facet meets another facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// The facet that the segment divides.
    pub(super) facet: FacetId,
    /// The facet that meets the divided one in the segment.
    pub(super) other: FacetId,
    /// The indices of the points at the ends of the segment.
    pub(super) ends: [u32; 2],
    /// The line that contains the segment, and the position of the other facet relative to this line.
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

impl Line {
    /// Returns true if the other face is in front of the divided one on one side of the line only, so that
    /// the winding number in front changes there.
    pub(super) fn changes_number(self) -> bool {
        matches!(self, Self::Directed | Self::Touching { in_front: true, .. })
    }
}

/// A pair of coplanar facets that have an area in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cover {
    pub(super) facet: FacetId,
    pub(super) other: FacetId,
}

/// The points, segments and areas in which facets meet.
#[derive(Debug, Default)]
pub(super) struct Contacts {
    /// The points in which facets meet; each name occurs once.
    pub(super) points: Vec<MeetingPoint>,
    /// The segments, sorted by facet; a segment is listed once for each facet that it divides.
    pub(super) segments: Vec<Segment>,
    /// The pairs of coplanar facets with a common area, ascending, each in both orders.
    pub(super) covers: Vec<Cover>,
    /// The facets that touch others without simply crossing them, ascending.
    pub(super) touched: Vec<FacetId>,
    pub(super) touching: TouchingVertices,
    numbers: HashMap<MeetingPoint, u32>,
}

/// For each two operands (or an operand and itself), which vertices of the first lie on faces of the second
/// to which they do not belong.
#[derive(Debug, Default)]
pub(super) struct TouchingVertices(HashMap<[usize; 2], Vec<bool>>);

impl TouchingVertices {
    /// Returns whether each vertex of an operand lies on faces of `other`; empty if none does.
    pub(super) fn of(&self, operand: usize, other: usize) -> &[bool] {
        self.0.get(&[operand, other]).map_or(&[], Vec::as_slice)
    }

    /// Returns, for each operand whose faces vertices of `operand` lie on, which vertices do.
    pub(super) fn all_of(&self, operand: usize) -> impl Iterator<Item = &Vec<bool>> {
        let of = move |([k, _], _): &(&[usize; 2], _)| *k == operand;
        self.0.iter().filter(of).map(|(_, touching)| touching)
    }

    /// Returns for vertices of an operand whether they lie on faces of `other`, to be changed.
    pub(super) fn of_mut(
        &mut self,
        facets: &Facets,
        operand: usize,
        other: usize,
    ) -> &mut Vec<bool> {
        let count = facets.operands[operand].mesh.vertices.len();
        let none = || vec![false; count];
        self.0.entry([operand, other]).or_insert_with(none)
    }
}

/// Two facets that meet, and how they meet.
pub(super) struct MeetingFacets {
    pair: [FacetId; 2],
    kind: MeetingKind,
}

enum MeetingKind {
    Crossing([PiercingPoint; 2]),
    Touching(Box<Touching>),
}

/// Intersects pairs of facets; `first` and `second` return the facets of a pair, with their corners.
fn meeting_facets(
    pairs: &[[u32; 2]],
    first: impl Fn(u32) -> (FacetId, Triangle),
    second: impl Fn(u32) -> (FacetId, Triangle),
) -> Vec<MeetingFacets> {
    spend(pairs.len());
    let mut found = Vec::new();
    for run in pairs.chunk_by(|p, q| p[0] == q[0]) {
        let (facet, triangle) = first(run[0][0]);
        let facing = Facing::of(&triangle);
        for &[_, g] in run {
            let (other, triangle) = second(g);
            let kind = match contact(&facing, &Facing::of(&triangle)) {
                Contact::Apart => continue,
                Contact::Crossing(ends) => MeetingKind::Crossing(ends),
                Contact::Touching(touching) => MeetingKind::Touching(touching),
            };
            let pair = [facet, other];
            found.push(MeetingFacets { pair, kind });
        }
    }
    found
}

impl Contacts {
    /// Returns the number of segments, counted once for each facet that they divide.
    pub(super) fn len(&self) -> usize {
        self.segments.len()
    }

    /// Adds the contacts between the candidate faces of two operands.
    ///
    /// # Errors
    /// `Crowded` if more than `MAX_PAIRS_PER_FACE` pairs of boxes meet for each face.
    pub(super) fn add_between(
        &mut self,
        facets: &Facets,
        operands: [usize; 2],
        candidates: &[Candidates; 2],
        work_size: WorkSize,
    ) -> Result<(), Declined> {
        let [first, second] = candidates;
        let left =
            AtomicUsize::new(MAX_PAIRS_PER_FACE * (first.triangles.len() + second.triangles.len()));
        let facet = |k: usize| {
            let candidates = &candidates[k];
            move |i: u32| {
                let number = facets.number(operands[k], candidates.faces[i as usize]);
                (number, candidates.triangles[i as usize])
            }
        };
        let visit = |block: &[[u32; 2]]| -> Result<Vec<MeetingFacets>, Declined> {
            let take = |left: usize| left.checked_sub(block.len());
            left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
                .map_err(|_| Declined::Crowded)?;
            Ok(meeting_facets(block, facet(0), facet(1)))
        };
        let met = first.tree.each_block(&second.tree, work_size, visit)?;
        self.add(facets, met);
        Ok(())
    }

    /// Adds the contacts of an operand's own faces, given the pairs of its faces that may overlap, and marks
    /// its irregular vertices, at which surfaces may cross although no two faces do.
    pub(super) fn add_own(
        &mut self,
        facets: &Facets,
        operand: usize,
        (pairs, irregular): (&[[FaceId; 2]], &[bool]),
        work_size: WorkSize,
    ) {
        let of = &facets.operands[operand];
        let facet = |f: u32| (facets.number(operand, FaceId(f)), of.triangle(FaceId(f)));
        let blocks = pairs.chunks(PAIRS_PER_BLOCK).collect();
        let met = each(work_size, blocks, |block: &[[FaceId; 2]]| {
            let numbers: Vec<[u32; 2]> = block.iter().map(|pair| pair.map(|f| f.0)).collect();
            meeting_facets(&numbers, facet, facet)
        });
        self.add(facets, met);
        let touching = self.touching.of_mut(facets, operand, operand);
        for (touches, more) in touching.iter_mut().zip(irregular) {
            *touches |= more;
        }
    }

    /// Returns the pairs of facets that have a segment in common, other than a common edge, ascending; the lower
    /// number of each pair comes first.
    pub(super) fn meeting_pairs(&self) -> Vec<[FacetId; 2]> {
        let pair = |s: &Segment| [s.facet.min(s.other), s.facet.max(s.other)];
        let mut pairs: Vec<[FacetId; 2]> = self.segments.iter().map(pair).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    fn add(&mut self, facets: &Facets, met: Vec<Vec<MeetingFacets>>) {
        for MeetingFacets { pair, kind } in met.into_iter().flatten() {
            poll();
            match kind {
                MeetingKind::Crossing(ends) => self.cross(facets, pair, ends),
                MeetingKind::Touching(touching) => self.touch(facets, pair, &touching),
            }
        }
        self.sort();
    }

    fn cross(&mut self, facets: &Facets, pair: [FacetId; 2], ends: [PiercingPoint; 2]) {
        let [from, to] = ends.map(|end| self.point(facets, pair, CommonPoint::Through(end)));
        for (k, ends) in [[from, to], [to, from]].into_iter().enumerate() {
            self.segments.push(Segment {
                facet: pair[k],
                other: pair[1 - k],
                ends,
                line: Line::Directed,
            });
        }
    }

    fn touch(&mut self, facets: &Facets, pair: [FacetId; 2], touching: &Touching) {
        let are_neighbours = || {
            let is_common = |common: &CommonPoint| is_common_vertex(facets, pair, *common);
            touching.points.iter().all(is_common)
        };
        if !touching.overlap && are_neighbours() {
            return;
        }
        self.touched.extend(pair);
        for common in &touching.points {
            self.mark_corners(facets, pair, *common);
        }
        let is_beside = !touching.overlap && touching.sides[0].iter().all(|s| *s == Side::On);
        if is_beside {
            return;
        }
        for segment in &touching.segments {
            let ends = segment.ends.map(|common| self.point(facets, pair, common));
            for (k, (facet, other)) in [(pair[0], pair[1]), (pair[1], pair[0])]
                .into_iter()
                .enumerate()
            {
                let line = match segment.along {
                    Some((of, edge)) if of != k => Line::Edge(edge),
                    Some(_) => continue,
                    None => line(&touching.sides[k], &touching.sides[1 - k]),
                };
                self.segments.push(Segment {
                    facet,
                    other,
                    ends,
                    line,
                });
            }
        }
        if touching.overlap {
            let [facet, other] = pair;
            let turned = Cover {
                facet: other,
                other: facet,
            };
            self.covers.extend([Cover { facet, other }, turned]);
        }
    }

    /// Marks the vertices of both facets at a common corner as touching the other facet's operand.
    fn mark_corners(&mut self, facets: &Facets, pair: [FacetId; 2], common: CommonPoint) {
        let CommonPoint::Corner(of, corner) = common else {
            return;
        };
        let point = facets.corner(pair[of], corner);
        let operands = pair.map(|facet| facets.operand_of(facet));
        for (k, facet) in pair.into_iter().enumerate() {
            if let Some(corner) = facets.corners(facet).iter().position(|p| *p == point) {
                let vertex = facets.vertices(facet)[corner];
                let touching = self.touching.of_mut(facets, operands[k], operands[1 - k]);
                touching[vertex.index()] = true;
            }
        }
    }

    /// Returns the index of a common point of two faces, the same for all pairs of faces for which it has the
    /// same name.
    fn point(&mut self, facets: &Facets, pair: [FacetId; 2], common: CommonPoint) -> u32 {
        let edge = |of: usize, ends: [usize; 2]| {
            let corners = facets.vertices(pair[of]);
            let [a, b] = ends.map(|i| corners[i]);
            (facets.operand_of(pair[of]), [a.min(b), a.max(b)])
        };
        let edge_from = |of: usize, i: usize| edge(of, [i, (i + 1) % 3]);
        let point = match common {
            CommonPoint::Corner(of, corner) => {
                MeetingPoint::Corner(facets.corner(pair[of], corner))
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
            .sort_unstable_by_key(|s| (s.facet, s.other, s.ends));
        self.covers.sort_unstable();
        self.touched.sort_unstable();
        self.touched.dedup();
    }
}

/// Returns true if a common point of two facets is a vertex of one mesh that both share by number, so that the
/// faces are connected there.
fn is_common_vertex(facets: &Facets, pair: [FacetId; 2], common: CommonPoint) -> bool {
    let CommonPoint::Corner(of, corner) = common else {
        return false;
    };
    let [ours, others] = [pair[of], pair[1 - of]];
    let vertex = facets.vertices(ours)[corner];
    let is_one = facets.operand_of(ours) == facets.operand_of(others);
    is_one && facets.vertices(others).contains(&vertex)
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
