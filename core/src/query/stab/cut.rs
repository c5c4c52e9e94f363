//! The point at which a ray crosses a hyperplane: in doubles if they suffice to choose children, else
//! exactly.

use super::cast::Cast;
use crate::arith::{Filtered, Int, Sign};
use crate::geometry::side::{Half, Side};
use crate::query::ray::filter::{Depth, ROUNDING};
use crate::query::ray::Ray;

/// The relative error of a sum of four products of factors with two roundings each.
const FILTER: f64 = 12.0 * ROUNDING;

/// A hyperplane with its coefficients as exact integers and as doubles.
#[derive(Clone, Debug)]
pub struct Cut<const D: usize> {
    normal: [i128; D],
    offset: Int<3>,
    near: [f64; D],
    near_offset: f64,
}

/// The position of a ray relative to a hyperplane.
#[derive(Clone, Copy, Debug)]
pub enum Stab {
    /// The ray stays on one side of the hyperplane, or runs in it (`On`).
    Beside(Side),
    /// The ray's line crosses the hyperplane.
    Through {
        /// The depth of the crossing, along the ray's main axis, in lattice steps.
        depth: Depth,
        /// True if the line goes from the minus to the plus side.
        rising: bool,
    },
}

impl<const D: usize> Cut<D> {
    /// Converts the hyperplane of a space.
    pub fn of<S: Cast<D>>(cut: &S::Hyperplane) -> Self {
        let (normal, offset) = S::coefficients(cut);
        Self {
            normal,
            offset,
            near: normal.map(|c| c as f64),
            near_offset: offset.to_f64(),
        }
    }

    /// Normal n and offset c of the hyperplane n·x + c = 0.
    pub fn coefficients(&self) -> ([i128; D], Int<3>) {
        (self.normal, self.offset)
    }

    /// Returns the side of the hyperplane on which all corners of a facet lie; `Doubtful` if they lie on both
    /// sides, or if doubles cannot decide.
    #[inline]
    pub fn half(&self, facet: &[[f64; D]; D]) -> Filtered<Half> {
        let mut sides = [false; 2];
        for corner in facet {
            let (mut value, mut size) = (self.near_offset, self.near_offset.abs());
            for (c, normal) in corner.iter().zip(&self.near) {
                value += c * normal;
                size += (c * normal).abs();
            }
            if value.abs() <= size * FILTER {
                return Filtered::Doubtful;
            }
            sides[usize::from(value > 0.0)] = true;
        }
        match sides {
            [true, false] => Filtered::Certain(Half::Minus),
            [false, true] => Filtered::Certain(Half::Plus),
            _ => Filtered::Doubtful,
        }
    }

    /// Returns the position of a ray relative to the hyperplane.
    #[inline]
    pub fn stab(&self, ray: &Ray<D>) -> Stab {
        let near = &ray.near;
        let rise = |k: usize| self.near[k] * near.shear[k] * near.heading;
        let term = |k: usize| self.near[k] * near.origin[k];
        let slope: f64 = (0..D).map(rise).sum();
        let slack: f64 = (0..D).map(|k| rise(k).abs()).sum::<f64>() * FILTER;
        if slope.abs() <= 4.0 * slack {
            return self.exact_stab(ray);
        }
        let value: f64 = (0..D).map(term).sum::<f64>() + self.near_offset;
        let size = (0..D).map(|k| term(k).abs()).sum::<f64>() + self.near_offset.abs();
        let z = -value / slope;
        // The relative error of the slope is less than a quarter.
        let error = (size * FILTER + z.abs() * slack) / slope.abs() * 2.0 + z.abs() * FILTER;
        let depth = Depth { z, error };
        let rising = slope > 0.0;
        Stab::Through { depth, rising }
    }

    #[cold]
    fn exact_stab(&self, ray: &Ray<D>) -> Stab {
        let rise = |k: usize| Int::<2>::from_i128(self.normal[k]).mul_i128(ray.direction()[k]);
        let term = |k: usize| Int::<2>::from_i128(self.normal[k]).mul_i64(ray.origin()[k]);
        let slope: Int<4> = (0..D).fold(Int::ZERO, |sum, k| sum + rise(k));
        let value: Int<3> = (0..D).fold(self.offset, |sum, k| sum + term(k));
        if slope.is_zero() {
            return Stab::Beside(Side::from_sign(value.sign()));
        }
        let lead = ray.direction()[ray.near.main].unsigned_abs() as f64;
        let z = -value.to_f64() / slope.to_f64() * lead;
        let error = z.abs() * FILTER;
        Stab::Through {
            depth: Depth { z, error },
            rising: slope.sign() == Sign::Positive,
        }
    }
}
