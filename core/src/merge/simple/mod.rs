//! The check whether a mesh is simple: nothing overlaps, and winding numbers are 0 outside and 1
//! inside.
//!
//! Nearly all pairs of faces in a small cell share a vertex or lie beyond each other's planes, and
//! the faces of a cap are told to be clear of each other by its outline; such cells need no tree.
//! The others are labelled, and so is one cell for each shell.

mod cuts;
mod flats;
mod looked;
mod places;
mod probes;
pub(super) mod star;
mod uniting;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use super::descent::choice::LEAF;
use super::kernels::trees::LeafTree;
use super::lists::list::{List, Sources};
use crate::arith::{Int, Sign};
use crate::error::Result;
use crate::geometry::cell::Cell;
use crate::geometry::flux::fixed::sixfold_flux;
use crate::geometry::side::{Half, Orientation};
use crate::interrupt::{poll, spend};
use crate::mesh::handle::{FaceId, Slot};
use crate::mesh::source::Source;
use crate::mesh::tasks::both;
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, Deferred, Group, Node};
use crate::tree::solid::Solid;
use flats::flat_pieces;
use looked::Looked;
pub use places::overlaps_at;
use star::is_star_shaped;
pub use uniting::united_where_it_overlaps;

/// Lists at least this long are worth a task of their own.
const TASK: usize = 1024;

/// Lists that no longer shrink are labelled at once, up to this length.
const STUCK: usize = 256;

/// So many pairs for each face are looked at one by one. More overlap in a few places, where local
/// trees divide space instead.
const MOST_PAIRS: usize = 64;

struct Check<'a> {
    sources: &'a Sources,
    mesh: &'a TriangleMesh,
    shells: Vec<u32>,
    /// By vertex, whether surfaces may meet there that pairs of faces do not show.
    irregular: Vec<bool>,
    /// By face, its flat piece.
    pieces: Vec<u32>,
    seen: Vec<AtomicBool>,
    overlap: AtomicBool,
}

/// The answer of the check of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simplicity {
    /// Nothing overlaps, and winding numbers are 0 outside and 1 inside.
    Simple,
    /// Something overlaps or is turned inside out.
    Overlapping,
    /// It was not asked: the solid is not made of one mesh.
    Unasked,
}

/// Check whether a solid made of one mesh is simple.
///
/// # Example
/// ```
/// use std::sync::{Arc, Mutex};
///
/// use bspcsg::merge::lists::list::Sources;
/// use bspcsg::merge::simple::{simplicity, Simplicity};
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// let sources = Sources::new(solid.sources().clone());
/// assert_eq!(simplicity(&solid, &sources)?, Simplicity::Simple);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
///
/// # Errors
/// `Cancelled`.
pub fn simplicity(solid: &Solid, sources: &Sources) -> Result<Simplicity> {
    let Some((leaf, source, mesh)) = only_mesh(solid) else {
        return Ok(Simplicity::Unasked);
    };
    let all = leaf.groups[0].faces.iter().copied().eq(mesh.face_ids());
    let closed = || source.open_vertices().is_empty();
    if all && closed() && is_star_shaped(mesh) {
        return Ok(Simplicity::Simple);
    }
    let mut check = Check::new(source, mesh, sources);
    if let [alone] = check.seen.as_mut_slice() {
        // A single shell whose faces keep clear of each other has one number on either side of all
        // of them, and which is 0 is plain from the sign of its volume.
        *alone.get_mut() = is_outward(mesh, mesh.face_ids());
    }
    check.cell(solid.root().cell, List::open(leaf, solid.root(), sources));
    Ok(if check.overlap.load(Ordering::Relaxed) {
        Simplicity::Overlapping
    } else {
        Simplicity::Simple
    })
}

/// The leaf, the source and the mesh of a solid that lists faces of one mesh and nothing else.
fn only_mesh(solid: &Solid) -> Option<(&Deferred, &Source, &TriangleMesh)> {
    let (Node::Deferred(leaf), 1) = (&*solid.root().node, solid.sources().len()) else {
        return None;
    };
    let source = solid.sources().get(Slot(0));
    let alone = leaf.parts.is_empty() && leaf.groups.len() == 1;
    Some((leaf, source, source.mesh().filter(|_| alone)?))
}

/// The shells of a mesh that closes by index, if there are several, and each alone is simple.
///
/// Where two of them cross or hold each other, their union is what the mesh winds around.
///
/// # Cost
/// As [`simplicity`]; shells that overlap are not compared with each other.
pub fn simple_shells(solid: &Solid, sources: &Sources) -> Option<Vec<Branch>> {
    let (leaf, source, mesh) = only_mesh(solid)?;
    let whole =
        leaf.corner == 0 && !solid.root().complement && !leaf.groups[0].orientation.is_opposite();
    let closed = source.open_vertices().is_empty();
    if !whole || !closed || leaf.len() != mesh.faces.len() {
        return None;
    }
    let shells = shells(source, mesh.faces.len());
    if shells.iter().all(|shell| *shell == 0) {
        return None;
    }
    let mut check = Check::with_shells(source, mesh, sources, shells);
    let mut faces = vec![Vec::new(); check.seen.len()];
    for (face, shell) in FaceId::all().zip(&check.shells) {
        faces[*shell as usize].push(face);
    }
    for (seen, faces) in check.seen.iter_mut().zip(&faces) {
        *seen.get_mut() = is_outward(mesh, faces.iter().copied());
    }
    let shared = &leaf.groups[0].source;
    let branches: Vec<Branch> = faces.into_iter().map(|f| shell_of(shared, f)).collect();
    for branch in &branches {
        if let Node::Deferred(leaf) = &*branch.node {
            check.cell(branch.cell, List::open(leaf, branch, sources));
        }
        if check.overlap.load(Ordering::Relaxed) {
            return None;
        }
    }
    Some(branches)
}

/// A branch of some faces of a mesh.
fn shell_of(source: &Arc<Source>, faces: Vec<FaceId>) -> Branch {
    let around = source.box_around(&faces);
    let cell = around.map_or(Cell::UNIVERSE, |(low, high)| Cell::around(&low, &high));
    let group = Group {
        source: Arc::clone(source),
        orientation: Orientation::Same,
        faces,
    };
    let leaf = Deferred {
        groups: vec![group],
        ..Deferred::default()
    };
    Branch::of_node(cell, Node::Deferred(leaf))
}

/// Return whether faces enclose more inside than outside.
fn is_outward(mesh: &TriangleMesh, faces: impl Iterator<Item = FaceId>) -> bool {
    let mut volume = Int::<4>::ZERO;
    for face in faces {
        volume += sixfold_flux(&mesh.corners(face));
    }
    volume.sign() == Sign::Positive
}

/// For each face the number of its edge-connected component.
fn shells(source: &Source, count: usize) -> Vec<u32> {
    let mut shell = vec![NONE; count];
    let Some(topology) = source.topology() else {
        return shell;
    };
    let mut next = 0;
    for start in 0..count {
        if shell[start] != NONE {
            continue;
        }
        shell[start] = next;
        let mut open = vec![start];
        while let Some(face) = open.pop() {
            for mate in &topology.mates()[3 * face..3 * face + 3] {
                let other = *mate as usize / 3;
                if *mate != NONE && shell[other] == NONE {
                    shell[other] = next;
                    open.push(other);
                }
            }
        }
        next += 1;
    }
    shell
}

fn irregular(source: &Source, mesh: &TriangleMesh) -> Vec<bool> {
    let mut marks = vec![false; mesh.vertices.len()];
    for vertex in source.irregular_vertices() {
        marks[vertex.place()] = true;
    }
    marks
}

impl<'a> Check<'a> {
    /// A check in which no shell was labelled yet.
    fn new(source: &Source, mesh: &'a TriangleMesh, sources: &'a Sources) -> Self {
        let shells = shells(source, mesh.faces.len());
        Self::with_shells(source, mesh, sources, shells)
    }

    fn with_shells(
        source: &Source,
        mesh: &'a TriangleMesh,
        sources: &'a Sources,
        shells: Vec<u32>,
    ) -> Self {
        let count = shells.iter().map(|s| *s as usize + 1).max().unwrap_or(0);
        Self {
            sources,
            mesh,
            shells,
            irregular: irregular(source, mesh),
            pieces: flat_pieces(source, mesh),
            seen: (0..count).map(|_| AtomicBool::new(false)).collect(),
            overlap: AtomicBool::new(false),
        }
    }

    /// Looks for overlaps in a cell.
    fn cell(&self, cell: Cell, list: List) {
        let look = |cell: &Cell, list: &List| self.leaf(cell, list);
        self.small_cells(cell, list, &look);
    }

    /// Calls `look` with the small cells of a cell, until an overlap is found.
    fn small_cells(&self, cell: Cell, list: List, look: &(impl Fn(&Cell, &List) + Sync)) {
        poll();
        if self.overlap.load(Ordering::Relaxed) {
            return;
        }
        let total = list.len();
        let stuck = || total <= STUCK && list.reaching_out(&cell) * 8 > total * 7;
        let cut = cell.cut().filter(|_| total > LEAF && !stuck());
        let Some(cut) = cut else {
            look(&cell, &list);
            return;
        };
        let (minus, plus) = list.divide(&cell, cut, self.sources);
        let below = || self.small_cells(cell.half(cut, Half::Minus), minus, look);
        let above = || self.small_cells(cell.half(cut, Half::Plus), plus, look);
        both(total >= TASK, below, above);
    }

    /// The pairs of faces that may overlap, each both ways, ascending; `None` if they are many.
    fn unclear_pairs(self, (cell, list): (Cell, List)) -> Option<Vec<[FaceId; 2]>> {
        let found = Mutex::new(Vec::new());
        let most = MOST_PAIRS * self.mesh.faces.len();
        let look = |_: &Cell, list: &List| {
            let pairs = self.unclear(list);
            if let Ok(mut found) = found.lock() {
                found.extend(pairs);
                self.overlap.fetch_or(found.len() > most, Ordering::Relaxed);
            }
        };
        self.small_cells(cell, list, &look);
        let mut pairs = found
            .into_inner()
            .ok()
            .filter(|found| found.len() <= most)?;
        pairs.sort_unstable();
        pairs.dedup();
        Some(pairs)
    }

    fn leaf(&self, cell: &Cell, list: &List) {
        let faces: Vec<FaceId> = list.records.iter().map(|r| r.face).collect();
        let shells = || {
            faces
                .iter()
                .map(|f| &self.seen[self.shells[f.place()] as usize])
        };
        let known = shells().all(|s| s.load(Ordering::Relaxed));
        if faces.is_empty() || (known && self.is_clean(&faces)) {
            return;
        }
        let leaf = LeafTree::new(list, cell, self.sources);
        if !leaf.is_simple() {
            self.overlap.store(true, Ordering::Relaxed);
        }
        for face in leaf.faces() {
            self.seen[self.shells[face.place()] as usize].store(true, Ordering::Relaxed);
        }
    }

    /// Return whether no two of the faces overlap, as far as a quick look can tell; errs on no.
    fn is_clean(&self, faces: &[FaceId]) -> bool {
        let looked = self.look_at(faces);
        (1..looked.len()).all(|i| looked[..i].iter().all(|other| looked[i].is_clear_of(other)))
    }

    /// The pairs of listed faces that may overlap, as far as a quick look can tell, each both ways.
    fn unclear(&self, list: &List) -> Vec<[FaceId; 2]> {
        let faces: Vec<FaceId> = list.records.iter().map(|r| r.face).collect();
        let looked = self.look_at(&faces);
        let mut pairs = Vec::new();
        for i in 1..looked.len() {
            for j in (0..i).filter(|j| !looked[i].is_clear_of(&looked[*j])) {
                pairs.extend([[faces[i], faces[j]], [faces[j], faces[i]]]);
            }
        }
        pairs
    }

    fn look_at(&self, faces: &[FaceId]) -> Vec<Looked> {
        spend(faces.len());
        let look = |f: &FaceId| Looked::at(self.mesh, *f, &self.irregular, self.pieces[f.place()]);
        faces.iter().map(look).collect()
    }
}
