//! Simplifies a mesh in rounds of independent changes.

use rustc_hash::FxHashSet as HashSet;

use super::choice::{chosen, Chosen};
use super::drift::Drift;
use super::edit::{Act, Limits};
use super::proof::proved;
use super::shells::Shells;
use super::sizes::is_small;
use super::surface::Surface;
use crate::arith::convert::as_number;
use crate::extract::mesh::numbers_left;
use crate::geometry::doubles::Point;
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::each_chunk;

/// The largest number of rounds; changes that still wait then are not made. A vertex has six neighbours on
/// average, so that a change blocks some twenty others: of a million, less than one waits longer.
const MAX_ROUNDS: usize = 256;

/// The result of simplifying a mesh.
#[derive(Debug)]
pub struct Simplified {
    /// The vertices that are left, in their old order, at their old positions.
    pub vertices: Vec<Point>,
    /// The triangles that are left.
    pub triangles: Vec<[VertexId; 3]>,
    /// No point of the old or the new surface is farther than this from the other surface.
    pub bound: f64,
    /// Triangles that are still slivers or have a short edge, ascending.
    pub left: Vec<u32>,
    /// True if anything was changed.
    pub changed: bool,
}

/// Removes short edges and slivers from a mesh that is closed by index with one fan at each vertex.
///
/// # Example
/// ```
/// use bspcsg::extract::simplify::rounds::simplify;
/// use bspcsg::mesh::handle::VertexId;
///
/// // A tetrahedron, one of whose edges a vertex divides a hair beside its end.
/// let hair = [0.001, 0.0, 0.0];
/// let vertices = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], hair];
/// let faces = vec![[0, 2, 4], [4, 2, 1], [0, 4, 3], [4, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let simple = simplify(vertices, VertexId::rows(faces), 0.01);
/// assert_eq!(simple.triangles.len(), 4);
/// ```
pub fn simplify(vertices: Vec<Point>, triangles: Vec<[VertexId; 3]>, tolerance: f64) -> Simplified {
    let mut simplifying = Simplifying::new(vertices, triangles, tolerance);
    for _ in 0..MAX_ROUNDS {
        if !simplifying.round() {
            break;
        }
    }
    simplifying.finished()
}

/// The mesh between two rounds of changes.
struct Simplifying {
    vertices: Vec<Point>,
    triangles: Vec<[VertexId; 3]>,
    tolerance: f64,
    drift: Drift,
    shells: Shells,
    /// True for vertices whose surroundings changed in the last round, or at which a change waits.
    awake: Vec<bool>,
    /// Changes that were undone because they made surfaces cross.
    refused: HashSet<Act>,
    changed: bool,
}

impl Simplifying {
    fn new(vertices: Vec<Point>, triangles: Vec<[VertexId; 3]>, tolerance: f64) -> Self {
        Self {
            drift: Drift::new(&vertices),
            shells: Shells::of(&vertices, &triangles),
            awake: vec![true; vertices.len()],
            refused: HashSet::default(),
            changed: false,
            vertices,
            triangles,
            tolerance,
        }
    }

    /// Makes a maximal set of independent changes; returns false if none was possible.
    fn round(&mut self) -> bool {
        let surface = Surface::of(&self.vertices, &self.triangles);
        let awake = std::mem::replace(&mut self.awake, vec![false; self.vertices.len()]);
        let limits = Limits {
            surface: &surface,
            drift: &self.drift,
            tolerance: self.tolerance,
        };
        let wanted = surface.acts(&awake, self.tolerance);
        let Chosen { edits, waiting } = chosen(&limits, &wanted, |act| self.refused.contains(act));
        let tried = !edits.is_empty();
        let (kept, refused) = proved(&self.vertices, &mut self.triangles, edits, &self.shells);
        for act in &waiting {
            act.corners().for_each(|v| self.awake[v.index()] = true);
        }
        for edit in &kept {
            edit.corners().for_each(|v| self.awake[v.index()] = true);
            self.drift.follow(edit.target, edit.arrival, edit.bound);
        }
        self.changed |= !kept.is_empty();
        self.refused.extend(refused);
        self.triangles.retain(|t| t[0] != t[1]);
        tried
    }

    fn finished(self) -> Simplified {
        let tolerance = self.tolerance;
        let corners = |t: &[VertexId; 3]| t.map(|v| self.vertices[v.index()]);
        let is_left = |t: &[VertexId; 3]| is_small(&corners(t), tolerance);
        let numbered = |first: usize, triangles: &[[VertexId; 3]]| {
            let small = (as_number(first)..)
                .zip(triangles)
                .filter(|(_, t)| is_left(t));
            small.map(|(t, _)| t).collect::<Vec<u32>>()
        };
        let left = each_chunk(&self.triangles, numbered).concat();
        let (vertices, triangles) = without_unused(&self.vertices, &self.triangles);
        Simplified {
            bound: self.drift.bound(),
            vertices,
            triangles,
            left,
            changed: self.changed,
        }
    }
}

/// Returns a mesh without the vertices that no triangle uses.
fn without_unused(
    vertices: &[Point],
    triangles: &[[VertexId; 3]],
) -> (Vec<Point>, Vec<[VertexId; 3]>) {
    let mut used = vec![false; vertices.len()];
    for v in triangles.iter().flatten() {
        used[v.index()] = true;
    }
    let numbers = numbers_left(&used);
    let kept = vertices.iter().zip(used).filter(|(_, used)| *used);
    let kept = kept.map(|(place, _)| *place).collect();
    let renumbered = |t: &[VertexId; 3]| t.map(|v| numbers[v.index()]);
    (kept, triangles.iter().map(renumbered).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::rounding::crossings::all_faults;
    use crate::mesh::faces::{edges, Faces};

    /// A cube with edges of length 1 whose side z = 1 consists of the triangles `top`, with the vertices
    /// `more`.
    fn cube(more: &[Point], top: &[[u32; 3]]) -> (Vec<Point>, Vec<[VertexId; 3]>) {
        let corner = |k: u32| [k & 1, k >> 1 & 1, k >> 2].map(f64::from);
        let vertices = (0..8).map(corner).chain(more.iter().copied());
        let rest = [
            [0, 2, 1],
            [1, 2, 3],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        let triangles = rest.into_iter().chain(top.iter().copied());
        (vertices.collect(), VertexId::rows(triangles))
    }

    fn is_sound(mesh: &Simplified) -> bool {
        let mut edges: Vec<[VertexId; 2]> = mesh.triangles.iter().flat_map(|t| edges(*t)).collect();
        edges.sort_unstable();
        let is_single = edges.windows(2).all(|pair| pair[0] != pair[1]);
        let has_mate = |e: &[VertexId; 2]| edges.binary_search(&[e[1], e[0]]).is_ok();
        let faces = Faces {
            vertices: &mesh.vertices,
            triangles: &mesh.triangles,
        };
        is_single && edges.iter().all(has_mate) && all_faults(&faces).is_empty()
    }

    #[test]
    fn a_short_edge_goes_and_the_corner_stays() {
        let fan = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]];
        let (vertices, triangles) = cube(&[[0.003, 0.004, 1.0]], &fan);
        let made = simplify(vertices.clone(), triangles, 0.01);
        // Of the two ends, the one inside a face is removed, which changes no volume.
        assert_eq!(made.vertices, vertices[..8]);
        assert!(made.bound >= 0.005 && made.bound < 0.005_000_001);
        assert!(made.triangles.len() == 12 && made.left.is_empty() && is_sound(&made));
    }

    #[test]
    fn the_long_edge_of_a_cap_is_flipped() {
        let fan = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]];
        let (vertices, triangles) = cube(&[[0.5, 0.001, 1.0]], &fan);
        let made = simplify(vertices.clone(), triangles, 0.01);
        assert_eq!(made.vertices, vertices);
        assert!(made.bound >= 0.001 && made.bound < 0.001_000_001);
        assert!(made.triangles.len() == 14 && made.left.is_empty() && is_sound(&made));
    }

    #[test]
    fn large_triangles_of_one_plane_stay() {
        let fan = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]];
        let (vertices, triangles) = cube(&[[0.5, 0.5, 1.0]], &fan);
        let made = simplify(vertices, triangles.clone(), 0.01);
        assert!(!made.changed && made.bound == 0.0);
        assert_eq!(made.triangles, triangles);
    }

    #[test]
    fn nothing_vanishes_or_turns_inside_out() {
        let (vertices, triangles) = cube(&[], &[[4, 5, 6], [5, 7, 6]]);
        for turned in [false, true] {
            let facing = |t: &[VertexId; 3]| if turned { [t[0], t[2], t[1]] } else { *t };
            let triangles: Vec<[VertexId; 3]> = triangles.iter().map(facing).collect();
            let before = Shells::of(&vertices, &triangles);
            let made = simplify(vertices.clone(), triangles, 100.0);
            assert!(made.triangles.len() >= 4 && made.bound <= 100.0 && is_sound(&made));
            assert_eq!(before.turned(&made.vertices, &made.triangles), [false]);
        }
    }
}
