//! Shells, the connected parts of a surface, which neither turn inside out nor pass through each other.
//!
//! Shells that do not cross before and after a round may still have passed through one another. Only a whole
//! shell can, if it lies in the volume that a change sweeps.

use super::edit::Edit;
use crate::arith::{Filtered, Sign};
use crate::geometry::doubles::vector::{difference, dot, normal};
use crate::geometry::doubles::{side, Point};
use crate::geometry::side::Side;
use crate::interrupt::{poll, spend};
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::VertexId;

/// The shell number of a vertex without triangles.
const NONE: u32 = u32::MAX;

/// The connected parts (shells) of a surface.
pub struct Shells {
    /// The shell number of each vertex.
    numbers: Vec<u32>,
    /// For each shell the sign of its volume, negative for a cavity, or doubtful.
    sides: Vec<Filtered<Sign>>,
}

impl Shells {
    /// Finds the connected parts of a mesh.
    pub fn of(vertices: &[Point], triangles: &[[VertexId; 3]]) -> Self {
        let numbers = connected(vertices.len(), triangles);
        let mut shells = Self {
            sides: Vec::new(),
            numbers,
        };
        shells.sides = shells.sides_of(vertices, triangles);
        shells
    }

    /// Returns whether the shell of a change may be changed: it is certain on which side its inside is.
    pub fn is_certain(&self, edit: &Edit) -> bool {
        self.sides[self.of_edit(edit)].is_certain()
    }

    /// Returns for each shell whether the sign of its volume has changed.
    pub fn turned(&self, vertices: &[Point], triangles: &[[VertexId; 3]]) -> Vec<bool> {
        let now = self.sides_of(vertices, triangles);
        now.iter().zip(&self.sides).map(|(a, b)| a != b).collect()
    }

    /// Returns the number of the shell that a change belongs to.
    pub fn of_edit(&self, edit: &Edit) -> usize {
        self.numbers[edit.target.index()] as usize
    }

    /// Returns for each change whether another shell may lie in the volume that the change sweeps.
    pub fn are_swept(
        &self,
        vertices: &[Point],
        triangles: &[[VertexId; 3]],
        edits: &[Edit],
    ) -> Vec<bool> {
        if self.sides.len() < 2 {
            return vec![false; edits.len()];
        }
        let shell_points = self.shell_points(vertices, triangles, edits);
        let is_swept = |edit: &Edit| {
            let own = self.of_edit(edit);
            edit.bodies().iter().any(|body| {
                poll();
                let body = body.map(|v| &vertices[v.index()]);
                let others = shell_points.beside(&body).iter().filter(|r| r.0 != own);
                others.into_iter().any(|(_, p)| may_hold(&body, p))
            })
        };
        edits.iter().map(is_swept).collect()
    }

    /// Finds for each shell a vertex that no change of this round removes.
    fn shell_points(
        &self,
        vertices: &[Point],
        triangles: &[[VertexId; 3]],
        edits: &[Edit],
    ) -> ShellPoints {
        let mut goes = vec![false; vertices.len()];
        for v in edits.iter().filter_map(Edit::going) {
            goes[v.index()] = true;
        }
        let mut found: Vec<Option<Point>> = vec![None; self.sides.len()];
        for &v in triangles.as_flattened().iter().filter(|v| !goes[v.index()]) {
            found[self.numbers[v.index()] as usize].get_or_insert(vertices[v.index()]);
        }
        let numbered = (0..).zip(found);
        let mut points: Vec<(usize, Point)> = numbered.filter_map(|(k, p)| Some((k, p?))).collect();
        points.sort_by(|p, q| p.1[0].total_cmp(&q.1[0]));
        ShellPoints { points }
    }

    /// Computes the sign of each shell's volume.
    fn sides_of(&self, vertices: &[Point], triangles: &[[VertexId; 3]]) -> Vec<Filtered<Sign>> {
        spend(triangles.len());
        let used = self.numbers.iter().filter(|n| **n != NONE);
        let count = used.max().map_or(0, |m| *m as usize + 1);
        let mut sums = vec![ShellVolume::default(); count];
        for t in triangles.iter().filter(|t| t[0] != t[1]) {
            let corners = t.map(|v| vertices[v.index()]);
            sums[self.numbers[t[0].index()] as usize].add(&corners);
        }
        sums.iter().map(ShellVolume::sign).collect()
    }
}

/// The sum of six times the volume of a shell, with a bound on its error.
#[derive(Clone, Default)]
struct ShellVolume {
    origin: Option<Point>,
    volume: f64,
    size: f64,
    count: f64,
}

/// The rounding errors of a difference, a minor, a product and a sum, in units of the last place, with a
/// margin.
const VOLUME_ROUNDINGS: f64 = 16.0;

impl ShellVolume {
    fn add(&mut self, corners: &[Point; 3]) {
        let origin = *self.origin.get_or_insert(corners[0]);
        let [a, b, c] = corners;
        let arm = difference(a, &origin);
        self.volume += dot(&arm, &normal(corners));
        let lengths = [arm, difference(b, a), difference(c, a)].map(|e| dot(&e, &e).sqrt());
        self.size += lengths.iter().product::<f64>();
        self.count += 1.0;
    }

    fn sign(&self) -> Filtered<Sign> {
        let error = (VOLUME_ROUNDINGS + self.count) * f64::EPSILON * self.size;
        Filtered::when(self.volume.abs() > error, Sign::of(self.volume))
    }
}

/// A vertex of each shell, sorted by x.
struct ShellPoints {
    points: Vec<(usize, Point)>,
}

impl ShellPoints {
    /// Returns the shell points between the least and the largest x of a tetrahedron.
    fn beside(&self, body: &[&Point; 4]) -> &[(usize, Point)] {
        let of_all = |pick: fn(f64, f64) -> f64| body.iter().map(|p| p[0]).reduce(pick);
        let (low, high) = (
            of_all(f64::min).unwrap_or(0.0),
            of_all(f64::max).unwrap_or(0.0),
        );
        let start = self.points.partition_point(|p| p.1[0] < low);
        let count = self.points[start..].partition_point(|p| p.1[0] <= high);
        &self.points[start..start + count]
    }
}

/// Returns false only if a face of a tetrahedron, which may be flat, certainly separates it from a point.
fn may_hold(body: &[&Point; 4], point: &Point) -> bool {
    let separates = |apex: usize| {
        let face = [1, 2, 3].map(|i| *body[(apex + i) % 4]);
        let of_point = side(&face, point);
        of_point != Side::On && of_point != side(&face, body[apex])
    };
    !(0..4).any(separates)
}

/// Returns for each vertex the number of its connected part; the parts are numbered by their first triangle.
fn connected(count: usize, triangles: &[[VertexId; 3]]) -> Vec<u32> {
    let mut sets = DisjointSets::of_triangles(count, triangles);
    let mut numbers = vec![NONE; count];
    let mut next = 0;
    for v in triangles.as_flattened() {
        let root = sets.least(v.0) as usize;
        if numbers[root] == NONE {
            numbers[root] = next;
            next += 1;
        }
        numbers[v.index()] = numbers[root];
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tetrahedra_hold_what_no_face_separates() {
        let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for body in [[&o, &x, &y, &z], [&x, &o, &y, &z]] {
            assert!(may_hold(&body, &[0.1, 0.1, 0.1]));
            assert!(may_hold(&body, &[0.0, 0.5, 0.5]));
            assert!(!may_hold(&body, &[0.4, 0.4, 0.4]));
            assert!(!may_hold(&body, &[0.1, 0.1, -1e-300]));
        }
        let flat = [&o, &x, &y, &[0.5, 0.5, 0.0]];
        assert!(may_hold(&flat, &[0.1, 0.1, 0.0]));
        assert!(!may_hold(&flat, &[0.1, 0.1, 1e-300]));
    }

    #[test]
    fn parts_are_numbered_in_order() {
        let triangles = VertexId::rows([[5, 1, 2], [0, 3, 4], [2, 1, 6]]);
        assert_eq!(connected(7, &triangles), [1, 0, 0, 1, 1, 0, 0]);
    }
}
