//! Tests whether a mesh overlaps itself, and unites it with itself, by comparing its own faces.

use std::sync::Arc;

use super::candidates::Operand;
use super::contacts::Contacts;
use super::facets::Facets;
use super::keep_rule::KeepRule;
use super::own_pairs::{are_clear, finds_overlap, irregular, own_pairs};
use super::scene::Scene;
use super::shells::{distinct, is_outward, shells, Shell};
use super::star::is_star_shaped;
use super::MIN_FACES_FOR_POOL;
use crate::arith::convert::as_double;
use crate::geometry::cell::Cell;
use crate::geometry::doubles::meeting::{meeting_of, Meeting};
use crate::geometry::doubles::{Facing, Point};
use crate::geometry::side::Orientation;
use crate::merge::expression::{Expression, Term};
use crate::merge::rule::Rule;
use crate::mesh::crossing_edges::crossing;
use crate::mesh::faces::Faces;
use crate::mesh::handle::Slot;
use crate::mesh::source::Source;
use crate::mesh::tasks::WorkSize;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, Node};
use crate::tree::solid::Solid;

/// The result of uniting a mesh with itself.
#[derive(Debug)]
pub enum United {
    /// The mesh itself: it does not overlap itself, and has no inner walls.
    Same,
    /// The root of another tree, because the mesh overlaps itself or has inner walls.
    Other(Branch),
    /// The connected components (shells) of the mesh, none of which overlaps itself; their union is still to
    /// be computed.
    Shells(Vec<Branch>),
}

/// Unites a mesh as it was imported with itself: the result bounds the points that `rule` calls inside.
/// `None` if the solid is not a mesh as it was imported, if too many of its faces overlap, or if faces are
/// too thin to count winding numbers at them.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::merge::arrangement::{united, United};
/// use bspcsg::merge::rule::Rule;
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// assert!(matches!(united(&solid, Rule::Positive), Some(United::Same)));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn united(solid: &Solid, rule: Rule) -> Option<United> {
    let operand = whole_mesh(solid)?;
    if is_star(&operand) {
        return Some(United::Same);
    }
    if own_pairs(&operand).is_some() {
        return arranged_alone(operand, solid.root().cell, rule);
    }
    simple_shells(&operand)
        .filter(|shells| shells.len() > 1 && rule != Rule::EvenOdd)
        .map(|shells| {
            let branches = shells.into_iter().map(|s| s.branch(operand.source));
            United::Shells(branches.collect())
        })
}

/// Returns whether a mesh as it was imported neither overlaps itself nor has inner walls; stops at the first
/// two faces that certainly overlap. `None` in the same cases as [`united`].
pub fn is_simple_mesh(solid: &Solid) -> Option<bool> {
    let operand = whole_mesh(solid)?;
    if is_star(&operand) {
        return Some(true);
    }
    if finds_overlap(&operand) {
        return Some(false);
    }
    let united = arranged_alone(operand, solid.root().cell, Rule::Positive)?;
    Some(matches!(united, United::Same))
}

/// Returns the mesh of a solid that is a mesh as it was imported; otherwise `None`.
fn whole_mesh(solid: &Solid) -> Option<Operand<'_>> {
    let root = solid.root();
    let is_plain = !root.complement && root.outside == 0;
    Operand::new(Slot(0), solid.whole_mesh().filter(|_| is_plain)?)
}

fn is_star(operand: &Operand) -> bool {
    operand.source.open_vertices().is_empty() && is_star_shaped(operand.mesh)
}

/// Unites a mesh with itself by comparing all its faces; `None` if too many may overlap, or if faces do not
/// determine the result.
fn arranged_alone(operand: Operand, cell: Cell, rule: Rule) -> Option<United> {
    let work_size = WorkSize::pool_if(operand.mesh.faces.len() >= MIN_FACES_FOR_POOL);
    let itself = Expression::new(vec![Term::Operand(0)]).ok()?;
    let mut scene = Scene {
        facets: Facets::of(vec![operand]),
        near: vec![Vec::new()],
        cell,
        kept: KeepRule::new(&itself, 1, rule),
        work_size,
    };
    let mut found = Contacts::default();
    scene.resolve(0, &mut found).ok()?;
    let root = scene.root(&found).ok()?;
    let is_same = is_all_of(&root, operand.source) && {
        let find = || passing_pairs(&scene.facets, &found);
        operand.source.passing_pairs().get_or_make(find).is_empty()
    };
    Some(if is_same {
        United::Same
    } else {
        United::Other(root)
    })
}

/// Returns the different shells of a mesh if each has its inside behind its faces and certainly does not
/// overlap itself.
fn simple_shells(operand: &Operand) -> Option<Vec<Shell>> {
    let is_simple =
        |shell: &Shell| is_outward(operand.mesh, &shell.faces) && are_clear(operand, &shell.faces);
    let is_regular = !irregular(operand.source).contains(&true);
    let shells = distinct(operand.mesh, shells(operand.mesh));
    (is_regular && shells.iter().all(is_simple)).then_some(shells)
}

/// Returns the pairs of faces at which walls of a mesh pass through one another, given the contacts of its faces,
/// which all bound the solid: this can be only in edges of six or more walls.
fn passing_pairs(facets: &Facets, found: &Contacts) -> Vec<[u32; 2]> {
    let pairs = found.meeting_pairs().into_iter();
    let pairs: Vec<[u32; 2]> = pairs.map(|pair| pair.map(|f| facets.face(f).0)).collect();
    crossing_pairs(facets.operands[0].mesh, &pairs)
}

/// Returns the pairs of faces, of the given ones, that cross on the lattice, or at whose common edge surfaces
/// cross.
fn crossing_pairs(mesh: &TriangleMesh, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    if pairs.is_empty() {
        return Vec::new();
    }
    // Lattice coordinates are exact in doubles.
    let places: Vec<Point> = mesh.vertices.iter().map(|p| p.map(as_double)).collect();
    let faces = Faces {
        vertices: &places,
        triangles: &mesh.faces,
    };
    let facing = |face: u32| Facing::of(&faces.corners(face));
    let met = |[t, u]: &[u32; 2]| ([*t, *u], meeting_of(&facing(*t), &facing(*u)));
    let (clear, doubtful): (Vec<_>, Vec<_>) = (pairs.iter().map(met))
        .filter(|(_, meeting)| *meeting != Meeting::Clear)
        .partition(|(_, meeting)| matches!(meeting, Meeting::Crossing | Meeting::Overlap));
    let mut found = crossing(&faces, doubtful);
    found.extend(clear.into_iter().map(|(pair, _)| pair));
    found.sort_unstable();
    found
}

/// Returns true if a leaf lists all faces of a mesh, whole and in their orientation, and nothing else.
fn is_all_of(root: &Branch, source: &Arc<Source>) -> bool {
    let Node::Deferred(leaf) = &*root.node else {
        return false;
    };
    let as_given = leaf
        .groups
        .iter()
        .filter(|g| g.orientation == Orientation::Same);
    let count: usize = as_given.map(|g| g.faces.len()).sum();
    leaf.parts.is_empty() && count == leaf.len() && count == source.face_count()
}
