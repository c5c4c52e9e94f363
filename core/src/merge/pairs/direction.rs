//! Directions in space as vectors of doubles.

use super::SweptElement;
use crate::geometry::doubles::vector::{cross, dot};

/// The padding of projections, as a share of the largest coordinate; far above their rounding errors.
pub const SLACK: f64 = 1e-14;

/// The lowest and the highest coordinate of a triangle along a line.
pub type Span = [f64; 2];

/// Returns a direction and two vectors perpendicular to it and to each other.
pub fn frame(long: &[f64; 3]) -> [[f64; 3]; 3] {
    let thin = (0..3).min_by(|i, j| long[*i].abs().total_cmp(&long[*j].abs()));
    let mut axis = [0.0; 3];
    axis[thin.unwrap_or(0)] = 1.0;
    let any = cross(long, &axis);
    [*long, any, cross(long, &any)]
}

/// Returns the vector scaled to length 1; `None` for the zero vector and for infinite lengths.
pub fn unit(v: &[f64; 3]) -> Option<[f64; 3]> {
    let size = dot(v, v).sqrt();
    (size > 0.0 && size.is_finite()).then(|| v.map(|x| x / size))
}

/// Returns the largest absolute coordinate of all corners of triangles, at least 1.
pub fn largest_coordinate(elements: &[&SweptElement]) -> f64 {
    let corners = elements.iter().filter_map(|e| e.corners.as_ref());
    let coordinates = corners.flatten().flatten();
    coordinates.fold(1.0f64, |m, x| m.max(x.abs()))
}
