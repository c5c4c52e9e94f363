//! Changes of the winding number along an axis-parallel segment between corners of cells.
//!
//! All corners are shifted by one vector (ε, ε², ε³) for an infinitely small ε, so that no sign is ever zero
//! and each count is the crossing number of one generic path.

use crate::arith::convert::as_double;
use crate::arith::{Int, Sign};
use crate::geometry::plane::{first_sign, normal, Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::side::Half;

/// An axis-parallel segment from one corner of a cell to another, in half lattice steps.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// The start, in half steps.
    pub from: Lattice,
    /// The axis to which the segment is parallel.
    pub axis: usize,
    /// The end's coordinate on the axis, in half steps; larger than the start's.
    pub to: i64,
}

impl Segment {
    fn end(&self) -> Lattice {
        let mut end = self.from;
        end[self.axis] = self.to;
        end
    }

    fn across(&self) -> (usize, usize) {
        ((self.axis + 1) % 3, (self.axis + 2) % 3)
    }
}

/// The change of the winding number along a segment where it crosses a plane with the inside on its minus
/// side: 1, 0 or −1.
pub fn plane_change(plane: &Plane, segment: &Segment) -> i32 {
    let before = plane.side_of_corner(&segment.from);
    let after = plane.side_of_corner(&segment.end());
    change_between(before, after)
}

/// The change of the winding number along a path from the half-space `before` of a surface's plane to the
/// half-space `after`: 1 if the path enters the minus side, −1 if it leaves it, else 0.
pub fn change_between(before: Half, after: Half) -> i32 {
    match (before, after) {
        (Half::Minus, Half::Plus) => -1,
        (Half::Plus, Half::Minus) => 1,
        (Half::Minus, Half::Minus) | (Half::Plus, Half::Plus) => 0,
    }
}

/// The change of the winding number along a segment where it crosses a lattice triangle: 1, 0 or −1.
pub fn triangle_change(corners: &[Lattice; 3], segment: &Segment) -> i32 {
    let (u, v) = segment.across();
    let mut sign = Sign::Zero;
    for i in 0..3 {
        let turn = turn_at_corner(&corners[i], &corners[(i + 1) % 3], &segment.from, u, v);
        if turn == Sign::Zero || turn == -sign {
            return 0;
        }
        sign = turn;
    }
    let reach = |f: fn(i64, i64) -> i64| corners.iter().map(|c| c[segment.axis]).reduce(f);
    let (Some(low), Some(high)) = (reach(i64::min), reach(i64::max)) else {
        return 0;
    };
    if 2 * low > segment.to || 2 * high < segment.from[segment.axis] {
        return 0;
    }
    if 2 * low > segment.from[segment.axis] && 2 * high < segment.to {
        return i32::from(-sign);
    }
    let n = normal(&corners[0], &corners[1], &corners[2]);
    let before = side_of_corner(&n, &corners[0], &segment.from);
    let after = side_of_corner(&n, &corners[0], &segment.end());
    change_between(before, after)
}

/// The half-space of the plane n·(x − a) = 0 in which a corner q, in half steps, shifted by δ = (ε, ε², ε³),
/// lies.
fn side_of_corner(n: &[i128; 3], a: &Lattice, q: &Lattice) -> Half {
    let term = |i: usize| -> Int<3> { Int::<2>::from_i128(n[i]).mul_i64(q[i] - 2 * a[i]) };
    Half::from_sign(match (term(0) + term(1) + term(2)).sign() {
        Sign::Zero => first_sign(n),
        sign => sign,
    })
}

/// The sign of the turn a → b → q + δ projected to the axes u and v, for a corner q in half steps and δ = (ε,
/// ε², ε³); zero only if a and b coincide in the projection.
fn turn_at_corner(a: &Lattice, b: &Lattice, q: &Lattice, u: usize, v: usize) -> Sign {
    let (du, dv) = (b[u] - a[u], b[v] - a[v]);
    let (eu, ev) = (q[u] - 2 * a[u], q[v] - 2 * a[v]);
    let (p, r) = (as_double(du) * as_double(ev), as_double(dv) * as_double(eu));
    let rough = p - r;
    if rough.abs() > 4.0 * f64::EPSILON * (p.abs() + r.abs()) {
        return Sign::of(rough);
    }
    let exact = i128::from(du) * i128::from(ev) - i128::from(dv) * i128::from(eu);
    if exact != 0 {
        return Sign::of(exact);
    }
    let (by_u, by_v) = (-Sign::of(dv), Sign::of(du));
    Sign::first(if u < v { [by_u, by_v] } else { [by_v, by_u] })
}

/// The change of the winding number along a segment where it crosses a convex polygon: 1, 0 or −1.
pub fn polygon_change(polygon: &Polygon, segment: &Segment) -> i32 {
    let support = polygon.support();
    let change = plane_change(support, segment);
    if change == 0 || support.normal()[segment.axis] == 0 {
        return 0;
    }
    let (u, v) = segment.across();
    let upward = Sign::of(support.normal()[segment.axis]);
    let inside = polygon.corners().iter().all(|corner| match &corner.edge {
        Carrier::Edge(edge) => {
            let (a, b) = edge.ends();
            turn_at_corner(a, b, &segment.from, u, v) == upward
        }
        Carrier::Cut(plane, flip) => {
            let side = sign_where_met(support, plane, segment) * upward;
            let wanted = if *flip {
                Sign::Positive
            } else {
                Sign::Negative
            };
            side == wanted
        }
    });
    if inside {
        change
    } else {
        0
    }
}

/// The sign of `plane` where the line through the segment meets `support`, times the sign of `support`'s
/// normal along the segment's axis.
fn sign_where_met(support: &Plane, plane: &Plane, segment: &Segment) -> Sign {
    let (p, e) = (support.normal(), plane.normal());
    let a = segment.axis;
    let wide = |c: i128| Int::<2>::from_i128(c);
    let left: Int<5> = wide(p[a]).mul(&plane.value_at_doubled(&segment.from));
    let right: Int<5> = wide(e[a]).mul(&support.value_at_doubled(&segment.from));
    let sign = (left - right).sign();
    if sign != Sign::Zero {
        return sign;
    }
    let slope = |i: usize| -> Sign {
        let left: Int<4> = wide(p[a]).mul(&wide(e[i]));
        let right: Int<4> = wide(e[a]).mul(&wide(p[i]));
        (left - right).sign()
    };
    Sign::first((0..3).filter(|i| *i != a).map(slope))
}
