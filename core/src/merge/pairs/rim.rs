//! Half-planes that bound the projections of triangles on a plane.

use super::direction::Span;
use super::line::Gauge;

/// A half-plane: the points with normal · point ≤ limit.
#[derive(Clone, Copy)]
pub struct HalfPlane {
    normal: [f64; 2],
    limit: f64,
}

impl HalfPlane {
    /// The half-plane without a limit: the whole plane.
    const ALL: Self = Self {
        normal: [0.0; 2],
        limit: f64::INFINITY,
    };

    /// Returns the half-plane that contains the points `corners` and is bounded by the line through the first
    /// two, moved outwards by `slack`.
    ///
    /// The half-plane contains the points whatever the rounding of its normal. Only products with the normal
    /// are off, by a few units in the last place of the coordinates, well below the coordinates' own error.
    fn beside(corners: [[f64; 2]; 3], slack: f64) -> Self {
        let [a, b, c] = corners;
        let across = [b[1] - a[1], a[0] - b[0]];
        let dot = |p: &[f64; 2]| across[0] * p[0] + across[1] * p[1];
        let out = if dot(&c) > dot(&a) { -1.0 } else { 1.0 };
        let normal = across.map(|x| out * x);
        let most = corners
            .iter()
            .map(|p| out * dot(p))
            .fold(f64::MIN, f64::max);
        let slack = (normal[0].abs() + normal[1].abs()) * slack;
        Self {
            normal,
            limit: most + slack,
        }
    }

    /// Returns true if a box of the plane, given by its extent on each axis, lies outside the half-plane.
    pub fn excludes(&self, spans: &[Span; 2]) -> bool {
        let least = |i: usize| self.normal[i] * spans[i][usize::from(self.normal[i] < 0.0)];
        least(0) + least(1) > self.limit
    }
}

/// Returns the half-planes at the edges of a triangle's projection on the plane of two gauges; `size` bounds
/// the coordinates. If there is no projection with straight edges, returns the whole plane three times.
pub fn rims(corners: Option<&[[f64; 3]; 3]>, plane: &[Gauge; 2], size: f64) -> [HalfPlane; 3] {
    let seen = corners.filter(|_| plane[0].keeps_straight(&plane[1]));
    let shadow = seen.and_then(|c| Some([plane[0].places(c)?, plane[1].places(c)?]));
    let Some([x, y]) = shadow else {
        return [HalfPlane::ALL; 3];
    };
    let slack = plane[0].slack(size).max(plane[1].slack(size));
    let [a, b, c] = [0, 1, 2].map(|i| [x[i], y[i]]);
    [[a, b, c], [b, c, a], [c, a, b]].map(|corners| HalfPlane::beside(corners, slack))
}
