//! What a tree says of each face: kept whole, cut, or gone.

use rayon::prelude::*;
use smallvec::{smallvec, SmallVec};

use super::leaves::{fill, listed, Fate, Listed, Piece, Spanning};
use crate::geometry::cell::Cell;
use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{BareEdge, Outline};
use crate::geometry::plane::Lattice;
use crate::interrupt::{carried, poll};
use crate::merge::lists::list::Sources;
use crate::merge::lists::separation::misses;
use crate::mesh::source::{Shape, Source};
use crate::mesh::tasks::in_pool;
use crate::tree::node::{Branch, Deferred, Node};
use crate::tree::solid::Solid;

/// A face of which a part is boundary.
#[derive(Debug)]
pub struct CutFace {
    /// The source's slot.
    pub slot: u32,
    /// The face.
    pub face: u32,
    /// Whether inside and outside are exchanged.
    pub flip: bool,
    /// The outline, counterclockwise on the face as the source has it.
    pub outline: Outline,
}

/// A solid's boundary by faces.
#[derive(Debug)]
pub struct Boundary {
    /// The fates of the faces, by slot.
    pub fates: Vec<Vec<Fate>>,
    /// The cut faces, by slot, face and orientation.
    pub cut: Vec<CutFace>,
    /// Faces in cells where several operands met, by slot: they may touch others.
    pub near: Vec<(u32, u32)>,
}

/// Fewer faces than this are looked at on one thread.
const MANY: usize = 256;

/// One in so many faces must be listed for counting to be faster than sorting.
const SPARSE: usize = 16;

struct Collector<'a> {
    sources: &'a Sources,
    root: &'a Branch,
    listed: Listed<'a>,
}

/// Collects the boundary of a solid.
pub fn collect(solid: &Solid, sources: &Sources) -> Boundary {
    let collector = Collector {
        sources,
        root: solid.root(),
        listed: listed(solid.root(), sources),
    };
    collector.settle()
}

impl Collector<'_> {
    /// Decides the faces that span leaves, and outlines the cut ones.
    fn settle(mut self) -> Boundary {
        let spanning = by_face(&self.listed.spanning, &self.listed.fates);
        let runs: Vec<&[Spanning]> = spanning
            .chunk_by(|a, b| (a.slot, a.face) == (b.slot, b.face))
            .collect();
        let whole = carried(|run: &&[Spanning]| self.is_whole(run));
        let whole: Vec<bool> = if in_pool() && runs.len() > MANY {
            runs.par_iter().map(whole).collect()
        } else {
            runs.iter().map(whole).collect()
        };
        let mut open: Vec<&[Spanning]> = Vec::new();
        for (run, whole) in runs.into_iter().zip(whole) {
            let fate = &mut self.listed.fates[run[0].slot as usize][run[0].face as usize];
            if whole {
                *fate = Fate::Whole(run[0].flip);
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

    /// Whether all of a face that spans leaves is boundary, and turned one way.
    fn is_whole(&self, run: &[Spanning]) -> bool {
        let first = &run[0];
        let source = self.sources.get(first.slot as usize);
        let fate = self.listed.fates[first.slot as usize][first.face as usize];
        fate == Fate::Gone
            && source.mesh().is_some()
            && run.iter().all(|s| s.flip == first.flip)
            && (self.fill_box(run, source) || covers(self.root, source, first.face, first.flip))
    }

    /// Whether the cells of the leaves that list a face make up its box; errs on no.
    fn fill_box(&self, run: &[Spanning], source: &Source) -> bool {
        let leaves = run.chunk_by(|a, b| a.leaf == b.leaf).map(|s| s[0].leaf);
        fill(source.face_box(run[0].face), leaves, &self.listed.cells)
    }

    /// The outlines of the faces that are not whole, or gone.
    fn outline(&mut self, open: &[&[Spanning]]) -> Vec<CutFace> {
        let spans = open.iter().flat_map(|run| run.iter()).map(Piece::from);
        let mut pieces: Vec<Piece> = spans.collect();
        pieces.append(&mut self.listed.parts);
        pieces.sort_by_key(|p| (p.slot, p.face, p.flip));
        let same = |a: &Piece, b: &Piece| (a.slot, a.face, a.flip) == (b.slot, b.face, b.flip);
        let runs: Vec<&mut [Piece]> = pieces.chunk_by_mut(same).collect();
        let joined = carried(|run: &mut [Piece]| self.joined(run));
        let found: Vec<CutFace> = if in_pool() && runs.len() > MANY {
            runs.into_par_iter().map(joined).collect()
        } else {
            runs.into_iter().map(joined).collect()
        };
        let mut cut = Vec::new();
        for mut c in found {
            poll();
            let source = self.sources.get(c.slot as usize);
            if is_full_face(&mut c, source) {
                self.listed.fates[c.slot as usize][c.face as usize] = Fate::Whole(c.flip);
            } else if !c.outline.edges().is_empty() {
                cut.push(c);
            }
        }
        cut
    }

    /// One face of its pieces.
    fn joined(&self, run: &mut [Piece]) -> CutFace {
        let cells = &self.listed.cells;
        let (slot, face, flip) = (run[0].slot, run[0].face, run[0].flip);
        let outline = if let [piece] = run {
            piece.outline(self.sources, cells)
        } else {
            let edges = run.iter_mut().map(|p| p.take_edges(self.sources, cells));
            Outline::of(edges.flatten().collect())
        };
        CutFace {
            slot,
            face,
            flip,
            outline,
        }
    }
}

/// What leaves list, sorted by slot and face; the leaves of a face keep their order.
fn by_face(spanning: &[Spanning], fates: &[Vec<Fate>]) -> Vec<Spanning> {
    let faces: usize = fates.iter().map(Vec::len).sum();
    let mut sorted = spanning.to_vec();
    if spanning.len() < faces / SPARSE {
        sorted.sort_by_key(|s| (s.slot, s.face));
        return sorted;
    }
    let firsts: Vec<usize> = fates
        .iter()
        .scan(0, |sum, fates| {
            *sum += fates.len();
            Some(*sum - fates.len())
        })
        .collect();
    let place = |s: &Spanning| firsts[s.slot as usize] + s.face as usize;
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

/// Whether an outline is the face's own triangle.
fn is_full_face(cut: &mut CutFace, source: &Source) -> bool {
    let Shape::Mesh(mesh) = source.shape() else {
        return false;
    };
    let c = mesh.corners(cut.face);
    let near = |edge: &BareEdge| c.iter().any(|corner| edge.from.may_be(corner));
    if cut.outline.edges().len() != 3 || !cut.outline.edges().iter().all(near) {
        return false;
    }
    let [p, q, r] = cut.outline.lines(&PlaneResidues::through(&c)) else {
        return false;
    };
    let own = [0, 1, 2].map(|i| LineKey::of_edge(&c[i], &c[(i + 1) % 3]));
    let distinct = p != q && q != r && r != p;
    distinct && own.iter().all(|k| [&*p, q, r].contains(&k))
}

/// A subtree to look through for a face, and the face's box in it.
#[derive(Clone, Copy)]
struct Place<'a> {
    branch: &'a Branch,
    complement: bool,
    low: Lattice,
    high: Lattice,
}

impl<'a> Place<'a> {
    /// Goes to a child; false if the box is not in its cell.
    fn enter(&mut self, child: &'a Branch) -> bool {
        self.branch = child;
        self.complement ^= child.complement;
        child.cell.holds_box(&self.low, &self.high)
    }

    /// Whether this is a leaf that lists the face.
    fn is_listed(&self, source: &Source, face: u32, flip: bool) -> bool {
        match &*self.branch.node {
            Node::Deferred(leaf) => lists(leaf, source, face, flip ^ self.complement),
            Node::Leaf(_) | Node::Cut(_) => false,
        }
    }
}

/// Whether every leaf that a face meets lists it; errs on no.
fn covers(root: &Branch, source: &Source, face: u32, flip: bool) -> bool {
    let (low, high) = source.face_box(face);
    if !root.cell.holds_box(&low, &high) {
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
        if !place.is_listed(source, face, flip) && enters(source, face, &place.branch.cell) {
            return false;
        }
    }
    true
}

/// Whether a face has area in a cell.
fn enters(source: &Source, face: u32, cell: &Cell) -> bool {
    !misses(source, face, cell) && source.clip(face, cell).is_some()
}

fn lists(leaf: &Deferred, source: &Source, face: u32, flip: bool) -> bool {
    leaf.groups.iter().any(|g| {
        g.source.id() == source.id() && g.flip == flip && g.faces.binary_search(&face).is_ok()
    })
}

/// Whether a solid has no boundary: it is empty or all of space.
///
/// A tree may list faces that meet none of their cells, so that the tree alone does not tell.
pub fn has_no_boundary(solid: &Solid) -> bool {
    if solid.root().constant().is_some() {
        return true;
    }
    let sources = Sources::new(solid.sources().clone());
    let boundary = collect(solid, &sources);
    let gone = |fates: &Vec<Fate>| fates.iter().all(|f| !matches!(f, Fate::Whole(_)));
    boundary.cut.is_empty() && boundary.fates.iter().all(gone)
}
