//! The pairs of faces of a mesh that may overlap: boxes find pairs that are near each other, and a
//! quick look at each tells nearly all of them clear.

use rustc_hash::FxHashMap as HashMap;

use super::looked::Looked;
use super::MOST_PAIRS;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;
use crate::merge::pairs::{pairs_of_many, shift_of, Boxed, Part, Swept};
use crate::mesh::faces::Faces;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;
use crate::mesh::tasks::{each_chunk, CHUNK};
use crate::mesh::terrains::terrains;
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;

/// Pairs that are looked at together, by several threads where there are any.
const BATCH: usize = 8 * CHUNK;

/// As many are looked at first; then twice as many each time.
const FIRST: usize = 256;

/// A mesh as quick looks at its faces need it.
pub(super) struct View<'a> {
    pub(super) mesh: &'a TriangleMesh,
    /// By vertex, whether surfaces may meet there that pairs of faces do not show.
    pub(super) irregular: Vec<bool>,
    /// By face, its terrain.
    pub(super) pieces: Vec<u32>,
}

/// Faces of a mesh that may overlap others, and with which.
pub struct Unclear {
    /// Each both ways, ascending.
    pub(super) pairs: Vec<[FaceId; 2]>,
    /// By face, whether it is in a pair.
    in_pairs: Vec<bool>,
}

/// An answer about all faces of some groups.
pub(super) enum Pairs {
    /// Two faces certainly overlap; no others were looked for.
    Overlap,
    /// The pairs that may overlap.
    Unclear(Unclear),
    /// They are many.
    Many,
}

/// A reason to end a search.
enum End {
    Overlap,
    Many,
}

/// A search for pairs.
struct Search<'a> {
    view: &'a View<'a>,
    /// True if two faces that certainly overlap end it.
    until_overlap: bool,
    /// So many pairs are looked at together: first few, since the search may end.
    batch: usize,
    /// Pairs that are near each other and were not looked at yet.
    waiting: Vec<[FaceId; 2]>,
    found: Vec<[FaceId; 2]>,
    most: usize,
    end: Option<End>,
}

impl Unclear {
    /// The pairs among the faces of each of some groups; `None` if they are many.
    pub(super) fn among<'a>(
        view: &View,
        groups: impl IntoIterator<Item = &'a [FaceId]>,
    ) -> Option<Self> {
        match Search::new(view, false).of(groups) {
            Pairs::Unclear(unclear) => Some(unclear),
            Pairs::Overlap | Pairs::Many => None,
        }
    }

    /// As [`Self::among`], unless two faces certainly overlap.
    pub(super) fn unless_overlapping(view: &View, faces: &[FaceId]) -> Pairs {
        Search::new(view, true).of([faces])
    }

    fn of(mut pairs: Vec<[FaceId; 2]>, count: usize) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        pairs.extend_from_within(..);
        let turned = pairs.len() / 2;
        pairs[turned..].iter_mut().for_each(|pair| pair.reverse());
        pairs.sort_unstable();
        let mut in_pairs = vec![false; count];
        for [face, _] in &pairs {
            in_pairs[face.place()] = true;
        }
        Self { pairs, in_pairs }
    }

    /// Return whether a face may overlap another.
    pub(super) fn holds(&self, face: FaceId) -> bool {
        self.in_pairs[face.place()]
    }

    /// Return whether no two of some faces may overlap.
    pub(super) fn is_clear(&self, faces: &[FaceId]) -> bool {
        let some: Vec<FaceId> = faces.iter().copied().filter(|f| self.holds(*f)).collect();
        let paired = |pair: [FaceId; 2]| self.pairs.binary_search(&pair).is_ok();
        (1..some.len()).all(|i| !some[..i].iter().any(|other| paired([some[i], *other])))
    }
}

impl<'a> View<'a> {
    pub(super) fn new(source: &Source, mesh: &'a TriangleMesh) -> Self {
        let mut irregular = vec![false; mesh.vertices.len()];
        for vertex in source.irregular_vertices() {
            irregular[vertex.place()] = true;
        }
        let pieces = pieces(source, mesh);
        Self {
            mesh,
            irregular,
            pieces,
        }
    }

    /// A face prepared for quick looks.
    pub(super) fn of(&self, face: FaceId) -> Looked {
        let piece = self.pieces[face.place()];
        Looked::at(self.mesh, face, &self.irregular, piece)
    }

    /// The party of a face: faces of one terrain are not compared with each other.
    fn party(&self, face: FaceId) -> usize {
        match self.pieces[face.place()] {
            NONE => self.mesh.faces.len() + face.place(),
            piece => piece as usize,
        }
    }

    /// The box around a face, its corner at a place.
    fn box_from(&self, face: FaceId, origin: &Lattice) -> [Lattice; 2] {
        let (low, high) = self.mesh.face_box(face);
        [low, high].map(|end| each_axis(|i| end[i] - origin[i]))
    }

    fn swept(&self, face: FaceId, origin: &Lattice) -> Swept {
        let [low, high] = self.box_from(face, origin);
        let corners = self.mesh.corners(face);
        Swept {
            operand: self.party(face),
            low,
            high,
            corners: Some(corners.map(|c| each_axis(|i| as_double(c[i] - origin[i])))),
        }
    }
}

impl<'a> Search<'a> {
    fn new(view: &'a View<'a>, until_overlap: bool) -> Self {
        Self {
            view,
            until_overlap,
            batch: FIRST,
            waiting: Vec::new(),
            found: Vec::new(),
            most: MOST_PAIRS * view.mesh.faces.len(),
            end: None,
        }
    }

    /// Compares the faces of each of some groups with each other.
    fn of<'b>(mut self, groups: impl IntoIterator<Item = &'b [FaceId]>) -> Pairs {
        let all = groups.into_iter().try_for_each(|faces| self.compare(faces));
        match (all, self.end) {
            (Some(()), None) => Pairs::Unclear(Unclear::of(self.found, self.view.mesh.faces.len())),
            (_, Some(End::Overlap)) => Pairs::Overlap,
            _ => Pairs::Many,
        }
    }

    /// Compares faces with each other, until the search ends.
    fn compare(&mut self, faces: &[FaceId]) -> Option<()> {
        let view = self.view;
        let ends = || faces.iter().map(|f| view.mesh.face_box(*f));
        let least = |i: usize| ends().map(|(low, _)| low[i]).min();
        let most = |i: usize| ends().map(|(_, high)| high[i]).max();
        let origin = each_axis(|i| least(i).unwrap_or(0));
        let extent = each_axis(|i| most(i).unwrap_or(0).abs_diff(origin[i]));
        let shift = shift_of(extent.into_iter().max().unwrap_or(0));
        let mut sorted = faces.to_vec();
        sorted.sort_unstable_by_key(|f| (view.party(*f), *f));
        let boxed = |(number, face): (usize, &FaceId)| {
            let [low, high] = view.box_from(*face, &origin);
            Boxed::new(view.party(*face), as_number(number), [&low, &high], shift)
        };
        let face = |number: u32| sorted[number as usize];
        let swept = |number: u32| view.swept(face(number), &origin);
        let boxes = sorted.iter().enumerate().map(boxed).collect();
        pairs_of_many(Part::of(boxes, shift), swept, |a, b| {
            self.add([face(a), face(b)])
        })?;
        self.look()
    }

    fn add(&mut self, pair: [FaceId; 2]) -> Option<()> {
        self.waiting.push(pair);
        if self.waiting.len() < self.batch {
            return Some(());
        }
        self.batch = BATCH.min(2 * self.batch);
        self.look()
    }

    /// Looks at the pairs that wait; `None` if the search ends.
    fn look(&mut self) -> Option<()> {
        let found = each_chunk(&self.waiting, |_, pairs| unclear(self.view, pairs));
        self.waiting.clear();
        let first = self.found.len();
        self.found.extend(found.into_iter().flatten());
        let overlap = |[a, b]: &[FaceId; 2]| self.view.of(*a).overlaps(&self.view.of(*b));
        if self.until_overlap && self.found[first..].iter().any(overlap) {
            self.end = Some(End::Overlap);
        } else if self.found.len() > self.most {
            self.end = Some(End::Many);
        }
        self.end.is_none().then_some(())
    }
}

/// Return for each face the number of its terrain; `NONE` where there is none, and where the mesh is not
/// closed by index.
fn pieces(source: &Source, mesh: &TriangleMesh) -> Vec<u32> {
    let all: Vec<u32> = (0..as_number(mesh.faces.len())).collect();
    if source.topology().is_none() {
        return vec![NONE; all.len()];
    }
    let vertices: Vec<Point> = mesh.vertices.iter().map(|v| v.map(as_double)).collect();
    let faces = Faces {
        vertices: &vertices,
        triangles: &mesh.faces,
    };
    terrains(&faces, &all)
}

/// Those of some pairs that a quick look does not tell clear.
fn unclear(view: &View, pairs: &[[FaceId; 2]]) -> Vec<[FaceId; 2]> {
    let mut looks = Looks {
        view,
        places: HashMap::default(),
        looked: Vec::new(),
    };
    let is_unclear = |pair: &&[FaceId; 2]| {
        poll();
        let [a, b] = pair.map(|face| looks.at(face));
        !looks.looked[a].is_clear_of(&looks.looked[b])
    };
    pairs.iter().filter(is_unclear).copied().collect()
}

/// The faces that were looked at: pairs that are found one after the other are of few faces.
struct Looks<'a> {
    view: &'a View<'a>,
    places: HashMap<FaceId, usize>,
    looked: Vec<Looked>,
}

impl Looks<'_> {
    /// The place of a face.
    fn at(&mut self, face: FaceId) -> usize {
        *self.places.entry(face).or_insert_with(|| {
            self.looked.push(self.view.of(face));
            self.looked.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;
    use crate::mesh::handle::Slot;

    /// The pairs among all faces of some boxes, each both ways, or among those of each box.
    fn pairs_of(boxes: &[[Lattice; 2]], box_by_box: bool) -> Option<Unclear> {
        let solid = cuboids(boxes.iter().copied());
        let source = solid.sources().get(Slot(0));
        let mesh = source.mesh()?;
        let faces: Vec<FaceId> = mesh.face_ids().collect();
        let size = if box_by_box { 12 } else { faces.len() };
        Unclear::among(&View::new(source, mesh), faces.chunks(size))
    }

    #[test]
    fn faces_that_cross_are_found_and_neighbours_are_not() {
        let boxes = [
            [[0; 3], [9; 3]],
            [[3, 3, 3], [6, 6, 15]],
            [[20; 3], [29; 3]],
        ];
        let found = pairs_of(&boxes, false).expect("few pairs");
        let across = |[a, b]: &[FaceId; 2]| (a.0 < 12) != (b.0 < 12) && a.0.max(b.0) < 24;
        assert!(!found.pairs.is_empty() && found.pairs.iter().all(across));
        let turned = |pair: &[FaceId; 2]| found.pairs.contains(&[pair[1], pair[0]]);
        assert!(found.pairs.iter().all(turned) && found.pairs.is_sorted());
        assert!(!found.is_clear(&found.pairs[0]) && found.is_clear(&found.pairs[0][..1]));
    }

    #[test]
    fn groups_are_not_compared_with_each_other() {
        let boxes = [[[0; 3], [9; 3]], [[3, 3, 3], [6, 6, 15]]];
        assert!(pairs_of(&boxes, true).is_some_and(|found| found.pairs.is_empty()));
    }

    #[test]
    fn a_search_gives_up_where_most_faces_overlap_most_others() {
        let boxes = vec![[[0; 3], [9; 3]]; 4 * MOST_PAIRS];
        assert!(pairs_of(&boxes, false).is_none());
    }

    /// Twice as many boxes in a row, each across the next, are twice as many pairs.
    #[test]
    fn pairs_follow_what_overlaps() {
        let row = |count: i64| {
            let place = |i: i64| [[10 * i, i % 2, 0], [10 * i + 14, 9 + i % 2, 9 - i % 2]];
            let boxes: Vec<[Lattice; 2]> = (0..count).map(place).collect();
            pairs_of(&boxes, false).expect("few pairs").pairs.len()
        };
        let (half, whole) = (row(200), row(400));
        assert!(half > 0 && whole <= 2 * half + 100, "{half} {whole}");
    }
}
