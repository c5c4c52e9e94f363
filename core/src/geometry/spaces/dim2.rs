//! The plane: hyperplanes are lines through lattice points, fragments are segments of them.
//!
//! Notation: a line is a·x + b·y + c = 0, a point (x/w, y/w) with w > 0. Every line comes from lattice
//! points, given coefficients or the frame, never from constructed points, so that coefficients do not widen
//! (`arith::bounds`).

use std::cmp::Ordering;

use super::space::Space;
use crate::arith::bounds::{
    COORDINATE_BITS, LINE_AT_MEET_LIMBS, LINE_CROSS_LIMBS, LINE_MEET_LIMBS, LINE_NORMAL_BITS,
    LINE_OFFSET_BITS, MAX_COORDINATE,
};
use crate::arith::convert::as_double;
use crate::arith::{gcd, gcd_u128, Int, Sign};
use crate::geometry::plane::FILTER;
use crate::geometry::side::{Orientation, Side, Split};

/// The plane with integer lattice coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dim2;

/// A lattice point of the plane.
pub type Lattice2 = [i64; 2];

/// The frame of the plane: the square |x|, |y| ≤ [`MAX_COORDINATE`] + 1/2, whose border contains no lattice
/// point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Square;

/// An oriented line with coprime coefficients; its minus side is the left of its direction (−b, a).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Line2 {
    a: i64,
    b: i64,
    c: i128,
}

/// A line together with its coefficients in doubles, for many side tests.
#[derive(Clone, Copy, Debug)]
pub struct RoundedLine {
    line: Line2,
    rounded: [f64; 3],
}

/// An exact point of the plane: a lattice point, or the meet of two lines.
#[derive(Clone, Copy, Debug)]
pub struct Point2 {
    x: [Int<LINE_MEET_LIMBS>; 2],
    w: Int<2>,
    approx: [f64; 3],
}

/// A segment of a line, from its first to its last point along the line's direction.
///
/// Each end is the meet with another line, which has the segment on its minus side.
#[derive(Clone, Copy, Debug)]
pub struct Segment2 {
    line: Line2,
    ends: [Line2; 2],
    points: [Point2; 2],
}

impl Line2 {
    /// The line through two lattice points with its minus side to the left of `from` → `to`.
    ///
    /// Returns `None` if the points are equal or a coordinate exceeds [`MAX_COORDINATE`].
    pub fn through(from: Lattice2, to: Lattice2) -> Option<Self> {
        if from == to || !is_near(from) || !is_near(to) {
            return None;
        }
        Some(Self::normalized(to[1] - from[1], from[0] - to[0], from))
    }

    /// The line with the outward normal (a, b) through a lattice point.
    ///
    /// Returns `None` if the normal is zero or has [`LINE_NORMAL_BITS`] bits or more, or if a coordinate
    /// exceeds [`MAX_COORDINATE`].
    pub fn with_normal(normal: [i64; 2], point: Lattice2) -> Option<Self> {
        let wide = normal.iter().any(|n| is_wide(*n));
        if normal == [0; 2] || wide || !is_near(point) {
            return None;
        }
        Some(Self::normalized(normal[0], normal[1], point))
    }

    /// The line with these coefficients, divided by their greatest common divisor.
    ///
    /// Returns `None` if the normal is zero or a coefficient is too wide for a line through the frame.
    pub fn new(a: i64, b: i64, c: i128) -> Option<Self> {
        let narrow = !is_wide(a) && !is_wide(b) && c.unsigned_abs() < 1 << LINE_OFFSET_BITS;
        if [a, b] == [0; 2] || !narrow {
            return None;
        }
        let g = gcd_u128(u128::from(a.unsigned_abs()), u128::from(b.unsigned_abs()));
        let g = gcd_u128(g, c.unsigned_abs());
        // The divisor of narrow coefficients fits.
        let short = i64::try_from(g).unwrap_or(1).max(1);
        let (a, b, c) = (a / short, b / short, c / i128::from(short));
        Some(Self { a, b, c })
    }

    /// The line n·x = offset with the outward normal n = (a, b), if it may meet the lattice.
    ///
    /// Returns `None` if the offset is too large for that, or if the normal is zero or too wide.
    pub fn across_lattice(normal: [i64; 2], offset: i128) -> Option<Self> {
        let [a, b] = normal;
        if is_wide(a) || is_wide(b) {
            return None;
        }
        let size = u128::from(a.unsigned_abs()) + u128::from(b.unsigned_abs());
        if offset.unsigned_abs() < size << COORDINATE_BITS {
            Self::new(a, b, -offset)
        } else {
            None
        }
    }

    /// The line across an axis at a lattice coordinate, with smaller coordinates on its minus side.
    pub fn axis_cut(axis: usize, at: i64) -> Self {
        let [a, b] = [[1, 0], [0, 1]][axis.min(1)];
        let c = -i128::from(at);
        Self { a, b, c }
    }

    /// The line with normal (a, b) through a lattice point, its coefficients divided by their common divisor.
    fn normalized(a: i64, b: i64, point: Lattice2) -> Self {
        let g = gcd(a.unsigned_abs(), b.unsigned_abs());
        // Both coefficients are narrow, so their divisor fits.
        let g = i64::try_from(g).unwrap_or(1).max(1);
        let (a, b) = (a / g, b / g);
        let [x, y] = point.map(i128::from);
        let c = -(i128::from(a) * x + i128::from(b) * y);
        Self { a, b, c }
    }

    /// The same line with its two sides exchanged and its direction reversed.
    #[must_use]
    pub fn flipped(&self) -> Self {
        let Self { a, b, c } = *self;
        let (a, b, c) = (-a, -b, -c);
        Self { a, b, c }
    }

    /// The coefficients of the line a·x + b·y + c = 0: the normal [a, b], and c.
    pub fn coefficients(&self) -> ([i64; 2], i128) {
        ([self.a, self.b], self.c)
    }

    fn side_of(&self, p: &Point2) -> Side {
        RoundedLine::of(*self).side_of(p)
    }

    /// The side of the line on which a point lies, in integers.
    fn exact_side_of(&self, p: &Point2) -> Side {
        if let Some([x, y]) = p.as_lattice() {
            let along = i128::from(self.a) * i128::from(x) + i128::from(self.b) * i128::from(y);
            return Side::from_order((along + self.c).cmp(&0));
        }
        let along: Int<LINE_AT_MEET_LIMBS> = p.x[0].mul_i64(self.a) + p.x[1].mul_i64(self.b);
        let last: Int<LINE_AT_MEET_LIMBS> = p.w.mul(&Int::<2>::from_i128(self.c));
        Side::from_sign((along + last).sign())
    }

    /// The order of two lines by the angle of their directions (−b, a): `Less` if the other line's direction
    /// is counterclockwise from this line's by less than a half turn.
    #[inline]
    pub fn turn(&self, other: &Self) -> Ordering {
        let product = |m: i64, n: i64| i128::from(m) * i128::from(n);
        (product(self.b, other.a)).cmp(&product(self.a, other.b))
    }

    /// Return whether two lines are parallel, in the same or in opposite directions.
    pub fn is_parallel(&self, other: &Self) -> bool {
        self.turn(other) == Ordering::Equal
    }

    /// The line across this one at a lattice point on it, parallel to the axis that makes the larger angle
    /// with this line; points farther along this line's direction are on its minus side.
    fn across(&self, point: Lattice2) -> Self {
        let direction = [-self.b, self.a];
        if direction[0].abs() >= direction[1].abs() {
            Self::normalized(-direction[0].signum(), 0, point)
        } else {
            Self::normalized(0, -direction[1].signum(), point)
        }
    }
}

impl RoundedLine {
    /// A line and its coefficients rounded to doubles.
    pub fn of(line: Line2) -> Self {
        let rounded = [as_double(line.a), as_double(line.b), as_double(line.c)];
        Self { line, rounded }
    }

    /// The line with its exact coefficients.
    pub fn line(&self) -> &Line2 {
        &self.line
    }

    /// The side of the line on which a point lies: by doubles if they decide it, else exactly.
    #[inline]
    pub fn side_of(&self, p: &Point2) -> Side {
        let [a, b, c] = self.rounded;
        let t = [a * p.approx[0], b * p.approx[1], c * p.approx[2]];
        let sum = t[0] + t[1] + t[2];
        if sum.abs() > (t[0].abs() + t[1].abs() + t[2].abs()) * FILTER {
            return if sum > 0.0 { Side::Plus } else { Side::Minus };
        }
        self.line.exact_side_of(p)
    }
}

impl Point2 {
    /// The lattice point (x, y).
    #[inline]
    pub fn lattice(p: Lattice2) -> Self {
        Self {
            x: [Int::from_i64(p[0]), Int::from_i64(p[1])],
            w: Int::ONE,
            approx: [as_double(p[0]), as_double(p[1]), 1.0],
        }
    }

    /// The point where two lines meet; `None` if they are parallel.
    pub fn meet(p: &Line2, q: &Line2) -> Option<Self> {
        let wide = |k: i64| i128::from(k);
        let w = wide(p.a) * wide(q.b) - wide(q.a) * wide(p.b);
        let times = |k: i64, c: i128| Int::<2>::from_i128(c).mul_i64::<3>(k);
        let x = times(p.b, q.c) - times(q.b, p.c);
        let y = times(q.a, p.c) - times(p.a, q.c);
        match Sign::of(w) {
            Sign::Zero => None,
            Sign::Positive => Some(Self::homogeneous([x, y], Int::from_i128(w))),
            Sign::Negative => Some(Self::homogeneous([-x, -y], Int::from_i128(-w))),
        }
    }

    #[inline]
    fn homogeneous(x: [Int<3>; 2], w: Int<2>) -> Self {
        let approx = [x[0].to_f64(), x[1].to_f64(), w.to_f64()];
        Self { x, w, approx }
    }

    /// The lattice coordinates, or `None` if the denominator is not 1.
    #[inline]
    pub fn as_lattice(&self) -> Option<Lattice2> {
        if self.w != Int::ONE {
            return None;
        }
        let whole = |x: &Int<LINE_MEET_LIMBS>| i64::try_from(x.to_i128()?).ok();
        Some([whole(&self.x[0])?, whole(&self.x[1])?])
    }

    /// The homogeneous coordinates: x and y times w, and w > 0.
    pub fn coordinates(&self) -> (&[Int<3>; 2], &Int<2>) {
        (&self.x, &self.w)
    }

    /// The coordinates in doubles, each within two units in the last place.
    #[inline]
    pub fn approx(&self) -> [f64; 2] {
        [
            self.approx[0] / self.approx[2],
            self.approx[1] / self.approx[2],
        ]
    }

    /// The exact order of two points by their coordinate along an axis.
    #[inline]
    pub fn compare(&self, other: &Self, axis: usize) -> Ordering {
        let left = self.approx[axis] * other.approx[2];
        let right = other.approx[axis] * self.approx[2];
        if (left - right).abs() > (left.abs() + right.abs()) * FILTER {
            return left.partial_cmp(&right).unwrap_or(Ordering::Equal);
        }
        let left: Int<LINE_CROSS_LIMBS> = self.x[axis].mul(&other.w);
        let right: Int<LINE_CROSS_LIMBS> = other.x[axis].mul(&self.w);
        left.cmp(&right)
    }

    /// The exact order of two points by x, then y.
    #[inline]
    pub fn order(&self, other: &Self) -> Ordering {
        self.compare(other, 0).then_with(|| self.compare(other, 1))
    }
}

impl Segment2 {
    /// The segment between two lattice points, with its minus side to the left of `from` → `to`.
    ///
    /// Returns `None` if the points are equal or a coordinate exceeds [`MAX_COORDINATE`].
    pub fn between(from: Lattice2, to: Lattice2) -> Option<Self> {
        let line = Line2::through(from, to)?;
        Some(Self {
            line,
            ends: [line.across(from), line.flipped().across(to)],
            points: [from, to].map(Point2::lattice),
        })
    }

    /// The segment of a line between two of its points, in order; `limits` are lines that cross it in these
    /// points, with either orientation.
    pub fn limited(line: Line2, limits: [Line2; 2], points: [Point2; 2]) -> Self {
        // The segment lies on the minus side of both limits: its line enters that of the first and leaves
        // that of the last.
        let turned = |limit: Line2, enters: bool| {
            if (line.turn(&limit) == Ordering::Greater) == enters {
                limit
            } else {
                limit.flipped()
            }
        };
        let ends = [turned(limits[0], true), turned(limits[1], false)];
        Self { line, ends, points }
    }

    /// The line in which the segment lies, with the segment's direction.
    pub fn line(&self) -> &Line2 {
        &self.line
    }

    /// The lines that cross the segment's line in its first and in its last point, with the segment on their
    /// minus sides.
    pub fn limits(&self) -> &[Line2; 2] {
        &self.ends
    }

    /// The first and the last point of the segment along its line's direction.
    pub fn points(&self) -> &[Point2; 2] {
        &self.points
    }

    /// The order of two points of the segment's line along the line's direction.
    pub fn order_along(&self, p: &Point2, q: &Point2) -> Ordering {
        let direction = [-self.line.b, self.line.a];
        let axis = usize::from(direction[0].unsigned_abs() < direction[1].unsigned_abs());
        match direction[axis] {
            ..=-1 => q.compare(p, axis),
            _ => p.compare(q, axis),
        }
    }

    /// The segment from the first point of this segment to the last point of another segment, which lies
    /// farther along the same line.
    #[must_use]
    pub fn joined(&self, last: &Self) -> Self {
        let mut longer = *self;
        longer.points[1] = last.points[1];
        longer.ends[1] = last.ends[1];
        longer
    }

    /// The segment with its first (`end` = 0) or last (1) point moved to the point where the line `cut`
    /// crosses the segment's line; `None` if the lines are parallel.
    fn cut_at_end(&self, end: usize, cut: Line2) -> Option<Self> {
        let mut shorter = *self;
        shorter.points[end] = Point2::meet(&self.line, &cut)?;
        shorter.ends[end] = cut;
        Some(shorter)
    }

    /// The parts of the segment on the minus and on the plus side of a line; the first point of the segment
    /// lies on the side `first`, the last point on the other side. `None` if the two lines are parallel.
    fn split_by(&self, first: Side, cut: &Line2) -> Option<Split<Self>> {
        let flipped = cut.flipped();
        let (inner, outer) = match first {
            Side::Minus => (self.cut_at_end(1, *cut)?, self.cut_at_end(0, flipped)?),
            _ => (self.cut_at_end(0, *cut)?, self.cut_at_end(1, flipped)?),
        };
        Some(Split::Both {
            minus: inner,
            plus: outer,
        })
    }
}

impl Space for Dim2 {
    const DIM: usize = 2;
    type Point = Point2;
    type Hyperplane = Line2;
    type Fragment = Segment2;
    type Frame = Square;

    fn side(cut: &Line2, point: &Point2) -> Side {
        cut.side_of(point)
    }

    fn coincide(a: &Line2, b: &Line2) -> Option<Orientation> {
        if a == b {
            Some(Orientation::Same)
        } else {
            (*a == b.flipped()).then_some(Orientation::Opposite)
        }
    }

    fn split(piece: &Segment2, cut: &Line2) -> Split<Segment2> {
        if let Some(orientation) = Self::coincide(&piece.line, cut) {
            return Split::Coplanar(orientation);
        }
        let [first, last] = piece.points.map(|p| cut.side_of(&p));
        match (first, last) {
            (Side::Minus | Side::On, Side::Minus | Side::On) => Split::Minus,
            (Side::Plus | Side::On, Side::Plus | Side::On) => Split::Plus,
            // The ends lie strictly on different sides of the line, so it is not parallel to the segment.
            _ => piece.split_by(first, cut).unwrap_or(Split::Minus),
        }
    }

    fn span(cut: &Line2, _: &Square) -> Option<Segment2> {
        let walls = square_walls();
        let crossing = |wall: &&Line2| Point2::meet(cut, wall).is_some();
        let mut crossed = walls.iter().filter(crossing);
        let (first, second) = (crossed.next()?, crossed.next()?);
        let whole = between_walls(cut, first, second)?;
        walls.iter().try_fold(whole, |rest, wall| {
            super::space::clip::<Self>(rest, wall, crate::geometry::side::Half::Minus)
        })
    }

    fn hyperplane(piece: &Segment2) -> &Line2 {
        &piece.line
    }

    fn reversed(piece: &Segment2) -> Segment2 {
        let [first, last] = piece.points;
        Segment2 {
            line: piece.line.flipped(),
            ends: [piece.ends[1], piece.ends[0]],
            points: [last, first],
        }
    }

    fn rims(piece: &Segment2) -> Vec<Line2> {
        piece.ends.to_vec()
    }
}

/// The segment of a line between two opposite walls of the frame; `None` if it is parallel to them.
fn between_walls(line: &Line2, p: &Line2, q: &Line2) -> Option<Segment2> {
    let points = [Point2::meet(line, p)?, Point2::meet(line, q)?];
    let whole = Segment2 {
        line: *line,
        ends: [*p, *q],
        points,
    };
    // The wall at the first point faces against the line's direction (−b, a).
    let product = |m: i64, n: i64| i128::from(m) * i128::from(n);
    let along = product(p.b, line.a) - product(p.a, line.b);
    if along < 0 {
        return Some(whole);
    }
    Some(Segment2 {
        ends: [*q, *p],
        points: [points[1], points[0]],
        ..whole
    })
}

/// The lines of the frame's four walls, opposite ones in pairs, with the frame on their minus sides.
fn square_walls() -> [Line2; 4] {
    let c = -(2 * i128::from(MAX_COORDINATE) + 1);
    [(2, 0), (-2, 0), (0, 2), (0, -2)].map(|(a, b)| Line2 { a, b, c })
}

/// The border of the frame as four segments, with the frame on their minus sides.
pub fn border() -> Vec<Segment2> {
    let walls = square_walls();
    let side = |i: usize| {
        let [p, q] = [walls[(i + 2) % 4], walls[((i + 2) % 4) ^ 1]];
        between_walls(&walls[i], &p, &q)
    };
    (0..4).filter_map(side).collect()
}

/// Return whether a component of a normal has [`LINE_NORMAL_BITS`] bits or more, too wide for a line.
fn is_wide(component: i64) -> bool {
    component.unsigned_abs() >= 1 << LINE_NORMAL_BITS
}

fn is_near(point: Lattice2) -> bool {
    point
        .iter()
        .all(|k| k.unsigned_abs() <= MAX_COORDINATE.unsigned_abs())
}
