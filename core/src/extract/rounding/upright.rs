//! Decides whether all faces of a mesh are perpendicular to axes, so that rounding cannot make them cross.
//!
//! If rounding keeps the order of different coordinates on each axis, it is a map of space that stretches
//! and shrinks along the axes. The map takes walls to walls, and surfaces that do not cross to surfaces that
//! do not cross: each part of a plane ends at edges along axes, and the map takes these to the edges of the
//! image. Inside such a part triangles overlap only if one is turned over.

#![allow(
    clippy::float_cmp,
    reason = "equal coordinates are meant to the last bit"
)]

use crate::arith::Sign;
use crate::extract::mesh::{outward_normal, Corner, ExactMesh};
use crate::geometry::doubles::{seen_along, turn, Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::faces::Faces;
use crate::mesh::grid::Pitch;

/// Two different coordinates of at most this many lattice steps have different nearest doubles: one step is
/// at least two spacings of doubles there.
const MAX_DISTINCT_STEPS: u64 = 1 << 51;

/// Returns true only if the triangles of a rounded mesh cross no more than on the lattice: all are
/// perpendicular to axes, each vertex is at the doubles nearest to its lattice point, and no triangle is
/// turned over. May return false negatives.
pub fn keeps_order(faces: &Faces, exact: &ExactMesh, sources: &Sources, pitch: Pitch) -> bool {
    let mut triangles = (0..).zip(&exact.faces);
    let mut vertices = exact.vertices.iter().zip(faces.vertices);
    triangles.all(|(t, face)| {
        poll();
        stands_upright(&faces.corners(t), &outward_normal(*face, sources))
    }) && vertices.all(|(corner, place)| {
        poll();
        let lattice = lattice_of(*corner, exact, sources);
        lattice.is_some_and(|p| is_at(place, &p, pitch))
    })
}

/// Returns true if a triangle is perpendicular to an axis and its normal has the direction of `normal`.
fn stands_upright(corners: &Triangle, normal: &[i128; 3]) -> bool {
    let [a, b, c] = corners;
    let axis = (0..3).find(|i| a[*i] == b[*i] && b[*i] == c[*i]);
    axis.is_some_and(|axis| {
        let facing = Sign::of(normal[axis]);
        facing != Sign::Zero && turn(seen_along(corners, axis)) == facing
    })
}

/// Returns true if a point is at the doubles nearest to a lattice point, and to no other lattice point.
fn is_at(place: &Point, p: &Lattice, pitch: Pitch) -> bool {
    p.iter().all(|k| k.unsigned_abs() <= MAX_DISTINCT_STEPS)
        && p.map(|k| pitch.coordinate(k)) == *place
}

/// Returns the lattice point of a vertex; `None` if the vertex is not known to be a lattice point.
fn lattice_of(corner: Corner, exact: &ExactMesh, sources: &Sources) -> Option<Lattice> {
    match corner {
        Corner::Point(point) => exact.table.point(point).as_lattice().copied(),
        Corner::Source(slot, vertex) => {
            let mesh = sources.get(slot).mesh()?;
            Some(mesh.vertices[vertex.index()])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::assemble::assemble;
    use crate::extract::rounding::crossings::all_faults;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, tetrahedra};
    use crate::tree::solid::Solid;

    /// Returns whether `keeps_order` is true for the mesh of a solid after `put` has moved vertices.
    fn keeps(solid: &Solid, put: impl FnOnce(&mut [Point])) -> bool {
        let exact = assemble(solid).expect("bounded");
        let sources = Sources::new(solid.sources().clone());
        let at = |corner: &Corner| lattice_of(*corner, &exact, &sources).unwrap_or_default();
        let doubles = |p: Lattice| p.map(|k| solid.pitch().coordinate(k));
        let mut vertices: Vec<Point> = exact.vertices.iter().map(at).map(doubles).collect();
        put(&mut vertices);
        let faces = Faces {
            vertices: &vertices,
            triangles: &exact.triangles,
        };
        let keeps = keeps_order(&faces, &exact, &sources, solid.pitch());
        assert!(!keeps || all_faults(&faces).is_empty());
        keeps
    }

    #[test]
    fn boxes_keep_their_order() {
        // Walls one step apart.
        let boxes = [
            cuboid([100_000_001; 3], [300_000_000, 700_000_000, 900_000_000]),
            cuboid([200_000_000; 3], [300_000_001, 900_000_000, 800_000_000]),
        ];
        for op in [Term::Or, Term::And] {
            assert!(keeps(&made_of(&boxes, op), |_| {}));
        }
    }

    #[test]
    fn what_is_elsewhere_or_slanted_may_cross() {
        let boxes = made_of(&[cuboid([0; 3], [4; 3]), cuboid([2; 3], [6; 3])], Term::Or);
        let next = |x: f64| x.next_up();
        assert!(!keeps(&boxes, |places| places[0] = places[0].map(next)));
        // All vertices of a wall, so that it stays upright.
        assert!(!keeps(&boxes, |places| {
            for place in places.iter_mut().filter(|p| p[0] == 0.0) {
                place[0] = next(0.0);
            }
        }));
        assert!(!keeps(&made_of(&tetrahedra(), Term::Or), |_| {}));
    }

    #[test]
    fn a_triangle_that_faces_elsewhere_does_not_stand_upright() {
        let corners = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
        assert!(stands_upright(&corners, &[0, 0, 1]));
        assert!(!stands_upright(&corners, &[0, 0, -1]));
        assert!(!stands_upright(&corners, &[0, 1, 0]));
        let line = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [2.0, 0.0, 1.0]];
        assert!(!stands_upright(&line, &[0, 0, 1]));
    }

    #[test]
    fn places_beyond_all_distinct_ones_are_not_told_apart() {
        let pitch = Pitch::DEFAULT;
        let at = |k: i64| is_at(&[pitch.coordinate(k); 3], &[k; 3], pitch);
        assert!(at(1 << 51) && !at((1 << 51) + 1));
        assert!(!is_at(&[1e-9, 0.0, 0.0], &[2, 0, 0], pitch));
    }
}
