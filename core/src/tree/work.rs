//! The work of an operation: how much it may have to examine.

use super::node::{Branch, Node};
use super::solid::Solid;
use crate::geometry::plane::Lattice;
use crate::mesh::handle::Slot;
use crate::mesh::triangles::TriangleMesh;

/// Cuts and elements that an operation on solids may have to examine, counted up to a limit.
///
/// Of two operands, only what is near the other counts.
pub fn work(solids: &[Solid], limit: usize) -> usize {
    let mut sum = 0;
    for (k, solid) in solids.iter().enumerate() {
        let other = match solids.len() {
            2 => Some(extent(&solids[1 - k], limit)),
            _ => None,
        };
        sum += count(solid.root(), other.as_ref(), limit - sum);
        if sum >= limit {
            break;
        }
    }
    sum
}

/// The number of faces to examine to find whether a solid is reduced, if few meshes decide it.
pub fn work_to_settle(solid: &Solid) -> usize {
    let open = solid.doubts().filter(|_| !solid.is_reduced());
    let faces = |mesh: &Solid| mesh.sources().iter().map(|s| s.face_count()).sum::<usize>();
    open.map_or(0, |doubts| doubts.iter().map(faces).sum())
}

/// A box around a solid's boundary: of a small mesh its own, else the root's cell.
fn extent(solid: &Solid, limit: usize) -> (Lattice, Lattice) {
    let cell = solid.root().cell;
    let only = (solid.sources().len() == 1).then(|| solid.sources().get(Slot(0)));
    let mesh = only.and_then(|source| source.mesh());
    mesh.filter(|m| m.faces.len() < limit)
        .and_then(TriangleMesh::bounds)
        .unwrap_or((*cell.low(), cell.high()))
}

fn count(root: &Branch, near: Option<&(Lattice, Lattice)>, limit: usize) -> usize {
    let mut sum = 0;
    let mut open = vec![root];
    while let (Some(branch), true) = (open.pop(), sum < limit) {
        if near.is_some_and(|(low, high)| !branch.cell.meets_box(low, high)) {
            continue;
        }
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(leaf) => sum += leaf.len(),
            Node::Cut(halves) => {
                sum += 1;
                open.extend(&halves.children);
            }
        }
    }
    sum.min(limit)
}
