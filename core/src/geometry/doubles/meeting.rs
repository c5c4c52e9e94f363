//! How two triangles in doubles intersect, exactly.
//!
//! Two surfaces that cross do so along lines, never only in single points. So triangles with only single
//! common points count as not intersecting, and a common segment is classified by whether it lies inside the
//! triangles or along their edges.
#![allow(clippy::float_cmp, reason = "equal corners are meant to the last bit")]

use crate::arith::{Filtered, Sign};
use crate::geometry::doubles::{
    clear_turn, is_flat, seen_along, side, turn, Facing, Point, Triangle,
};
use crate::geometry::polygon::straddle;
use crate::geometry::side::Side;

/// How two triangles intersect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// The triangles have at most single points in common.
    Clear,
    /// A segment of this edge of the first triangle lies inside the second.
    FirstEdge(usize),
    /// A segment of this edge of the second triangle lies inside the first.
    SecondEdge(usize),
    /// A segment that lies on an edge of the first triangle and on an edge of the second, by their numbers.
    Edges(usize, usize),
    /// A segment that runs inside both triangles.
    Crossing,
    /// The triangles lie in one plane and have an area in common.
    Overlap,
}

/// Return how two triangles with area intersect.
pub fn meeting(p: &Triangle, q: &Triangle) -> Meeting {
    meeting_of(&Facing::of(p), &Facing::of(q))
}

/// Return how two prepared triangles with area intersect.
pub fn meeting_of(p: &Facing, q: &Facing) -> Meeting {
    if are_clear(p, q) {
        Meeting::Clear
    } else {
        meeting_by_sides(p.triangle(), q.triangle())
    }
}

fn meeting_by_sides(p: &Triangle, q: &Triangle) -> Meeting {
    let of_p = sides(p, q);
    let first = part_in_plane(of_p);
    if first == PartInPlane::Point {
        return Meeting::Clear;
    }
    let of_q = sides(q, p);
    match (first, part_in_plane(of_q)) {
        (_, PartInPlane::Point) => Meeting::Clear,
        (PartInPlane::All, _) | (_, PartInPlane::All) if overlap(p, q) => Meeting::Overlap,
        (PartInPlane::All, _) | (_, PartInPlane::All) => Meeting::Clear,
        (PartInPlane::Edge(i), PartInPlane::Edge(j)) if is_same_edge(p, i, q, j) => {
            Meeting::Edges(i, j)
        }
        (first, second) if has_common_segment(p, lone_corner(of_p), q, lone_corner(of_q)) => {
            match (first, second) {
                (PartInPlane::Edge(i), PartInPlane::Edge(j)) => Meeting::Edges(i, j),
                (PartInPlane::Edge(i), _) => Meeting::FirstEdge(i),
                (_, PartInPlane::Edge(j)) => Meeting::SecondEdge(j),
                _ => Meeting::Crossing,
            }
        }
        _ => Meeting::Clear,
    }
}

/// Return whether doubles alone prove that two triangles have no common point except perhaps one common
/// corner; true for nearly all pairs.
pub fn are_clear(p: &Facing, q: &Facing) -> bool {
    let common = CommonCorners::of(p.triangle(), q.triangle());
    if common.has_several() {
        return false;
    }
    if lies_beside(p, common, q) || lies_beside(q, common.turned(), p) {
        return true;
    }
    let axis = q.main_axis();
    lies_outside(p, common, q, axis) || lies_outside(q, common.turned(), p, axis)
}

/// The corners that two triangles have in common: bit `3 i + j` is set if corner `i` of the first
/// is corner `j` of the second.
#[derive(Clone, Copy)]
struct CommonCorners(u16);

impl CommonCorners {
    #[inline]
    fn of(p: &Triangle, q: &Triangle) -> Self {
        let mut bits = 0;
        for (i, corner) in p.iter().enumerate() {
            for (j, other) in q.iter().enumerate() {
                bits |= u16::from(is_same(corner, other)) << (3 * i + j);
            }
        }
        Self(bits)
    }

    /// Return whether the triangles have at least two corners in common.
    #[inline]
    fn has_several(self) -> bool {
        // Corners of a triangle with area are distinct.
        self.0.count_ones() > 1
    }

    /// Return whether corner `i` of the first triangle is a corner of the second.
    #[inline]
    fn has(self, i: usize) -> bool {
        self.0 >> (3 * i) & 0b111 != 0
    }

    /// Return whether corner `i` of the first triangle is an end of the given edge of the second.
    #[inline]
    fn is_end(self, i: usize, edge: usize) -> bool {
        const ENDS: [u16; 3] = [0b011, 0b110, 0b101];
        self.0 >> (3 * i) & ENDS[edge] != 0
    }

    /// The same common corners with the two triangles exchanged.
    #[inline]
    fn turned(self) -> Self {
        const DIAGONAL: u16 = 0b100_010_001;
        const ABOVE: u16 = 0b000_100_010;
        const CORNER: u16 = 0b000_000_100;
        let rows = (self.0 & ABOVE) << 2 | self.0 >> 2 & ABOVE;
        let corners = (self.0 & CORNER) << 4 | self.0 >> 4 & CORNER;
        Self(self.0 & DIAGONAL | rows | corners)
    }
}

/// Return whether a triangle, except for its common corners, is certainly on one side of another triangle's
/// plane.
#[inline]
fn lies_beside(t: &Facing, common: CommonCorners, plane: &Facing) -> bool {
    let corners = t.triangle().iter().enumerate();
    let others = corners.filter(|(i, _)| !common.has(*i));
    plane.clearly_on_one_side(others.map(|(_, corner)| corner))
}

/// Return whether a triangle, projected along an axis, certainly lies on the outer side of an edge of another
/// one, except for ends of that edge. The projection of the other triangle must have an area.
fn lies_outside(t: &Facing, common: CommonCorners, other: &Facing, axis: usize) -> bool {
    let Filtered::Certain(inner) = other.clear_turn(axis) else {
        return false;
    };
    let (seen, other) = (
        seen_along(t.triangle(), axis),
        seen_along(other.triangle(), axis),
    );
    (0..3).any(|edge| {
        let ends = [other[edge], other[(edge + 1) % 3]];
        (0..3).all(|k| {
            common.is_end(k, edge)
                || clear_turn([ends[0], ends[1], seen[k]]) == Filtered::Certain(-inner)
        })
    })
}

/// Return whether two triangles with area that share an edge lie in one plane on the same side of the edge,
/// so that they overlap; `edge` is the number of the edge in `q`. If false, they have only the edge in
/// common.
pub fn folds_over(p: &Facing, q: &Facing, edge: usize) -> bool {
    // In a projection in which both turn the same way, they lie on different sides of the edge.
    let is_spread = |axis: usize| {
        let own = p.clear_turn(axis);
        own.is_certain() && q.clear_turn(axis) == own
    };
    let apex = &q.triangle()[(edge + 2) % 3];
    if is_spread(0) || is_spread(1) || is_spread(2) || p.side(apex) != Side::On {
        return false;
    }
    let facing = |t: &Facing, axis: usize| turn(seen_along(t.triangle(), axis));
    (0..3).all(|axis| facing(p, axis) == -facing(q, axis))
}

/// The sides of the plane of the triangle `plane` on which the corners of `triangle` lie.
fn sides(triangle: &Triangle, plane: &Triangle) -> [Side; 3] {
    let facing = Facing::of(plane);
    let side = |p: &Point| {
        if has_corner(plane, p) {
            Side::On
        } else {
            facing.side(p)
        }
    };
    let [a, b, c] = triangle;
    [side(a), side(b), side(c)]
}

/// Return whether a point equals a corner of a triangle.
#[inline]
fn has_corner([a, b, c]: &Triangle, p: &Point) -> bool {
    is_same(p, a) || is_same(p, b) || is_same(p, c)
}

/// Return whether two points are equal; comparing arrays as slices is slower.
#[inline]
fn is_same(p: &Point, q: &Point) -> bool {
    p[0] == q[0] && p[1] == q[1] && p[2] == q[2]
}

/// The part of a triangle that lies in the plane of another triangle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PartInPlane {
    /// One corner, or nothing.
    Point,
    /// An edge, by its number.
    Edge(usize),
    /// A segment through the triangle's inside.
    Inside,
    /// The whole triangle.
    All,
}

fn part_in_plane(sides: [Side; 3]) -> PartInPlane {
    let zeros = sides.iter().filter(|s| **s == Side::On).count();
    let passes = straddle(&sides) == (true, true);
    match (zeros, passes) {
        (3, _) => PartInPlane::All,
        (2, _) => PartInPlane::Edge((lone_corner(sides) + 1) % 3),
        (_, true) => PartInPlane::Inside,
        _ => PartInPlane::Point,
    }
}

fn is_same_edge(p: &Triangle, i: usize, q: &Triangle, j: usize) -> bool {
    let ends = |t: &Triangle, at: usize| [t[at], t[(at + 1) % 3]];
    let ([a, b], [c, d]) = (ends(p, i), ends(q, j));
    a == d && b == c || a == c && b == d
}

/// The index of the corner of a triangle that lies alone strictly on one side of a plane; 0 if there is no
/// such corner.
fn lone_corner(sides: [Side; 3]) -> usize {
    let single = |i: &usize| {
        let others = sides.iter().filter(|s| **s == sides[*i]).count();
        others == 1 && sides[*i] != Side::On
    };
    (0..3).find(single).unwrap_or(0)
}

/// Return whether the segments in which two triangles meet the common line of their planes share more than a
/// point.
///
/// The corners `p[i]` and `q[k]` are alone on their sides of the other triangle's plane, and the edges at
/// these corners end the segments. The sign of the volume that an edge of each triangle spans says which of
/// the two meets the line first, up to a sign that is the same for all four pairs; `On` means that both meet
/// it in one point.
fn has_common_segment(p: &Triangle, i: usize, q: &Triangle, k: usize) -> bool {
    let ends = |t: &Triangle, at: usize| [t[(at + 1) % 3], t[(at + 2) % 3]];
    let order = |our: &Point, their: &Point| side(&[p[i], *our, q[k]], their);
    let (ours, theirs) = (ends(p, i), ends(q, k));
    let pairs = [(0, 0), (0, 1), (1, 0), (1, 1)];
    let orders = pairs.map(|(a, b)| order(&ours[a], &theirs[b]));
    straddle(&orders) == (true, true)
}

/// Return whether two triangles of one plane have an area in common: no line through an edge separates them.
fn overlap(p: &Triangle, q: &Triangle) -> bool {
    let facing = |axis: usize| turn(seen_along(p, axis));
    let Some(axis) = (0..3).find(|axis| facing(*axis) != Sign::Zero) else {
        return false;
    };
    let (p, q) = (seen_along(p, axis), seen_along(q, axis));
    !lie_apart(&p, &q) && !separates(&p, &q) && !separates(&q, &p)
}

/// Return whether the boxes around two triangles have no area in common.
fn lie_apart(p: &[[f64; 2]; 3], q: &[[f64; 2]; 3]) -> bool {
    let low = |t: &[[f64; 2]; 3], i: usize| t[0][i].min(t[1][i]).min(t[2][i]);
    let high = |t: &[[f64; 2]; 3], i: usize| t[0][i].max(t[1][i]).max(t[2][i]);
    (0..2).any(|i| high(p, i) <= low(q, i) || high(q, i) <= low(p, i))
}

/// Return whether the line through some edge of `p` separates `p` from `q`, which may touch the line.
fn separates(p: &[[f64; 2]; 3], q: &[[f64; 2]; 3]) -> bool {
    let inner = turn(*p);
    (0..3).any(|i| {
        let (a, b) = (p[i], p[(i + 1) % 3]);
        let beyond = |c: &[f64; 2]| *c == a || *c == b || turn([a, b, *c]) != inner;
        q.iter().all(beyond)
    })
}

/// Return whether a triangle has no area: corners coincide or lie on one line.
pub fn has_no_area(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle;
    a == b || b == c || c == a || is_flat(triangle)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point of a small grid, by its number; triangles of such points touch in all possible ways.
    fn corner(number: u32, step: f64) -> Point {
        [1, 3, 9].map(|place| f64::from(number / place % 3) * step)
    }

    /// Pseudorandom integers below a bound.
    fn numbers(bound: u32) -> impl Iterator<Item = u32> {
        let next = |x: &u32| Some(x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
        std::iter::successors(Some(7), next).map(move |x| (x >> 8) % bound)
    }

    #[test]
    fn what_doubles_show_holds_exactly() {
        // Rounded thirds put triangles of one plane slightly off it.
        for step in [1.0, 1.0 / 3.0, 0.1] {
            let (mut corners, mut clear, mut met) = (numbers(27), 0, 0);
            for _ in 0..20_000 {
                let mut next = || [(); 3].map(|()| corner(corners.next().unwrap_or(0), step));
                let (p, q) = (next(), next());
                if has_no_area(&p) || has_no_area(&q) {
                    continue;
                }
                let exact = meeting_by_sides(&p, &q);
                assert_eq!(meeting(&p, &q), exact, "{p:?} {q:?}");
                clear += usize::from(are_clear(&Facing::of(&p), &Facing::of(&q)));
                met += usize::from(exact != Meeting::Clear);
            }
            assert!(clear > 4000 && met > 4000, "{clear} {met}");
        }
    }

    #[test]
    fn mates_fold_over_where_they_overlap() {
        for step in [1.0, 1.0 / 3.0] {
            let (mut corners, mut folded, mut flat) = (numbers(27), 0, 0);
            for _ in 0..20_000 {
                let mut next = || corner(corners.next().unwrap_or(0), step);
                let (a, b, c, d) = (next(), next(), next(), next());
                let (p, q) = ([a, b, c], [b, a, d]);
                if has_no_area(&p) || has_no_area(&q) {
                    continue;
                }
                let exact = meeting_by_sides(&p, &q);
                for (turned, edge) in [(q, 0), ([d, b, a], 1), ([a, d, b], 2)] {
                    let folds = folds_over(&Facing::of(&p), &Facing::of(&turned), edge);
                    assert_eq!(folds, exact == Meeting::Overlap, "{p:?} {turned:?}");
                }
                folded += usize::from(exact == Meeting::Overlap);
                flat += usize::from(exact == Meeting::Clear);
            }
            assert!(folded > 100 && flat > 100, "{folded} {flat}");
        }
    }
}
