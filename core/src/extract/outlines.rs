//! Triangulates outlines in the plane, given in doubles, with their corners snapped to the lattice.

use super::triangulate::triangulate;
use super::vertices::Projection;
use crate::geometry::plane::Plane;
use crate::geometry::vertices::VertexTable;
use crate::mesh::grid::Pitch;

/// Triangulates the region on the left of closed outlines in the plane; corners are indices of points.
///
/// Each corner is snapped to the lattice that import would choose. `None` if two corners then coincide, or
/// the edges do not bound a region.
///
/// # Cost
/// That of [`triangulate`].
///
/// # Example
/// ```
/// use bspcsg::extract::outlines::triangulate_outlines;
///
/// let square = [[0.0, 0.0], [1.5, 0.0], [1.5, 1.5], [0.0, 1.5]];
/// let edges = [(0, 1), (1, 2), (2, 3), (3, 0)];
/// assert_eq!(triangulate_outlines(&square, &edges).map(|found| found.len()), Some(2));
/// ```
pub fn triangulate_outlines(points: &[[f64; 2]], edges: &[(u32, u32)]) -> Option<Vec<[u32; 3]>> {
    let pitch = suited(points)?;
    let mut table = VertexTable::default();
    for (number, [x, y]) in (0u32..).zip(points) {
        let place = [pitch.snap(*x).ok()?, pitch.snap(*y).ok()?, 0];
        if table.number_at(place) != number {
            return None;
        }
    }
    let floor = Plane::through(&[0, 0, 0], &[1, 0, 0], &[0, 1, 0])?;
    triangulate(&Projection::onto(&floor, &table), edges).ok()
}

/// Returns the pitch that import chooses for points with such coordinates and such an extent.
fn suited(points: &[[f64; 2]]) -> Option<Pitch> {
    let along = |axis: usize| points.iter().map(move |p| p[axis]);
    let extent = |axis| along(axis).fold(f64::MIN, f64::max) - along(axis).fold(f64::MAX, f64::min);
    let largest = points
        .iter()
        .flatten()
        .fold(0.0, |m, x| f64::max(m, x.abs()));
    Pitch::suited(largest, extent(0).max(extent(1))).ok()
}
