//! Exact rational numbers and volumes for tests.

use std::cmp::Ordering;

use bspcsg::arith::{inv_mod, mantissa_and_exponent, mul_mod, Int, P1, P2};
use bspcsg::geometry::flux::fixed::FLUX_FRACTION_BITS;
use bspcsg::geometry::vertex::Homogeneous;
use bspcsg::query::measure::{self, Fraction};
use bspcsg::tree::flux::share;
use bspcsg::tree::solid::Solid;
use num_bigint::{BigInt, Sign};
use num_integer::Integer;

/// A rational number, numerator over positive denominator, not reduced.
#[derive(Clone, Debug)]
pub struct Ratio(BigInt, BigInt);

impl Ratio {
    pub fn whole(value: i64) -> Self {
        Self(BigInt::from(value), BigInt::from(1))
    }

    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self(&self.0 * &other.1 + &other.0 * &self.1, &self.1 * &other.1)
    }

    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&Self(-&other.0, other.1.clone()))
    }

    /// The product of the number and an integer.
    #[must_use]
    pub fn times(&self, factor: i64) -> Self {
        Self(&self.0 * factor, self.1.clone())
    }
}

impl Ratio {
    pub fn of(fraction: Fraction) -> Self {
        Self(fraction.numerator, fraction.denominator)
    }

    /// A finite double as an exact ratio.
    pub fn of_double(x: f64) -> Self {
        let (mantissa, exponent) = mantissa_and_exponent(x);
        let power = BigInt::from(1) << exponent.unsigned_abs();
        match exponent {
            0.. => Self(BigInt::from(mantissa) * power, BigInt::from(1)),
            _ => Self(BigInt::from(mantissa), power),
        }
    }

    /// The absolute value of the number.
    #[must_use]
    pub fn size(&self) -> Self {
        Self(self.0.magnitude().clone().into(), self.1.clone())
    }

    pub fn is_between_zero_and_one(&self) -> bool {
        self.0.sign() != Sign::Minus && self.0 < self.1
    }

    /// The number modulo the two primes of `arith`; its denominator must not vanish there.
    pub fn residues(&self) -> [u64; 2] {
        [P1, P2].map(|p| {
            let of = |n: &BigInt| u64::try_from(n.mod_floor(&BigInt::from(p))).expect("below p");
            mul_mod(of(&self.0), inv_mod(of(&self.1), p), p)
        })
    }
}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some((&self.0 * &other.1).cmp(&(&other.0 * &self.1)))
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        &self.0 * &other.1 == &other.0 * &self.1
    }
}

/// The exact volume of a solid, after checking that the bounds cached in its nodes enclose it.
pub fn volume(solid: &Solid) -> Ratio {
    let exact = Ratio::of(measure::volume(solid).expect("a bounded solid"));
    let exponent = u32::try_from(-3 * solid.pitch().exponent()).expect("steps are not long");
    let units = (BigInt::from(6) << FLUX_FRACTION_BITS) * BigInt::from(10).pow(exponent);
    let ends = share(solid.root()).flux.ends().expect("a moderate error");
    let [low, high] = ends.map(|end| big(&end) * &exact.1);
    let middle = &exact.0 * units;
    assert!(low <= middle && middle <= high, "the flux misses {exact:?}");
    exact
}

/// Six times the volume of the tetrahedron between the origin and three points.
pub fn sixfold_volume(corners: [&Homogeneous; 3]) -> Ratio {
    let [a, b, c] = corners.map(|h| h.x.map(|x| big(&x)));
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    let value = &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1);
    let weight = corners.iter().fold(BigInt::from(1), |w, h| w * big(&h.w));
    Ratio(value, weight)
}

fn big<const N: usize>(value: &Int<N>) -> BigInt {
    let sign = if value.is_negative() {
        Sign::Minus
    } else {
        Sign::Plus
    };
    let size = value.abs();
    let bytes: Vec<u8> = size.limbs().iter().flat_map(|l| l.to_le_bytes()).collect();
    BigInt::from_bytes_le(sign, &bytes)
}
