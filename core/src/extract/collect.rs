//! What a tree says of each face: kept whole, cut, or gone.

use rustc_hash::FxHashSet as HashSet;

use crate::geometry::cell::Cell;
use crate::geometry::line::LineKey;
use crate::geometry::outline::{cancel, OutlineEdge};
use crate::geometry::plane::Lattice;
use crate::merge::list::Sources;
use crate::mesh::source::{Shape, Source};
use crate::tree::node::{Branch, Deferred, Node, Part};
use crate::tree::solid::Solid;

/// The fate of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// No part of it is boundary.
    Gone,
    /// All of it is boundary; turned around if the flag is set. Never said of a half-space's face,
    /// which only the border of the universe ends.
    Whole(bool),
    /// Some of it is boundary, or it joins a polygon of its plane.
    Cut,
}

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
    pub edges: Vec<OutlineEdge>,
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

/// A face that reaches out of a leaf that lists it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Spanning {
    slot: u32,
    face: u32,
    flip: bool,
    leaf: u32,
}

struct Collector<'a> {
    sources: &'a Sources,
    root: &'a Branch,
    fates: Vec<Vec<Fate>>,
    spanning: Vec<Spanning>,
    parts: Vec<CutFace>,
    cells: Vec<Cell>,
    near: Vec<(u32, u32)>,
}

/// Collects the boundary of a solid.
pub fn collect(solid: &Solid, sources: &Sources) -> Boundary {
    let mut collector = Collector {
        sources,
        root: solid.root(),
        fates: vec![Vec::new(); sources.table().len()],
        spanning: Vec::new(),
        parts: Vec::new(),
        cells: Vec::new(),
        near: Vec::new(),
    };
    collector.visit_leaves();
    collector.settle()
}

impl Collector<'_> {
    fn visit_leaves(&mut self) {
        let mut open = vec![self.root.clone()];
        while let Some(branch) = open.pop() {
            match &*branch.node {
                Node::Leaf(_) => {}
                Node::Deferred(leaf) => self.visit(&branch, leaf),
                Node::Cut(halves) => {
                    let [minus, plus] = &halves.children;
                    open.push(branch.child(plus));
                    open.push(branch.child(minus));
                }
            }
        }
    }

    fn visit(&mut self, branch: &Branch, leaf: &Deferred) {
        let number = self.cells.len() as u32;
        self.cells.push(branch.cell);
        for group in &leaf.groups {
            let slot = self.sources.slot(&group.source);
            let flip = group.flip ^ branch.complement;
            let fates = fates_of(&mut self.fates[slot], &group.source);
            let bounded = group.source.mesh().is_some();
            let inside = bounded && group.source.cell().is_some_and(|c| branch.cell.holds(&c));
            if leaf.worked {
                self.near
                    .extend(group.faces.iter().map(|f| (slot as u32, *f)));
            }
            for &face in &group.faces {
                if inside || bounded && holds_face(&branch.cell, &group.source, face) {
                    fates[face as usize] = Fate::Whole(flip);
                } else {
                    self.spanning.push(Spanning {
                        slot: slot as u32,
                        face,
                        flip,
                        leaf: number,
                    });
                }
            }
        }
        for element in &leaf.parts {
            let part = &element.part;
            let edges = part_edges(part, &branch.cell);
            if edges.is_empty() {
                continue;
            }
            let slot = self.sources.slot(&part.source);
            fates_of(&mut self.fates[slot], &part.source)[part.face as usize] = Fate::Cut;
            self.parts.push(CutFace {
                slot: slot as u32,
                face: part.face,
                flip: element.flip ^ branch.complement,
                edges,
            });
        }
    }

    /// Decides the faces that span leaves, and outlines the cut ones.
    fn settle(mut self) -> Boundary {
        self.spanning.sort_unstable();
        let spanning = std::mem::take(&mut self.spanning);
        let mut open: Vec<&[Spanning]> = Vec::new();
        for run in spanning.chunk_by(|a, b| (a.slot, a.face) == (b.slot, b.face)) {
            let (slot, face) = (run[0].slot as usize, run[0].face);
            let one_side = run.iter().all(|s| s.flip == run[0].flip);
            let fate = &mut self.fates[slot][face as usize];
            let bounded = self.sources.get(slot).mesh().is_some();
            let uncut = bounded && *fate == Fate::Gone && one_side;
            if uncut && covers(self.root, self.sources.get(slot), face, run[0].flip) {
                *fate = Fate::Whole(run[0].flip);
            } else {
                *fate = Fate::Cut;
                open.push(run);
            }
        }
        let cut = self.outline(&open);
        self.near.sort_unstable();
        self.near.dedup();
        Boundary {
            fates: self.fates,
            cut,
            near: self.near,
        }
    }

    fn outline(&mut self, open: &[&[Spanning]]) -> Vec<CutFace> {
        let mut pieces: Vec<CutFace> = Vec::new();
        for s in open.iter().flat_map(|run| run.iter()) {
            let source = self.sources.get(s.slot as usize);
            if let Some(polygon) = source.clip(s.face, &self.cells[s.leaf as usize]) {
                let edges = OutlineEdge::all_of(&polygon).collect();
                pieces.push(CutFace {
                    slot: s.slot,
                    face: s.face,
                    flip: s.flip,
                    edges,
                });
            }
        }
        pieces.append(&mut self.parts);
        pieces.sort_by_key(|p| (p.slot, p.face, p.flip));
        let mut cut: Vec<CutFace> = Vec::new();
        for piece in pieces {
            match cut.last_mut() {
                Some(c) if (c.slot, c.face, c.flip) == (piece.slot, piece.face, piece.flip) => {
                    c.edges.extend(piece.edges);
                }
                _ => cut.push(piece),
            }
        }
        cut.retain_mut(|c| {
            c.edges = cancel(std::mem::take(&mut c.edges));
            let whole = is_full_face(c, self.sources.get(c.slot as usize));
            if whole {
                self.fates[c.slot as usize][c.face as usize] = Fate::Whole(c.flip);
            }
            !whole && !c.edges.is_empty()
        });
        cut
    }
}

fn fates_of<'a>(fates: &'a mut Vec<Fate>, source: &Source) -> &'a mut Vec<Fate> {
    if fates.is_empty() {
        fates.resize(source.face_count(), Fate::Gone);
    }
    fates
}

fn holds_face(cell: &Cell, source: &Source, face: u32) -> bool {
    let (low, high) = source.face_box(face);
    cell.holds_box(&low, &high)
}

/// The outline of a part inside a leaf's cell.
fn part_edges(part: &Part, cell: &Cell) -> Vec<OutlineEdge> {
    if part.home == *cell {
        return part.edges.clone();
    }
    let clipped = part.pieces().iter().filter_map(|p| p.clone().clipped(cell));
    cancel(
        clipped
            .flat_map(|p| OutlineEdge::all_of(&p).collect::<Vec<_>>())
            .collect(),
    )
}

/// Whether an outline is the face's own triangle.
fn is_full_face(cut: &CutFace, source: &Source) -> bool {
    let Shape::Mesh(mesh) = source.shape() else {
        return false;
    };
    let c = mesh.corners(cut.face);
    let own = [0, 1, 2].map(|i| LineKey::of_edge(&c[i], &c[(i + 1) % 3]));
    let lines: HashSet<LineKey> = cut.edges.iter().map(|e| e.line).collect();
    cut.edges.len() == 3 && lines.len() == 3 && own.iter().all(|k| lines.contains(k))
}

/// Whether every leaf that a face meets lists it; errs on no.
fn covers(root: &Branch, source: &Source, face: u32, flip: bool) -> bool {
    let (low, high) = source.face_box(face);
    if !root.cell.holds_box(&low, &high) {
        return false;
    }
    let mut open = vec![root.clone()];
    while let Some(branch) = open.pop() {
        match &*branch.node {
            Node::Leaf(_) => {
                if source.clip(face, &branch.cell).is_some() {
                    return false;
                }
            }
            Node::Deferred(leaf) => {
                if !lists(leaf, &branch, source, face, flip)
                    && source.clip(face, &branch.cell).is_some()
                {
                    return false;
                }
            }
            Node::Cut(halves) => {
                let Some(cut) = branch.cell.cut() else {
                    return false;
                };
                for (child, plus) in halves.children.iter().zip([false, true]) {
                    let half = branch.cell.half(cut, plus);
                    let Some((a, b)) = overlap(&half, &low, &high) else {
                        continue;
                    };
                    if !child.cell.holds_box(&a, &b) {
                        return false;
                    }
                    open.push(branch.child(child));
                }
            }
        }
    }
    true
}

fn overlap(cell: &Cell, low: &Lattice, high: &Lattice) -> Option<(Lattice, Lattice)> {
    let top = cell.high();
    let a = [0, 1, 2].map(|i| low[i].max(cell.low()[i]));
    let b = [0, 1, 2].map(|i| high[i].min(top[i]));
    (0..3).all(|i| a[i] <= b[i]).then_some((a, b))
}

fn lists(leaf: &Deferred, branch: &Branch, source: &Source, face: u32, flip: bool) -> bool {
    leaf.groups.iter().any(|g| {
        g.source.id() == source.id()
            && g.flip ^ branch.complement == flip
            && g.faces.binary_search(&face).is_ok()
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
