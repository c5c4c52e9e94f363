//! Corrects triangles that rounding to doubles turned over, by swapping edges.
//!
//! A constructed vertex moves by half a unit in its last place at most. A triangle narrower than that may
//! turn over; with the other diagonal between it and a neighbour in its plane, both mostly face the right
//! way.

use rustc_hash::FxHashMap as HashMap;

use crate::arith::convert::as_index;
use crate::arith::Sign;
use crate::extract::mesh::{outward_normal, Corner, ExactMesh, Mesh};
use crate::geometry::doubles::{seen_along, turn};
use crate::geometry::plane::Plane;
use crate::geometry::side::Orientation;
use crate::merge::lists::list::Sources;
use crate::mesh::faces::edges;
use crate::mesh::handle::VertexId;

/// The largest number of swaps per triangle found turned over; each swap lowers the number of such
/// triangles.
const MAX_SWAPS_PER_TRIANGLE: usize = 8;

/// The triangles that edge swaps changed, and those that they could not correct.
#[derive(Debug, Default)]
pub struct Unfolded {
    /// The triangles that were made by swapping an edge, ascending.
    pub repaired: Vec<u64>,
    /// Triangles that still have no area or face opposite to their planes.
    pub left: Vec<u64>,
}

/// Swaps edges between triangles of one plane until no swap corrects a triangle that faces the wrong way.
///
/// # Order
/// Triangles by their numbers, and in each triangle the edges from its first corner on.
pub fn unfold(mesh: &mut Mesh, exact: &ExactMesh, sources: &Sources) -> Unfolded {
    let turned = turned(mesh, exact, sources);
    if turned.is_empty() {
        return Unfolded::default();
    }
    let mut surface = Surface::new(mesh, Planes { exact, sources });
    let mut tries = MAX_SWAPS_PER_TRIANGLE * turned.len();
    let mut found = Unfolded::default();
    let mut open: Vec<usize> = turned.iter().rev().map(|t| as_index(*t)).collect();
    while let Some(t) = open.pop() {
        if tries == 0 || !surface.is_turned(t) {
            continue;
        }
        tries -= 1;
        if let Some(pair) = (3 * t..3 * t + 3).find_map(|half| surface.swap(half)) {
            found.repaired.extend(pair.map(|t| t as u64));
            open.extend(pair);
        } else {
            found.left.push(t as u64);
        }
    }
    found.repaired.sort_unstable();
    found.repaired.dedup();
    found.left.retain(|&t| surface.is_turned(as_index(t)));
    found
}

/// Returns, in ascending order, the triangles with a constructed corner that rounding has flattened or turned
/// over.
pub fn turned(mesh: &Mesh, exact: &ExactMesh, sources: &Sources) -> Vec<u64> {
    let planes = Planes { exact, sources };
    let is_given = |v: &VertexId| matches!(exact.vertices.get(v.index()), Some(Corner::Source(..)));
    let is_left = |t: &[VertexId; 3]| t[0] != t[1];
    let late = mesh.triangles.iter().enumerate().skip(exact.untouched);
    late.filter(|(_, t)| is_left(t) && !t.iter().all(is_given))
        .filter(|(t, _)| planes.is_turned(mesh, *t))
        .map(|(t, _)| t as u64)
        .collect()
}

/// The exact plane of each triangle, oriented as the triangle should face.
struct Planes<'a> {
    exact: &'a ExactMesh,
    sources: &'a Sources,
}

impl Planes<'_> {
    fn of(&self, triangle: usize) -> Plane {
        let face = self.exact.faces[triangle];
        let plane = self.sources.get(face.slot()).plane(face.id());
        match face.orientation {
            Orientation::Same => (*plane).clone(),
            Orientation::Opposite => plane.flipped(),
        }
    }

    fn is_turned(&self, mesh: &Mesh, triangle: usize) -> bool {
        let normal = outward_normal(self.exact.faces[triangle], self.sources);
        is_turned(mesh, &mesh.triangles[triangle], &normal)
    }
}

/// Returns true if a rounded triangle, projected along the main axis of its plane's normal, does not turn
/// left.
fn is_turned(mesh: &Mesh, corners: &[VertexId; 3], normal: &[i128; 3]) -> bool {
    let axis = (0..3).rev().max_by_key(|i| normal[*i].unsigned_abs());
    let axis = axis.unwrap_or(0);
    let corners = corners.map(|c| mesh.vertices[c.index()]);
    let facing = Sign::of(normal[axis]);
    turn(seen_along(&corners, axis)) != facing
}

/// A mesh whose edges can be swapped; half-edge 3t + i runs from corner i of triangle t.
struct Surface<'a> {
    mesh: &'a mut Mesh,
    planes: Planes<'a>,
    halves: HashMap<[VertexId; 2], usize>,
}

impl<'a> Surface<'a> {
    fn new(mesh: &'a mut Mesh, planes: Planes<'a>) -> Self {
        let ends = |(t, c): (usize, &[VertexId; 3])| edges(*c).into_iter().zip(3 * t..);
        let halves = mesh.triangles.iter().enumerate().flat_map(ends).collect();
        Self {
            mesh,
            planes,
            halves,
        }
    }

    fn is_turned(&self, triangle: usize) -> bool {
        self.planes.is_turned(self.mesh, triangle)
    }

    /// Replaces an edge by the other diagonal of its two triangles, if that leaves fewer of them turned
    /// over; returns the two triangles.
    fn swap(&mut self, half: usize) -> Option<[usize; 2]> {
        let corner = |h: usize| self.mesh.triangles[h / 3][h % 3];
        let next = |h: usize| h - h % 3 + (h % 3 + 1) % 3;
        let (a, b, c) = (corner(half), corner(next(half)), corner(next(next(half))));
        let mate = *self.halves.get(&[b, a])?;
        let d = corner(next(next(mate)));
        let pair = [half / 3, mate / 3];
        let plane = self.planes.of(pair[0]);
        let taken = [[c, d], [d, c]].iter().any(|e| self.halves.contains_key(e));
        if c == d || taken || plane != self.planes.of(pair[1]) {
            return None;
        }
        let made = [[a, d, c], [d, b, c]];
        let before = pair.iter().filter(|t| self.is_turned(**t)).count();
        let after = made
            .iter()
            .filter(|t| is_turned(self.mesh, t, plane.normal()))
            .count();
        (after < before).then(|| self.replace(pair, made))
    }

    fn replace(&mut self, pair: [usize; 2], made: [[VertexId; 3]; 2]) -> [usize; 2] {
        for t in pair {
            for edge in edges(self.mesh.triangles[t]) {
                self.halves.remove(&edge);
            }
        }
        for (t, corners) in pair.into_iter().zip(made) {
            self.halves.extend(edges(corners).into_iter().zip(3 * t..));
            self.mesh.triangles[t] = corners;
        }
        pair
    }
}
