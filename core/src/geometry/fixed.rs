//! Points in fixed binary places, and the flux of (0, 0, z) through polygons of them.
//!
//! Exact polygons clipped to cells are dear where only a sum over all of them is asked for. Here
//! corners are rounded to a small part of a step, and each answer comes with a bound on its error.

use smallvec::SmallVec;

use super::cell::Cell;
use super::plane::Lattice;
use super::vertex::Vertex;
use crate::arith::Int;

/// Binary places of a step. Coordinates below 2^54 steps leave a bit for sums of three.
pub const PLACES: u32 = 72;

/// A point in units of 2^-`PLACES` steps.
pub type Fixed = [i128; 3];

/// A closed polygon, its corners in order.
pub type Ring = SmallVec<[Fixed; 12]>;

/// Six times a flux, in units of 2^-152 cubic steps, and a bound on its error.
///
/// # Bits
/// A triangle's flux is below 2^165 cubic steps; 66 bits are left for sums of them.
#[derive(Clone, Copy, Debug)]
pub struct Flux {
    /// The value.
    pub value: Int<6>,
    /// How far it may be from the true one.
    pub error: f64,
}

/// Binary places of a cubic step in a [`Flux`]: three times `PLACES` less one limb.
pub const FLUX_PLACES: u32 = 3 * PLACES - 64;

impl Flux {
    /// No flux.
    pub const ZERO: Self = Self {
        value: Int::ZERO,
        error: 0.0,
    };

    /// The least and the largest value that the error allows; `None` if it is beyond all bounds.
    pub fn ends(&self) -> Option<[Int<6>; 2]> {
        let limbs = (0..4).find(|k| self.error * 2f64.powi(-64 * k) < 2f64.powi(100))?;
        let rounded = (self.error * 2f64.powi(-64 * limbs)) as i128 + 1;
        let mut error = [0; 6];
        error[limbs as usize] = rounded as u64;
        error[limbs as usize + 1] = (rounded >> 64) as u64;
        let error = Int::from_limbs(error);
        Some([self.value - error, self.value + error])
    }

    /// Adds another flux, or takes it away.
    pub fn add(&mut self, other: &Self, negative: bool) {
        if negative {
            self.value -= other.value;
        } else {
            self.value += other.value;
        }
        self.error += other.error;
    }
}

/// A lattice point.
pub fn of_lattice(p: &Lattice) -> Fixed {
    p.map(|c| i128::from(c) << PLACES)
}

/// An exact point, each coordinate to within [`slack`].
pub fn of_vertex(vertex: &Vertex) -> Fixed {
    match vertex.as_lattice() {
        Some(p) => of_lattice(p),
        None => {
            let h = vertex.coordinates();
            h.x.map(|x| place(&x, &h.w))
        }
    }
}

/// x / w in units of 2^-`PLACES`.
fn place(x: &Int<6>, w: &Int<6>) -> i128 {
    quotient(&x.mul_i128::<8>(1 << PLACES), w, |q| w.mul_i128(q))
}

/// A quotient by two steps of long division in doubles, each of 50 bits and more.
fn quotient<const N: usize, const M: usize>(
    n: &Int<N>,
    d: &Int<M>,
    times: impl Fn(i128) -> Int<N>,
) -> i128 {
    let reciprocal = 1.0 / d.to_f64();
    let first = (n.to_f64() * reciprocal) as i128;
    let rest = *n - times(first);
    first + (rest.to_f64() * reciprocal).round() as i128
}

/// How far a coordinate can be from the true one after a quotient, if none exceeds `size`.
///
/// The first step leaves 2^-51 of the quotient, the second as much of that, and one for rounding.
pub fn slack(size: f64) -> f64 {
    1.0 + size * 2f64.powi(-101)
}

/// The walls of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Walls {
    low: Fixed,
    high: Fixed,
}

impl Walls {
    /// The walls of a cell, half a step outside its lattice points.
    pub fn of(cell: &Cell) -> Self {
        let half = |doubled: i64| i128::from(doubled) << (PLACES - 1);
        let high = cell.high();
        Self {
            low: cell.low().map(|c| half(2 * c - 1)),
            high: high.map(|c| half(2 * c + 1)),
        }
    }

    /// Whether all points lie inside.
    pub fn hold<'a>(&self, mut points: impl Iterator<Item = &'a Fixed>) -> bool {
        points.all(|p| (0..3).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i]))
    }

    /// The part of a polygon inside; how many walls cut it.
    pub fn clip(&self, ring: &mut Ring) -> u32 {
        let mut cuts = 0;
        for axis in 0..3 {
            for (wall, sign) in [(self.low[axis], -1), (self.high[axis], 1)] {
                if ring.iter().any(|p| sign * p[axis] > sign * wall) {
                    *ring = below(ring, axis, wall, sign);
                    cuts += 1;
                }
            }
        }
        cuts
    }
}

/// The part of a polygon that lies below a wall, or above it if `sign` is −1.
fn below(ring: &Ring, axis: usize, wall: i128, sign: i128) -> Ring {
    let mut kept = Ring::new();
    let over = |p: &Fixed| sign * (p[axis] - wall);
    for (i, p) in ring.iter().enumerate() {
        let q = &ring[(i + 1) % ring.len()];
        let (a, b) = (over(p), over(q));
        if a <= 0 {
            kept.push(*p);
        }
        if (a < 0 && b > 0) || (a > 0 && b < 0) {
            kept.push(crossing(p, q, axis, wall));
        }
    }
    kept
}

/// Where an edge with ends on both sides meets a wall.
///
/// The ends are taken in one order, so that neighbours on the two sides of an edge agree.
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

/// Six times the flux through the triangle of three points.
pub fn through(a: &Fixed, b: &Fixed, c: &Fixed) -> Int<6> {
    let product = |x: i128, y: i128| -> Int<4> { Int::<2>::from_i128(x).mul_i128(y) };
    let area = product(b[0] - a[0], c[1] - a[1]) - product(c[0] - a[0], b[1] - a[1]);
    let whole: Int<6> = area.mul_i128(a[2] + b[2] + c[2]);
    let mut limbs = [if whole.is_negative() { u64::MAX } else { 0 }; 6];
    limbs[..5].copy_from_slice(&whole.limbs()[1..]);
    Int::from_limbs(limbs)
}

/// Six times the flux through a polygon.
pub fn through_ring(ring: &Ring) -> Int<6> {
    let mut sum = Int::ZERO;
    for i in 2..ring.len() {
        sum += through(&ring[0], &ring[i - 1], &ring[i]);
    }
    sum
}

/// The lattice's units in those of a [`Flux`].
pub fn of_cubic_steps(whole: &Int<4>) -> Int<6> {
    let high: Int<4> = whole.mul_i64(1 << (FLUX_PLACES - 128));
    let mut limbs = [0; 6];
    limbs[2..].copy_from_slice(high.limbs());
    Int::from_limbs(limbs)
}

/// How far points lie from the origin, and apart, in units.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    size: f64,
    extent: f64,
}

impl Reach {
    /// Of these points.
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
            size: size.max().unwrap_or(0) as f64,
            extent: extent.max().unwrap_or(0) as f64,
        }
    }

    /// A bound on the error of the flux through a polygon in such points whose corners were rounded
    /// and cut `rounds` times in all; `slope` bounds |z| / |(x, y)| of its plane's normal.
    ///
    /// With corners off by s, sizes Z and extents L, each of n triangles of a fan errs by at most
    /// s (24 Z L + 6 L²). Where a wall z = c cuts the polygon, the edge is off by s (1 + slope), and
    /// the strip beside it counts with 6 Z; in walls across x or y the field has no flux.
    pub fn error(&self, corners: usize, rounds: u32, slope: f64) -> f64 {
        let s = slack(self.size);
        let product = (self.extent + 8.0 * s) * (self.size + self.extent) * (1.0 + slope);
        let count = corners as f64 * f64::from(rounds);
        1.0 + 64.0 * count * s * product * 2f64.powi(-64)
    }
}
