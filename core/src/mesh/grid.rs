//! The lattice: how doubles become integers, and integers doubles.

use crate::arith::bounds::COORDINATE_BITS;
use crate::arith::convert::{as_double, as_whole};
use crate::arith::{ratio_to_f64, Int};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Lattice;
use crate::geometry::spaces::dim2::Point2;
use crate::geometry::vertex::Vertex;

/// The lattice step 10^exponent, in model units.
///
/// # Example
/// ```
/// use bspcsg::mesh::grid::Pitch;
///
/// // Steps of a thousandth: 0.3 is 300 of them, though no double is 0.3.
/// let pitch = Pitch::new(-3)?;
/// assert_eq!(pitch.snap(0.1 + 0.2)?, 300);
/// assert_eq!(pitch.coordinate(300), 0.3);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pitch(i8);

/// The largest power of ten up to which doubles represent all powers exactly.
const EXACT_POWERS: i8 = 22;

/// The powers of ten from 10^0 to 10^[`EXACT_POWERS`].
const POWERS_OF_TEN: [f64; EXACT_POWERS as usize + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

impl Pitch {
    /// The step of 10^-9 units: CAD numbers are decimals of at most nine digits after the point.
    pub const DEFAULT: Self = Self(-9);

    /// The pitch of the step 10^`exponent` model units; an error outside −22..=22.
    pub fn new(exponent: i64) -> Result<Self> {
        i8::try_from(exponent)
            .ok()
            .filter(|e| (-EXACT_POWERS..=EXACT_POWERS).contains(e))
            .map(Self)
            .ok_or_else(|| {
                let text =
                    format!("the lattice step 10^{exponent} is not between 10^-22 and 10^22");
                Error::new(ErrorKind::TooLarge, text)
            })
    }

    /// The exponent of ten: the lattice step is 10^exponent model units.
    pub fn exponent(self) -> i64 {
        i64::from(self.0)
    }

    /// The pitch for a mesh with this largest coordinate and this extent: the default if both suit it.
    ///
    /// Coarser by powers of 1000 until the largest coordinate fits; finer for meshes less than 10^6 steps
    /// across, as long as the largest coordinate fits.
    pub fn suited(largest: f64, extent: f64) -> Result<Self> {
        let mut pitch = Self::DEFAULT;
        while !pitch.is_in_reach(largest) {
            pitch = Self::new(pitch.exponent() + 3).map_err(|_| {
                let text = format!(
                    "the coordinate {largest:e} is too large for any lattice; scale the mesh down"
                );
                Error::new(ErrorKind::TooLarge, text)
            })?;
        }
        while extent > 0.0 && pitch.steps(extent) < 1e6 && pitch.0 > -EXACT_POWERS + 3 {
            let finer = Self(pitch.0 - 3);
            if !finer.is_in_reach(largest) {
                break;
            }
            pitch = finer;
        }
        Ok(pitch)
    }

    /// A length in model units converted to lattice steps, within three units in the last place.
    #[inline]
    pub fn steps(self, x: f64) -> f64 {
        let power = power_of_ten(self.0.abs());
        if self.0 < 0 {
            x * power
        } else {
            x / power
        }
    }

    /// The difference from the lattice coordinate `origin` to `x`, which is in model units, in steps; only
    /// the result is rounded.
    pub fn steps_from(self, x: f64, origin: f64) -> f64 {
        let power = power_of_ten(self.0.abs());
        if self.0 <= 0 {
            x.mul_add(power, -origin)
        } else {
            origin.mul_add(-power, x) / power
        }
    }

    /// The factor from model units to steps; `None` for steps of several units, where one divides instead.
    pub(super) fn steps_per_unit(self) -> Option<f64> {
        (self.0 <= 0).then(|| power_of_ten(-self.0))
    }

    #[inline]
    fn is_in_reach(self, x: f64) -> bool {
        self.steps(x).abs() < LIMIT
    }

    /// The lattice coordinate nearest to `x`, decided by the exact product; halves are rounded away from
    /// zero.
    #[inline]
    pub fn snap(self, x: f64) -> Result<i64> {
        // The test is also false for infinities and NaN.
        if !self.is_in_reach(x) {
            return Err(self.too_large_error(x));
        }
        let rounded = if self.0 <= 0 {
            snap_product(x, power_of_ten(-self.0))
        } else {
            snap_quotient(x, power_of_ten(self.0))
        };
        Ok(as_whole(rounded))
    }

    #[cold]
    fn too_large_error(self, x: f64) -> Error {
        if !x.is_finite() {
            let text = format!("a coordinate is {x}; coordinates must be finite");
            return Error::new(ErrorKind::NonFinite, text);
        }
        let text = format!(
            "the coordinate {x:e} is more than 2^53 lattice steps of 10^{} from the origin; scale the \
             coordinates down, or choose a coarser pitch",
            self.0
        );
        Error::new(ErrorKind::TooLarge, text)
    }

    /// The double nearest to a lattice coordinate, in model units.
    #[inline]
    pub fn coordinate(self, k: i64) -> f64 {
        self.units(as_double(k))
    }

    /// The double nearest to a number of steps, in model units.
    #[inline]
    pub fn units(self, steps: f64) -> f64 {
        let power = power_of_ten(self.0.abs());
        if self.0 <= 0 {
            steps / power
        } else {
            steps * power
        }
    }

    /// The doubles nearest to a vertex's coordinates, in model units.
    pub fn position(self, vertex: &Vertex) -> [f64; 3] {
        if let Some(p) = vertex.as_lattice() {
            return p.map(|k| self.coordinate(k));
        }
        let h = vertex.coordinates();
        let (up, down) = self.step();
        let den: Int<8> = h.w.mul(&down);
        h.x.map(|x| {
            let num: Int<8> = x.mul(&up);
            ratio_to_f64(&num, &den)
        })
    }

    /// The doubles nearest to the coordinates of a point of the plane, in model units.
    pub fn position_in_plane(self, point: &Point2) -> [f64; 2] {
        let (x, w) = point.coordinates();
        let (up, down) = self.step();
        let den: Int<4> = w.mul(&down);
        x.map(|x| {
            let num: Int<5> = x.mul(&up);
            ratio_to_f64(&num, &den)
        })
    }

    /// The lattice step in model units, as numerator and denominator.
    fn step(self) -> (Int<2>, Int<2>) {
        let power = Int::from_i128(10i128.pow(u32::from(self.0.unsigned_abs())));
        if self.0 <= 0 {
            (Int::ONE, power)
        } else {
            (power, Int::ONE)
        }
    }

    /// The integer by which this pitch divides a coarser one; `None` if the other is finer or the integer
    /// does not fit.
    pub fn refinement(self, coarser: Self) -> Option<i64> {
        let steps = u32::try_from(coarser.0 - self.0).ok()?;
        10i64.checked_pow(steps)
    }
}

/// The least magnitude that is too large for a lattice coordinate, 2^53.
#[allow(clippy::cast_precision_loss, reason = "a small constant")]
pub const LIMIT: f64 = (1u64 << COORDINATE_BITS) as f64;

#[inline]
fn power_of_ten(exponent: i8) -> f64 {
    POWERS_OF_TEN[usize::from(exponent.unsigned_abs())]
}

/// The largest double below one half.
const BELOW_HALF: f64 = 0.5 - f64::EPSILON / 4.0;

/// Rounds the exact product x·power to the nearest integer, halves away from zero; |x·power| < 2^53.
#[inline]
fn snap_product(x: f64, power: f64) -> f64 {
    let product = x * power;
    // To the nearest, halves away from zero, without an unpredictable branch.
    let rounded = as_double(as_whole(product + BELOW_HALF.copysign(product)));
    let doubt = product.abs() * f64::EPSILON;
    if (product - rounded).abs() + doubt < 0.5 {
        return rounded;
    }
    snap_doubtful(x, power, product, rounded)
}

/// Rounds the exact product, which is near the midpoint of `rounded` and a neighbour, to the nearest integer.
#[cold]
#[allow(clippy::float_cmp)]
fn snap_doubtful(x: f64, power: f64, product: f64, rounded: f64) -> f64 {
    let rest = product - rounded;
    let error = x.mul_add(power, -product);
    let exact = rest + error;
    let tie_away = exact.abs() == 0.5 && (exact > 0.0) == (x > 0.0);
    if exact.abs() > 0.5 || tie_away {
        rounded + exact.signum()
    } else {
        rounded
    }
}

/// Rounds the exact quotient x/power to the nearest integer.
fn snap_quotient(x: f64, power: f64) -> f64 {
    let rounded = (x / power).round();
    let rest = (-rounded).mul_add(power, x);
    if rest.abs() > power / 2.0 {
        rounded + rest.signum()
    } else {
        rounded
    }
}

/// Snaps a point in model units to the nearest lattice point.
pub fn snap_point(pitch: Pitch, p: &[f64; 3]) -> Result<Lattice> {
    Ok([pitch.snap(p[0])?, pitch.snap(p[1])?, pitch.snap(p[2])?])
}

#[cfg(test)]
mod tests {
    use super::*;

    // Formerly, halves of a step were rounded towards zero from 2⁵² steps on.
    #[test]
    fn halves_go_away_from_zero_at_all_sizes() {
        let pitch = Pitch::new(-9).expect("a pitch");
        // Halves of a step that doubles represent exactly, below and above 2^52 steps.
        for (x, steps) in [
            (0.5f64.powi(10), 976_563),
            (4_503_599.629_882_812_5, 4_503_599_629_882_813),
        ] {
            assert_eq!(pitch.snap(x).expect("on the lattice"), steps);
            assert_eq!(pitch.snap(-x).expect("on the lattice"), -steps);
        }
    }

    #[test]
    fn a_pitch_is_between_the_powers_that_doubles_hold() {
        for exponent in i64::from(i8::MIN) - 1..=i64::from(i8::MAX) + 1 {
            let pitch = Pitch::new(exponent);
            assert_eq!(pitch.is_ok(), (-22..=22).contains(&exponent), "{exponent}");
        }
    }
}
