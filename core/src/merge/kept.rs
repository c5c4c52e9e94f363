//! What stays of the faces in a cell, joined again to the elements of a leaf.

use std::sync::Arc;

use super::list::Sources;
use crate::geometry::cell::Cell;
use crate::geometry::line::LineKey;
use crate::geometry::outline::{cancel, BareEdge, OutlineEdge};
use crate::geometry::plane::Plane;
use crate::geometry::polygon::{Carrier, Polygon};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::{Deferred, Group, Node, Part, PartElement, Work};

/// What stays of one element with one orientation.
#[derive(Debug)]
pub struct Kept {
    face: (u32, u32),
    flip: bool,
    what: What,
}

#[derive(Debug)]
enum What {
    /// All of a whole face inside the cell.
    Whole,
    /// All of a part inside the cell.
    Part(Arc<Part>),
    /// Some convex pieces, and what some edges bound.
    Pieces(Vec<Polygon>, Vec<BareEdge>),
    /// What an outline bounds that needs no joining, and is not all of the face in the cell.
    Outline(Vec<BareEdge>),
}

impl Kept {
    /// All of a face in the cell: of a slot and a number.
    pub fn whole(face: (u32, u32), flip: bool) -> Self {
        let what = What::Whole;
        Self { face, flip, what }
    }

    /// All of a part in the cell.
    pub fn part(face: (u32, u32), flip: bool, part: Arc<Part>) -> Self {
        let what = What::Part(part);
        Self { face, flip, what }
    }

    /// Convex pieces of a face.
    pub fn pieces(face: (u32, u32), flip: bool, pieces: Vec<Polygon>) -> Self {
        Self::joined(face, flip, pieces, Vec::new())
    }

    /// Convex pieces of a face, and what some edges on it bound.
    pub fn joined(
        face: (u32, u32),
        flip: bool,
        pieces: Vec<Polygon>,
        edges: Vec<BareEdge>,
    ) -> Self {
        let what = What::Pieces(pieces, edges);
        Self { face, flip, what }
    }

    /// What an outline bounds: some, but not all of a face in the cell; no two of its edges that
    /// follow each other lie on one line.
    pub fn outlined(face: (u32, u32), flip: bool, edges: Vec<BareEdge>) -> Self {
        let what = What::Outline(edges);
        Self { face, flip, what }
    }

    /// What bounds it inside the cell.
    fn edges(&self, source: &Source, cell: &Cell) -> Vec<OutlineEdge> {
        let polygons = self.polygons(source, cell);
        let mut edges: Vec<OutlineEdge> = Vec::new();
        for polygon in &polygons {
            edges.extend(OutlineEdge::all_of(polygon));
        }
        if let What::Pieces(_, bare) | What::Outline(bare) = &self.what {
            edges.extend(OutlineEdge::keyed(
                bare,
                &source.plane_residues(self.face.1),
            ));
        }
        edges
    }

    /// The convex pieces inside the cell.
    fn polygons(&self, source: &Source, cell: &Cell) -> Vec<Polygon> {
        match &self.what {
            What::Whole => source.clip(self.face.1, cell).into_iter().collect(),
            What::Part(part) => {
                let clipped = part.pieces().into_iter().filter_map(|p| p.clipped(cell));
                clipped.collect()
            }
            What::Pieces(pieces, _) => pieces.clone(),
            What::Outline(_) => Vec::new(),
        }
    }
}

/// Joins the pieces of each face again and lists them, as the work of a kernel.
pub fn assemble(
    mut kept: Vec<Kept>,
    corner: i32,
    work: Work,
    cell: &Cell,
    sources: &Sources,
) -> Node {
    if kept.is_empty() {
        return Node::Leaf(corner);
    }
    kept.sort_by_key(|k| (k.face.0, k.flip, k.face.1));
    let mut leaf = Deferred {
        corner,
        work,
        ..Deferred::default()
    };
    for run in kept.chunk_by_mut(|a, b| a.face == b.face && a.flip == b.flip) {
        let (slot, face) = run[0].face;
        let source = sources.get(slot as usize);
        let flip = run[0].flip;
        match run {
            [Kept {
                what: What::Whole, ..
            }] => {
                list_whole(&mut leaf.groups, source, face, flip);
                continue;
            }
            [Kept {
                what: What::Part(part),
                ..
            }] => {
                let part = Arc::clone(part);
                leaf.parts.push(PartElement { part, flip });
                continue;
            }
            [Kept {
                what: What::Outline(edges),
                ..
            }] => {
                let edges = std::mem::take(edges).into_boxed_slice();
                let part = Arc::new(Part::of_edges(Arc::clone(source), face, *cell, edges));
                leaf.parts.push(PartElement { part, flip });
                continue;
            }
            _ => {}
        }
        let edges = run.iter().flat_map(|k| k.edges(source, cell)).collect();
        let edges = cancel(edges);
        if is_whole(&edges, source, face, cell) {
            list_whole(&mut leaf.groups, source, face, run[0].flip);
        } else {
            let part = Arc::new(Part::new(Arc::clone(source), face, *cell, edges));
            leaf.parts.push(PartElement { part, flip });
        }
    }
    Node::Deferred(leaf)
}

fn list_whole(groups: &mut Vec<Group>, source: &Arc<Source>, face: u32, flip: bool) {
    match groups.last_mut() {
        Some(g) if Arc::ptr_eq(&g.source, source) && g.flip == flip => g.faces.push(face),
        _ => groups.push(Group {
            source: Arc::clone(source),
            flip,
            faces: vec![face],
        }),
    }
}

/// Whether an outline runs only on the face's own edges and the cell's border: then it is the
/// border of the whole face inside the cell, for a part of a connected set with no border of its
/// own is all of it.
pub fn is_whole(edges: &[OutlineEdge], source: &Source, face: u32, cell: &Cell) -> bool {
    let own: Vec<LineKey> = match source.shape() {
        Shape::Mesh(mesh) => {
            let c = mesh.corners(face);
            (0..3)
                .map(|i| LineKey::of_edge(&c[i], &c[(i + 1) % 3]))
                .collect()
        }
        Shape::HalfSpace(_) => Vec::new(),
    };
    let foreign = |e: &&OutlineEdge| !own.contains(&e.line);
    let others: Vec<&OutlineEdge> = edges.iter().filter(foreign).collect();
    if others.is_empty() {
        return !edges.is_empty();
    }
    // No wall is slanted.
    let is_slanted = |carrier: &Carrier| match carrier {
        Carrier::Cut(plane, _) => plane.only_axis().is_none(),
        Carrier::Edge(_) => false,
    };
    if others.iter().any(|e| is_slanted(&e.carrier)) {
        return false;
    }
    let border = border_lines(&source.plane(face), cell);
    others.iter().all(|e| border.contains(&e.line))
}

/// The lines in which a plane meets the planes of a cell's walls.
fn border_lines(plane: &Plane, cell: &Cell) -> Vec<LineKey> {
    let crossed = |wall: &Plane| {
        let axis = wall.main_axis();
        (0..3).any(|i| i != axis && plane.normal()[i] != 0)
    };
    cell.walls()
        .iter()
        .filter(|w| crossed(w))
        .map(|w| LineKey::of_planes(plane, w))
        .collect()
}
