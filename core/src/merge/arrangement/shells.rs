//! Divides a mesh into its shells: its connected components.

use std::sync::Arc;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use crate::arith::{Int, Sign};
use crate::geometry::cell::Cell;
use crate::geometry::flux::fixed::sixfold_flux;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node};

/// The ascending numbers of faces that are connected by common vertices.
#[derive(Debug, Default)]
pub(super) struct Shell {
    pub(super) faces: Vec<FaceId>,
}

impl Shell {
    /// Returns the shell as a branch with one deferred leaf.
    pub(super) fn branch(self, source: &Arc<Source>) -> Branch {
        let around = source.box_around(&self.faces);
        let cell = around.map_or(Cell::UNIVERSE, |(low, high)| Cell::around(&low, &high));
        let group = FaceGroup {
            touching: false,
            source: Arc::clone(source),
            orientation: Orientation::Same,
            faces: self.faces,
        };
        let leaf = DeferredLeaf {
            groups: vec![group],
            ..DeferredLeaf::default()
        };
        Branch::of_node(cell, Node::Deferred(leaf))
    }
}

/// Returns the connected components of a mesh, in the order of their first faces.
pub(super) fn shells(mesh: &TriangleMesh) -> Vec<Shell> {
    let mut parents: Vec<usize> = (0..mesh.vertices.len()).collect();
    for face in mesh.face_ids() {
        poll();
        let [a, b, c] = mesh
            .vertices_of(face)
            .map(|v| root(&mut parents, v.index()));
        let first = a.min(b).min(c);
        for other in [a, b, c] {
            parents[other] = first;
        }
    }
    let mut numbers: HashMap<usize, usize> = HashMap::default();
    let mut shells: Vec<Shell> = Vec::new();
    for face in mesh.face_ids() {
        let root = root(&mut parents, mesh.vertices_of(face)[0].index());
        let number = *numbers.entry(root).or_insert_with(|| {
            shells.push(Shell::default());
            shells.len() - 1
        });
        shells[number].faces.push(face);
    }
    shells
}

/// Returns the shells without those that have the same triangles in the same order as an earlier shell.
pub(super) fn distinct(mesh: &TriangleMesh, shells: Vec<Shell>) -> Vec<Shell> {
    let mut seen: HashSet<Vec<[Lattice; 3]>> = HashSet::default();
    let mut is_first = |shell: &Shell| {
        poll();
        seen.insert(shell.faces.iter().map(|f| mesh.corners(*f)).collect())
    };
    shells.into_iter().filter(|s| is_first(s)).collect()
}

/// Returns the root of an element in a forest of disjoint sets, and halves the path to it.
fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}

/// Returns true if the signed volume that the faces enclose is positive.
pub(super) fn is_outward(mesh: &TriangleMesh, faces: &[FaceId]) -> bool {
    let mut volume = Int::<4>::ZERO;
    for face in faces {
        volume += sixfold_flux(&mesh.corners(*face));
    }
    volume.sign() == Sign::Positive
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;
    use crate::mesh::handle::Slot;

    #[test]
    fn shells_hang_together_and_copies_go() {
        let boxes = [[[0; 3], [4; 3]], [[2; 3], [9; 3]], [[0; 3], [4; 3]]];
        let solid = cuboids(boxes);
        let source = solid.sources().get(Slot(0));
        let mesh = source.mesh().expect("a mesh");
        let shells = shells(mesh);
        assert!(shells.len() == 3 && shells.iter().all(|s| is_outward(mesh, &s.faces)));
        let firsts: Vec<u32> = distinct(mesh, shells)
            .iter()
            .map(|s| s.faces[0].0)
            .collect();
        assert_eq!(firsts, [0, 12]);
    }
}
