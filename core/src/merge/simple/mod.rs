//! The check whether a mesh is simple: nothing overlaps, and winding numbers are 0 outside and 1
//! inside.
//!
//! Nearly all pairs of faces in a small cell share a vertex or lie beyond each other's planes, and
//! the faces of a cap are told to be clear of each other by its outline; such cells need no tree.
//! The others are labelled, and so is one cell for each shell.

mod copies;
mod cuts;
mod looked;
mod places;
mod probes;
pub(super) mod star;
mod unclear;
mod uniting;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

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
use crate::mesh::tasks::{both, Worth};
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, Deferred, Group, Node};
use crate::tree::solid::Solid;
use looked::Looked;
pub use places::overlaps_at;
use star::is_star_shaped;
pub use unclear::Unclear;
use unclear::{Pairs, View};
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
    view: &'a View<'a>,
    shells: Vec<u32>,
    /// The faces that may overlap others; `None` if these are many, and cells are looked at one by
    /// one.
    unclear: Option<Unclear>,
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
    Ok(simplicity_and_pairs(solid, sources)?.0)
}

/// As [`simplicity`], and the pairs of faces that may overlap, if it had to look for them and they
/// are not too many.
///
/// # Errors
/// `Cancelled`.
pub fn simplicity_and_pairs(
    solid: &Solid,
    sources: &Sources,
) -> Result<(Simplicity, Option<Unclear>)> {
    let Some((leaf, source, mesh)) = only_mesh(solid) else {
        return Ok((Simplicity::Unasked, None));
    };
    let all = leaf.groups[0].faces.iter().copied().eq(mesh.face_ids());
    let closed = || source.open_vertices().is_empty();
    if all && closed() && is_star_shaped(mesh) {
        return Ok((Simplicity::Simple, None));
    }
    let shells = shells(source, mesh.faces.len());
    let some = all && closed() && count_of(&shells) > 1;
    if some && copies::are_some(mesh, &faces_of(&shells)) {
        return Ok((Simplicity::Overlapping, None));
    }
    let view = View::new(source, mesh);
    let unclear = match Unclear::unless_overlapping(&view, &leaf.groups[0].faces) {
        Pairs::Overlap => return Ok((Simplicity::Overlapping, None)),
        Pairs::Unclear(unclear) => Some(unclear),
        Pairs::Many => None,
    };
    let mut check = Check::new(sources, &view, shells, unclear);
    if let [alone] = check.seen.as_mut_slice() {
        // A single shell whose faces keep clear of each other has one number on either side of all
        // of them, and which is 0 is plain from the sign of its volume.
        *alone.get_mut() = is_outward(mesh, mesh.face_ids());
    }
    check.cell(solid.root().cell, List::open(leaf, solid.root(), sources));
    let found = if check.overlap.load(Ordering::Relaxed) {
        Simplicity::Overlapping
    } else {
        Simplicity::Simple
    };
    Ok((found, check.unclear))
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

/// The shells of a mesh that closes by index and bound something, if each alone is simple; of equal
/// ones the first. `None` if one shell that bounds something is all there is, and if more than `most`
/// are.
///
/// A shell in one plane bounds nothing. Where two others cross or hold each other, their union is
/// what the mesh winds around.
///
/// # Cost
/// As [`simplicity`]; shells that overlap are not compared with each other.
pub fn simple_shells(solid: &Solid, sources: &Sources, most: usize) -> Option<Vec<Branch>> {
    let (leaf, source, mesh) = only_mesh(solid)?;
    let whole =
        leaf.corner == 0 && !solid.root().complement && !leaf.groups[0].orientation.is_opposite();
    let closed = source.open_vertices().is_empty();
    if !whole || !closed || leaf.len() != mesh.faces.len() {
        return None;
    }
    let shells = shells(source, mesh.faces.len());
    let faces = faces_of(&shells);
    let is_flat = |k: &usize| mesh.are_in_one_plane(faces[*k].iter().copied());
    let bounding: Vec<usize> = (0..faces.len()).filter(|k| !is_flat(k)).collect();
    if bounding.len() > most || faces.len() == 1 && bounding.len() == 1 {
        return None;
    }
    let is_first = copies::are_firsts(mesh, &faces);
    let firsts = bounding.into_iter().filter(|k| is_first[*k]);
    let staying: Vec<&Vec<FaceId>> = firsts.map(|k| &faces[k]).collect();
    let view = View::new(source, mesh);
    let unclear = Unclear::among(&view, staying.iter().map(|shell| shell.as_slice()));
    let mut check = Check::new(sources, &view, shells, unclear);
    for (seen, faces) in check.seen.iter_mut().zip(&faces) {
        *seen.get_mut() = is_outward(mesh, faces.iter().copied());
    }
    let shared = &leaf.groups[0].source;
    let branches: Vec<Branch> = staying
        .into_iter()
        .map(|shell| shell_of(shared, shell.clone()))
        .collect();
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
        touching: false,
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

/// For each shell its faces, ascending.
fn faces_of(shells: &[u32]) -> Vec<Vec<FaceId>> {
    let mut faces = vec![Vec::new(); count_of(shells)];
    for (face, shell) in FaceId::all().zip(shells) {
        faces[*shell as usize].push(face);
    }
    faces
}

/// Count the shells.
fn count_of(shells: &[u32]) -> usize {
    shells.iter().map(|s| *s as usize + 1).max().unwrap_or(0)
}

impl<'a> Check<'a> {
    /// A check in which no shell was labelled yet.
    fn new(
        sources: &'a Sources,
        view: &'a View<'a>,
        shells: Vec<u32>,
        unclear: Option<Unclear>,
    ) -> Self {
        let count = count_of(&shells);
        Self {
            sources,
            view,
            shells,
            unclear,
            seen: (0..count).map(|_| AtomicBool::new(false)).collect(),
            overlap: AtomicBool::new(false),
        }
    }

    /// Looks for overlaps in a cell, until one is found.
    fn cell(&self, cell: Cell, list: List) {
        poll();
        if self.overlap.load(Ordering::Relaxed) || self.is_settled(&list) {
            return;
        }
        let total = list.len();
        let stuck = || total <= STUCK && list.reaching_out(&cell) * 8 > total * 7;
        let cut = cell.cut().filter(|_| total > LEAF && !stuck());
        let Some(cut) = cut else {
            self.leaf(&cell, &list);
            return;
        };
        let (minus, plus) = list.divide(&cell, cut, self.sources);
        let below = || self.cell(cell.half(cut, Half::Minus), minus);
        let above = || self.cell(cell.half(cut, Half::Plus), plus);
        both(Worth::pool_if(total >= TASK), below, above);
    }

    /// Return whether all faces of a list are known to be clear of each other, and their shells to
    /// wind once around what they hold.
    fn is_settled(&self, list: &List) -> bool {
        let faces = || list.records.iter().map(|r| r.face);
        let is_seen =
            |f: FaceId| self.seen[self.shells[f.place()] as usize].load(Ordering::Relaxed);
        let clear = |u: &Unclear| faces().filter(|f| u.holds(*f)).nth(1).is_none();
        self.unclear.as_ref().is_some_and(clear) && faces().all(is_seen)
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

    /// Return whether no two of the faces overlap, as far as quick looks can tell; errs on no.
    fn is_clean(&self, faces: &[FaceId]) -> bool {
        if let Some(unclear) = &self.unclear {
            return unclear.is_clear(faces);
        }
        spend(faces.len());
        let looked: Vec<Looked> = faces.iter().map(|f| self.view.of(*f)).collect();
        (1..looked.len()).all(|i| looked[..i].iter().all(|other| looked[i].is_clear_of(other)))
    }
}
