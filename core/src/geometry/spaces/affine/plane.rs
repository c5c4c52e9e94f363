//! Coefficients, coordinates and measures in the plane.

use num_bigint::BigInt;

use super::Affine;
use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::convert::as_double;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Split;
use crate::geometry::spaces::dim2::{Dim2, Line2, Point2, Segment2, Square};
use crate::geometry::spaces::space::Space;

fn position(point: &Point2) -> [f64; 3] {
    let [x, y] = point.approx();
    [x, y, 0.0]
}

fn is_lattice(point: &Point2, lattice: &Lattice) -> bool {
    let corner = Point2::lattice([lattice[0], lattice[1]]);
    corner.order(point).is_eq()
}

fn turn(a: &[f64; 3], b: &[f64; 3], apex: &[f64; 3]) -> f64 {
    (a[0] - apex[0]) * (b[1] - apex[1]) - (b[0] - apex[0]) * (a[1] - apex[1])
}

impl Affine for Dim2 {
    const EVERYTHING: Square = Square;
    const MAX_COORDINATE: i64 = MAX_COORDINATE;

    fn fragment(corners: &[Lattice]) -> Option<Segment2> {
        match corners {
            [a, b] => Segment2::between([a[0], a[1]], [b[0], b[1]]),
            _ => None,
        }
    }

    fn approx(cut: &Line2) -> [f64; 4] {
        let ([a, b], c) = cut.coefficients();
        [as_double(a), as_double(b), 0.0, as_double(c)]
    }

    fn exact(cut: &Line2) -> [BigInt; 4] {
        let ([a, b], c) = cut.coefficients();
        [a.into(), b.into(), BigInt::ZERO, c.into()]
    }

    fn axis_cut(axis: usize, at: i64) -> Option<Line2> {
        (axis < 2 && at.abs() <= Self::MAX_COORDINATE).then(|| Line2::axis_cut(axis, at))
    }

    fn corners(piece: &Segment2) -> Vec<[f64; 3]> {
        piece.points().iter().map(position).collect()
    }

    fn original_edges(piece: &Segment2, facet: &[Lattice], _: &[bool]) -> Vec<bool> {
        let is_end = |p: &Point2| facet.iter().any(|end| is_lattice(p, end));
        piece.points().iter().map(is_end).collect()
    }

    fn relation(piece: &Segment2, cut: &Line2) -> Split<()> {
        if let Some(orientation) = Self::coincide(piece.line(), cut) {
            return Split::Coplanar(orientation);
        }
        super::relation_of(piece.points().iter().map(|p| Self::side(cut, p)))
    }

    fn size(piece: &Segment2) -> f64 {
        let [a, b] = [0, 1].map(|i| position(&piece.points()[i]));
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        (x * x + y * y).sqrt()
    }

    fn cone_measure(piece: &Segment2, apex: &[f64; 3]) -> f64 {
        let [a, b] = [0, 1].map(|i| position(&piece.points()[i]));
        turn(&a, &b, apex) / 2.0
    }
}
