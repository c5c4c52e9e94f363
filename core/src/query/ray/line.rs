//! Rays: a lattice point and an integer direction, with the doubles that the filter needs.

use super::bounds::DIRECTION_BITS;
use crate::arith::mantissa_and_exponent;
use crate::error::{Error, ErrorKind, Result};

/// An exact ray from a lattice point, in `D` dimensions.
///
/// The direction is the given one times 2^`exponent`, in integers. It is exact, except that components more
/// than 2^60 times smaller than the largest are rounded to 2^-113 of it.
#[derive(Clone, Debug)]
pub struct Ray<const D: usize> {
    origin: [i64; D],
    direction: [i128; D],
    exponent: i32,
    pub(in crate::query) near: Near<D>,
}

/// A ray in doubles: origin and direction carry one rounding each at most, as `filter` supposes.
#[derive(Clone, Debug)]
pub(in crate::query) struct Near<const D: usize> {
    pub origin: [f64; D],
    /// The axis of the largest component of the direction.
    pub main: usize,
    /// The sign of the largest component of the direction.
    pub heading: f64,
    /// Each component of the direction divided by the largest one.
    pub shear: [f64; D],
}

impl<const D: usize> Ray<D> {
    /// Makes the ray from a lattice point along a direction in doubles.
    ///
    /// # Errors
    /// `NonFinite` for a direction that is not finite, `BadNormal` for one of length zero.
    #[inline]
    pub fn new(origin: [i64; D], direction: &[f64; D]) -> Result<Self> {
        if let Some(bad) = direction.iter().find(|c| !c.is_finite()) {
            let text = format!("a ray's direction has the component {bad}; it must be finite");
            return Err(Error::new(ErrorKind::NonFinite, text));
        }
        if let Some((whole, exponent)) = exactly(direction) {
            // Doubles give the magnitudes and quotients of the integers, without converting wide ones.
            let main = first_largest(direction, f64::abs);
            let near = Near::along(&origin, direction, main);
            return Ok(Self {
                origin,
                direction: whole,
                exponent,
                near,
            });
        }
        let (direction, exponent) = rounded(direction).ok_or_else(zero_direction)?;
        Ok(Self::of(origin, direction, exponent))
    }

    /// Makes the ray from one lattice point to another, which it reaches at parameter 1.
    ///
    /// # Errors
    /// `BadNormal` if the two points are the same.
    pub fn between(origin: [i64; D], target: &[i64; D]) -> Result<Self> {
        let direction = std::array::from_fn(|i| i128::from(target[i]) - i128::from(origin[i]));
        if direction == [0; D] {
            return Err(zero_direction());
        }
        Ok(Self::of(origin, direction, 0))
    }

    fn of(origin: [i64; D], direction: [i128; D], exponent: i32) -> Self {
        let main = first_largest(&direction, i128::unsigned_abs);
        let near = Near::along(&origin, &direction.map(|c| c as f64), main);
        Self {
            origin,
            direction,
            exponent,
            near,
        }
    }

    /// The lattice point where the ray starts.
    pub fn origin(&self) -> &[i64; D] {
        &self.origin
    }

    /// The direction, which is not zero; its components are below 2^113 in magnitude.
    pub fn direction(&self) -> &[i128; D] {
        &self.direction
    }

    /// The power of two by which the given direction was multiplied.
    pub fn exponent(&self) -> i32 {
        self.exponent
    }
}

impl<const D: usize> Near<D> {
    #[inline]
    fn along(origin: &[i64; D], direction: &[f64; D], main: usize) -> Self {
        let lead = direction[main];
        let (mut near, mut shear) = ([0.0; D], [0.0; D]);
        for k in 0..D {
            near[k] = origin[k] as f64;
            // Negative zeros become positive, as they do in integers.
            shear[k] = (direction[k] + 0.0) / lead;
        }
        Self {
            origin: near,
            main,
            heading: lead.signum(),
            shear,
        }
    }
}

/// Returns the first axis with the largest component, so that equal rays always get the same axis.
#[inline]
fn first_largest<C: Copy, S: PartialOrd, const D: usize>(
    direction: &[C; D],
    size: impl Fn(C) -> S,
) -> usize {
    let mut main = 0;
    for k in 1..D {
        if size(direction[k]) > size(direction[main]) {
            main = k;
        }
    }
    main
}

fn zero_direction() -> Error {
    let text = "the direction of a ray is the zero vector";
    Error::new(ErrorKind::BadNormal, text)
}

/// Scales components by a power of two to integers without a common factor of two; returns them and the
/// exponent, `None` for zero, or if they need more than `DIRECTION_BITS`.
#[inline]
fn exactly<const D: usize>(direction: &[f64; D]) -> Option<([i128; D], i32)> {
    let (mut low, mut high) = (i32::MAX, i32::MIN);
    let mut parts = [(0, 0); D];
    for (part, c) in parts.iter_mut().zip(direction) {
        let (m, e) = mantissa_and_exponent(*c);
        *part = (m, e);
        if m != 0 {
            low = low.min(e + m.trailing_zeros() as i32);
            high = high.max(e + bits(m));
        }
    }
    if low > high || high - low > DIRECTION_BITS as i32 {
        return None;
    }
    let mut whole = [0; D];
    for (c, (m, e)) in whole.iter_mut().zip(parts) {
        *c = scaled(m, e - low);
    }
    Some((whole, -low))
}

/// `m`·2^`shift`, which is an integer.
#[inline]
fn scaled(m: i64, shift: i32) -> i128 {
    if m == 0 {
        0
    } else if shift < 0 {
        i128::from(m >> -shift)
    } else {
        i128::from(m) << shift
    }
}

/// Rounds components times a common power of two to integers; returns them and the exponent, `None` for
/// zero.
fn rounded<const D: usize>(direction: &[f64; D]) -> Option<([i128; D], i32)> {
    let parts = direction.map(mantissa_and_exponent);
    let top = |(m, e): &(i64, i32)| (*m != 0).then(|| e + bits(*m));
    let highest = parts.iter().filter_map(top).max()?;
    let exponent = DIRECTION_BITS as i32 - highest;
    let wide = parts.map(|(m, e)| if m == 0 { 0 } else { shifted(m, e + exponent) });
    let spare = wide.iter().fold(0, |all, c| all | c).trailing_zeros();
    Some((wide.map(|c| c >> spare), exponent - spare as i32))
}

fn bits(m: i64) -> i32 {
    64 - m.unsigned_abs().leading_zeros() as i32
}

/// The integer nearest to `m`·2^`shift`; halves are rounded up.
fn shifted(m: i64, shift: i32) -> i128 {
    let wide = i128::from(m);
    match shift {
        0.. => wide << shift,
        -64..=-1 => (wide + (1i128 << (-shift - 1))) >> -shift,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction<const D: usize>(d: [f64; D]) -> ([i128; D], i32) {
        let ray = Ray::new([0; D], &d).expect("the direction is fine");
        (*ray.direction(), ray.exponent())
    }

    #[test]
    fn directions_are_taken_as_they_are() {
        assert_eq!(direction([0.0, 0.0, -3.0]), ([0, 0, -3], 0));
        assert_eq!(direction([0.5, 0.75, 0.0]), ([2, 3, 0], 2));
        assert_eq!(direction([f64::MAX, 0.0]).0, [(1 << 53) - 1, 0]);
        assert_eq!(direction([5e-324]), ([1], 1074));
        let (d, e) = direction([1.0, 2f64.powi(-60), -(2f64.powi(-60))]);
        assert_eq!((d, e), ([1 << 60, 1, -1], 60));
    }

    #[test]
    fn components_that_are_far_smaller_are_rounded() {
        assert_eq!(direction([1.0, 1e-300]), ([1, 0], 0));
        let (d, _) = direction([1.0, 2f64.powi(-90) * 1.000_000_000_000_1]);
        assert!(d[0] <= 1 << 113 && d[1] > 0);
    }

    #[test]
    fn no_direction_is_refused() {
        let code = |d: [f64; 2]| Ray::new([0; 2], &d).expect_err("refused").kind();
        assert_eq!(code([0.0, -0.0]), ErrorKind::BadNormal);
        assert_eq!(code([0.0, f64::NAN]), ErrorKind::NonFinite);
        assert_eq!(code([f64::INFINITY, 0.0]), ErrorKind::NonFinite);
        assert!(Ray::between([3, 4], &[3, 4]).is_err());
    }
}
