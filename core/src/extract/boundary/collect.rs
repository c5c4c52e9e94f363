//! Reads from a solid's tree which source faces are boundary as a whole, in part (cut) or not at all (gone).

use rayon::prelude::*;
use smallvec::{smallvec, SmallVec};

use super::leaves::{fill, listed, Fate, Fates, Listed, Piece, Spanning};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{BareEdge, Outline};
use crate::geometry::plane::Lattice;
use crate::interrupt::{carried, poll};
use crate::merge::lists::list::Sources;
use crate::merge::lists::separation::misses;
use crate::mesh::handle::{FaceId, OrientedFace, SourceFace};
use crate::mesh::source::{Shape, Source};
use crate::mesh::tasks::in_pool;
use crate::tree::node::{Branch, DeferredLeaf, Node};
use crate::tree::solid::Solid;

/// A source face of which only a part belongs to the boundary of a solid.
#[derive(Debug)]
pub struct CutFace {
    /// The face and its orientation in the boundary.
    pub face: OrientedFace,
    /// The outline of the part that is boundary, counterclockwise in the orientation of the face's source.
    pub outline: Outline,
}

/// The boundary of a solid, described by the fate of each source face: whole, cut, or gone.
#[derive(Debug)]
pub struct Boundary {
    /// For each face of each source, whether all of it (whole), a part (cut) or none (gone) is boundary.
    pub fates: Fates,
    /// The faces that are boundary in part, ascending.
    pub cut: Vec<CutFace>,
    /// Faces in cells where several operands met, ascending: they may touch other faces.
    pub near: Vec<SourceFace>,
}

/// If more faces than this are to be processed, several threads share the work.
const PARALLEL_FROM: usize = 256;

/// Pairs of a face and a leaf that lists it are sorted, not counted by face, if there are fewer than one pair
/// for this many faces.
const COUNTED_IF_ONE_IN: usize = 16;

struct Collector<'a> {
    sources: &'a Sources,
    root: &'a Branch,
    listed: Listed<'a>,
}

/// Finds the faces and parts of faces that make up the boundary of a solid.
pub fn collect(solid: &Solid, sources: &Sources) -> Boundary {
    let collector = Collector {
        sources,
        root: solid.root(),
        listed: listed(solid.root(), sources),
    };
    collector.settle()
}

impl Collector<'_> {
    /// Decides for each face that extends over several leaves whether all of it is boundary (whole) or a part
    /// (cut), and finds the outlines of the cut faces.
    fn settle(mut self) -> Boundary {
        let spanning = by_face(&self.listed.spanning, &self.listed.fates);
        let runs: Vec<&[Spanning]> = spanning
            .chunk_by(|a, b| a.face.face == b.face.face)
            .collect();
        let whole = carried(|run: &&[Spanning]| self.is_whole(run));
        let whole: Vec<bool> = if in_pool() && runs.len() > PARALLEL_FROM {
            runs.par_iter().map(whole).collect()
        } else {
            runs.iter().map(whole).collect()
        };
        let mut open: Vec<&[Spanning]> = Vec::new();
        for (run, whole) in runs.into_iter().zip(whole) {
            let OrientedFace { face, orientation } = run[0].face;
            let fate = &mut self.listed.fates[face];
            if whole {
                *fate = Fate::Whole(orientation);
            } else {
                *fate = Fate::Cut;
                open.push(run);
            }
        }
        let cut = self.outline(&open);
        let Listed {
            fates, mut near, ..
        } = self.listed;
        near.sort_unstable();
        near.dedup();
        Boundary { fates, cut, near }
    }

    /// Returns true only if every leaf that a face meets lists the face in the same orientation, so that all
    /// of the face is boundary; may return false negatives. `run` has one entry for each leaf that lists it.
    fn is_whole(&self, run: &[Spanning]) -> bool {
        let first = run[0].face;
        let source = self.sources.get(first.slot());
        self.listed.fates[first.face] == Fate::Gone
            && source.mesh().is_some()
            && run.iter().all(|s| s.face.orientation == first.orientation)
            && (self.fill_box(run, source) || covers(self.root, source, first))
    }

    /// Returns true only if the cells of the leaves that list a face fill the face's bounding box; may
    /// return false negatives.
    fn fill_box(&self, run: &[Spanning], source: &Source) -> bool {
        let leaves = run.chunk_by(|a, b| a.leaf == b.leaf).map(|s| s[0].leaf);
        fill(
            source.face_box(run[0].face.id()),
            leaves,
            &self.listed.cells,
        )
    }

    /// Returns the faces that are boundary in part, with outlines; if the boundary parts of a face add up to
    /// the full triangle, it is marked as whole instead.
    fn outline(&mut self, open: &[&[Spanning]]) -> Vec<CutFace> {
        let spans = open.iter().flat_map(|run| run.iter()).map(Piece::from);
        let mut pieces: Vec<Piece> = spans.collect();
        pieces.append(&mut self.listed.parts);
        pieces.sort_by_key(|p| p.face);
        let same = |a: &Piece, b: &Piece| a.face == b.face;
        let runs: Vec<&mut [Piece]> = pieces.chunk_by_mut(same).collect();
        let joined = carried(|run: &mut [Piece]| self.joined(run));
        let found: Vec<CutFace> = if in_pool() && runs.len() > PARALLEL_FROM {
            runs.into_par_iter().map(joined).collect()
        } else {
            runs.into_iter().map(joined).collect()
        };
        let mut cut = Vec::new();
        for mut c in found {
            poll();
            let source = self.sources.get(c.face.slot());
            if is_full_face(&mut c, source) {
                self.listed.fates[c.face.face] = Fate::Whole(c.face.orientation);
            } else if !c.outline.edges().is_empty() {
                cut.push(c);
            }
        }
        cut
    }

    /// Joins the parts of one face that are boundary to one outline.
    fn joined(&self, run: &mut [Piece]) -> CutFace {
        let cells = &self.listed.cells;
        let face = run[0].face;
        let outline = if let [piece] = run {
            piece.outline(self.sources, cells)
        } else {
            let edges = run.iter_mut().map(|p| p.take_edges(self.sources, cells));
            Outline::of(edges.flatten().collect())
        };
        CutFace { face, outline }
    }
}

/// Sorts pairs of a face and a leaf that lists it by face; the pairs of one face stay in the order of their
/// leaves.
fn by_face(spanning: &[Spanning], fates: &Fates) -> Vec<Spanning> {
    let faces = fates.faces();
    let mut sorted = spanning.to_vec();
    if spanning.len() < faces / COUNTED_IF_ONE_IN {
        sorted.sort_by_key(|s| s.face.face);
        return sorted;
    }
    let firsts: Vec<usize> = fates
        .by_slot()
        .scan(0, |sum, (_, fates)| {
            *sum += fates.len();
            Some(*sum - fates.len())
        })
        .collect();
    let place = |s: &Spanning| firsts[s.face.slot().index()] + s.face.id().index();
    let mut ends = vec![0u32; faces];
    for s in spanning {
        ends[place(s)] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        sum += *end;
        *end = sum;
    }
    for s in spanning.iter().rev() {
        let end = &mut ends[place(s)];
        *end -= 1;
        sorted[*end as usize] = *s;
    }
    sorted
}

/// Returns true if the outline of a cut face is the face's whole triangle.
fn is_full_face(cut: &mut CutFace, source: &Source) -> bool {
    let Shape::Mesh(mesh) = source.shape() else {
        return false;
    };
    let c = mesh.corners(cut.face.id());
    let near = |edge: &BareEdge| c.iter().any(|corner| edge.from.may_lie_at(corner));
    if cut.outline.edges().len() != 3 || !cut.outline.edges().iter().all(near) {
        return false;
    }
    let [p, q, r] = cut.outline.lines(&PlaneResidues::through(&c)) else {
        return false;
    };
    let own = each_axis(|i| LineKey::of_edge(&c[i], &c[(i + 1) % 3]));
    let distinct = p != q && q != r && r != p;
    distinct && own.iter().all(|k| [&*p, q, r].contains(&k))
}

/// A subtree to search for a face, and the part of the face's bounding box in the subtree's cell.
#[derive(Clone, Copy)]
struct Place<'a> {
    branch: &'a Branch,
    complement: bool,
    low: Lattice,
    high: Lattice,
}

impl<'a> Place<'a> {
    /// Replaces the subtree by one of its children; returns false if the box is not inside the child's cell.
    fn enter(&mut self, child: &'a Branch) -> bool {
        self.branch = child;
        self.complement ^= child.complement;
        child.cell.contains_box(&self.low, &self.high)
    }

    /// Returns true if the subtree is a single leaf that lists the face.
    fn is_listed(&self, source: &Source, face: OrientedFace) -> bool {
        match &*self.branch.node {
            Node::Deferred(leaf) => lists(leaf, source, face, self.complement),
            Node::Leaf(_) | Node::Cut(_) => false,
        }
    }
}

/// Returns true only if every leaf that a face meets lists it; may return false negatives.
fn covers(root: &Branch, source: &Source, face: OrientedFace) -> bool {
    let (low, high) = source.face_box(face.id());
    if !root.cell.contains_box(&low, &high) {
        return false;
    }
    let mut open: SmallVec<[Place; 8]> = smallvec![Place {
        branch: root,
        complement: root.complement,
        low,
        high
    }];
    while let Some(mut place) = open.pop() {
        poll();
        while let Node::Cut(halves) = &*place.branch.node {
            let Some(cut) = place.branch.cell.cut() else {
                return false;
            };
            let [minus, plus] = &halves.children;
            let reaches = (place.low[cut.axis] < cut.at, place.high[cut.axis] >= cut.at);
            let mut above = place;
            if reaches.1 {
                above.low[cut.axis] = above.low[cut.axis].max(cut.at);
                if !above.enter(plus) {
                    return false;
                }
            }
            if !reaches.0 {
                place = above;
                continue;
            }
            if reaches.1 {
                open.push(above);
                place.high[cut.axis] = cut.at - 1;
            }
            if !place.enter(minus) {
                return false;
            }
        }
        if !place.is_listed(source, face) && enters(source, face.id(), &place.branch.cell) {
            return false;
        }
    }
    true
}

/// Returns true if the part of a face inside a cell has an area.
fn enters(source: &Source, face: FaceId, cell: &Cell) -> bool {
    !misses(source, face, cell) && source.clip(face, cell).is_some()
}

/// Returns true if a leaf lists a face in its orientation, or in the opposite one if `complement` is true.
fn lists(leaf: &DeferredLeaf, source: &Source, face: OrientedFace, complement: bool) -> bool {
    let orientation = face.orientation.turned_if(complement);
    leaf.groups.iter().any(|g| {
        let alike = g.source.id() == source.id() && g.orientation == orientation;
        alike && g.faces.binary_search(&face.id()).is_ok()
    })
}

/// Returns true if a solid has no boundary: it is empty or all of space.
///
/// A leaf may list a face that does not meet its cell, so the tree alone does not decide.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::extract::boundary::collect::has_no_boundary;
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// assert!(!has_no_boundary(&solid));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn has_no_boundary(solid: &Solid) -> bool {
    if solid.root().constant().is_some() {
        return true;
    }
    let sources = Sources::new(solid.sources().clone());
    let boundary = collect(solid, &sources);
    let gone = |(_, fates): (_, &[Fate])| fates.iter().all(|f| !matches!(f, Fate::Whole(_)));
    boundary.cut.is_empty() && boundary.fates.by_slot().all(gone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::side::Orientation;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, cuboids, made_of, tetrahedra};
    use crate::mesh::handle::Slot;

    fn fates(combined: fn(Vec<u32>) -> Term) -> [usize; 3] {
        let solid = made_of(&tetrahedra(), combined);
        let sources = Sources::new(solid.sources().clone());
        let boundary = collect(&solid, &sources);
        let all: Vec<Fate> = boundary
            .fates
            .by_slot()
            .flat_map(|f| f.1.to_vec())
            .collect();
        let count = |is: fn(&Fate) -> bool| all.iter().filter(|f| is(f)).count();
        let whole = count(|f| matches!(f, Fate::Whole(_)));
        let gone = count(|f| *f == Fate::Gone);
        assert_eq!(boundary.cut.len(), count(|f| *f == Fate::Cut));
        [whole, boundary.cut.len(), gone]
    }

    #[test]
    fn faces_are_whole_or_cut_or_gone() {
        assert_eq!(fates(Term::Or), [4, 4, 0]);
        assert_eq!(fates(Term::And), [0, 4, 4]);
    }

    /// Small boxes cross one side of a large box, whose other sides span many leaves.
    #[test]
    fn faces_that_span_leaves_are_whole_where_nothing_crosses_them() {
        let large = cuboid([0; 3], [64; 3]);
        let places = (0..16).map(|i| [60, 3 + 15 * (i & 3), 3 + 15 * (i >> 2)]);
        let small = cuboids(places.map(|p| [p, p.map(|c| c + 9)]));
        let solid = made_of(&[large, small], Term::Or);
        let sources = Sources::new(solid.sources().clone());
        let boundary = collect(&solid, &sources);
        let of_large = boundary.fates.of(Slot(0));
        let whole = Fate::Whole(Orientation::Same);
        assert_eq!(of_large.iter().filter(|f| **f == whole).count(), 10);
        assert_eq!(of_large.iter().filter(|f| **f == Fate::Cut).count(), 2);
    }
}
