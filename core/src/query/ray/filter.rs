//! Tests a ray against facets in doubles, with certain answers or doubt.
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

use super::block::{Block, LANES};
use super::line::Ray;

/// The unit roundoff of doubles.
pub const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The result of testing a ray against a facet in doubles.
///
/// Not a `Filtered`: a hit is certain, but the error of its depth may still require integers.
#[derive(Clone, Copy, Debug)]
pub enum Probe {
    /// The ray does not meet the facet.
    Miss,
    /// The ray meets the facet's interior at this depth, up to the depth's error.
    Hit(Depth),
    /// Doubles cannot decide; integers must.
    Doubt,
}

/// A distance along a ray's main axis in lattice steps, and a bound on its error.
#[derive(Clone, Copy, Debug)]
pub struct Depth {
    /// The depth.
    pub z: f64,
    /// The bound on the error of the depth.
    pub error: f64,
}

impl Depth {
    /// The least value that the exact depth can have.
    pub fn low(&self) -> f64 {
        self.z - self.error
    }

    /// The largest value that the exact depth can have.
    pub fn high(&self) -> f64 {
        self.z + self.error
    }
}

/// The constants for testing one ray against facets in doubles.
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
    /// Prepares the tests of a ray against facets in a box.
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

    /// Tests a facet in doubles.
    #[inline]
    pub fn probe(&self, facet: &[[f64; D]; D]) -> Probe {
        self.side_by_side(&facet.map(|corner| corner.map(|c| [c])))
            .probe(self, 0)
    }

    /// Tests the facets of a block in doubles; calls `answer` for each lane that is not certainly missed.
    #[inline]
    pub fn probe_block(&self, block: &Block<D>, mut answer: impl FnMut(usize, Probe)) {
        let seen: Seen<D, LANES> = self.side_by_side(&block.corners);
        if seen.missed.iter().all(|missed| *missed) {
            return;
        }
        for lane in 0..block.facets().len() {
            match seen.probe(self, lane) {
                Probe::Miss => {}
                found => answer(lane, found),
            }
        }
    }

    /// Returns the facets in coordinates in which the ray runs along one axis; by corner, axis and lane.
    #[inline]
    fn side_by_side<const L: usize>(&self, corners: &[[[f64; L]; D]; D]) -> Seen<D, L> {
        let mut sheared = [[[0.0; L]; D]; D];
        let along = self.axes[D - 1];
        for (seen, corner) in sheared.iter_mut().zip(corners) {
            for l in 0..L {
                let z = corner[along][l] - self.origin[along];
                for (i, axis) in self.axes.into_iter().enumerate() {
                    let across = corner[axis][l] - self.origin[axis];
                    let last = i + 1 == D;
                    seen[i][l] = if last { z } else { across - self.shear[i] * z };
                }
            }
        }
        let weights = planar_weights(&sheared);
        let (mut least, mut most) = (weights[0], weights[0]);
        for w in &weights[1..] {
            for l in 0..L {
                least[l] = if w[l] < least[l] { w[l] } else { least[l] };
                most[l] = if w[l] > most[l] { w[l] } else { most[l] };
            }
        }
        let mut missed = [false; L];
        for l in 0..L {
            missed[l] = least[l] < -self.doubt && most[l] > self.doubt;
        }
        Seen {
            sheared,
            weights,
            least,
            most,
            missed,
        }
    }
}

/// Facets in sheared coordinates, in which the ray runs along an axis, and the weights of their corners.
struct Seen<const D: usize, const L: usize> {
    sheared: [[[f64; L]; D]; D],
    weights: [[f64; L]; D],
    least: [f64; L],
    most: [f64; L],
    missed: [bool; L],
}

impl<const D: usize, const L: usize> Seen<D, L> {
    #[inline]
    fn probe(&self, filter: &Filter<D>, lane: usize) -> Probe {
        if self.missed[lane] {
            return Probe::Miss;
        }
        if self.least[lane] <= filter.doubt && self.most[lane] >= -filter.doubt {
            return Probe::Doubt;
        }
        self.depth(filter, lane)
    }

    #[inline]
    fn depth(&self, filter: &Filter<D>, lane: usize) -> Probe {
        let sum: f64 = self.weights.iter().map(|w| w[lane]).sum();
        let size = sum.abs();
        if size < 8.0 * filter.doubt {
            return Probe::Doubt;
        }
        let moment: f64 = (0..D)
            .map(|i| self.weights[i][lane] * self.sheared[i][D - 1][lane])
            .sum();
        let z = moment / sum * filter.heading;
        let error = 12.0 * filter.doubt * filter.reach / size + 24.0 * ROUNDING * filter.reach;
        if z < -error {
            Probe::Miss
        } else if z > error {
            Probe::Hit(Depth { z, error })
        } else {
            Probe::Doubt
        }
    }
}

/// The weights of corners in sheared coordinates, up to a common factor.
#[inline]
fn planar_weights<const D: usize, const L: usize>(p: &[[[f64; L]; D]; D]) -> [[f64; L]; D] {
    let mut weights = [[1.0; L]; D];
    for i in 0..D {
        for l in 0..L {
            weights[i][l] = match D {
                1 => 1.0,
                2 if i == 0 => p[1][0][l],
                2 => -p[0][0][l],
                _ => {
                    let (a, b) = (&p[(i + 1) % D], &p[(i + 2) % D]);
                    a[0][l] * b[1][l] - a[1][l] * b[0][l]
                }
            };
        }
    }
    weights
}
