//! Coefficients, coordinates and measures on the line.

use num_bigint::BigInt;

use super::Affine;
use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::convert::as_double;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Split;
use crate::geometry::spaces::dim1::{Dim1, Direction, Point1};
use crate::geometry::spaces::space::Space;

fn sign(point: &Point1) -> i64 {
    match point.inside() {
        Direction::Below => 1,
        Direction::Above => -1,
    }
}

impl Affine for Dim1 {
    const EVERYTHING: () = ();
    const MAX_COORDINATE: i64 = MAX_COORDINATE;

    fn fragment(corners: &[Lattice]) -> Option<Point1> {
        corners.first().map(|p| Point1::new(p[0], Direction::Below))
    }

    fn approx(cut: &Point1) -> [f64; 4] {
        let s = as_double(sign(cut));
        [s, 0.0, 0.0, -s * as_double(cut.at())]
    }

    fn exact(cut: &Point1) -> [BigInt; 4] {
        let s = sign(cut);
        [s, 0, 0, -s * cut.at()].map(BigInt::from)
    }

    fn axis_cut(axis: usize, at: i64) -> Option<Point1> {
        (axis == 0 && at.abs() <= Self::MAX_COORDINATE).then(|| Point1::new(at, Direction::Below))
    }

    fn corners(piece: &Point1) -> Vec<[f64; 3]> {
        vec![[as_double(piece.at()), 0.0, 0.0]]
    }

    fn original_edges(_: &Point1, _: &[Lattice], _: &[bool]) -> Vec<bool> {
        vec![true]
    }

    fn relation(piece: &Point1, cut: &Point1) -> Split<()> {
        match Self::split(piece, cut) {
            Split::Coplanar(orientation) => Split::Coplanar(orientation),
            Split::Plus => Split::Plus,
            _ => Split::Minus,
        }
    }

    fn size(_: &Point1) -> f64 {
        1.0
    }

    fn cone_measure(piece: &Point1, apex: &[f64; 3]) -> f64 {
        (as_double(piece.at()) - apex[0]) * as_double(sign(piece))
    }
}
