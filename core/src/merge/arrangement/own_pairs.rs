//! Finds the pairs of faces of one mesh that may share more than corners and edges.
//!
//! A tree of boxes compared with itself finds near pairs, and tests in doubles exclude nearly all of them. If
//! boxes do not separate the faces, as in a fan of needles (long thin triangles), `merge::pairs` finds the near
//! pairs instead.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::candidates::{Candidates, Operand};
use super::MAX_PAIRS_PER_FACE;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::meeting::{meeting_of, Meeting};
use crate::geometry::doubles::{Facing, Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::interrupt::{poll, spend};
use crate::merge::pairs::{pairs, shift_of, BoundedElement, BoxedElement, ElementsInBox};
use crate::mesh::faces::Faces;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::source::Source;
use crate::mesh::tasks::{each_chunk, WorkSize, CHUNK};
use crate::mesh::terrains::terrains;
use crate::mesh::topology::NONE;

/// The number of near pairs from `merge::pairs` that are tested together, by several threads if there are any.
const PAIRS_PER_BATCH: usize = 8 * CHUNK;

/// The number of pairs in the first batch of a search that may end early; each batch has twice as many pairs
/// as the last one.
const PAIRS_IN_FIRST_BATCH: usize = 256;

/// The most near pairs for each face that a tree of boxes may have; with more, boxes do not separate the faces.
/// A face of a regular mesh is near about six others with which it was not yet compared.
const MAX_NEAR_PAIRS_PER_FACE: usize = 64;

/// The result of a search for pairs of faces that may overlap.
#[derive(Debug)]
pub(super) enum Pairs {
    /// The pairs of faces that may share more than corners and edges, each once, ascending.
    Few(Vec<[FaceId; 2]>),
    /// There are more than `MAX_PAIRS_PER_FACE` pairs for each face.
    Many,
    /// Two faces certainly overlap; the search stopped there.
    Overlap,
}

/// Returns the pairs of a mesh's faces that may share more than corners and edges, each once, ascending; they
/// are found once for each mesh. `None` if there are more than `MAX_PAIRS_PER_FACE` for each face.
pub(super) fn own_pairs<'a>(operand: &Operand<'a>) -> Option<&'a [[FaceId; 2]]> {
    let find = || match (Search {
        operand,
        until_overlap: false,
    })
    .all_pairs()
    {
        Pairs::Few(pairs) => Some(pairs),
        Pairs::Many | Pairs::Overlap => None,
    };
    operand.source.own_pairs().get_or_make(find).as_deref()
}

/// Returns true if two faces of a mesh certainly overlap; stops at the first two found. Otherwise all pairs
/// that may overlap are known afterwards.
pub(super) fn finds_overlap(operand: &Operand) -> bool {
    let cache = operand.source.own_pairs();
    if cache.get().is_some() {
        return false;
    }
    let found = match (Search {
        operand,
        until_overlap: true,
    })
    .all_pairs()
    {
        Pairs::Overlap => return true,
        Pairs::Few(pairs) => Some(pairs),
        Pairs::Many => None,
    };
    cache.get_or_make(|| found);
    false
}

/// Returns true if no two of these faces of a mesh share more than corners and edges.
pub(super) fn are_clear(operand: &Operand, faces: &[FaceId]) -> bool {
    let search = Search {
        operand,
        until_overlap: true,
    };
    matches!(search.pairs(faces), Pairs::Few(found) if found.is_empty())
}

/// Returns for each vertex whether surfaces may cross there although no two faces cross: the vertex is
/// irregular, or the mesh is not closed there.
pub(super) fn irregular(source: &Source) -> Vec<bool> {
    let count = source.mesh().map_or(0, |mesh| mesh.vertices.len());
    let mut irregular = vec![false; count];
    for vertex in source
        .irregular_vertices()
        .iter()
        .chain(source.open_vertices())
    {
        irregular[vertex.index()] = true;
    }
    irregular
}

/// A search for the pairs of a mesh's faces that may overlap.
#[derive(Clone, Copy)]
struct Search<'a, 'b> {
    operand: &'b Operand<'a>,
    /// Whether the search ends at the first two faces that certainly overlap.
    until_overlap: bool,
}

impl Search<'_, '_> {
    fn all_pairs(self) -> Pairs {
        self.pairs(&self.operand.mesh.face_ids().collect::<Vec<_>>())
    }

    /// Returns the pairs among these faces that may overlap.
    fn pairs(self, faces: &[FaceId]) -> Pairs {
        self.separated_by_boxes(faces)
            .unwrap_or_else(|| self.not_separated_by_boxes(faces))
    }

    /// Returns the pairs among these faces that may overlap; `None` if boxes do not separate the faces.
    fn separated_by_boxes(self, faces: &[FaceId]) -> Option<Pairs> {
        let Candidates {
            faces,
            triangles,
            tree,
        } = self.operand.comparable(faces);
        let left = AtomicUsize::new(MAX_NEAR_PAIRS_PER_FACE * faces.len());
        let visit = |block: &[[u32; 2]]| {
            let take = |left: usize| left.checked_sub(block.len());
            left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
                .map_err(|_| None)?;
            spend(block.len());
            let of = |i: u32| self.prepared(faces[i as usize], &triangles[i as usize]);
            let mut found = Vec::new();
            for run in block.chunk_by(|p, q| p[0] == q[0]) {
                let first = of(run[0][0]);
                for [_, other] in run {
                    found.extend(self.tested(&first, &of(*other))?);
                }
            }
            Ok(found)
        };
        let work_size = WorkSize::pool_if(faces.len() >= super::MIN_FACES_FOR_POOL);
        match tree.each_block(&tree, work_size, visit) {
            Ok(found) => Some(self.few_or_many(found.concat())),
            Err(end) => end,
        }
    }

    /// Returns the pairs among these faces that may overlap; halves space and clips faces to find near pairs.
    fn not_separated_by_boxes(self, faces: &[FaceId]) -> Pairs {
        let crowd = Crowd::of(self.operand, faces);
        let mut batch = if self.until_overlap {
            PAIRS_IN_FIRST_BATCH
        } else {
            PAIRS_PER_BATCH
        };
        let (mut waiting, mut found) = (Vec::new(), Vec::new());
        let mut end = None;
        let mut test = |waiting: &mut Vec<[FaceId; 2]>| {
            let tested = each_chunk(waiting, |_, pairs| self.tested_pairs(pairs));
            waiting.clear();
            for pairs in tested {
                found.extend(pairs.map_err(|overlap| end = overlap).ok()?);
            }
            (found.len() <= self.max_pairs()).then_some(())
        };
        let all = crowd.near_pairs(|pair| {
            waiting.push(pair);
            if waiting.len() < batch {
                return Some(());
            }
            batch = PAIRS_PER_BATCH.min(2 * batch);
            test(&mut waiting)
        });
        match all.and_then(|()| test(&mut waiting)) {
            Some(()) => self.few_or_many(found),
            None => end.unwrap_or(Pairs::Many),
        }
    }

    fn max_pairs(&self) -> usize {
        MAX_PAIRS_PER_FACE * self.operand.mesh.faces.len()
    }

    fn few_or_many(&self, mut found: Vec<[FaceId; 2]>) -> Pairs {
        found.sort_unstable();
        found.dedup();
        if found.len() > self.max_pairs() {
            Pairs::Many
        } else {
            Pairs::Few(found)
        }
    }

    /// Returns those of the pairs that may overlap.
    ///
    /// # Errors
    /// `Overlap` if the search ends there.
    fn tested_pairs(self, pairs: &[[FaceId; 2]]) -> Result<Vec<[FaceId; 2]>, Option<Pairs>> {
        let of = |face: FaceId| self.prepared(face, &self.operand.triangle(face));
        let mut found = Vec::new();
        for run in pairs.chunk_by(|p, q| p[0] == q[0]) {
            poll();
            let first = of(run[0][0]);
            for [_, other] in run {
                found.extend(self.tested(&first, &of(*other))?);
            }
        }
        Ok(found)
    }

    fn prepared(self, face: FaceId, triangle: &Triangle) -> PreparedFace {
        PreparedFace {
            face,
            vertices: self.operand.mesh.vertices_of(face),
            facing: Facing::of(triangle),
        }
    }

    /// Returns the pair of two faces, ascending, if they may overlap.
    ///
    /// # Errors
    /// `Overlap` if the search ends there.
    fn tested(
        self,
        first: &PreparedFace,
        second: &PreparedFace,
    ) -> Result<Option<[FaceId; 2]>, Option<Pairs>> {
        let meeting = meeting_of(&first.facing, &second.facing);
        if self.until_overlap && matches!(meeting, Meeting::Crossing | Meeting::Overlap) {
            return Err(Some(Pairs::Overlap));
        }
        let may_overlap = match meeting {
            Meeting::Clear => false,
            Meeting::Edges(edge, _) => !first.shares_edge(edge, second),
            _ => true,
        };
        let pair = [first.face, second.face];
        Ok(may_overlap.then(|| [pair[0].min(pair[1]), pair[0].max(pair[1])]))
    }
}

/// A face prepared to be compared with others.
struct PreparedFace {
    face: FaceId,
    vertices: [VertexId; 3],
    facing: Facing,
}

impl PreparedFace {
    /// Returns true if both vertices of an edge, given by the index of its first corner, are vertices of the
    /// other face, so that the faces are connected along the edge.
    fn shares_edge(&self, edge: usize, other: &Self) -> bool {
        let ends = [edge, (edge + 1) % 3].map(|i| self.vertices[i]);
        ends.iter().all(|v| other.vertices.contains(v))
    }
}

/// Faces of a mesh that boxes do not separate.
struct Crowd<'a, 'b> {
    operand: &'b Operand<'a>,
    /// For each face of the mesh the number of its terrain, or a number of its own: faces with equal numbers
    /// are known not to overlap each other.
    parties: Vec<usize>,
    /// The faces, sorted by party.
    faces: Vec<FaceId>,
    /// The number of low bits dropped from coordinates of boxes.
    shift: u32,
}

impl<'a, 'b> Crowd<'a, 'b> {
    fn of(operand: &'b Operand<'a>, faces: &[FaceId]) -> Self {
        let [low, high] = &operand.bounds;
        let extent = each_axis(|i| high[i].abs_diff(low[i]));
        let parties = parties(operand);
        let mut faces = faces.to_vec();
        faces.sort_unstable_by_key(|f| (parties[f.index()], *f));
        Self {
            operand,
            parties,
            faces,
            shift: shift_of(extent.into_iter().max().unwrap_or(0)),
        }
    }

    /// Calls `report` for all pairs of near faces of different parties; stops and returns `None` if `report`
    /// does.
    fn near_pairs(&self, mut report: impl FnMut([FaceId; 2]) -> Option<()>) -> Option<()> {
        let boxed = |(number, face): (u32, &FaceId)| {
            let [low, high] = self.box_of(*face);
            let party = self.parties[face.index()];
            BoxedElement::new(party, number, [&low, &high], self.shift)
        };
        let boxes = (0..).zip(&self.faces).map(boxed).collect();
        let face = |number: u32| self.faces[number as usize];
        pairs(
            ElementsInBox::of(boxes, self.shift),
            |number| self.bounded(face(number)),
            |a, b| report([face(a), face(b)]),
        )
    }

    /// Returns the box around a face, relative to the low corner of the mesh's box.
    fn box_of(&self, face: FaceId) -> [Lattice; 2] {
        let (low, high) = self.operand.mesh.face_box(face);
        [low, high].map(|end| self.relative(&end))
    }

    fn relative(&self, point: &Lattice) -> Lattice {
        each_axis(|i| point[i] - self.operand.bounds[0][i])
    }

    fn bounded(&self, face: FaceId) -> BoundedElement {
        let [low, high] = self.box_of(face);
        let corners = self.operand.mesh.corners(face);
        BoundedElement {
            operand: self.parties[face.index()],
            low,
            high,
            corners: Some(corners.map(|c| self.relative(&c).map(as_double))),
        }
    }
}

/// Returns for each face of a mesh the number of its party: faces of one party are known not to overlap each
/// other. If an edge of the mesh has no opposite by vertex index, each face is a party.
fn parties(operand: &Operand) -> Vec<usize> {
    let mesh = operand.mesh;
    let all: Vec<u32> = (0..as_number(mesh.faces.len())).collect();
    if !operand.source.open_vertices().is_empty() {
        return (0..all.len()).collect();
    }
    let vertices: Vec<Point> = mesh.vertices.iter().map(|v| v.map(as_double)).collect();
    let faces = Faces {
        vertices: &vertices,
        triangles: &mesh.faces,
    };
    let party = |(face, terrain): (usize, u32)| match terrain {
        NONE => all.len() + face,
        terrain => terrain as usize,
    };
    terrains(&faces, &all)
        .into_iter()
        .enumerate()
        .map(party)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;
    use crate::mesh::handle::Slot;

    /// Returns the pairs of faces of these boxes that may overlap; `None` if there are too many.
    fn pairs_of(boxes: &[[Lattice; 2]]) -> Option<Vec<[FaceId; 2]>> {
        let solid = cuboids(boxes.iter().copied());
        let source = solid.sources().get(Slot(0));
        let operand = Operand::new(Slot(0), source)?;
        let overlaps = finds_overlap(&operand);
        let pairs = own_pairs(&operand)?;
        assert_eq!(overlaps, !pairs.is_empty());
        let search = Search {
            operand: &operand,
            until_overlap: false,
        };
        let faces: Vec<FaceId> = operand.mesh.face_ids().collect();
        match search.not_separated_by_boxes(&faces) {
            Pairs::Few(all) => assert_eq!(pairs, all),
            found => panic!("{found:?}"),
        }
        Some(pairs.to_vec())
    }

    #[test]
    fn faces_that_cross_are_found_and_neighbours_are_not() {
        let boxes = [
            [[0; 3], [9; 3]],
            [[3, 3, 3], [6, 6, 15]],
            [[20; 3], [29; 3]],
        ];
        let found = pairs_of(&boxes).expect("few pairs");
        let across = |[a, b]: &[FaceId; 2]| a.0 < 12 && (12..24).contains(&b.0);
        assert!(!found.is_empty() && found.iter().all(across) && found.is_sorted());
    }

    #[test]
    fn a_search_gives_up_where_most_faces_overlap_most_others() {
        let boxes = vec![[[0; 3], [9; 3]]; 4 * MAX_PAIRS_PER_FACE];
        assert!(pairs_of(&boxes).is_none());
    }

    /// In a row in which each box crosses the next, twice as many boxes have about twice as many pairs.
    #[test]
    fn pairs_follow_what_overlaps() {
        let row = |count: i64| {
            let place = |i: i64| [[10 * i, i % 2, 0], [10 * i + 14, 9 + i % 2, 9 - i % 2]];
            let boxes: Vec<[Lattice; 2]> = (0..count).map(place).collect();
            pairs_of(&boxes).expect("few pairs").len()
        };
        let (half, whole) = (row(200), row(400));
        assert!(half > 0 && whole <= 2 * half + 100, "{half} {whole}");
    }
}
