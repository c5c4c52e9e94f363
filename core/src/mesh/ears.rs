//! Exact triangulation of simple polygons by their ears.
//!
//! # Source
//! Meisters 1975, "Polygons have ears".

use crate::arith::Sign;
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;

/// Twice the signed area of the triangle a, b, c in the projection to two axes.
///
/// # Bits
/// Differences are below 2^54, products below 2^108.
fn turn(a: &Lattice, b: &Lattice, c: &Lattice, axes: (usize, usize)) -> i128 {
    let (u, v) = axes;
    let arm = |p: &Lattice, i: usize| i128::from(p[i] - a[i]);
    arm(b, u) * arm(c, v) - arm(b, v) * arm(c, u)
}

/// Return whether a polygon, counterclockwise in the projection to two axes, is strictly convex and winds
/// once.
pub fn is_convex(corners: &[Lattice], axes: (usize, usize)) -> bool {
    let n = corners.len();
    let at = |i: usize| &corners[i % n];
    let strict = (0..n).all(|i| turn(at(i), at(i + 1), at(i + 2), axes) > 0);
    let (u, v) = axes;
    let upward = |i: usize| {
        let (from, to) = (at(i), at(i + 1));
        to[v] > from[v] || to[v] == from[v] && to[u] > from[u]
    };
    let starts = (0..n).filter(|&i| upward(i) && !upward(i + n - 1)).count();
    strict && starts == 1
}

/// Return whether two edges of a polygon that do not share a corner have a point in common, in the projection
/// to two axes.
fn crosses_itself(corners: &[Lattice], axes: (usize, usize)) -> bool {
    let n = corners.len();
    let edge = |i: usize| (&corners[i], &corners[(i + 1) % n]);
    (0..n).any(|i| {
        // The last edge is a neighbour of the first one.
        let end = if i == 0 { n - 1 } else { n };
        (i + 2..end).any(|j| meet(edge(i), edge(j), axes))
    })
}

/// Return whether two closed segments have a point in common, in the projection to two axes.
fn meet(p: (&Lattice, &Lattice), q: (&Lattice, &Lattice), axes: (usize, usize)) -> bool {
    let apart = |i: usize| {
        p.0[i].max(p.1[i]) < q.0[i].min(q.1[i]) || q.0[i].max(q.1[i]) < p.0[i].min(p.1[i])
    };
    if apart(axes.0) || apart(axes.1) {
        return false;
    }
    let sides = |(a, b): (&Lattice, &Lattice), (c, d): (&Lattice, &Lattice)| {
        Sign::of(turn(a, b, c, axes)) * Sign::of(turn(a, b, d, axes))
    };
    sides(p, q) != Sign::Positive && sides(q, p) != Sign::Positive
}

/// Triangles, as indices of corners, that make up a polygon which is counterclockwise in the projection to
/// two axes.
///
/// `None` if the outline crosses or touches itself.
///
/// # Cost
/// Usually quadratic in the number of corners; cubic at worst.
pub fn triangles(corners: &[Lattice], axes: (usize, usize)) -> Option<Vec<[usize; 3]>> {
    if crosses_itself(corners, axes) {
        return None;
    }
    let mut ring: Vec<usize> = (0..corners.len()).collect();
    let mut found = Vec::with_capacity(corners.len());
    while ring.len() > 3 {
        poll();
        let n = ring.len();
        let ear = (0..n).find(|&i| is_ear(corners, &ring, i, axes))?;
        found.push(around(&ring, ear));
        ring.remove(ear);
    }
    let last = around(&ring, 1);
    let [a, b, c] = last.map(|i| &corners[i]);
    if turn(a, b, c, axes) <= 0 {
        return None;
    }
    found.push(last);
    Some(found)
}

fn around(ring: &[usize], i: usize) -> [usize; 3] {
    let n = ring.len();
    [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]
}

fn is_ear(corners: &[Lattice], ring: &[usize], i: usize, axes: (usize, usize)) -> bool {
    let numbers = around(ring, i);
    let [a, b, c] = numbers.map(|k| &corners[k]);
    let touches = |p: &Lattice| {
        turn(a, b, p, axes) >= 0 && turn(b, c, p, axes) >= 0 && turn(c, a, p, axes) >= 0
    };
    turn(a, b, c, axes) > 0
        && ring
            .iter()
            .filter(|k| !numbers.contains(k))
            .all(|&k| !touches(&corners[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const XY: (usize, usize) = (0, 1);

    #[test]
    fn a_pentagram_is_not_convex() {
        let star = [[0, 10, 0], [-6, -8, 0], [10, 3, 0], [-10, 3, 0], [6, -8, 0]];
        assert!(!is_convex(&star, XY));
        let pentagon = [star[0], star[3], star[1], star[4], star[2]];
        assert!(is_convex(&pentagon, XY));
    }

    #[test]
    fn ears_cover_a_concave_polygon() {
        let comb = [
            [0, 0, 0],
            [6, 0, 0],
            [6, 5, 0],
            [4, 1, 0],
            [3, 5, 0],
            [2, 1, 0],
            [0, 5, 0],
        ];
        let doubled = |t: &[usize; 3]| turn(&comb[t[0]], &comb[t[1]], &comb[t[2]], XY);
        let found = triangles(&comb, XY).unwrap();
        assert_eq!(found.len(), comb.len() - 2);
        let shoelace: i128 = (0..comb.len())
            .map(|i| turn(&[0; 3], &comb[i], &comb[(i + 1) % comb.len()], XY))
            .sum();
        assert_eq!(found.iter().map(doubled).sum::<i128>(), shoelace);
    }

    #[test]
    fn a_bow_tie_has_no_triangulation() {
        let bow = [[0, 0, 0], [4, 4, 0], [4, 0, 0], [0, 4, 0]];
        assert!(triangles(&bow, XY).is_none());
    }
}
