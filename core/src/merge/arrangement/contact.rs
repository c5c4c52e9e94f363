//! The narrow phase: in which segment two triangles cross, by signs alone.
//!
//! No coordinates of the segment are computed or compared. Its ends are named by an edge of one triangle
//! and the other triangle.
//!
//! # Source
//! Guigue and Devillers 2003 (the signs and their order).

use crate::arith::Sign;
use crate::geometry::doubles::{seen_along, side, turn, Facing, Point, Triangle};
use crate::geometry::side::Side;

/// How two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Contact {
    /// They have no point in common.
    Apart,
    /// They cross in a segment that runs inside both. It is directed so that, seen from in front of
    /// the first triangle, the points behind the second one are on its left.
    Crossing([End; 2]),
    /// They meet in any other way.
    Special,
}

/// The end of a segment: an edge of one triangle goes through the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct End {
    /// The triangle that the edge is of: 0 for the first.
    pub(super) of: usize,
    /// The corners at the ends of the edge.
    pub(super) edge: [usize; 2],
}

/// Return how two triangles with integer corners meet; exact.
pub(super) fn contact(f: &Facing, g: &Facing) -> Contact {
    let ours = sides(f, g);
    if is_apart(ours) {
        return Contact::Apart;
    }
    let theirs = sides(g, f);
    if is_apart(theirs) {
        return Contact::Apart;
    }
    if ours.contains(&Side::On) || theirs.contains(&Side::On) {
        return special(f, g, ours, theirs);
    }
    crossing(f.triangle(), g.triangle(), ours, theirs)
}

/// The sides of a triangle's plane on which the corners of another one lie.
fn sides(of: &Facing, plane: &Facing) -> [Side; 3] {
    of.triangle().each_ref().map(|corner| plane.side(corner))
}

fn is_apart(sides: [Side; 3]) -> bool {
    sides[0] != Side::On && sides[1] == sides[0] && sides[2] == sides[0]
}

/// The edge at which a triangle's border leaves a side, from the corner on that side.
fn leaving(sides: [Side; 3], side: Side) -> [usize; 2] {
    let next = |i: usize| (i + 1) % 3;
    let leaves = |i: &usize| sides[*i] == side && sides[next(*i)] != side;
    let i = (0..3).find(leaves).unwrap_or(0);
    [i, next(i)]
}

/// The contact of triangles of which each has corners strictly on both sides of the other's plane.
fn crossing(f: &Triangle, g: &Triangle, ours: [Side; 3], theirs: [Side; 3]) -> Contact {
    let [end, start] = leaving(ours, Side::Plus);
    let (f_first, f_last) = (leaving(ours, Side::Minus), [start, end]);
    let (g_first, g_last) = (leaving(theirs, Side::Plus), leaving(theirs, Side::Minus));
    let turn = |a: [usize; 2], b: [usize; 2]| side(&[f[a[0]], f[a[1]], g[b[0]]], &g[b[1]]);
    let order = [turn(f_first, g_last), turn(f_last, g_first)];
    if order.contains(&Side::Minus) {
        return Contact::Apart;
    }
    let ends = [turn(f_first, g_first), turn(f_last, g_last)];
    if order.contains(&Side::On) || ends.contains(&Side::On) {
        return Contact::Special;
    }
    let end = |side: Side, ours: [usize; 2], theirs: [usize; 2]| match side {
        Side::Plus => End { of: 0, edge: ours },
        Side::Minus | Side::On => End {
            of: 1,
            edge: theirs,
        },
    };
    Contact::Crossing([end(ends[0], f_first, g_first), end(ends[1], f_last, g_last)])
}

/// The contact of triangles of which one has a corner in the other's plane.
fn special(f: &Facing, g: &Facing, ours: [Side; 3], theirs: [Side; 3]) -> Contact {
    if touches(f, g, ours) || touches(g, f, theirs) {
        Contact::Special
    } else {
        Contact::Apart
    }
}

/// Return whether an edge of a triangle, or one of its corners, has a point of another triangle.
fn touches(f: &Facing, g: &Facing, sides: [Side; 3]) -> bool {
    let corners = f.triangle();
    (0..3).any(|i| {
        let (p, q) = (&corners[i], &corners[(i + 1) % 3]);
        match (sides[i], sides[(i + 1) % 3]) {
            (Side::On, Side::On) => overlaps(p, q, g),
            (Side::On, _) => holds(g, p),
            (_, Side::On) => holds(g, q),
            (side, other) => side != other && goes_through(p, q, g.triangle()),
        }
    })
}

/// Return whether a segment between the two sides of a triangle's plane goes through the triangle.
fn goes_through(p: &Point, q: &Point, [a, b, c]: &Triangle) -> bool {
    let turns = [[a, b], [b, c], [c, a]].map(|[s, t]| side(&[*p, *q, *s], t));
    !(turns.contains(&Side::Plus) && turns.contains(&Side::Minus))
}

/// Return whether a triangle holds a point of its plane.
fn holds(g: &Facing, p: &Point) -> bool {
    overlaps(p, p, g)
}

/// Return whether a segment in a triangle's plane has a point of the triangle: no edge of it and not the
/// segment's own line has them on different sides.
fn overlaps(p: &Point, q: &Point, g: &Facing) -> bool {
    let axis = g.main_axis();
    let corners = seen_along(g.triangle(), axis);
    let [s, t, _] = seen_along(&[*p, *q, *p], axis);
    let turned = turn(corners);
    let beyond = |i: usize, at: [f64; 2]| turn([corners[i], corners[(i + 1) % 3], at]) == -turned;
    if (0..3).any(|i| beyond(i, s) && beyond(i, t)) {
        return false;
    }
    let across = corners.map(|corner| turn([s, t, corner]));
    across.contains(&Sign::Zero) || across[0] != across[1] || across[1] != across[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(corners: [[i32; 3]; 3]) -> Facing {
        Facing::of(&corners.map(|c| c.map(f64::from)))
    }

    /// The floor, seen from above.
    const FLOOR: [[i32; 3]; 3] = [[0, 0, 0], [8, 0, 0], [0, 8, 0]];

    #[test]
    fn triangles_that_cross_have_a_segment_with_the_back_on_its_left() {
        // The normal points to smaller x, so that larger ones are behind: left of the way to -y.
        let wall = [[2, 1, -4], [2, 1, 4], [2, 3, 1]];
        let Contact::Crossing([from, to]) = contact(&of(FLOOR), &of(wall)) else {
            panic!("they cross");
        };
        let along = |end: End| {
            let [a, b] = end.edge.map(|i| wall[i]);
            assert_eq!(end.of, 1);
            (a[1] + b[1]).min(5)
        };
        let normal_is_positive = {
            let [a, b, c] = wall;
            (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]) > 0
        };
        assert_eq!(along(from) < along(to), normal_is_positive);
    }

    #[test]
    fn contacts_other_than_crossings_are_special() {
        let touching = [
            [[2, 2, 0], [2, 2, 5], [3, 1, 5]],
            [[0, 0, 0], [9, 9, 9], [8, 9, 9]],
            [[-4, 4, 0], [4, -4, 0], [0, 0, 9]],
            [[1, 1, 0], [2, 1, 0], [1, 2, 0]],
            [[9, 9, 0], [-9, 0, 0], [0, -9, 0]],
            [[4, 0, -3], [4, 0, 3], [4, -3, 0]],
        ];
        for other in touching {
            assert_eq!(
                contact(&of(FLOOR), &of(other)),
                Contact::Special,
                "{other:?}"
            );
            assert_eq!(
                contact(&of(other), &of(FLOOR)),
                Contact::Special,
                "{other:?}"
            );
        }
    }

    #[test]
    fn triangles_apart_may_have_corners_in_the_other_plane() {
        let apart = [
            [[9, 9, 0], [9, 9, 5], [7, 9, 5]],
            [[9, 9, 0], [12, 9, 0], [9, 12, 0]],
            [[5, 5, 0], [8, 8, 0], [8, 8, 3]],
            [[4, 9, -3], [4, 9, 3], [4, 12, 0]],
            [[1, 1, 1], [2, 1, 1], [1, 2, 2]],
        ];
        for other in apart {
            assert_eq!(contact(&of(FLOOR), &of(other)), Contact::Apart, "{other:?}");
            assert_eq!(contact(&of(other), &of(FLOOR)), Contact::Apart, "{other:?}");
        }
    }
}
