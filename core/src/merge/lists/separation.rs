//! Tests whether a face misses an axis-parallel box, by separating axes in doubles.

use crate::arith::convert::as_double;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::doubles::vector::{cross, difference, dot};
use crate::geometry::plane::{Lattice, Plane};
use crate::mesh::handle::FaceId;
use crate::mesh::source::{Shape, Source};

/// The relative slack of the separating axis tests in doubles, far above their rounding errors.
const SLACK: f64 = 1e-13;

/// Returns true if a face certainly misses a closed cell; false proves nothing.
pub fn misses(source: &Source, face: FaceId, cell: &Cell) -> bool {
    let (low, high) = (cell.low(), cell.high());
    match source.shape() {
        Shape::HalfSpace(plane) => plane_misses(plane, low, &high),
        Shape::Mesh(mesh) => triangle_misses(&mesh.corners(face), low, &high),
    }
}

fn plane_misses(plane: &Plane, low: &Lattice, high: &Lattice) -> bool {
    let n = plane.approx();
    let (center, half) = middle(low, high, &[0; 3]);
    let value = n[0] * center[0] + n[1] * center[1] + n[2] * center[2] + n[3];
    let reach: f64 = (0..3).map(|i| n[i].abs() * half[i]).sum();
    let size: f64 = (0..3).map(|i| n[i].abs() * center[i].abs()).sum::<f64>() + n[3].abs();
    value.abs() > reach + (size + reach) * SLACK
}

/// Returns true if a triangle certainly misses the box from half a step below `low` to half a step above
/// `high`; false proves nothing.
///
/// The separating axes are the triangle's normal, and the cross products of its edges with the coordinate
/// axes.
///
/// # Example
/// ```
/// use bspcsg::merge::lists::separation::triangle_misses;
///
/// // Both boxes lie in that of the triangle.
/// let triangle = [[0, 0, 0], [9, 0, 0], [0, 9, 0]];
/// assert!(triangle_misses(&triangle, &[7, 7, 0], &[9, 9, 0]));
/// assert!(!triangle_misses(&triangle, &[0, 0, 0], &[2, 2, 0]));
/// ```
pub fn triangle_misses(corners: &[Lattice; 3], low: &Lattice, high: &Lattice) -> bool {
    let (center, half) = middle(low, high, &corners[0]);
    let local = corners.map(|c| each_axis(|i| as_double(c[i] - corners[0][i]) - center[i]));
    separated(&local, &half)
}

/// Returns the centre relative to `origin` and the half extents of the box from half a step below `low` to
/// half a step above `high`.
fn middle(low: &Lattice, high: &Lattice, origin: &Lattice) -> ([f64; 3], [f64; 3]) {
    let center = each_axis(|i| {
        f64::midpoint(
            as_double(low[i] - origin[i]),
            as_double(high[i] - origin[i]),
        )
    });
    (
        center,
        each_axis(|i| as_double(high[i] - low[i]) / 2.0 + 0.5),
    )
}

fn separated(p: &[[f64; 3]; 3], half: &[f64; 3]) -> bool {
    let e = each_axis(|i| difference(&p[(i + 1) % 3], &p[i]));
    let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let across = e
        .iter()
        .flat_map(|edge| unit.iter().map(|u| cross(u, edge)));
    std::iter::once(cross(&e[0], &e[1]))
        .chain(across)
        .any(|axis| separates(p, half, &axis))
}

fn separates(p: &[[f64; 3]; 3], half: &[f64; 3], axis: &[f64; 3]) -> bool {
    let values = [dot(&p[0], axis), dot(&p[1], axis), dot(&p[2], axis)];
    let low = values[0].min(values[1]).min(values[2]);
    let high = values[0].max(values[1]).max(values[2]);
    let reach: f64 = (0..3).map(|i| half[i] * axis[i].abs()).sum();
    let size: f64 = p
        .iter()
        .map(|c| (0..3).map(|i| (c[i] * axis[i]).abs()).sum::<f64>())
        .fold(reach, f64::max);
    low > reach + size * SLACK || high < -reach - size * SLACK
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle with a corner on each axis, and boxes that overlap its bounding box.
    #[test]
    fn boxes_on_one_side_of_the_plane_are_missed() {
        let corners = [[30, 0, 0], [0, 30, 0], [0, 0, 30]];
        assert!(triangle_misses(&corners, &[0; 3], &[8; 3]));
        assert!(triangle_misses(&corners, &[12; 3], &[20; 3]));
        assert!(!triangle_misses(&corners, &[8; 3], &[12; 3]));
    }

    #[test]
    fn boxes_beside_an_edge_are_missed() {
        let corners = [[0, 0, 0], [40, 40, 0], [40, 41, 0]];
        assert!(triangle_misses(&corners, &[20, 0, -5], &[30, 10, 5]));
        assert!(!triangle_misses(&corners, &[20, 20, -5], &[30, 30, 5]));
    }
}
