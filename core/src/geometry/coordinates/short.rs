//! Points where short planes meet each other or lattice edges, in machine words wherever the result fits.
//!
//! `arith::bounds::SHORT_NORMAL_BITS` and the constants beside it bound the widths.

use super::homogeneous::Homogeneous;
use crate::arith::Int;
use crate::geometry::plane::{Lattice, ShortPlane};

/// The point where three short planes meet; `None` if they have no single common point.
pub(super) fn meet(a: &ShortPlane, b: &ShortPlane, c: &ShortPlane) -> Option<Homogeneous<4>> {
    for (cut, p, q) in [(c, a, b), (b, a, c), (a, b, c)] {
        if let Some((axis, offset)) = as_cut(cut) {
            return meet_on_axis_cut(cut.n[axis], axis, offset, p, q);
        }
    }
    let (bc, ca, ab) = (cross(&b.n, &c.n), cross(&c.n, &a.n), cross(&a.n, &b.n));
    let term = |i: usize| wide(bc[i]).mul_i64::<4>(a.n[i]);
    let w = term(0) + term(1) + term(2);
    let (d, e, f) = (wide(a.d), wide(b.d), wide(c.d));
    let x = |i: usize| -> Int<4> { d.mul_i128(bc[i]) + e.mul_i128(ca[i]) + f.mul_i128(ab[i]) };
    Homogeneous::positive([x(0), x(1), x(2)], -w)
}

/// The point where the line through a lattice edge meets a short plane; `None` if the two are parallel.
pub(super) fn on_edge(a: &Lattice, b: &Lattice, cut: &ShortPlane) -> Option<Homogeneous<4>> {
    let (va, vb) = (cut.value_at(a), cut.value_at(b));
    if let (Ok(va), Ok(vb)) = (i64::try_from(va), i64::try_from(vb)) {
        return on_edge_by_words(a, va, b, vb);
    }
    let (from, to) = (wide(va), wide(vb));
    let x = |i: usize| -> Int<4> { to.mul_i64(a[i]) - from.mul_i64(b[i]) };
    Homogeneous::positive([x(0), x(1), x(2)], Int::from_i128(vb - va))
}

/// The point where the line through two lattice points meets a plane, from the plane's values at these
/// points; `None` if the values are equal. Values that fit an `i64` are usual for cuts across an axis.
///
/// # Bits
/// Each coordinate is a difference of two products of a value in a machine word and a lattice
/// coordinate: below 2^118.
fn on_edge_by_words(a: &Lattice, va: i64, b: &Lattice, vb: i64) -> Option<Homogeneous<4>> {
    let w = i128::from(vb) - i128::from(va);
    let x = |i: usize| {
        let x = product(vb, a[i]) - product(va, b[i]);
        Int::from_i128(if w < 0 { -x } else { x })
    };
    let x = [x(0), x(1), x(2)];
    (w != 0).then_some(Homogeneous {
        x,
        w: Int::from_i128(w.abs()),
    })
}

/// The axis and the offset of a plane across an axis, if its leading coefficient is at most two in magnitude;
/// else `None`.
fn as_cut(plane: &ShortPlane) -> Option<(usize, i64)> {
    let axis = match plane.n {
        [_, 0, 0] => 0,
        [0, _, 0] => 1,
        [0, 0, _] => 2,
        _ => return None,
    };
    let offset = i64::try_from(plane.d).ok()?;
    (plane.n[axis].abs() <= 2).then_some((axis, offset))
}

/// The point where two planes meet an axis-parallel plane, by 2×2 determinants; `None` if there is no single
/// such point.
fn meet_on_axis_cut(
    lead: i64,
    axis: usize,
    offset: i64,
    p: &ShortPlane,
    q: &ShortPlane,
) -> Option<Homogeneous<4>> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let reduced = |plane: &ShortPlane| plane.d * i128::from(lead) - product(offset, plane.n[axis]);
    let (d, e) = (wide(reduced(p)), wide(reduced(q)));
    let (n, m) = (&p.n, &q.n);
    let minor = product(n[u], m[v]) - product(n[v], m[u]);
    let mut x = [Int::ZERO; 3];
    x[axis] = wide(minor).mul_i64(offset);
    x[u] = d.mul_i64::<4>(m[v]) - e.mul_i64::<4>(n[v]);
    x[v] = e.mul_i64::<4>(n[u]) - d.mul_i64::<4>(m[u]);
    Homogeneous::positive(x, -Int::from_i128(minor * i128::from(lead)))
}

fn cross(a: &[i64; 3], b: &[i64; 3]) -> [i128; 3] {
    let minor = |i: usize, j: usize| product(a[i], b[j]) - product(a[j], b[i]);
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn product(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

fn wide(value: i128) -> Int<2> {
    Int::from_i128(value)
}
