//! Checks of meshes that tests share.

use std::collections::{HashMap, HashSet};

use bspcsg::extract::mesh::Mesh;
use bspcsg::extract::rounding::round;
use bspcsg::merge::SetOp;
use bspcsg::mesh::handle::VertexId;
use bspcsg::tree::solid::Solid;

use super::{applied, is_empty};

/// Returns the mesh, after checking that every directed edge has exactly one opposite, and that every vertex
/// is used and has one fan of triangles.
pub fn manifold_mesh(solid: &Solid, context: &str) -> Mesh {
    let mesh = round::mesh(solid).unwrap_or_else(|e| panic!("{context}: {e}"));
    let after = corners(&mesh, context);
    let closed = after.keys().all(|(a, b)| after.contains_key(&(*b, *a)));
    assert!(closed, "{context}: an edge has no opposite");
    let used: HashSet<VertexId> = mesh.triangles.iter().flatten().copied().collect();
    assert_eq!(
        used.len(),
        mesh.vertices.len(),
        "{context}: unused vertices"
    );
    assert_eq!(
        fans(&after),
        mesh.vertices.len(),
        "{context}: a vertex has several fans"
    );
    mesh
}

/// Maps each vertex and the end of an edge that leaves it to the end of the next edge around the vertex.
fn corners(mesh: &Mesh, context: &str) -> HashMap<(VertexId, VertexId), VertexId> {
    let mut after = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (v, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            let twice = after.insert((v, from), to);
            assert!(twice.is_none(), "{context}: edge {v} {from} is used twice");
        }
    }
    after
}

/// Counts the closed fans, given for each edge that leaves a vertex the next one around the vertex.
fn fans(after: &HashMap<(VertexId, VertexId), VertexId>) -> usize {
    let mut seen: HashSet<(VertexId, VertexId)> = HashSet::with_capacity(after.len());
    let mut count = 0;
    for &(vertex, start) in after.keys() {
        let mut spoke = start;
        count += usize::from(!seen.contains(&(vertex, start)));
        while seen.insert((vertex, spoke)) {
            spoke = after[&(vertex, spoke)];
        }
    }
    count
}

/// The triangles by the doubles of their corners, the smallest corner first, sorted.
fn triangle_set(mesh: &Mesh) -> Vec<[[u64; 3]; 3]> {
    let corner = |v: VertexId| mesh.vertices[v.index()].map(f64::to_bits);
    let mut set: Vec<_> = mesh
        .triangles
        .iter()
        .map(|t| {
            let mut t = t.map(corner);
            while t[0] > t[1] || t[0] > t[2] {
                t.rotate_left(1);
            }
            t
        })
        .collect();
    set.sort_unstable();
    set
}

/// Asserts that two solids are the same set.
pub fn assert_same_set(a: &Solid, b: &Solid) {
    assert!(is_empty(&applied(SetOp::SymmetricDifference, a, b)));
}

/// Asserts that two solids have the same triangles, whatever their order.
pub fn assert_same_triangles(a: &Solid, b: &Solid, context: &str) {
    let [a, b] = [a, b].map(|s| triangle_set(&manifold_mesh(s, context)));
    assert_eq!(a, b, "{context}");
}
