//! The line, whose hyperplanes are oriented points; simple enough for exhaustive tests.

use super::space::Space;
use crate::geometry::side::{Orientation, Side, Split};

/// The line with integer coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dim1;

/// A point of the line that separates an inside from an outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Point1 {
    at: i64,
    inside: Direction,
}

/// One of the two directions along the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Towards smaller coordinates.
    Below,
    /// Towards larger coordinates.
    Above,
}

impl Point1 {
    /// The point at `at` with its minus side in direction `inside`.
    pub fn new(at: i64, inside: Direction) -> Self {
        Self { at, inside }
    }

    /// The coordinate of the point, in lattice steps.
    pub fn at(&self) -> i64 {
        self.at
    }

    /// The direction in which the point's minus side lies.
    pub fn inside(&self) -> Direction {
        self.inside
    }
}

impl Space for Dim1 {
    const DIM: usize = 1;
    type Point = i64;
    type Hyperplane = Point1;
    type Fragment = Point1;
    type Frame = ();

    fn side(cut: &Point1, point: &i64) -> Side {
        let side = Side::from_order(point.cmp(&cut.at));
        match cut.inside {
            Direction::Below => side,
            Direction::Above => side.opposite(),
        }
    }

    fn coincide(a: &Point1, b: &Point1) -> Option<Orientation> {
        (a.at == b.at).then(|| {
            if a.inside == b.inside {
                Orientation::Same
            } else {
                Orientation::Opposite
            }
        })
    }

    fn split(piece: &Point1, cut: &Point1) -> Split<Point1> {
        match (Self::coincide(piece, cut), Self::side(cut, &piece.at)) {
            (Some(orientation), _) => Split::Coplanar(orientation),
            (None, Side::Minus) => Split::Minus,
            (None, _) => Split::Plus,
        }
    }

    fn span(cut: &Point1, (): &()) -> Option<Point1> {
        Some(*cut)
    }

    fn hyperplane(piece: &Point1) -> &Point1 {
        piece
    }

    fn reversed(piece: &Point1) -> Point1 {
        let inside = match piece.inside {
            Direction::Below => Direction::Above,
            Direction::Above => Direction::Below,
        };
        Point1::new(piece.at, inside)
    }

    fn rims(_: &Point1) -> Vec<Point1> {
        Vec::new()
    }
}
