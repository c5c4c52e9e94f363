//! Tests whether a mesh overlaps itself, and unites it with itself, by comparing its own faces.

use std::sync::Arc;

use super::candidates::Operand;
use super::keep_rule::KeepRule;
use super::near::{Pairs, PreparedMesh};
use super::scene::Scene;
use super::segments::{contacts_among, Contacts};
use super::shells::{distinct, is_outward, shells, Shell};
use super::star::is_star_shaped;
use super::surfaces::Surfaces;
use super::MIN_FACES_FOR_POOL;
use crate::geometry::cell::Cell;
use crate::geometry::side::Orientation;
use crate::merge::rule::Rule;
use crate::mesh::handle::{FaceId, Slot};
use crate::mesh::source::Source;
use crate::mesh::tasks::WorkSize;
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
/// `None` if the solid is not a mesh as it was imported, if too many boxes of faces overlap, or if faces are
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
    let irregular = irregular(operand.source);
    let comparison = SelfComparison::new(operand, solid.root().cell, rule, &irregular)?;
    let shells = shells(operand.mesh);
    let count = shells.len();
    if count == 1 || rule == Rule::EvenOdd {
        return comparison.united(comparison.pairs());
    }
    let shells = distinct(operand.mesh, shells);
    let found = if shells.len() < count {
        Pairs::Overlap
    } else {
        comparison
            .prepared_mesh
            .pairs_unless_overlapping(&comparison.scene.near[0])
    };
    match found {
        few @ Pairs::Few(_) => comparison.united(few),
        Pairs::Many | Pairs::Overlap if comparison.are_simple(&shells) => {
            let branches = shells.into_iter().map(|s| s.branch(operand.source));
            Some(United::Shells(branches.collect()))
        }
        Pairs::Many | Pairs::Overlap => comparison.united(comparison.pairs()),
    }
}

/// Returns whether a mesh as it was imported neither overlaps itself nor has inner walls; stops at the first
/// two faces that certainly overlap. `None` in the same cases as [`united`].
pub fn is_simple_mesh(solid: &Solid) -> Option<bool> {
    let operand = whole_mesh(solid)?;
    if is_star(&operand) {
        return Some(true);
    }
    let irregular = irregular(operand.source);
    let comparison = SelfComparison::new(operand, solid.root().cell, Rule::Positive, &irregular)?;
    match comparison
        .prepared_mesh
        .pairs_unless_overlapping(&comparison.scene.near[0])
    {
        Pairs::Overlap => Some(false),
        found => Some(matches!(comparison.united(found)?, United::Same)),
    }
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

/// The data for comparing the faces of a mesh with each other.
struct SelfComparison<'a> {
    scene: Scene<'a>,
    prepared_mesh: PreparedMesh<'a>,
    irregular: &'a [bool],
}

impl<'a> SelfComparison<'a> {
    fn new(operand: Operand<'a>, cell: Cell, rule: Rule, irregular: &'a [bool]) -> Option<Self> {
        Some(Self {
            scene: Scene::of_one(operand, cell, rule),
            prepared_mesh: PreparedMesh::new(operand.source, irregular)?,
            irregular,
        })
    }

    fn pairs(&self) -> Pairs {
        self.prepared_mesh.pairs(&self.scene.near[0])
    }

    /// Unites the mesh with itself, given the pairs of its faces that may overlap; `None` if these are too
    /// many, or if faces do not determine the result.
    fn united(&self, pairs: Pairs) -> Option<United> {
        let found = self.contacts(pairs)?.with_touching_vertices(self.irregular);
        let root = self.scene.root(&found).ok()?;
        Some(
            if is_all_of(&root, self.scene.surfaces.operands[0].source) {
                United::Same
            } else {
                United::Other(root)
            },
        )
    }

    /// Intersects the given pairs of faces; `None` if there are too many pairs.
    fn contacts(&self, pairs: Pairs) -> Option<Contacts> {
        let Pairs::Few(pairs) = pairs else {
            return None;
        };
        let Scene {
            surfaces,
            work_size,
            ..
        } = &self.scene;
        Some(contacts_among(surfaces, &pairs, *work_size))
    }

    /// Returns true if each shell has its inside behind its faces and certainly does not overlap itself.
    fn are_simple(&self, shells: &[Shell]) -> bool {
        let mesh = self.scene.surfaces.operands[0].mesh;
        let is_closed = !self.irregular.contains(&true);
        let is_simple = |shell: &Shell| {
            is_outward(mesh, &shell.faces)
                && self
                    .contacts(self.prepared_mesh.pairs(&shell.faces))
                    .is_some_and(|found| found.divide_nothing())
        };
        is_closed && shells.iter().all(is_simple)
    }
}

impl<'a> Scene<'a> {
    /// Makes the scene for comparing all faces of one mesh with each other.
    fn of_one(operand: Operand<'a>, cell: Cell, rule: Rule) -> Self {
        let all: Vec<FaceId> = operand.mesh.face_ids().collect();
        Self {
            work_size: WorkSize::pool_if(all.len() >= MIN_FACES_FOR_POOL),
            surfaces: Surfaces::new(vec![operand], vec![all.clone()]),
            near: vec![all],
            cell,
            kept: KeepRule::Single(rule),
        }
    }
}

/// Returns for each vertex whether surfaces may cross there although no two faces cross: the vertex is
/// irregular, or the mesh is not closed there.
fn irregular(source: &Source) -> Vec<bool> {
    let count = source.mesh().map_or(0, |mesh| mesh.vertices.len());
    let mut irregular = vec![false; count];
    for vertex in source
        .irregular_vertices()
        .iter()
        .chain(source.open_vertices())
    {
        irregular[vertex.index()] = true;
    }
    irregular
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
