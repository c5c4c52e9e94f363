//! The triangles around one edge, in angular order, and the wedges of the inside between them.

use std::cmp::Ordering;

use crate::arith::{Int, Sign};
use crate::mesh::handle::VertexId;

use super::Radial;

/// An integer wide enough for sums of three products of two normal components: 2 · 120 + 2 < 256 bits.
type Wide = Int<4>;

/// A triangle at an edge, to be sorted by its angle around the edge.
struct Spoke {
    half: usize,
    forward: bool,
    /// The triangle's normal, reversed if the half-edge is backward: for every triangle this vector is a
    /// quarter turn around the edge from the triangle, in the same direction.
    across: [i128; 3],
}

/// The direction of an edge, from its lower to its higher vertex, in one coordinate.
struct Axis {
    /// A coordinate in which the edge's ends differ.
    coordinate: usize,
    /// The sign of the direction in this coordinate.
    sign: Sign,
}

/// Pairs the half-edges of one edge, so that the triangles of a pair bound a wedge of the inside.
///
/// Counterclockwise around the edge, the inside begins at a backward half-edge and ends at a forward one.
/// Among triangles in one half-plane those with forward half-edges come first, so that a wall without
/// thickness separates its two sides. Backward and forward half-edges match like opening and closing
/// parentheses, so that no two pairs cross where wedges overlap.
///
/// # Order
/// Depends on the half-edges' numbers only among triangles in one half-plane.
pub(super) fn wedges<R: Radial>(
    radial: &R,
    [a, b]: [VertexId; 2],
    forward: &[usize],
    backward: &[usize],
) -> Vec<(usize, usize)> {
    let axis = Axis::new(radial.direction(a, b));
    let mut spokes: Vec<Spoke> = Vec::with_capacity(forward.len() + backward.len());
    for (&half, is_forward) in forward
        .iter()
        .map(|h| (h, true))
        .chain(backward.iter().map(|h| (h, false)))
    {
        let spoke = Spoke::new(radial, half, is_forward);
        // Insertion tolerates an inconsistent order, which normals may cause; `sort_by` may panic.
        let place = spokes.partition_point(|other| {
            axis.order(&spokes[0].across, &other.across, &spoke.across)
                .is_le()
        });
        spokes.insert(place, spoke);
    }
    match_wedges(&spokes)
}

/// Matches each forward half-edge around an edge with the last unmatched backward one, in cyclic order.
fn match_wedges(spokes: &[Spoke]) -> Vec<(usize, usize)> {
    let mut pairs = Vec::with_capacity(spokes.len() / 2);
    let mut begun = Vec::new();
    let twice = spokes.iter().chain(spokes);
    for spoke in twice.skip(start(spokes)).take(spokes.len()) {
        if !spoke.forward {
            begun.push(spoke.half);
        } else if let Some(backward) = begun.pop() {
            pairs.push((spoke.half, backward));
        }
    }
    pairs
}

/// Returns the index of the half-edge at which matching starts: in cyclic order from there, every wedge of
/// the inside begins before it ends.
fn start(spokes: &[Spoke]) -> usize {
    let (mut depth, mut lowest, mut start) = (0_i64, 0_i64, 0);
    for (k, spoke) in spokes.iter().enumerate() {
        depth += if spoke.forward { -1 } else { 1 };
        if depth < lowest {
            (lowest, start) = (depth, k + 1);
        }
    }
    start
}

impl Spoke {
    fn new<R: Radial>(radial: &R, half: usize, forward: bool) -> Self {
        // The caller has checked that triangles count in 32 bits.
        let normal = radial.normal(u32::try_from(half / 3).unwrap_or(u32::MAX));
        let across = if forward {
            normal
        } else {
            normal.map(i128::wrapping_neg)
        };
        Self {
            half,
            forward,
            across,
        }
    }
}

impl Axis {
    fn new(direction: [Sign; 3]) -> Self {
        let coordinate = direction
            .iter()
            .position(|&sign| sign != Sign::Zero)
            .unwrap_or(0);
        Self {
            coordinate,
            sign: direction[coordinate],
        }
    }

    /// Compares the angles of `u` and `v` around the axis, counterclockwise from `zero`.
    fn order(&self, zero: &[i128; 3], u: &[i128; 3], v: &[i128; 3]) -> Ordering {
        let by_half = self.half(zero, u).cmp(&self.half(zero, v));
        by_half.then_with(|| self.turn(u, v).order().reverse())
    }

    /// Returns 0 if `u` has the direction of `zero`; else the class of the angle from `zero` to `u`: 1 below
    /// 180 degrees, 2 at 180 degrees, 3 above.
    fn half(&self, zero: &[i128; 3], u: &[i128; 3]) -> u8 {
        match self.turn(zero, u) {
            Sign::Positive => 1,
            Sign::Zero if dot_sign(zero, u) == Sign::Positive => 0,
            Sign::Zero => 2,
            Sign::Negative => 3,
        }
    }

    /// The sign of the turn from `u` to `v` about the axis, for vectors perpendicular to it.
    ///
    /// - `Positive`: counterclockwise, by less than a half turn
    /// - `Zero`: none, or a half turn
    /// - `Negative`: clockwise
    fn turn(&self, u: &[i128; 3], v: &[i128; 3]) -> Sign {
        let (j, k) = ((self.coordinate + 1) % 3, (self.coordinate + 2) % 3);
        // The cross product is parallel to the axis: one coordinate tells its direction.
        (product(u[j], v[k]) - product(u[k], v[j])).sign() * self.sign
    }
}

fn dot_sign(u: &[i128; 3], v: &[i128; 3]) -> Sign {
    (product(u[0], v[0]) + product(u[1], v[1]) + product(u[2], v[2])).sign()
}

fn product(a: i128, b: i128) -> Wide {
    Int::<2>::from_i128(a).mul(&Int::<2>::from_i128(b))
}
