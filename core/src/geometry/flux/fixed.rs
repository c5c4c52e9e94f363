//! Points in fixed-point binary, and the flux of the field (0, 0, z) through polygons of such points.
//!
//! Clipping polygons to cells exactly is expensive, and only a sum over all of them is needed. So corners are
//! rounded to a small fraction of a lattice step, and each result has an error bound.

use smallvec::SmallVec;

use crate::arith::convert::{as_double, as_wide, low_limb};
use crate::arith::Int;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;

/// The number of binary fraction digits of a coordinate in lattice steps. Coordinates are below 2^54 steps,
/// so a sum of three fits an `i128`.
pub const FRACTION_BITS: u32 = 72;

/// A point in fixed-point binary: coordinates in units of 2^-`FRACTION_BITS` lattice steps.
pub type Fixed = [i128; 3];

/// The corners of a closed polygon, in order.
pub type FixedPolygon = SmallVec<[Fixed; 12]>;

/// Six times the flux of the field (0, 0, z) through a surface, in units of 2^-152 cubic lattice steps, with
/// a bound on its error.
///
/// # Bits
/// A triangle's flux is below 2^165 cubic steps; 66 bits are left for sums of them.
#[derive(Clone, Copy, Debug)]
pub struct Flux {
    /// Six times the flux, rounded.
    pub value: Int<6>,
    /// A bound on the difference between `value` and six times the exact flux.
    pub error: f64,
}

/// The number of binary fraction digits of a [`Flux`] in cubic lattice steps: three times `FRACTION_BITS`
/// less one limb.
pub const FLUX_FRACTION_BITS: u32 = 3 * FRACTION_BITS - 64;

impl Flux {
    /// The exact flux zero.
    pub const ZERO: Self = Self {
        value: Int::ZERO,
        error: 0.0,
    };

    /// The lower and the upper end of the interval that contains the exact value, by the error bound; `None`
    /// if the bound is not finite.
    pub fn ends(&self) -> Option<[Int<6>; 2]> {
        let in_limbs = |k: u8| self.error * 2f64.powi(-64 * i32::from(k));
        let limbs = (0..4).find(|k| in_limbs(*k) < 2f64.powi(100))?;
        let rounded = (as_wide(in_limbs(limbs)) + 1).cast_unsigned();
        let limbs = usize::from(limbs);
        let mut error = [0; 6];
        error[limbs] = low_limb(rounded);
        error[limbs + 1] = (rounded >> 64) as u64;
        let error = Int::from_limbs(error);
        Some([self.value - error, self.value + error])
    }

    /// Adds another flux, or subtracts it if the orientation is `Opposite`; the errors add up in either case.
    pub fn add(&mut self, other: &Self, orientation: Orientation) {
        match orientation {
            Orientation::Same => self.value += other.value,
            Orientation::Opposite => self.value -= other.value,
        }
        self.error += other.error;
    }
}

/// A lattice point in fixed-point binary; exact.
pub fn of_lattice(p: &Lattice) -> Fixed {
    p.map(|c| i128::from(c) << FRACTION_BITS)
}

/// An exact point in fixed-point binary, each coordinate within `slack` of the exact one.
pub fn of_vertex(vertex: &Vertex) -> Fixed {
    if let Some(p) = vertex.as_lattice() {
        return of_lattice(p);
    }
    let h = vertex.coordinates();
    let near = vertex.approx();
    each_axis(|i| fixed_coordinate(&h.x[i], &h.w, near[i]))
}

/// The quotient x / w in units of 2^-`FRACTION_BITS`, improved from a double that is off by a few units in
/// its last place.
///
/// Uses the leading 120 bits of w, and drops as many bits of x as of w: an error of 2^-119 of the quotient.
fn fixed_coordinate(x: &Int<6>, w: &Int<6>, near: f64) -> i128 {
    let shift = w.bit_length().saturating_sub(120).cast_signed();
    let divisor: Int<2> = shifted_down(w, shift);
    let dividend: Int<4> = shifted_down(x, shift - FRACTION_BITS.cast_signed());
    let first = as_wide(near * UNIT);
    let rest = dividend - divisor.mul_i128(first);
    first + as_wide(rest.to_f64() / divisor.to_f64())
}

/// The integer divided by 2^shift and rounded down, in `N` limbs, which must suffice.
fn shifted_down<const N: usize>(number: &Int<6>, shift: i32) -> Int<N> {
    let sign = if number.is_negative() { u64::MAX } else { 0 };
    let limb = |i: i32| match usize::try_from(i) {
        Ok(i) => number.limbs().get(i).copied().unwrap_or(sign),
        Err(_) => 0,
    };
    let (mut at, offset) = (shift.div_euclid(64), shift.rem_euclid(64));
    Int::from_limbs(std::array::from_fn(|_| {
        let pair = u128::from(limb(at + 1)) << 64 | u128::from(limb(at));
        at += 1;
        low_limb(pair >> offset)
    }))
}

/// The number of units of 2^-`FRACTION_BITS` in a lattice step.
#[allow(clippy::cast_precision_loss, reason = "a small constant")]
const UNIT: f64 = (1u128 << FRACTION_BITS) as f64;

/// The quotient n / d in units of 2^-`FRACTION_BITS`, by two steps of long division in doubles.
fn fraction(n: i128, d: i128) -> i128 {
    if n.unsigned_abs() >= 1 << 104 || d.unsigned_abs() >= 1 << 120 {
        return long_fraction(&Int::from_i128(n), d);
    }
    let first = as_wide(as_double(n) / as_double(d) * UNIT);
    // The remainder is 2^-50 of the numerator, so it fits; overflow cancels.
    let rest = (n << FRACTION_BITS).wrapping_sub(first.wrapping_mul(d));
    first.saturating_add(as_wide(as_double(rest) / as_double(d)))
}

fn long_fraction(n: &Int<3>, d: i128) -> i128 {
    quotient(
        &n.mul_i128::<5>(1 << FRACTION_BITS),
        &Int::<2>::from_i128(d),
        |q| Int::<2>::from_i128(q).mul_i128(d),
    )
}

/// The quotient n / d, by two steps of long division in doubles; `times` is a function that multiplies an
/// integer by d.
fn quotient<const N: usize, const M: usize>(
    n: &Int<N>,
    d: &Int<M>,
    times: impl Fn(i128) -> Int<N>,
) -> i128 {
    let reciprocal = 1.0 / d.to_f64();
    let first = as_wide(n.to_f64() * reciprocal);
    let rest = *n - times(first);
    first.saturating_add(as_wide(rest.to_f64() * reciprocal))
}

/// A bound on the error of a coordinate that is a quotient of at most `size` in magnitude, in units of
/// 2^-`FRACTION_BITS`.
///
/// The first step of the division leaves an error of 2^-50 of the quotient, the second step 2^-50 of this
/// error, and the final rounding adds 1.
fn slack(size: f64) -> f64 {
    1.0 + size * 2f64.powi(-99)
}

/// The positions of a cell's six walls: for each axis the low wall, then the high one.
#[derive(Clone, Copy, Debug)]
pub struct Walls {
    /// The coordinates of the walls in half lattice steps.
    doubled: [i64; 6],
    /// The coordinates of the walls in units of 2^-`FRACTION_BITS` steps.
    at: [i128; 6],
}

impl Walls {
    /// The walls of a cell, half a step outside its lattice points.
    pub fn of(cell: &Cell) -> Self {
        let (low, high) = (cell.low(), cell.high());
        let doubled = std::array::from_fn(|wall| match wall % 2 {
            0 => 2 * low[wall / 2] - 1,
            _ => 2 * high[wall / 2] + 1,
        });
        Self {
            doubled,
            at: doubled.map(|half| i128::from(half) << (FRACTION_BITS - 1)),
        }
    }

    /// Return how far a lattice point lies outside a wall, in half steps; negative for points inside.
    pub fn half_steps_outside(&self, wall: usize, p: &Lattice) -> i64 {
        let over = 2 * p[wall / 2] - self.doubled[wall];
        if wall.is_multiple_of(2) {
            -over
        } else {
            over
        }
    }

    /// Return how far a point lies outside a wall, in units of 2^-`FRACTION_BITS` steps; negative for points
    /// inside.
    fn distance_outside(&self, wall: usize, p: &Fixed) -> i128 {
        let over = p[wall / 2] - self.at[wall];
        if wall.is_multiple_of(2) {
            -over
        } else {
            over
        }
    }

    /// Return whether all points lie inside all walls, or on them.
    pub fn contain<'a>(&self, mut points: impl Iterator<Item = &'a Fixed>) -> bool {
        points.all(|p| (0..6).all(|wall| self.distance_outside(wall, p) <= 0))
    }

    /// Return whether a point certainly lies inside all walls; its doubles may be off by a few units in the
    /// last place.
    pub fn surely_contain(&self, near: &[f64; 3]) -> bool {
        (0..3).all(|i| {
            let [low, high] = [2 * i, 2 * i + 1].map(|wall| as_double(self.doubled[wall]) / 2.0);
            let doubt = 2f64.powi(-48) * (near[i].abs() + low.abs() + high.abs());
            low + doubt <= near[i] && near[i] <= high - doubt
        })
    }

    /// Clips a polygon to the inside of the cell; returns the number of walls that cut it.
    pub fn clip(&self, ring: &mut FixedPolygon) -> u32 {
        let mut cuts = 0;
        for wall in 0..6 {
            if ring.iter().any(|p| self.distance_outside(wall, p) > 0) {
                *ring = self.inner(ring, wall);
                cuts += 1;
            }
        }
        cuts
    }

    /// The part of a polygon on the inner side of a wall.
    fn inner(&self, ring: &FixedPolygon, wall: usize) -> FixedPolygon {
        let mut kept = FixedPolygon::new();
        for (i, p) in ring.iter().enumerate() {
            let q = &ring[(i + 1) % ring.len()];
            let (a, b) = (
                self.distance_outside(wall, p),
                self.distance_outside(wall, q),
            );
            if a <= 0 {
                kept.push(*p);
            }
            if (a < 0 && b > 0) || (a > 0 && b < 0) {
                kept.push(crossing(p, q, wall / 2, self.at[wall]));
            }
        }
        kept
    }
}

/// Return the point in which an edge, with one end on each side of a wall across `axis`, meets the wall.
///
/// The result does not depend on the direction of the edge, so that the two polygons at an edge agree.
fn crossing(p: &Fixed, q: &Fixed, axis: usize, wall: i128) -> Fixed {
    let (p, q) = if p[axis] < q[axis] { (p, q) } else { (q, p) };
    let run = Int::<2>::from_i128(q[axis] - p[axis]);
    let part = wall - p[axis];
    let mut at = *p;
    at[axis] = wall;
    for i in [(axis + 1) % 3, (axis + 2) % 3] {
        let rise = Int::<2>::from_i128(q[i] - p[i]);
        if !rise.is_zero() {
            at[i] += quotient(&rise.mul_i128::<4>(part), &run, |k| run.mul_i128(k));
        }
    }
    at
}

/// A lattice triangle to be cut by the walls of cells.
///
/// Each new corner is computed from the triangle's own corners and walls, so that errors do not add.
#[derive(Debug)]
pub struct Triangle<'a> {
    corners: &'a [Lattice; 3],
    normal: [i128; 3],
}

/// A corner of a clipped triangle, and the number of the line that carries the edge from this corner on: 0 to
/// 2 is the triangle's edge from that corner; 3 + k is wall k of the cell.
type CarriedCorner = (Fixed, usize);

impl<'a> Triangle<'a> {
    /// A triangle with its normal, whose components may have a common divisor.
    pub fn new(corners: &'a [Lattice; 3], normal: [i128; 3]) -> Self {
        Self { corners, normal }
    }

    /// The part of the triangle inside a cell, as corners; `None` if it has no area.
    pub fn clipped(&self, walls: &Walls) -> Option<FixedPolygon> {
        let mut ring: SmallVec<[CarriedCorner; 12]> =
            (0..3).map(|i| (of_lattice(&self.corners[i]), i)).collect();
        let mut spare = SmallVec::new();
        for wall in 0..6 {
            let beyond = |p: &&Lattice| walls.half_steps_outside(wall, p) > 0;
            match self.corners.iter().filter(beyond).count() {
                0 => {}
                3 => return None,
                _ => {
                    self.cut(&ring, walls, wall, &mut spare);
                    std::mem::swap(&mut ring, &mut spare);
                }
            }
        }
        (ring.len() >= 3).then(|| ring.into_iter().map(|c| c.0).collect())
    }

    fn cut(
        &self,
        ring: &[CarriedCorner],
        walls: &Walls,
        wall: usize,
        kept: &mut SmallVec<[CarriedCorner; 12]>,
    ) {
        kept.clear();
        for (i, p) in ring.iter().enumerate() {
            let q = &ring[(i + 1) % ring.len()];
            let (a, b) = (
                walls.distance_outside(wall, &p.0),
                walls.distance_outside(wall, &q.0),
            );
            if a <= 0 {
                kept.push((p.0, if a == 0 && b > 0 { 3 + wall } else { p.1 }));
            }
            if (a < 0 && b > 0) || (a > 0 && b < 0) {
                let at = self.crossing(p, &q.0, walls, wall);
                kept.push((at, if b > 0 { 3 + wall } else { p.1 }));
            }
        }
    }

    /// Return the point in which the edge between two corners of a clipped triangle meets a wall; the ends
    /// lie on different sides.
    fn crossing(&self, from: &CarriedCorner, to: &Fixed, walls: &Walls, wall: usize) -> Fixed {
        let axis = wall / 2;
        let mut at = from.0;
        at[axis] = walls.at[wall];
        for i in [(axis + 1) % 3, (axis + 2) % 3] {
            let exact = match from.1.checked_sub(3) {
                None => Some(self.on_edge(from.1, i, walls, wall)),
                Some(other) if other / 2 == i => None,
                Some(other) => self.on_walls(i, walls, [wall, other]),
            };
            let (low, high) = (from.0[i].min(to[i]), from.0[i].max(to[i]));
            at[i] = exact.unwrap_or(from.0[i]).clamp(low, high);
        }
        at
    }

    /// The coordinate along `axis` of the point in which an edge of the triangle meets a wall, in units of
    /// 2^-`FRACTION_BITS` steps.
    fn on_edge(&self, edge: usize, axis: usize, walls: &Walls, wall: usize) -> i128 {
        let (a, b) = (&self.corners[edge], &self.corners[(edge + 1) % 3]);
        let across = wall / 2;
        let run = 2 * i128::from(b[across] - a[across]);
        let part = i128::from(walls.doubled[wall] - 2 * a[across]);
        let rise = i128::from(b[axis] - a[axis]);
        (i128::from(a[axis]) << FRACTION_BITS) + fraction(rise * part, run)
    }

    /// The coordinate along `axis` of the point in which the triangle's plane meets two walls across the
    /// other axes; `None` if the plane is parallel to `axis` or the coordinate overflows.
    fn on_walls(&self, axis: usize, walls: &Walls, pair: [usize; 2]) -> Option<i128> {
        let a = &self.corners[0];
        let divisor = 2 * self.normal[axis];
        let [p, q] = pair.map(|wall| {
            let across = wall / 2;
            let part = walls.doubled[wall] - 2 * a[across];
            (self.normal[across], i128::from(part))
        });
        if divisor == 0 {
            return None;
        }
        let short = |n: i128| n.unsigned_abs() < 1 << 64;
        let offset = if short(p.0) && short(q.0) {
            fraction(p.0 * p.1 + q.0 * q.1, divisor)
        } else {
            let product = |(n, part): (i128, i128)| Int::<2>::from_i128(n).mul_i128::<3>(part);
            long_fraction(&(product(p) + product(q)), divisor)
        };
        (i128::from(a[axis]) << FRACTION_BITS).checked_sub(offset)
    }
}

/// Six times the flux of (0, 0, z) through the triangle with these corners, in units of
/// 2^-[`FLUX_FRACTION_BITS`] cubic steps.
pub fn through(a: &Fixed, b: &Fixed, c: &Fixed) -> Int<6> {
    let product = |x: i128, y: i128| -> Int<4> { Int::<2>::from_i128(x).mul_i128(y) };
    let area = product(b[0] - a[0], c[1] - a[1]) - product(c[0] - a[0], b[1] - a[1]);
    over_limb(&area.mul_i128(a[2] + b[2] + c[2]))
}

/// The integer divided by 2^64 and rounded down.
pub fn over_limb(number: &Int<6>) -> Int<6> {
    let mut limbs = [if number.is_negative() { u64::MAX } else { 0 }; 6];
    limbs[..5].copy_from_slice(&number.limbs()[1..]);
    Int::from_limbs(limbs)
}

/// Six times the flux of (0, 0, z) through a polygon, in units of 2^-[`FLUX_FRACTION_BITS`] cubic steps.
pub fn flux_through_ring(ring: &FixedPolygon) -> Int<6> {
    let mut sum = Int::ZERO;
    for i in 2..ring.len() {
        sum += through(&ring[0], &ring[i - 1], &ring[i]);
    }
    sum
}

/// Six times the flux of (0, 0, z) through a lattice triangle, in cubic lattice steps; exact.
///
/// # Example
/// ```
/// use bspcsg::arith::Int;
/// use bspcsg::geometry::flux::fixed::sixfold_flux;
///
/// // Through a closed surface it is six times the volume: that of this corner of a cube is 1/6.
/// let places = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
/// let mut sum = Int::ZERO;
/// for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
///     sum += sixfold_flux(&face.map(|v: usize| places[v]));
/// }
/// assert_eq!(sum, Int::ONE);
/// ```
pub fn sixfold_flux(corners: &[Lattice; 3]) -> Int<4> {
    let height = corners[0][2] + corners[1][2] + corners[2][2];
    Int::<2>::from_i128(minor(corners, 0, 1)).mul_i64(height)
}

/// The component of a triangle's normal along the axis after `u` and `v`, in lattice steps: twice the area of
/// its projection.
pub fn minor(corners: &[Lattice; 3], u: usize, v: usize) -> i128 {
    let [a, b, c] = corners;
    let d = |p: &Lattice, i: usize| i128::from(p[i] - a[i]);
    d(b, u) * d(c, v) - d(c, u) * d(b, v)
}

/// A whole number of cubic lattice steps in the units of a [`Flux`], 2^-[`FLUX_FRACTION_BITS`] cubic steps.
pub fn from_cubic_steps(whole: &Int<4>) -> Int<6> {
    let high: Int<4> = whole.mul_i64(1 << (FLUX_FRACTION_BITS - 128));
    let mut limbs = [0; 6];
    limbs[2..].copy_from_slice(high.limbs());
    Int::from_limbs(limbs)
}

/// The largest distance of points from the origin along an axis, and the largest extent of their box along an
/// axis; in units of 2^-`FRACTION_BITS` lattice steps.
#[derive(Clone, Copy, Debug)]
pub struct CoordinateExtent {
    size: f64,
    extent: f64,
}

impl CoordinateExtent {
    /// Computes the largest coordinate, in magnitude, of points in fixed-point binary, and the largest extent
    /// of their box.
    pub fn of(points: &[Fixed]) -> Self {
        let mut low = [i128::MAX; 3];
        let mut high = [i128::MIN; 3];
        for p in points {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let size = (0..3).map(|i| low[i].unsigned_abs().max(high[i].unsigned_abs()));
        let extent = (0..3).map(|i| high[i].abs_diff(low[i]));
        Self {
            size: as_double(size.max().unwrap_or(0)),
            extent: as_double(extent.max().unwrap_or(0)),
        }
    }

    /// Computes the largest coordinate, in magnitude, of the corners of a lattice triangle, and the largest
    /// extent of the triangle's box.
    pub fn of_triangle(corners: &[Lattice; 3]) -> Self {
        let size = corners.iter().flatten().map(|c| c.unsigned_abs()).max();
        let spread = |i: usize| {
            let c = corners.map(|p| p[i]);
            c.iter().max().unwrap_or(&0) - c.iter().min().unwrap_or(&0)
        };
        Self {
            size: as_double(size.unwrap_or(0)) * UNIT,
            extent: as_double(spread(0).max(spread(1)).max(spread(2))) * UNIT,
        }
    }

    /// A bound on the error of six times the flux through a polygon of such points whose corners were rounded
    /// and cut `rounds` times in all; `slope` bounds |z| / |(x, y)| of its plane's normal.
    ///
    /// With corners off by s, coordinates up to Z and extents up to L, each of n fan triangles errs by at
    /// most s (24 Z L + 6 L²). Where a wall z = c cuts the polygon, the edge is off by s (1 + slope), and the
    /// strip beside it counts with 6 Z; the field has no flux through walls across x or y.
    pub fn error(&self, corners: usize, rounds: u32, slope: f64) -> f64 {
        let s = slack(self.size);
        let product = (self.extent + 8.0 * s) * (self.size + self.extent) * (1.0 + slope);
        let count = as_double(corners) * f64::from(rounds);
        1.0 + 64.0 * count * s * product * 2f64.powi(-64)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn point(reach: i64) -> impl Strategy<Value = Lattice> {
        [-reach..=reach, -reach..=reach, -reach..=reach]
    }

    fn sixfold(ring: &FixedPolygon) -> f64 {
        flux_through_ring(ring).to_f64() / 2f64.powi(FLUX_FRACTION_BITS.cast_signed())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Coordinates are few, so that triangle edges often meet the edges between walls.
        #[test]
        fn triangles_clipped_from_their_corners_are_those_clipped_wall_by_wall(
            corners in [point(9), point(9), point(9)],
            [p, q] in [point(9), point(9)],
        ) {
            let low = each_axis(|i| i64::min(p[i], q[i]));
            let high = each_axis(|i| i64::max(p[i], q[i]));
            let walls = Walls::of(&Cell::around(&low, &high));
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(u, v)| minor(&corners, u, v));
            prop_assume!(normal[2] != 0);
            let once = Triangle::new(&corners, normal).clipped(&walls);
            let mut ring: FixedPolygon = corners.iter().map(of_lattice).collect();
            walls.clip(&mut ring);
            let gap = once.map_or(0.0, |ring| sixfold(&ring)) - sixfold(&ring);
            prop_assert!(gap.abs() < 1e-9, "{} apart", gap);
        }
    }
}
