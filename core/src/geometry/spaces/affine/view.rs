//! Viewpoints: points or directions given in doubles, with exact tests on which side of a hyperplane they
//! lie.

use num_bigint::BigInt;

use super::Affine;
use crate::arith::{mantissa_and_exponent, Sign};
use crate::geometry::plane::FILTER;
use crate::geometry::side::Side;

/// A viewpoint (x/w, y/w, z/w) with w > 0, or with w = 0 the point at infinity in direction (x, y, z).
///
/// # Exactness
/// A double is an integer times a power of two. In lattice steps each coordinate is such a number times a
/// power of ten. A negative power goes into w, so that nothing is snapped or rounded.
#[derive(Clone, Debug)]
pub struct Viewpoint {
    approx: [f64; 4],
    exact: [BigInt; 4],
}

impl Viewpoint {
    /// The viewpoint with these finite coordinates, in units of 10^`exponent` lattice steps.
    ///
    /// `exponent` is the negated pitch: 9 if a step is 10^-9 units.
    pub fn point(position: &[f64; 3], exponent: i64) -> Self {
        Self::homogeneous(position, 1.0, exponent)
    }

    /// The viewpoint infinitely far away in this direction, whose components are finite.
    pub fn direction(towards: &[f64; 3]) -> Self {
        Self::homogeneous(towards, 0.0, 0)
    }

    fn homogeneous(position: &[f64; 3], last: f64, exponent: i64) -> Self {
        let parts = [position[0], position[1], position[2], last].map(mantissa_and_exponent);
        let lowest = parts.iter().map(|(_, e)| *e).min().unwrap_or(0);
        let power = BigInt::from(10).pow(u32::try_from(exponent.unsigned_abs()).unwrap_or(0));
        let mut exact = parts.map(|(m, e)| BigInt::from(m) << (e - lowest).unsigned_abs());
        if exponent >= 0 {
            exact[..3].iter_mut().for_each(|c| *c *= &power);
        } else {
            exact[3] *= &power;
        }
        let scale = 10f64.powi(i32::try_from(exponent).unwrap_or(0));
        let [x, y, z] = position.map(|c| c * scale);
        Self {
            approx: [x, y, z, last],
            exact,
        }
    }

    /// The side of a hyperplane on which the viewpoint lies, exactly.
    pub fn side<S: Affine>(&self, cut: &S::Hyperplane) -> Side {
        let coefficients = S::approx(cut);
        let t = [0, 1, 2, 3].map(|i| coefficients[i] * self.approx[i]);
        let sum = t[0] + t[1] + t[2] + t[3];
        let size = t[0].abs() + t[1].abs() + t[2].abs() + t[3].abs();
        // Scaling rounds each coordinate twice more than FILTER allows; comparisons after an overflow or
        // underflow are false.
        if size.is_normal() && size > 1e-280 && sum.abs() > size * 2.0 * FILTER {
            return Side::from_sign(Sign::of(sum));
        }
        self.exact_side(&S::exact(cut))
    }

    fn exact_side(&self, coefficients: &[BigInt; 4]) -> Side {
        let terms = self.exact.iter().zip(coefficients);
        let value: BigInt = terms.map(|(x, n)| x * n).sum();
        Side::from_order(value.cmp(&BigInt::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_double;
    use crate::geometry::spaces::dim1::{Dim1, Direction, Point1};

    #[test]
    fn doubles_are_taken_apart_exactly() {
        for x in [0.0, 1.0, -0.1, 5e-324, f64::MAX, 1e-310] {
            let (m, e) = mantissa_and_exponent(x);
            // Two steps, since 2^-1074 is a double but 2^1074 is not.
            let half = e / 2;
            let back = as_double(m) * 2f64.powi(half) * 2f64.powi(e - half);
            assert!((back - x).abs() <= 0.0, "{x:e} became {back:e}");
        }
    }

    #[test]
    fn a_double_next_to_a_lattice_point_is_not_on_it() {
        // 0.1 as a double is above a tenth, its predecessor below.
        let tenth = Point1::new(100_000_000, Direction::Below);
        let side = |x: f64| Viewpoint::point(&[x, 0.0, 0.0], 9).side::<Dim1>(&tenth);
        assert_eq!(side(0.1), Side::Plus);
        assert_eq!(side(f64::from_bits(0.1f64.to_bits() - 1)), Side::Minus);
        let half = Point1::new(500_000_000, Direction::Below);
        assert_eq!(Viewpoint::point(&[0.5; 3], 9).side::<Dim1>(&half), Side::On);
        let coarse = Point1::new(5, Direction::Above);
        let far = Viewpoint::point(&[5000.0, 0.0, 0.0], -3);
        assert_eq!(far.side::<Dim1>(&coarse), Side::On);
    }

    #[test]
    fn directions_have_no_place() {
        let cut = Point1::new(i64::from(i32::MAX), Direction::Below);
        let right = Viewpoint::direction(&[1e-300, 0.0, 0.0]);
        assert_eq!(right.side::<Dim1>(&cut), Side::Plus);
        assert_eq!(
            right.side::<Dim1>(&Dim1::axis_cut(0, 7).unwrap()),
            Side::Plus
        );
    }
}
