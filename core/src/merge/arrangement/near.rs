//! Finds the pairs of faces of one mesh that may overlap: boxes find near pairs, and a quick test excludes
//! nearly all of them.

use rustc_hash::FxHashMap as HashMap;

use super::prepared::PreparedFace;
use super::MAX_PAIRS_PER_FACE;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;
use crate::merge::pairs::{pairs, shift_of, BoundedElement, BoxedElement, ElementsInBox};
use crate::mesh::faces::Faces;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;
use crate::mesh::tasks::{each_chunk, CHUNK};
use crate::mesh::terrains::terrains;
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;

/// The number of pairs of faces that are tested together, by several threads if there are any.
const PAIRS_PER_BATCH: usize = 8 * CHUNK;

/// The number of pairs in the first batch of a search that may end early; each batch has twice as many pairs
/// as the last one.
const PAIRS_IN_FIRST_BATCH: usize = 256;

/// A mesh prepared for quick tests of pairs of its faces.
pub(super) struct PreparedMesh<'a> {
    mesh: &'a TriangleMesh,
    /// For each vertex, whether surfaces may cross there although no two faces cross.
    irregular: &'a [bool],
    /// For each face the number of its terrain: a set of faces that are known not to overlap each other.
    terrains: Vec<u32>,
    /// The low corner of the box around all vertices.
    origin: Lattice,
    /// The number of low bits dropped from coordinates of boxes.
    shift: u32,
}

/// The result of a search for pairs of faces that may overlap.
#[derive(Debug)]
pub(super) enum Pairs {
    /// The pairs of faces that may share more than corners and edges, each once, ascending.
    Few(Vec<[u32; 2]>),
    /// There are more than `MAX_PAIRS_PER_FACE` pairs for each face.
    Many,
    /// Two faces certainly overlap; the search stopped there.
    Overlap,
}

impl<'a> PreparedMesh<'a> {
    /// Prepares a mesh; `None` if the source is not a mesh, or has no vertices.
    pub(super) fn new(source: &'a Source, irregular: &'a [bool]) -> Option<Self> {
        let mesh = source.mesh()?;
        let (origin, high) = mesh.bounds()?;
        let extent = each_axis(|i| high[i].abs_diff(origin[i]));
        Some(Self {
            mesh,
            irregular,
            terrains: all_terrains(source, mesh),
            origin,
            shift: shift_of(extent.into_iter().max().unwrap_or(0)),
        })
    }

    /// Returns the pairs among these faces that may overlap, unless there are too many.
    pub(super) fn pairs(&self, faces: &[FaceId]) -> Pairs {
        self.search(faces, false)
    }

    /// Returns the pairs among these faces that may overlap, unless there are too many; ends at the first two
    /// faces that certainly overlap.
    pub(super) fn pairs_unless_overlapping(&self, faces: &[FaceId]) -> Pairs {
        self.search(faces, true)
    }

    fn search(&self, faces: &[FaceId], until_overlap: bool) -> Pairs {
        let mut sorted = faces.to_vec();
        sorted.sort_unstable_by_key(|f| (self.group_of(*f), *f));
        let boxed = |(number, face): (usize, &FaceId)| {
            let [low, high] = self.box_of(*face);
            let group = self.group_of(*face);
            BoxedElement::new(group, as_number(number), [&low, &high], self.shift)
        };
        let boxes = sorted.iter().enumerate().map(boxed).collect();
        let mut search = Search {
            view: self,
            until_overlap,
            batch: if until_overlap {
                PAIRS_IN_FIRST_BATCH
            } else {
                PAIRS_PER_BATCH
            },
            waiting: Vec::new(),
            found: Vec::new(),
            overlap: false,
        };
        let face = |number: u32| sorted[number as usize];
        let bounded = |number: u32| self.bounded(face(number));
        let add = |a: u32, b: u32| search.add([face(a), face(b)]);
        let all = pairs(ElementsInBox::of(boxes, self.shift), bounded, add);
        if all.and_then(|()| search.test_waiting()).is_none() {
            return if search.overlap {
                Pairs::Overlap
            } else {
                Pairs::Many
            };
        }
        search.found.sort_unstable();
        search.found.dedup();
        Pairs::Few(search.found)
    }
}

impl PreparedMesh<'_> {
    /// Prepares a face for quick tests.
    fn of(&self, face: FaceId) -> PreparedFace {
        let terrain = self.terrains[face.index()];
        PreparedFace::at(self.mesh, face, self.irregular, terrain)
    }

    /// Returns a number that is equal for two faces only if they belong to one terrain (a set of faces known
    /// not to overlap each other), so that they need not be compared.
    fn group_of(&self, face: FaceId) -> usize {
        match self.terrains[face.index()] {
            NONE => self.mesh.faces.len() + face.index(),
            terrain => terrain as usize,
        }
    }

    /// Returns the box around a face, relative to the low corner of the mesh's box.
    fn box_of(&self, face: FaceId) -> [Lattice; 2] {
        let (low, high) = self.mesh.face_box(face);
        [low, high].map(|end| each_axis(|i| end[i] - self.origin[i]))
    }

    fn bounded(&self, face: FaceId) -> BoundedElement {
        let [low, high] = self.box_of(face);
        let corners = self.mesh.corners(face);
        BoundedElement {
            operand: self.group_of(face),
            low,
            high,
            corners: Some(corners.map(|c| each_axis(|i| as_double(c[i] - self.origin[i])))),
        }
    }
}

/// A running search for the pairs of faces that may overlap.
struct Search<'a> {
    view: &'a PreparedMesh<'a>,
    until_overlap: bool,
    /// The number of pairs that are tested together; small at first if the search may end early.
    batch: usize,
    /// Pairs of near faces that are not tested yet.
    waiting: Vec<[FaceId; 2]>,
    found: Vec<[u32; 2]>,
    /// True if the search ended because two faces certainly overlap.
    overlap: bool,
}

impl Search<'_> {
    /// Adds a pair of near faces, and tests the waiting pairs if they fill a batch; `None` if the search
    /// ends.
    fn add(&mut self, pair: [FaceId; 2]) -> Option<()> {
        self.waiting.push(pair);
        if self.waiting.len() < self.batch {
            return Some(());
        }
        self.batch = PAIRS_PER_BATCH.min(2 * self.batch);
        self.test_waiting()
    }

    /// Tests the waiting pairs of faces; `None` if the search ends because two faces overlap or pairs are too
    /// many.
    fn test_waiting(&mut self) -> Option<()> {
        let found = each_chunk(&self.waiting, |_, pairs| pairs_not_clear(self.view, pairs));
        self.waiting.clear();
        let found: Vec<[FaceId; 2]> = found.into_iter().flatten().collect();
        let overlap = |[a, b]: &[FaceId; 2]| self.view.of(*a).overlaps(&self.view.of(*b));
        self.overlap = self.until_overlap && found.iter().any(overlap);
        if self.overlap {
            return None;
        }
        let ascending = found.iter().map(|[a, b]| [a.0.min(b.0), a.0.max(b.0)]);
        self.found.extend(ascending);
        (self.found.len() <= MAX_PAIRS_PER_FACE * self.view.mesh.faces.len()).then_some(())
    }
}

/// Returns for each face the number of its terrain, a set of faces that are known not to overlap each other;
/// `NONE` if the face belongs to no terrain, or if an edge of the mesh has no opposite by vertex index.
fn all_terrains(source: &Source, mesh: &TriangleMesh) -> Vec<u32> {
    let all: Vec<u32> = (0..as_number(mesh.faces.len())).collect();
    if !source.open_vertices().is_empty() {
        return vec![NONE; all.len()];
    }
    let vertices: Vec<Point> = mesh.vertices.iter().map(|v| v.map(as_double)).collect();
    let faces = Faces {
        vertices: &vertices,
        triangles: &mesh.faces,
    };
    terrains(&faces, &all)
}

/// Returns the pairs of faces that a quick test does not prove to share only corners and edges.
fn pairs_not_clear(view: &PreparedMesh, pairs: &[[FaceId; 2]]) -> Vec<[FaceId; 2]> {
    let mut prepared = PreparedFaces {
        view,
        indices: HashMap::default(),
        faces: Vec::new(),
    };
    let is_unclear = |pair: &&[FaceId; 2]| {
        poll();
        let [a, b] = pair.map(|face| prepared.at(face));
        !prepared.faces[a].is_clear_of(&prepared.faces[b])
    };
    pairs.iter().filter(is_unclear).copied().collect()
}

/// Faces already prepared for quick tests, so that a face of several pairs is prepared once.
struct PreparedFaces<'a> {
    view: &'a PreparedMesh<'a>,
    indices: HashMap<FaceId, usize>,
    faces: Vec<PreparedFace>,
}

impl PreparedFaces<'_> {
    /// Returns the index of a face in `faces`, and prepares it first if it is new.
    fn at(&mut self, face: FaceId) -> usize {
        *self.indices.entry(face).or_insert_with(|| {
            self.faces.push(self.view.of(face));
            self.faces.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;
    use crate::mesh::handle::Slot;

    /// Returns the pairs of faces of these boxes that may overlap; `None` if there are too many.
    fn pairs_of(boxes: &[[Lattice; 2]]) -> Option<Vec<[u32; 2]>> {
        let solid = cuboids(boxes.iter().copied());
        let source = solid.sources().get(Slot(0));
        let irregular = vec![false; source.mesh()?.vertices.len()];
        let faces: Vec<FaceId> = source.mesh()?.face_ids().collect();
        let view = PreparedMesh::new(source, &irregular)?;
        let overlap = !matches!(view.pairs_unless_overlapping(&faces), Pairs::Few(_));
        match view.pairs(&faces) {
            Pairs::Few(pairs) => {
                assert_eq!(overlap, !pairs.is_empty());
                Some(pairs)
            }
            Pairs::Many | Pairs::Overlap => None,
        }
    }

    #[test]
    fn faces_that_cross_are_found_and_neighbours_are_not() {
        let boxes = [
            [[0; 3], [9; 3]],
            [[3, 3, 3], [6, 6, 15]],
            [[20; 3], [29; 3]],
        ];
        let found = pairs_of(&boxes).expect("few pairs");
        let across = |[a, b]: &[u32; 2]| *a < 12 && (12..24).contains(b);
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
