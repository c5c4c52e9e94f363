//! Exact sums.

use bspcsg::arith::Int;
use bspcsg::geometry::vertex::Homogeneous;
use bspcsg::query::measure;
use bspcsg::tree::solid::Solid;
use num_bigint::{BigInt, Sign};

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

    /// This many times the number.
    #[must_use]
    pub fn times(&self, factor: i64) -> Self {
        Self(&self.0 * factor, self.1.clone())
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        &self.0 * &other.1 == &other.0 * &self.1
    }
}

/// The exact volume.
pub fn volume(solid: &Solid) -> Ratio {
    let volume = measure::volume(solid).expect("a bounded solid");
    Ratio(volume.numerator, volume.denominator)
}

/// Six times the volume of the tetrahedron from the origin to three points.
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
