//! Intersects two triangles by signs of determinants alone (the narrow phase).
//!
//! No coordinates of common points are computed or compared. Each point is named by what defines it: a
//! corner, an edge and a triangle, or two edges.
//!
//! # Source
//! Guigue and Devillers 2003 (the signs and their order).
#![allow(clippy::float_cmp, reason = "equal corners are meant to the last bit")]

use smallvec::SmallVec;

use crate::arith::Sign;
use crate::geometry::doubles::{seen_along, side, turn, Facing, Point, Triangle};
use crate::geometry::side::Side;

/// The kind of intersection of two triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Contact {
    /// The triangles have no point in common.
    Apart,
    /// The triangles cross in a segment whose inner points are inside both. Seen from in front of the first
    /// triangle, the points behind the second one are on the left of the directed segment.
    Crossing([PiercingPoint; 2]),
    /// The triangles have common points in another configuration.
    Touching(Box<Touching>),
}

/// A point in which an edge of one triangle passes through the inside of the other triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PiercingPoint {
    /// The triangle that has the edge: 0 for the first, 1 for the second.
    pub(super) of: usize,
    /// The indices of the corners at the ends of the edge.
    pub(super) edge: [usize; 2],
}

/// A common point of two triangles, named by the corners or edges that define it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CommonPoint {
    /// A corner: its triangle (0 or 1) and its index there; if two corners coincide, the corner of triangle
    /// 0.
    Corner(usize, usize),
    /// An edge of one triangle passes through the inside of the other.
    Through(PiercingPoint),
    /// An edge of the first triangle and an edge of the second cross; each is given by the index of its first
    /// corner.
    Edges(usize, usize),
}

/// A common segment of two triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CommonSegment {
    /// The points at the ends of the segment.
    pub(super) ends: [CommonPoint; 2],
    /// For triangles in one plane, the edge that contains the segment: its triangle (0 or 1) and the index of
    /// its first corner; otherwise `None`.
    pub(super) along: Option<(usize, usize)>,
}

/// The intersection of two triangles that touch, or whose crossing segment ends at a corner or at two edges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Touching {
    /// For each triangle, the sides of the other triangle's plane on which its corners lie.
    pub(super) sides: [[Side; 3]; 2],
    /// The points at which an edge or a corner of one triangle meets the other triangle.
    pub(super) points: SmallVec<[CommonPoint; 6]>,
    /// The common segments: one at most, except for triangles in one plane.
    pub(super) segments: SmallVec<[CommonSegment; 6]>,
    /// True if the triangles have an area in common.
    pub(super) overlap: bool,
}

/// Returns the intersection of two triangles with integer corners, exactly.
pub(super) fn contact(f: &Facing, g: &Facing) -> Contact {
    let ours = sides(f, g);
    if is_apart(ours) {
        return Contact::Apart;
    }
    let theirs = sides(g, f);
    if is_apart(theirs) {
        return Contact::Apart;
    }
    let both = [ours, theirs];
    if ours == [Side::On; 3] {
        return contact_in_one_plane(f, g, both).into_contact();
    }
    if both.as_flattened().contains(&Side::On) {
        return contact_in_two_planes(f, g, both).into_contact();
    }
    crossing_contact(f.triangle(), g.triangle(), ours, theirs)
        .unwrap_or_else(|| contact_in_two_planes(f, g, both).into_contact())
}

impl Touching {
    fn new(sides: [[Side; 3]; 2]) -> Self {
        Self {
            sides,
            points: SmallVec::new(),
            segments: SmallVec::new(),
            overlap: false,
        }
    }

    fn into_contact(self) -> Contact {
        if self.points.is_empty() {
            Contact::Apart
        } else {
            Contact::Touching(Box::new(self))
        }
    }
}

/// Returns the sides of the plane of triangle `plane` on which the corners of triangle `of` lie.
fn sides(of: &Facing, plane: &Facing) -> [Side; 3] {
    of.triangle().each_ref().map(|corner| plane.side(corner))
}

fn is_apart(sides: [Side; 3]) -> bool {
    sides[0] != Side::On && sides[1] == sides[0] && sides[2] == sides[0]
}

/// Returns the edge (the indices of its corners) at which a triangle's border leaves the given side of a
/// plane; its first corner is on that side.
fn edge_leaving(sides: [Side; 3], side: Side) -> [usize; 2] {
    let next = |i: usize| (i + 1) % 3;
    let leaves = |i: &usize| sides[*i] == side && sides[next(*i)] != side;
    let i = (0..3).find(leaves).unwrap_or(0);
    [i, next(i)]
}

/// Returns the intersection of two triangles, each of which has all corners off the other's plane and on both
/// sides of it; `None` if two edges meet.
fn crossing_contact(
    f: &Triangle,
    g: &Triangle,
    ours: [Side; 3],
    theirs: [Side; 3],
) -> Option<Contact> {
    let [end, start] = edge_leaving(ours, Side::Plus);
    let (f_first, f_last) = (edge_leaving(ours, Side::Minus), [start, end]);
    let (g_first, g_last) = (
        edge_leaving(theirs, Side::Plus),
        edge_leaving(theirs, Side::Minus),
    );
    let turn = |a: [usize; 2], b: [usize; 2]| side(&[f[a[0]], f[a[1]], g[b[0]]], &g[b[1]]);
    let order = [turn(f_first, g_last), turn(f_last, g_first)];
    if order.contains(&Side::Minus) {
        return Some(Contact::Apart);
    }
    let ends = [turn(f_first, g_first), turn(f_last, g_last)];
    if order.contains(&Side::On) || ends.contains(&Side::On) {
        return None;
    }
    let end = |side: Side, ours: [usize; 2], theirs: [usize; 2]| match side {
        Side::Plus => PiercingPoint { of: 0, edge: ours },
        Side::Minus | Side::On => PiercingPoint {
            of: 1,
            edge: theirs,
        },
    };
    let ends = [end(ends[0], f_first, g_first), end(ends[1], f_last, g_last)];
    Some(Contact::Crossing(ends))
}

/// Returns the intersection of two triangles in different planes; `both` has the sides of the other's plane
/// on which their corners lie.
fn contact_in_two_planes(f: &Facing, g: &Facing, both: [[Side; 3]; 2]) -> Touching {
    let mut found = Touching::new(both);
    for (of, t, other) in [(0, f, g), (1, g, f)] {
        let (corners, sides) = (t.triangle(), both[of]);
        for (i, corner) in corners.iter().enumerate() {
            let next = (i + 1) % 3;
            if sides[i] == Side::On && contains(other, corner) {
                add(
                    &mut found.points,
                    corner_point(of, i, corner, other.triangle()),
                );
            } else if sides[i].is_across_from(sides[next])
                && let Some(point) = piercing_point(of, [i, next], corners, other.triangle())
            {
                add(&mut found.points, point);
            }
        }
    }
    if let [from, to] = found.points[..] {
        let ends = [from, to];
        found.segments.push(CommonSegment { ends, along: None });
    }
    found
}

fn add(points: &mut SmallVec<[CommonPoint; 6]>, point: CommonPoint) {
    if !points.contains(&point) {
        points.push(point);
    }
}

/// Names a corner of a triangle; if it coincides with a corner of the first triangle, by that corner.
fn corner_point<P: PartialEq>(of: usize, corner: usize, point: &P, others: &[P; 3]) -> CommonPoint {
    match others.iter().position(|p| p == point).filter(|_| of == 1) {
        Some(twin) => CommonPoint::Corner(0, twin),
        None => CommonPoint::Corner(of, corner),
    }
}

/// Returns the point in which an edge that crosses the plane of triangle `other` meets this triangle; `None`
/// if it misses the triangle or meets it at a corner.
fn piercing_point(
    of: usize,
    edge: [usize; 2],
    t: &Triangle,
    other: &Triangle,
) -> Option<CommonPoint> {
    let [p, q] = edge.map(|i| t[i]);
    let beside = |k: usize| side(&[p, q, other[k]], &other[(k + 1) % 3]);
    let turns = [0, 1, 2].map(beside);
    if turns.contains(&Side::Plus) && turns.contains(&Side::Minus) {
        return None;
    }
    let mut on = (0..3).filter(|k| turns[*k] == Side::On);
    match (on.next(), on.next()) {
        (None, _) => Some(CommonPoint::Through(PiercingPoint { of, edge })),
        (Some(k), None) if of == 0 => Some(CommonPoint::Edges(edge[0], k)),
        (Some(k), None) => Some(CommonPoint::Edges(k, edge[0])),
        _ => None,
    }
}

/// Returns true if a triangle contains a point of its plane, inside or on the border.
fn contains(g: &Facing, p: &Point) -> bool {
    let axis = g.main_axis();
    let corners = seen_along(g.triangle(), axis);
    let [at, ..] = seen_along(&[*p; 3], axis);
    let turned = turn(corners);
    (0..3).all(|i| turn([corners[i], corners[(i + 1) % 3], at]) != -turned)
}

/// Returns the intersection of two triangles in one plane.
fn contact_in_one_plane(f: &Facing, g: &Facing, sides: [[Side; 3]; 2]) -> Touching {
    let axis = f.main_axis();
    let both = [f, g].map(|t| seen_along(t.triangle(), axis));
    let beside = [
        CornerSides::of(&both[0], &both[1]),
        CornerSides::of(&both[1], &both[0]),
    ];
    let mut found = Touching::new(sides);
    if beside.iter().any(CornerSides::is_apart) {
        return found;
    }
    for of in [0, 1] {
        for edge in 0..3 {
            let points = common_points_of_edge(of, edge, &both, &beside);
            if let [from, to] = points[..] {
                found.segments.push(CommonSegment {
                    ends: [from, to],
                    along: Some((of, edge)),
                });
            }
            for point in points {
                add(&mut found.points, point);
            }
        }
    }
    found.overlap = !beside.iter().any(CornerSides::is_outside);
    found
}

/// The sides of a triangle's edges on which the corners of another triangle of its plane lie.
struct CornerSides {
    /// The sign for each edge and each corner: negative if the corner is outside the edge, zero on its line.
    turns: [[Sign; 3]; 3],
}

impl CornerSides {
    fn of(edges: &[[f64; 2]; 3], corners: &[[f64; 2]; 3]) -> Self {
        let turned = turn(*edges);
        let at = |k: usize, i: usize| match turned {
            Sign::Negative => -turn([edges[k], edges[(k + 1) % 3], corners[i]]),
            _ => turn([edges[k], edges[(k + 1) % 3], corners[i]]),
        };
        Self {
            turns: [0, 1, 2].map(|k| [0, 1, 2].map(|i| at(k, i))),
        }
    }

    fn is_apart(&self) -> bool {
        self.turns.contains(&[Sign::Negative; 3])
    }

    /// Returns true if an edge separates the insides of the two triangles.
    fn is_outside(&self) -> bool {
        self.turns.iter().any(|t| !t.contains(&Sign::Positive))
    }

    fn contains(&self, corner: usize) -> bool {
        (0..3).all(|k| self.turns[k][corner] != Sign::Negative)
    }

    /// Returns true if the ends of edge number `edge` lie strictly on different sides of the line of edge
    /// number `by`.
    fn are_divided(&self, by: usize, edge: usize) -> bool {
        let [a, b] = [edge, (edge + 1) % 3].map(|i| self.turns[by][i]);
        a != Sign::Zero && b == -a
    }
}

/// Returns the ends of the intersection of an edge of triangle `of` with the other triangle, in one plane:
/// no, one or two points.
fn common_points_of_edge(
    of: usize,
    edge: usize,
    both: &[[[f64; 2]; 3]; 2],
    beside: &[CornerSides; 2],
) -> SmallVec<[CommonPoint; 6]> {
    let (ours, theirs) = (&both[of], &both[1 - of]);
    let (in_theirs, in_ours) = (&beside[1 - of], &beside[of]);
    let mut points = SmallVec::new();
    for end in [edge, (edge + 1) % 3]
        .into_iter()
        .filter(|i| in_theirs.contains(*i))
    {
        add(&mut points, corner_point(of, end, &ours[end], theirs));
    }
    for (k, corner) in theirs.iter().enumerate() {
        if in_theirs.are_divided(k, edge) && in_ours.are_divided(edge, k) {
            let [first, second] = if of == 0 { [edge, k] } else { [k, edge] };
            add(&mut points, CommonPoint::Edges(first, second));
        }
        let on_line = in_ours.turns[edge][k] == Sign::Zero;
        if on_line && is_between(ours[edge], *corner, ours[(edge + 1) % 3]) {
            add(&mut points, CommonPoint::Corner(1 - of, k));
        }
    }
    points
}

/// Returns true if the point p lies strictly between the points a and b of the same line.
fn is_between(a: [f64; 2], p: [f64; 2], b: [f64; 2]) -> bool {
    (0..2).any(|i| a[i] < p[i] && p[i] < b[i] || b[i] < p[i] && p[i] < a[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(corners: [[i32; 3]; 3]) -> Facing {
        Facing::of(&corners.map(|c| c.map(f64::from)))
    }

    /// A horizontal triangle whose front is above.
    const FLOOR: [[i32; 3]; 3] = [[0, 0, 0], [8, 0, 0], [0, 8, 0]];

    #[test]
    fn triangles_that_cross_have_a_segment_with_the_back_on_its_left() {
        // The normal points to smaller x, so larger x is behind, on the left of the direction -y.
        let wall = [[2, 1, -4], [2, 1, 4], [2, 3, 1]];
        let Contact::Crossing([from, to]) = contact(&of(FLOOR), &of(wall)) else {
            panic!("they cross");
        };
        let along = |end: PiercingPoint| {
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
    fn contacts_other_than_crossings_are_named() {
        let touching = [
            [[2, 2, 0], [2, 2, 5], [3, 1, 5]],
            [[0, 0, 0], [9, 9, 9], [8, 9, 9]],
            [[-4, 4, 0], [4, -4, 0], [0, 0, 9]],
            [[1, 1, 0], [2, 1, 0], [1, 2, 0]],
            [[9, 9, 0], [-9, 0, 0], [0, -9, 0]],
            [[4, 0, -3], [4, 0, 3], [4, -3, 0]],
        ];
        for other in touching {
            for (f, g) in [(FLOOR, other), (other, FLOOR)] {
                let found = contact(&of(f), &of(g));
                assert!(matches!(found, Contact::Touching(_)), "{other:?}");
            }
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

    /// Returns a name for a common point that does not depend on the order of the triangles.
    fn name(point: CommonPoint, pair: [&[[i32; 3]; 3]; 2]) -> Vec<[i32; 3]> {
        let edge = |of: usize, i: usize, j: usize| {
            let mut ends = [pair[of][i], pair[of][j]];
            ends.sort_unstable();
            ends
        };
        match point {
            CommonPoint::Corner(of, i) => vec![pair[of][i]],
            CommonPoint::Through(PiercingPoint { of, edge: [i, j] }) => edge(of, i, j).to_vec(),
            CommonPoint::Edges(i, j) => {
                let mut edges = [edge(0, i, (i + 1) % 3), edge(1, j, (j + 1) % 3)];
                edges.sort_unstable();
                edges.concat()
            }
        }
    }

    /// Intersects all pairs of a sample of the triangles in a small cube: the result does not depend on their
    /// order.
    #[test]
    fn common_points_are_named_alike_from_both_sides() {
        let point = |k: i32| [k % 3, k / 3 % 3, k / 9 % 3];
        let mut triangles =
            (0..2500).map(|k: i32| [7 * k, 11 * k + k / 27, 5 * k + k / 9].map(point));
        let triangles: Vec<_> = triangles
            .by_ref()
            .filter(|t| !crate::geometry::doubles::is_flat(&t.map(|c| c.map(f64::from))))
            .step_by(13)
            .collect();
        let mut found = 0;
        for (f, g) in triangles
            .iter()
            .flat_map(|f| triangles.iter().map(move |g| (f, g)))
        {
            let names = |f: &[[i32; 3]; 3], g: &[[i32; 3]; 3]| {
                let Contact::Touching(touching) = contact(&of(*f), &of(*g)) else {
                    return Vec::new();
                };
                let points = touching.points.iter().map(|s| name(*s, [f, g]));
                let mut names: Vec<_> = points.collect();
                names.sort_unstable();
                names
            };
            assert_eq!(names(f, g), names(g, f), "{f:?} {g:?}");
            found += names(f, g).len();
        }
        assert!(found > 1000, "{found}");
    }
}
