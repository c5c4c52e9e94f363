//! What each leaf of a tree says of the faces it lists, for all leaves at once.

use std::sync::atomic::{AtomicU8, Ordering};

use rayon::prelude::*;

use super::collect::{CutFace, Fate};
use crate::geometry::cell::Cell;
use crate::geometry::outline::{cancel, OutlineEdge};
use crate::merge::list::Sources;
use crate::mesh::source::{Source, TriangleMesh};
use crate::mesh::tasks::{in_pool, CHUNK};
use crate::tree::node::{Branch, Deferred, Group, Node, Part, Work};

/// A face that reaches out of a leaf that lists it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spanning {
    /// The source's slot.
    pub slot: u32,
    /// The face.
    pub face: u32,
    /// Whether inside and outside are exchanged.
    pub flip: bool,
    /// The number of the leaf.
    pub leaf: u32,
}

/// What the leaves say, in their order.
#[derive(Default)]
pub struct Listed {
    /// Faces inside a leaf's cell are whole, those with a part in one are cut; by slot.
    pub fates: Vec<Vec<Fate>>,
    /// The faces that reach out of leaves.
    pub spanning: Vec<Spanning>,
    /// The parts, and where they end.
    pub parts: Vec<CutFace>,
    /// Faces in cells where several operands met, by slot.
    pub near: Vec<(u32, u32)>,
    /// The leaves' cells.
    pub cells: Vec<Cell>,
}

/// What one leaf says but for the faces inside its cell.
#[derive(Default)]
struct Found {
    spanning: Vec<Spanning>,
    parts: Vec<CutFace>,
    near: Vec<(u32, u32)>,
}

/// A leaf, its number and its element groups' slots.
struct Leaf<'a> {
    number: u32,
    cell: Cell,
    complement: bool,
    content: &'a Deferred,
}

/// Asks all leaves.
pub fn listed(root: &Branch, sources: &Sources) -> Listed {
    let leaves = leaves_of(root);
    let fates = Fates::of(&leaves, sources);
    let visit = |leaf: &Leaf| leaf.visit(sources, &fates);
    let size: usize = leaves.iter().map(|l| l.content.len()).sum();
    let found: Vec<Found> = if in_pool() && size > CHUNK {
        leaves.par_iter().map(visit).collect()
    } else {
        leaves.iter().map(visit).collect()
    };
    let mut all = Listed {
        fates: fates.into_plain(),
        cells: leaves.iter().map(|l| l.cell).collect(),
        ..Listed::default()
    };
    for leaf in found {
        all.spanning.extend(leaf.spanning);
        all.parts.extend(leaf.parts);
        all.near.extend(leaf.near);
    }
    all
}

fn leaves_of(root: &Branch) -> Vec<Leaf<'_>> {
    let mut leaves = Vec::new();
    let mut open = vec![(root, root.complement)];
    while let Some((branch, complement)) = open.pop() {
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(content) => leaves.push(Leaf {
                number: leaves.len() as u32,
                cell: branch.cell,
                complement,
                content,
            }),
            Node::Cut(halves) => {
                let [minus, plus] = &halves.children;
                for child in [plus, minus] {
                    open.push((child, complement ^ child.complement));
                }
            }
        }
    }
    leaves
}

/// Fates that several threads mark, by slot; empty for sources that no leaf names.
struct Fates(Vec<Vec<AtomicU8>>);

const GONE: u8 = 0;
const WHOLE: u8 = 1;
const TURNED: u8 = 2;
const CUT: u8 = 3;

impl Fates {
    fn of(leaves: &[Leaf], sources: &Sources) -> Self {
        let mut fates: Vec<Vec<AtomicU8>> = Vec::new();
        fates.resize_with(sources.table().len(), Vec::new);
        let mut enter = |source: &Source, slot: usize| {
            if fates[slot].is_empty() {
                fates[slot].resize_with(source.face_count(), || AtomicU8::new(GONE));
            }
        };
        for leaf in leaves {
            for group in &leaf.content.groups {
                enter(&group.source, sources.slot(&group.source));
            }
            for element in &leaf.content.parts {
                enter(&element.part.source, sources.slot(&element.part.source));
            }
        }
        Self(fates)
    }

    fn into_plain(self) -> Vec<Vec<Fate>> {
        let plain = |mark: AtomicU8| match mark.into_inner() {
            GONE => Fate::Gone,
            WHOLE => Fate::Whole(false),
            TURNED => Fate::Whole(true),
            _ => Fate::Cut,
        };
        let slots = self.0.into_iter();
        slots.map(|s| s.into_iter().map(plain).collect()).collect()
    }
}

impl Leaf<'_> {
    fn visit(&self, sources: &Sources, fates: &Fates) -> Found {
        let mut found = Found::default();
        for group in &self.content.groups {
            let slot = sources.slot(&group.source);
            if self.content.work == Work::Trees {
                let faces = group.faces.iter();
                found.near.extend(faces.map(|f| (slot as u32, *f)));
            }
            self.visit_group(group, slot as u32, &fates.0[slot], &mut found);
        }
        for element in &self.content.parts {
            let part = &element.part;
            let edges = part_edges(part, &self.cell);
            if edges.is_empty() {
                continue;
            }
            let slot = sources.slot(&part.source);
            fates.0[slot][part.face as usize].store(CUT, Ordering::Relaxed);
            found.parts.push(CutFace {
                slot: slot as u32,
                face: part.face,
                flip: element.flip ^ self.complement,
                edges,
            });
        }
        found
    }

    fn visit_group(&self, group: &Group, slot: u32, fates: &[AtomicU8], found: &mut Found) {
        let flip = group.flip ^ self.complement;
        let mesh = group.source.mesh();
        let holds_all = mesh.is_some() && group.source.cell().is_some_and(|c| self.cell.holds(&c));
        let holds = mesh.map(|mesh| holder(mesh, &self.cell));
        for &face in &group.faces {
            if holds_all || holds.as_ref().is_some_and(|holds| holds(face)) {
                let mark = if flip { TURNED } else { WHOLE };
                fates[face as usize].store(mark, Ordering::Relaxed);
            } else {
                found.spanning.push(Spanning {
                    slot,
                    face,
                    flip,
                    leaf: self.number,
                });
            }
        }
    }
}

/// Whether a face's corners lie in a cell.
fn holder<'a>(mesh: &'a TriangleMesh, cell: &Cell) -> impl Fn(u32) -> bool + 'a {
    let (low, high) = (*cell.low(), cell.high());
    move |face| {
        mesh.faces[face as usize].iter().all(|v| {
            let p = &mesh.vertices[*v as usize];
            (0..3).all(|i| low[i] <= p[i] && p[i] <= high[i])
        })
    }
}

/// The outline of a part inside a leaf's cell.
fn part_edges(part: &Part, cell: &Cell) -> Vec<OutlineEdge> {
    if part.home == *cell {
        return part.outline();
    }
    let clipped = part.pieces().into_iter().filter_map(|p| p.clipped(cell));
    cancel(
        clipped
            .flat_map(|p| OutlineEdge::all_of(&p).collect::<Vec<_>>())
            .collect(),
    )
}
