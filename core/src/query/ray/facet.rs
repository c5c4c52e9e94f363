//! Decides in integers where a ray meets a facet.
//!
//! Notation: v₀ … are the facet's corners relative to the ray's origin, d is the direction. By Cramer's rule
//! the ray meets the facet's hyperplane at s = det(v) / Σ wᵢ, where wᵢ = det(v with vᵢ replaced by d), and
//! the wᵢ are the barycentric weights of that point. Facets are closed: the ray meets them where no two
//! weights have opposite signs. Σ wᵢ is d times the facet's normal, which points to the right of a segment
//! and follows the right-hand rule for a triangle.

use super::bounds::{DENOMINATOR_LIMBS, NUMERATOR_LIMBS, WEIGHT_LIMBS};
use super::line::Ray;
use super::ratio::Ratio;
use crate::arith::{Int, Sign};

/// The corners of a facet: a point in 1D, a segment in 2D, a triangle in 3D.
pub type Facet<const D: usize> = [[f64; D]; D];

/// The corners of a facet relative to a ray's origin, in lattice steps.
pub type Corners<const D: usize> = [[i64; D]; D];

type Weight = Int<DENOMINATOR_LIMBS>;

/// The first point, exactly, at which a ray meets a facet.
#[derive(Clone, Debug)]
pub struct Meeting<const D: usize> {
    /// The parameter along the ray, not negative.
    pub at: Ratio,
    /// The last parameter at which the ray is on the facet: `at`, unless the ray runs in its hyperplane.
    pub until: Ratio,
    /// The barycentric weights, not negative; their sum is positive.
    pub weights: [Int<WEIGHT_LIMBS>; D],
}

/// Returns the corners of a facet relative to a ray's origin.
#[inline]
pub fn relative<const D: usize>(ray: &Ray<D>, facet: &[[f64; D]; D]) -> Corners<D> {
    let mut v = [[0; D]; D];
    for (v, corner) in v.iter_mut().zip(facet) {
        for i in 0..D {
            // Corners are lattice points, which doubles hold exactly.
            v[i] = corner[i] as i64 - ray.origin()[i];
        }
    }
    v
}

/// Returns the first point at which a ray meets a closed facet; `None` if it does not.
pub fn meet<const D: usize>(ray: &Ray<D>, facet: &[[f64; D]; D]) -> Option<Meeting<D>> {
    let v = relative(ray, facet);
    let weights = weights(&v, ray.direction());
    let sum = total(&weights);
    match sum.sign() {
        Sign::Zero => meet_within(&v, ray.direction()),
        sign => meet_across(&v, weights.map(|w| sign.times(w)), sign.times(sum), sign),
    }
}

fn meet_across<const D: usize>(
    v: &Corners<D>,
    weights: [Weight; D],
    sum: Weight,
    sign: Sign,
) -> Option<Meeting<D>> {
    let height = sign.times(determinant(v));
    if height.is_negative() || weights.iter().any(Int::is_negative) {
        return None;
    }
    let at = Ratio::new(height, sum);
    let weights = weights.map(|w| w.widen());
    Some(Meeting {
        at,
        until: at,
        weights,
    })
}

/// Returns the parameter at which a ray's line, shifted by (ε, ε², ε³), crosses a facet, and in which
/// direction; `None` if it does not.
///
/// The shifted line meets no edge and no vertex, and runs in no facet, so that the signs along it add up to
/// winding numbers. The parameter is the limit for ε → 0 and can be negative.
pub fn cross<const D: usize>(ray: &Ray<D>, facet: &[[f64; D]; D]) -> Option<(Ratio, Sign)> {
    let v = relative(ray, facet);
    let weights = weights(&v, ray.direction());
    let sum = total(&weights);
    let sign = sum.sign();
    let inside = |i: usize| match weights[i].sign() {
        Sign::Zero => shifted_sign(&v, ray.direction(), i) == sign,
        other => other == sign,
    };
    (sign != Sign::Zero && (0..D).all(inside)).then(|| (Ratio::new(determinant(&v), sum), sign))
}

fn total<const D: usize>(weights: &[Weight; D]) -> Weight {
    weights.iter().fold(Int::ZERO, |sum, w| sum + *w)
}

fn weights<const D: usize>(v: &Corners<D>, d: &[i128; D]) -> [Weight; D] {
    std::array::from_fn(|i| match D {
        1 => Int::from_i128(d[0]),
        2 if i == 0 => planar(d[0], d[1], v[1][0], v[1][1]).widen(),
        2 => -planar(d[0], d[1], v[0][0], v[0][1]).widen(),
        _ => {
            let n = normal(&v[(i + 1) % D], &v[(i + 2) % D]);
            (0..3).fold(Int::ZERO, |sum, k| sum + product(d[k], n[k]))
        }
    })
}

/// The cross product d × v in the plane.
fn planar(dx: i128, dy: i128, x: i64, y: i64) -> Int<NUMERATOR_LIMBS> {
    let product = |a: i128, b: i64| Int::<2>::from_i128(a).mul_i64::<NUMERATOR_LIMBS>(b);
    product(dx, y) - product(dy, x)
}

fn product(a: i128, b: i128) -> Weight {
    Int::<2>::from_i128(a).mul_i128(b)
}

/// The cross product of two corners relative to a ray's origin.
fn normal<const D: usize>(a: &[i64; D], b: &[i64; D]) -> [i128; 3] {
    [0, 1, 2].map(|k| minor(a, b, (k + 1) % 3, (k + 2) % 3))
}

fn minor<const D: usize>(a: &[i64; D], b: &[i64; D], i: usize, j: usize) -> i128 {
    i128::from(a[i]) * i128::from(b[j]) - i128::from(a[j]) * i128::from(b[i])
}

fn determinant<const D: usize>(v: &Corners<D>) -> Int<NUMERATOR_LIMBS> {
    match D {
        1 => Int::from_i64(v[0][0]),
        2 => Int::from_i128(minor(&v[0], &v[1], 0, 1)),
        _ => {
            let n = normal(&v[1], &v[2]);
            let term = |k: usize| Int::<2>::from_i128(n[k]).mul_i64(v[0][k]);
            (0..3).fold(Int::ZERO, |sum, k| sum + term(k))
        }
    }
}

/// Returns the sign that a zero weight of a corner gets when the origin moves by (ε, ε², ε³).
///
/// In space the weight w = d · (a × b), with the opposite edge from a to b, grows by ε⃗ · ((a − b) × d); in
/// the plane w₀ = d × b and w₁ = a × d, which grow by ∓ d × ε⃗.
fn shifted_sign<const D: usize>(v: &Corners<D>, d: &[i128; D], i: usize) -> Sign {
    match D {
        1 => Sign::Positive,
        2 => {
            let first = if d[1] == 0 { -d[0] } else { d[1] };
            Sign::of(if i == 0 { first } else { -first })
        }
        _ => {
            let (a, b) = (&v[(i + 1) % D], &v[(i + 2) % D]);
            let edge: [i64; 3] = [0, 1, 2].map(|k| a[k] - b[k]);
            let part = |k: usize| {
                let (p, q) = ((k + 1) % 3, (k + 2) % 3);
                -planar(d[p], d[q], edge[p], edge[q]).sign()
            };
            Sign::first((0..3).map(part))
        }
    }
}

/// A corner's weight along a ray in the facet's hyperplane: value + s · slope, at least 0 on the facet.
struct Rim {
    value: Int<NUMERATOR_LIMBS>,
    slope: Int<NUMERATOR_LIMBS>,
}

impl Rim {
    fn zero(&self) -> Ratio {
        Ratio::new(-self.value, self.slope.widen())
    }

    fn weight(&self, at: &Ratio) -> Int<WEIGHT_LIMBS> {
        let still: Int<WEIGHT_LIMBS> = self.value.mul(at.denominator());
        let moved: Int<WEIGHT_LIMBS> = self.slope.mul(at.numerator());
        still + moved
    }
}

/// Returns the first point of a facet on a ray parallel to it; `None` unless the ray runs in its hyperplane.
fn meet_within<const D: usize>(v: &Corners<D>, d: &[i128; D]) -> Option<Meeting<D>> {
    if !determinant(v).is_zero() {
        return None;
    }
    let rims = match D {
        2 => segment_rims(v, d),
        _ => triangle_rims(v, d),
    };
    let (at, until) = stretch(&rims)?;
    let weights = std::array::from_fn(|i| rims[i].weight(&at));
    Some(Meeting { at, until, weights })
}

/// Returns the first and last parameters, from 0 on, at which all weights are non-negative; `None` if none
/// is.
fn stretch<const D: usize>(rims: &[Rim; D]) -> Option<(Ratio, Ratio)> {
    let (mut from, mut until) = (Ratio::ZERO, None::<Ratio>);
    for rim in rims {
        match rim.slope.sign() {
            Sign::Zero if rim.value.is_negative() => return None,
            Sign::Zero => {}
            Sign::Positive => from = from.max(rim.zero()),
            Sign::Negative => until = Some(until.map_or(rim.zero(), |u| u.min(rim.zero()))),
        }
    }
    // The weights add up to a constant, so one of them decreases along the ray.
    until.filter(|u| from <= *u).map(|u| (from, u))
}

/// The weights of a segment's ends along an axis to which the ray is not perpendicular.
fn segment_rims<const D: usize>(v: &Corners<D>, d: &[i128; D]) -> [Rim; D] {
    let k = usize::from(d[0] == 0) % D;
    let (from, to) = (v[0][k], v[1 % D][k]);
    let sign = Sign::from_order(to.cmp(&from));
    std::array::from_fn(|i| {
        let (value, slope) = if i == 0 { (to, -d[k]) } else { (-from, d[k]) };
        Rim {
            value: sign.times(Int::from_i64(value)),
            slope: sign.times(Int::from_i128(slope)),
        }
    })
}

/// The weights of a triangle's corners in the projection along the main axis of its normal.
fn triangle_rims<const D: usize>(v: &Corners<D>, d: &[i128; D]) -> [Rim; D] {
    let [a, b, c]: [[i64; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|k| v[i % D][k % D]));
    let edge = |p: [i64; 3]| [0, 1, 2].map(|k| p[k] - a[k]);
    let n = normal(&edge(b), &edge(c));
    let axis = (0..3).max_by_key(|k| n[*k].unsigned_abs()).unwrap_or(0);
    let (p, q) = ((axis + 1) % 3 % D, (axis + 2) % 3 % D);
    let sign = Sign::of(n[axis]);
    std::array::from_fn(|i| {
        let (a, b) = (&v[(i + 1) % D], &v[(i + 2) % D]);
        let slope = planar(d[p], d[q], a[p] - b[p], a[q] - b[q]);
        Rim {
            value: sign.times(Int::from_i128(minor(a, b, p, q))),
            slope: sign.times(slope),
        }
    })
}
