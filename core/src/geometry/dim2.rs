//! The plane: hyperplanes are lines through lattice points, fragments are segments of them.
//!
//! Notation: a line is a·x + b·y + c = 0, a point (x/w, y/w) with w > 0. Every line comes from
//! lattice points or the frame, never from constructed points, so that widths do not grow.
//!
//! # Bits
//! Lattice coordinates |k| ≤ 2^30: a, b ≤ 2^31, c ≤ 2^62, w ≤ 2^63, x and y ≤ 2^94, the side of a
//! meet ≤ 2^127 (each product of two lines' coefficients is bounded by the edge they come from).

use super::side::{Orientation, Side, Split};
use super::space::Space;

/// Lattice coordinates are at most this large in magnitude.
pub const REACH: i64 = 1 << 30;

/// The plane with integer lattice coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dim2;

/// A lattice point of the plane.
pub type Lattice2 = [i64; 2];

/// The square |x|, |y| ≤ [`REACH`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Square;

/// An oriented line with coprime coefficients; its minus side is the left of its direction (−b, a).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Line2 {
    a: i64,
    b: i64,
    c: i64,
}

/// An exact point: a lattice point, or where two lines meet.
#[derive(Clone, Copy, Debug)]
pub struct Point2 {
    x: i128,
    y: i128,
    w: i128,
}

/// A segment of a line, from its first to its last point along the line's direction.
///
/// Each end is named by a line that crosses the segment's own there, the segment on its minus side.
#[derive(Clone, Copy, Debug)]
pub struct Segment2 {
    line: Line2,
    ends: [Line2; 2],
    points: [Point2; 2],
}

impl Line2 {
    /// The line through two lattice points with its minus side to the left of `from` → `to`.
    ///
    /// Returns `None` if the points are equal or beyond [`REACH`].
    pub fn through(from: Lattice2, to: Lattice2) -> Option<Self> {
        let inside = |p: Lattice2| p.iter().all(|k| k.abs() <= REACH);
        if from == to || !inside(from) || !inside(to) {
            return None;
        }
        Some(Self::normalized(to[1] - from[1], from[0] - to[0], from))
    }

    /// The line through a lattice point with normal (a, b).
    fn normalized(a: i64, b: i64, point: Lattice2) -> Self {
        let g = gcd(a.unsigned_abs(), b.unsigned_abs());
        // Both coefficients are below 2^32, so their divisor fits.
        let g = i64::try_from(g).unwrap_or(1).max(1);
        let (a, b) = (a / g, b / g);
        let c = -(a * point[0] + b * point[1]);
        Self { a, b, c }
    }

    /// The same line with its sides exchanged.
    #[must_use]
    pub fn flipped(&self) -> Self {
        let Self { a, b, c } = *self;
        let (a, b, c) = (-a, -b, -c);
        Self { a, b, c }
    }

    /// The coefficients a, b, c.
    pub fn coefficients(&self) -> [i64; 3] {
        [self.a, self.b, self.c]
    }

    fn side_of(&self, p: &Point2) -> Side {
        let [a, b, c] = [self.a, self.b, self.c].map(i128::from);
        let value = a * p.x + b * p.y + c * p.w;
        Side::from_sign(sign(value))
    }

    /// The line across this one at a lattice point on it, parallel to the axis this line is less
    /// parallel to, its minus side along this line's direction.
    fn across(&self, point: Lattice2) -> Self {
        let direction = [-self.b, self.a];
        if direction[0].abs() >= direction[1].abs() {
            Self::normalized(-direction[0].signum(), 0, point)
        } else {
            Self::normalized(0, -direction[1].signum(), point)
        }
    }
}

impl Point2 {
    /// The lattice point (x, y).
    pub fn lattice(p: Lattice2) -> Self {
        let [x, y] = p.map(i128::from);
        Self { x, y, w: 1 }
    }

    /// The point where two lines meet, `None` if they are parallel.
    pub fn meet(p: &Line2, q: &Line2) -> Option<Self> {
        let [a, b, c] = p.coefficients().map(i128::from);
        let [d, e, f] = q.coefficients().map(i128::from);
        let [x, y, w] = [b * f - e * c, c * d - f * a, a * e - d * b];
        match sign(w) {
            0 => None,
            1 => Some(Self { x, y, w }),
            _ => Some(Self {
                x: -x,
                y: -y,
                w: -w,
            }),
        }
    }

    /// The homogeneous coordinates (x, y, w), w > 0.
    pub fn coordinates(&self) -> [i128; 3] {
        [self.x, self.y, self.w]
    }
}

impl Segment2 {
    /// The segment between two lattice points, its minus side to the left of `from` → `to`.
    ///
    /// Returns `None` if the points are equal or beyond [`REACH`].
    pub fn between(from: Lattice2, to: Lattice2) -> Option<Self> {
        let line = Line2::through(from, to)?;
        Some(Self {
            line,
            ends: [line.across(from), line.flipped().across(to)],
            points: [from, to].map(Point2::lattice),
        })
    }

    /// The line the segment lies in.
    pub fn line(&self) -> &Line2 {
        &self.line
    }

    /// The first and the last point along the line's direction.
    pub fn points(&self) -> &[Point2; 2] {
        &self.points
    }

    /// The segment with one end moved to where `cut` crosses it.
    fn ended(&self, end: usize, cut: Line2) -> Option<Self> {
        let mut shorter = *self;
        shorter.points[end] = Point2::meet(&self.line, &cut)?;
        shorter.ends[end] = cut;
        Some(shorter)
    }

    /// The two parts of a segment whose first point lies on side `first` of `cut`, its last beyond.
    fn parted(&self, first: Side, cut: &Line2) -> Option<Split<Self>> {
        let flipped = cut.flipped();
        let (inner, outer) = match first {
            Side::Minus => (self.ended(1, *cut)?, self.ended(0, flipped)?),
            _ => (self.ended(0, *cut)?, self.ended(1, flipped)?),
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
            // Points strictly on both sides of a line: it is not parallel to the segment.
            _ => piece.parted(first, cut).unwrap_or(Split::Minus),
        }
    }

    fn span(cut: &Line2, _: &Square) -> Option<Segment2> {
        let walls = square_walls();
        let crossing = |wall: &&Line2| Point2::meet(cut, wall).is_some();
        let mut crossed = walls.iter().filter(crossing);
        let (first, second) = (crossed.next()?, crossed.next()?);
        let whole = between_walls(cut, first, second)?;
        walls.iter().try_fold(whole, |rest, wall| {
            super::space::clip::<Self>(rest, wall, super::side::Half::Minus)
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

/// The part of `line` between two opposite walls that it crosses.
fn between_walls(line: &Line2, p: &Line2, q: &Line2) -> Option<Segment2> {
    let points = [Point2::meet(line, p)?, Point2::meet(line, q)?];
    let whole = Segment2 {
        line: *line,
        ends: [*p, *q],
        points,
    };
    // The wall at the first point faces against the line's direction (−b, a).
    let along = p.b * line.a - p.a * line.b;
    if along < 0 {
        return Some(whole);
    }
    Some(Segment2 {
        ends: [*q, *p],
        points: [points[1], points[0]],
        ..whole
    })
}

/// The lines that bound the frame, opposite ones together, the frame on their minus sides.
fn square_walls() -> [Line2; 4] {
    [(1, 0), (-1, 0), (0, 1), (0, -1)].map(|(a, b)| Line2 { a, b, c: -REACH })
}

fn sign(value: i128) -> i32 {
    i32::from(value > 0) - i32::from(value < 0)
}

fn gcd(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}
