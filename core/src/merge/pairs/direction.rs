//! Directions in doubles, and the largest coordinate.

use super::Swept;
use crate::geometry::doubles::vector::{cross, dot};

/// The padding of projections, as a share of the largest coordinate; far above their rounding.
pub const SLACK: f64 = 1e-14;

/// The lowest and highest place along a line.
pub type Span = [f64; 2];

/// A direction and two perpendicular to it.
pub fn frame(long: &[f64; 3]) -> [[f64; 3]; 3] {
    let thin = (0..3).min_by(|i, j| long[*i].abs().total_cmp(&long[*j].abs()));
    let mut axis = [0.0; 3];
    axis[thin.unwrap_or(0)] = 1.0;
    let any = cross(long, &axis);
    [*long, any, cross(long, &any)]
}

/// The unit vector of a vector; `None` for zero.
pub fn unit(v: &[f64; 3]) -> Option<[f64; 3]> {
    let size = dot(v, v).sqrt();
    (size > 0.0 && size.is_finite()).then(|| v.map(|x| x / size))
}

/// The largest coordinate of all corners, at least 1.
pub fn largest_coordinate(elements: &[&Swept]) -> f64 {
    let corners = elements.iter().filter_map(|e| e.corners.as_ref());
    let coordinates = corners.flatten().flatten();
    coordinates.fold(1.0f64, |m, x| m.max(x.abs()))
}
