//! Convex hulls of points, decided for their nearest lattice points.

use std::collections::hash_map::Entry;

use rustc_hash::FxHashMap as HashMap;

use super::faces::edges;
use super::grid::Pitch;
use super::handle::VertexId;
use super::snap::snap_all;
use crate::arith::convert::as_double;
use crate::error::Result;
use crate::geometry::doubles::hull::{corners_of, hull, hull_of_inexact};
use crate::geometry::doubles::vector::{cross, dot, normal};
use crate::geometry::doubles::{Facing, Point, Triangle};
use crate::geometry::side::Side;

/// The triangle mesh of a convex hull.
#[derive(Clone, Debug)]
pub struct Hull {
    /// The corners of the hull, in model units.
    pub vertices: Vec<Point>,
    /// The triangles of the hull, counterclockwise from outside, as indices of the corners.
    pub triangles: Vec<[VertexId; 3]>,
    /// True if the faces are still a convex hull, and so do not cross, after the corners are snapped to the
    /// lattice.
    pub is_convex_there: bool,
}

/// The sine of the angle by which adjoining faces may fold inwards. Rounding was never seen to fold an
/// ordinary face inwards; below this angle, it leaves no point outside a face by more than this fraction of
/// the hull's size.
const MAX_FOLD_SINE: f64 = 1e-7;

/// The convex hull of points, exact for the lattice points nearest to them; empty if they lie in one plane up
/// to rounding.
///
/// Rounding moves each point by at most a known distance, so a point is no corner if it lies within twice
/// this distance of the hull of the other points. If a face of the hull would face inwards with the given
/// coordinates, the corners are the lattice points instead. If a face still faces inwards, as on a lattice no
/// coarser than the doubles, the result is the exact hull of the corners as given.
///
/// # Errors
/// As [`Pitch::snap`].
///
/// # Example
/// ```
/// use bspcsg::mesh::grid::Pitch;
/// use bspcsg::mesh::hulls::hull_of;
///
/// let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// // A third of the way along an edge, as near as doubles come.
/// let points = [&corners[..], &[[0.0, 2.0 / 3.0, 1.0 / 3.0]]].concat();
/// assert_eq!(hull_of(&points, Pitch::DEFAULT)?.vertices, corners);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn hull_of(points: &[Point], pitch: Pitch) -> Result<Hull> {
    let lattice = snap_all(points, pitch)?;
    // Below 2^53 in magnitude: exact in doubles.
    let steps: Vec<Point> = lattice.iter().map(|p| p.map(as_double)).collect();
    let radius = moved_by(points, &steps, pitch);
    let faces = hull_of_inexact(&steps, radius);
    let used = corners_of(&faces);
    let triangles = numbered(&faces, &used);
    let given: Vec<Point> = used.iter().map(|p| points[*p]).collect();
    let on_lattice = used
        .iter()
        .map(|p| lattice[*p].map(|k| pitch.coordinate(k)));
    let vertices = if looks_outwards(&given, &triangles) {
        given
    } else {
        let others: Vec<Point> = on_lattice.collect();
        if !looks_outwards(&others, &triangles) {
            return Ok(hull_as_given(&given));
        }
        others
    };
    Ok(Hull {
        vertices,
        triangles,
        is_convex_there: true,
    })
}

/// The exact convex hull of points as given, in doubles.
fn hull_as_given(points: &[Point]) -> Hull {
    let faces = hull(points);
    let used = corners_of(&faces);
    Hull {
        vertices: used.iter().map(|p| points[*p]).collect(),
        triangles: numbered(&faces, &used),
        is_convex_there: false,
    }
}

/// The largest distance, in steps, by which rounding may have moved a point: by snapping and, unless all
/// points are on the lattice, when its coordinates were computed.
fn moved_by(points: &[Point], steps: &[Point], pitch: Pitch) -> f64 {
    let squares = points.iter().zip(steps).map(|(point, place)| {
        let off = |i: usize| pitch.steps_from(point[i], place[i]);
        off(0).powi(2) + off(1).powi(2) + off(2).powi(2)
    });
    let moved = squares.fold(0.0, f64::max).sqrt();
    let largest = steps
        .as_flattened()
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    if moved > 0.0 {
        moved + TURNED_POINT_ROUNDING * f64::EPSILON * largest
    } else {
        0.0
    }
}

/// The rounding error of a point that a matrix has rotated, in spacings of doubles at the largest coordinate:
/// one half for each of three products and three sums, along two axes or all three.
const TURNED_POINT_ROUNDING: f64 = 4.0;

/// Faces with their corners as indices into the ascending list of used points.
fn numbered(faces: &[[usize; 3]], used: &[usize]) -> Vec<[VertexId; 3]> {
    let place = |p: usize| used.partition_point(|q| *q < p);
    faces
        .iter()
        .map(|face| face.map(|p| VertexId::of(place(p))))
        .collect()
}

/// Return whether all triangles of a nearly convex mesh face away from its middle, and none folds inwards
/// against a neighbour.
///
/// In the projection from the middle, the triangles then lie side by side, so that none crosses another.
fn looks_outwards(vertices: &[Point], triangles: &[[VertexId; 3]]) -> bool {
    let middle = [0, 1, 2].map(|i| {
        let sum: f64 = vertices.iter().map(|p| p[i]).sum();
        sum / as_double(vertices.len())
    });
    let corners = |t: &[VertexId; 3]| t.map(|v| vertices[v.index()]);
    let mut first: HashMap<[VertexId; 2], &[VertexId; 3]> = HashMap::default();
    first.reserve(triangles.len() * 3 / 2);
    triangles.iter().all(|t| {
        let facing = Facing::of(&corners(t));
        let mut beside =
            edges(*t)
                .into_iter()
                .filter_map(|[a, b]| match first.entry([a.min(b), a.max(b)]) {
                    Entry::Occupied(other) => Some(other.remove()),
                    Entry::Vacant(place) => {
                        place.insert(t);
                        None
                    }
                });
        facing.side(&middle) == Side::Minus
            && beside.all(|other| !turns_inwards(&facing, &corners(other)))
    })
}

/// Return whether a triangle folds inwards against another triangle that shares an edge with it.
fn turns_inwards(facing: &Facing, other: &Triangle) -> bool {
    let ways = [normal(facing.triangle()), normal(other)];
    let bend = cross(&ways[0], &ways[1]);
    let sizes = dot(&ways[0], &ways[0]) * dot(&ways[1], &ways[1]);
    let is_before = |p: &Point| facing.side(p) == Side::Plus;
    (dot(&ways[0], &ways[1]) < 0.0 || dot(&bend, &bend) > MAX_FOLD_SINE * MAX_FOLD_SINE * sizes)
        && other.iter().any(is_before)
}

#[cfg(test)]
mod tests {
    use super::{hull_of, looks_outwards, Pitch, Point};
    use crate::geometry::doubles::vector::{difference, dot, normal};

    /// Two layers of grid points, rotated about two axes.
    fn turned_layers(width: u32, turn: f64) -> Vec<Point> {
        let numbers = || (0..width).map(f64::from);
        let layer = |z: f64| numbers().flat_map(move |x| numbers().map(move |y| [x, y, z]));
        let (s, c) = turn.sin_cos();
        let about_z = |p: Point| [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]];
        let about_x = |p: Point| [p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]];
        let all = [0.0, 4.0].into_iter().flat_map(layer);
        all.map(|p| about_x(about_z(p))).collect()
    }

    #[test]
    fn turned_boxes_of_points_have_twelve_triangles() {
        for turn in 1..40 {
            let points = turned_layers(9, f64::from(turn) * 0.1);
            let hull = hull_of(&points, Pitch::DEFAULT).unwrap();
            assert_eq!((hull.vertices.len(), hull.triangles.len()), (8, 12));
            assert!(hull.is_convex_there);
        }
    }

    #[test]
    fn turned_layers_of_one_plane_are_empty() {
        for turn in 1..40 {
            let points = turned_layers(9, f64::from(turn) * 0.1);
            let hull = hull_of(&points[..81], Pitch::DEFAULT).unwrap();
            assert!(hull.triangles.is_empty(), "turn {turn}");
        }
    }

    #[test]
    fn corners_of_the_lattice_count_however_near_they_lie() {
        let mut points = vec![[0.0; 3], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 8.0]];
        points.push([1.0, 1.0, -(0.5f64.powi(9))]);
        let step = Pitch::new(-9).unwrap();
        assert_eq!(hull_of(&points, step).unwrap().vertices.len(), 5);
        points[4] = [2.0, 2.0, -1.0];
        assert_eq!(
            hull_of(&points, Pitch::new(0).unwrap())
                .unwrap()
                .vertices
                .len(),
            5
        );
    }

    /// A corner near the edge of a box lies in the plane of a side on the lattice, but outside it as given:
    /// the thin faces there fold by its height divided by its distance from the edge.
    #[test]
    fn thin_faces_look_outwards() {
        let mut mended = 0;
        for step in 1..60 {
            let mut points = turned_layers(2, 0.0);
            points.push([0.5, 1.0 + f64::from(step) * 1e-9, 4.0 + 0.45e-9]);
            let hull = hull_of(&points, Pitch::DEFAULT).unwrap();
            assert!(hull.is_convex_there);
            mended += usize::from(
                hull.vertices
                    .iter()
                    .all(|p| p[2].to_bits() != (4.0f64 + 0.45e-9).to_bits()),
            );
            assert!(looks_outwards(&hull.vertices, &hull.triangles));
            for t in &hull.triangles {
                let triangle = t.map(|v| hull.vertices[v.index()]);
                let normal = normal(&triangle);
                let size = dot(&normal, &normal).sqrt();
                for point in &points {
                    assert!(
                        dot(&normal, &difference(point, &triangle[0])) <= 1e-6 * size,
                        "{step}"
                    );
                }
            }
        }
        assert!(mended > 0);
    }
}
