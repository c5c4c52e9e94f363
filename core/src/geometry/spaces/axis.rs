//! Operations of spaces with coordinate axes that are needed for building a tree inside a frame: hyperplanes
//! across the axes, and the frame's border.

use std::sync::Arc;

use super::dim1::{Dim1, Direction, Point1};
use super::dim2::{Dim2, Line2, Square};
use super::dim3::Dim3;
use super::space::Space;
use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::convert::as_whole;
use crate::arith::Sign;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Plane;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Half;

/// A space with coordinate axes, in a frame around all lattice points.
pub trait AxisSpace: Space {
    /// A coordinate of the fragment's first corner, rounded to the lattice.
    fn corner(piece: &Self::Fragment, axis: usize) -> i64;

    /// The hyperplane across an axis at a lattice coordinate, with smaller coordinates on its minus side.
    fn axis_cut(axis: usize, at: i64) -> Self::Hyperplane;

    /// The frame: a convex body around all lattice points.
    fn universe() -> Self::Frame;

    /// The border of the frame as convex fragments, with the frame on their minus sides.
    fn border() -> Vec<Self::Fragment>;

    /// The side of a hyperplane on which the frame's corner of least coordinates lies, moved inwards by (ε,
    /// ε², ε³) for an infinitely small ε.
    fn side_of_corner(cut: &Self::Hyperplane) -> Half;
}

impl AxisSpace for Dim1 {
    fn corner(piece: &Point1, _: usize) -> i64 {
        piece.at()
    }

    fn axis_cut(_: usize, at: i64) -> Point1 {
        Point1::new(at, Direction::Below)
    }

    fn universe() {}

    fn border() -> Vec<Point1> {
        let beyond = MAX_COORDINATE + 1;
        vec![
            Point1::new(-beyond, Direction::Above),
            Point1::new(beyond, Direction::Below),
        ]
    }

    fn side_of_corner(cut: &Point1) -> Half {
        match cut.inside() {
            Direction::Below => Half::Minus,
            Direction::Above => Half::Plus,
        }
    }
}

impl AxisSpace for Dim2 {
    fn corner(piece: &super::dim2::Segment2, axis: usize) -> i64 {
        as_whole(piece.points()[0].approx()[axis].round())
    }

    fn axis_cut(axis: usize, at: i64) -> Line2 {
        Line2::axis_cut(axis, at)
    }

    fn universe() -> Square {
        Square
    }

    fn border() -> Vec<super::dim2::Segment2> {
        super::dim2::border()
    }

    fn side_of_corner(cut: &Line2) -> Half {
        let ([a, b], c) = cut.coefficients();
        let wall = 2 * i128::from(MAX_COORDINATE) + 1;
        let value = 2 * c - (i128::from(a) + i128::from(b)) * wall;
        Half::from_sign(Sign::first([Sign::of(value), Sign::of(a), Sign::of(b)]))
    }
}

impl AxisSpace for Dim3 {
    fn corner(piece: &Polygon, axis: usize) -> i64 {
        as_whole(piece.corners()[0].at.approx()[axis].round())
    }

    fn axis_cut(axis: usize, at: i64) -> Arc<Plane> {
        Arc::new(Plane::axis_cut(axis, 2 * at))
    }

    fn universe() -> Cell {
        Cell::UNIVERSE
    }

    fn border() -> Vec<Polygon> {
        // Half a step inside the cell's walls, outside all meshes: a wall has no span in its own cell.
        let (low, high) = (Cell::UNIVERSE.low(), Cell::UNIVERSE.high());
        let wall = |i: usize| {
            let axis = i / 2;
            let plane = match i % 2 {
                0 => Plane::axis_cut(axis, 2 * low[axis]).flipped(),
                _ => Plane::axis_cut(axis, 2 * high[axis]),
            };
            Polygon::span(&Arc::new(plane), &Cell::UNIVERSE)
        };
        (0..6).filter_map(wall).collect()
    }

    fn side_of_corner(cut: &Arc<Plane>) -> Half {
        cut.side_of_corner(&Cell::UNIVERSE.corner())
    }
}
