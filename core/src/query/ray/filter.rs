//! The ray against a facet in doubles: certain answers, or doubt.
//!
//! # Source
//! Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection": corners relative to the
//! origin are sheared so that the ray runs along its main axis; weights are then determinants of
//! one order less. The error bounds below are this module's own.
//!
//! # Error
//! u = 2^-53; M bounds every coordinate relative to the origin; all inputs are integers below
//! 2^54, so that each carries one rounding (a direction is the difference of two points at most).
//! A relative coordinate x carries one rounding, a shear factor three, |shear| ≤ 1:
//!
//! * a sheared coordinate x − shear·z is off by at most 2uM + 6uM and terms of u², below 8.1 uM;
//!   its magnitude is below 2.1 M;
//! * a weight in space is the difference of two products of such: off by at most
//!   2·(2·2.1·8.1 + 4.5) uM² + 9 uM² < 87 uM²; in the plane it is a sheared coordinate;
//! * so a weight beyond `doubt` = 96 uM² (space), 12 uM (plane) has the sign of the exact one;
//! * depth z = Σ wᵢzᵢ / Σ wᵢ with all weights of one sign and |Σ wᵢ| ≥ 8·doubt: numerator and
//!   denominator are off by at most 3·doubt·M (plus 8u relative) and 3·doubt, and the denominator
//!   keeps more than half of its size, so that z is off by less than
//!   12·doubt·M/|Σ wᵢ| + 24 uM.

use super::line::Ray;

/// The unit roundoff of doubles.
pub const ROUNDING: f64 = f64::EPSILON / 2.0;

/// What doubles can tell of a ray and a facet.
#[derive(Clone, Copy, Debug)]
pub enum Probe {
    /// The ray does not meet the facet.
    Miss,
    /// The ray meets the facet's interior at this depth, give or take the error.
    Hit(Depth),
    /// Integers must decide.
    Doubt,
}

/// The way along a ray, measured along its main axis in lattice steps, and a bound of its error.
#[derive(Clone, Copy, Debug)]
pub struct Depth {
    /// The depth.
    pub z: f64,
    /// It is off by at most this.
    pub error: f64,
}

impl Depth {
    /// The least that the exact depth can be.
    pub fn low(&self) -> f64 {
        self.z - self.error
    }

    /// The most that the exact depth can be.
    pub fn high(&self) -> f64 {
        self.z + self.error
    }
}

/// The filter of one ray in one scene.
#[derive(Clone, Debug)]
pub struct Filter<const D: usize> {
    origin: [f64; D],
    axes: [usize; D],
    shear: [f64; D],
    heading: f64,
    reach: f64,
    doubt: f64,
}

impl<const D: usize> Filter<D> {
    /// The filter for facets within a box.
    pub fn new(ray: &Ray<D>, low: &[f64; D], high: &[f64; D]) -> Self {
        let near = &ray.near;
        let span = |i: usize| (high[i] - near.origin[i]).max(near.origin[i] - low[i]);
        // Each span carries one rounding.
        let reach = (0..D).map(span).fold(1.0, f64::max) * (1.0 + 4.0 * ROUNDING);
        let axes = std::array::from_fn(|i| (near.main + 1 + i) % D);
        Self {
            origin: near.origin,
            axes,
            shear: axes.map(|k| near.shear[k]),
            heading: near.heading,
            reach,
            doubt: match D {
                1 => 0.0,
                2 => 12.0 * ROUNDING * reach,
                _ => 96.0 * ROUNDING * reach * reach,
            },
        }
    }

    /// Doubles' answer for one facet.
    #[inline]
    pub fn probe(&self, facet: &[[f64; D]; D]) -> Probe {
        let sheared = facet.map(|corner| self.sheared(&corner));
        let weights = planar_weights(&sheared);
        let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
        let most = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if least < -self.doubt && most > self.doubt {
            return Probe::Miss;
        }
        if least <= self.doubt && most >= -self.doubt {
            return Probe::Doubt;
        }
        self.depth(&sheared, &weights)
    }

    #[inline]
    fn sheared(&self, corner: &[f64; D]) -> [f64; D] {
        let along = self.axes[D - 1];
        let z = corner[along] - self.origin[along];
        std::array::from_fn(|i| {
            if i + 1 == D {
                return z;
            }
            let axis = self.axes[i];
            corner[axis] - self.origin[axis] - self.shear[i] * z
        })
    }

    #[inline]
    fn depth(&self, sheared: &[[f64; D]; D], weights: &[f64; D]) -> Probe {
        let sum: f64 = weights.iter().sum();
        let size = sum.abs();
        if size < 8.0 * self.doubt {
            return Probe::Doubt;
        }
        let moment: f64 = (0..D).map(|i| weights[i] * sheared[i][D - 1]).sum();
        let z = moment / sum * self.heading;
        let error = 12.0 * self.doubt * self.reach / size + 24.0 * ROUNDING * self.reach;
        if z < -error {
            Probe::Miss
        } else if z > error {
            Probe::Hit(Depth { z, error })
        } else {
            Probe::Doubt
        }
    }
}

/// The weights of corners seen along the ray, up to a common factor.
#[inline]
fn planar_weights<const D: usize>(p: &[[f64; D]; D]) -> [f64; D] {
    std::array::from_fn(|i| match D {
        1 => 1.0,
        2 if i == 0 => p[1][0],
        2 => -p[0][0],
        _ => {
            let (a, b) = (&p[(i + 1) % D], &p[(i + 2) % D]);
            a[0] * b[1] - a[1] * b[0]
        }
    })
}
