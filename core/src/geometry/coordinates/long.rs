//! Points where planes of any width meet each other or lattice edges, in integers of six limbs.

use super::homogeneous::Homogeneous;
use crate::arith::Int;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};

/// The point where three planes meet; `None` if they have no single common point.
pub(super) fn meet(a: &Plane, b: &Plane, c: &Plane) -> Option<Homogeneous> {
    for (cut, p, q) in [(c, a, b), (b, a, c), (a, b, c)] {
        if let Some(axis) = cut.only_axis() {
            return meet_on_axis_cut(cut, axis, p, q);
        }
    }
    let bc = cross(b.normal(), c.normal());
    let ca = cross(c.normal(), a.normal());
    let ab = cross(a.normal(), b.normal());
    let term = |i: usize| -> Int<6> { Int::<2>::from_i128(a.normal()[i]).mul(&bc[i]) };
    let w = term(0) + term(1) + term(2);
    let x = each_axis(|i| {
        let p: Int<6> = a.offset().mul(&bc[i]);
        let q: Int<6> = b.offset().mul(&ca[i]);
        let r: Int<6> = c.offset().mul(&ab[i]);
        p + q + r
    });
    Homogeneous::positive(x, -w)
}

/// The point where the line through a lattice edge meets a plane; `None` if the two are parallel.
///
/// # Bits
/// The denominator is a difference of two values at lattice points, far below that of three planes.
pub(super) fn on_edge(a: &Lattice, b: &Lattice, cut: &Plane) -> Option<Homogeneous> {
    let (va, vb) = (cut.value_at(a), cut.value_at(b));
    let x = each_axis(|i| -> Int<6> {
        let difference: Int<4> = vb.mul_i64::<4>(a[i]) - va.mul_i64::<4>(b[i]);
        difference.widen()
    });
    Homogeneous::positive(x, (vb - va).widen())
}

/// The point where two planes meet an axis-parallel plane, by 2×2 determinants; `None` if there is no single
/// such point.
fn meet_on_axis_cut(cut: &Plane, axis: usize, p: &Plane, q: &Plane) -> Option<Homogeneous> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let lead = cut.normal()[axis];
    let reduced = |plane: &Plane| -> Int<5> {
        let here: Int<5> = plane.offset().mul_i128(lead);
        let there: Int<5> = cut.offset().mul_i128(plane.normal()[axis]);
        here - there
    };
    let (d, e) = (reduced(p), reduced(q));
    let (n, m) = (p.normal(), q.normal());
    let minor = product(n[u], m[v]) - product(n[v], m[u]);
    let w: Int<6> = minor.mul_i128(lead);
    let mut x = [Int::<6>::ZERO; 3];
    x[axis] = cut.offset().mul(&minor);
    x[u] = d.mul_i128::<6>(m[v]) - e.mul_i128::<6>(n[v]);
    x[v] = e.mul_i128::<6>(n[u]) - d.mul_i128::<6>(m[u]);
    Homogeneous::positive(x, -w)
}

/// The exact cross product of two plane normals; its components are below 2^217.
pub fn cross(a: &[i128; 3], b: &[i128; 3]) -> [Int<4>; 3] {
    [
        product(a[1], b[2]) - product(a[2], b[1]),
        product(a[2], b[0]) - product(a[0], b[2]),
        product(a[0], b[1]) - product(a[1], b[0]),
    ]
}

/// The product of two components of plane normals; one machine multiplication if both fit an `i64`.
fn product(a: i128, b: i128) -> Int<4> {
    match (i64::try_from(a), i64::try_from(b)) {
        (Ok(a), Ok(b)) => Int::from_i128(i128::from(a) * i128::from(b)),
        _ => Int::<2>::from_i128(a).mul(&Int::<2>::from_i128(b)),
    }
}
