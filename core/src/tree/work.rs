//! Estimates of how much an operation on solids may have to examine.

use super::node::{Branch, Node};
use super::solid::Solid;
use crate::geometry::plane::Lattice;
use crate::mesh::handle::Slot;
use crate::mesh::triangles::TriangleMesh;

/// The number of cuts, faces and parts that an operation on solids may have to examine, counted up to
/// `limit`.
///
/// For two operands, only branches whose cells meet the box around the other operand count.
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

/// The number of faces to examine to find out whether a solid is reduced; 0 if that is known, or if no known
/// meshes decide it.
pub fn work_to_settle(solid: &Solid) -> usize {
    let open = solid.unchecked_meshes().filter(|_| !solid.is_reduced());
    let faces = |mesh: &Solid| mesh.sources().iter().map(|s| s.face_count()).sum::<usize>();
    open.map_or(0, |unchecked_meshes| {
        unchecked_meshes.iter().map(faces).sum()
    })
}

/// A lattice box around a solid's boundary: the box of its mesh if it has only one with fewer than `limit`
/// faces, else the root's cell.
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
