//! The trait of spaces for stab trees: what these need to know of facets and hyperplanes.

use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::Int;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Side;
use crate::geometry::spaces::dim1::{Dim1, Direction, Point1};
use crate::geometry::spaces::dim2::{Dim2, Line2, Point2, Segment2};
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::spaces::space::Space;
use std::sync::Arc;

/// A space of `D` dimensions in which stab trees are built over facets of `D` lattice corners.
pub trait Cast<const D: usize>: Space {
    /// The largest magnitude of a lattice coordinate.
    const MAX_COORDINATE: i64;

    /// Makes the fragment that covers a whole facet.
    ///
    /// # Errors
    /// `TooLarge` beyond [`Self::MAX_COORDINATE`]; `Internal` for a facet without extent.
    fn fragment(corners: &[[i64; D]; D]) -> Result<Self::Fragment>;

    /// Returns normal n and offset c of the hyperplane n·x + c = 0; the value is positive on the plus side.
    fn coefficients(cut: &Self::Hyperplane) -> ([i128; D], Int<3>);

    /// Returns true if a fragment on one side of `cut` can have a point in the interior of a facet in `cut`.
    ///
    /// It cannot if at most two corners of the fragment lie in the cut, and these are corners of the facet.
    fn touches(piece: &Self::Fragment, cut: &Self::Hyperplane, facet: &[[i64; D]; D]) -> bool;
}

fn without_extent() -> Error {
    Error::internal("a facet without extent got into a tree")
}

impl Cast<1> for Dim1 {
    const MAX_COORDINATE: i64 = MAX_COORDINATE - 1;

    fn fragment(corners: &[[i64; 1]; 1]) -> Result<Point1> {
        Ok(Point1::new(corners[0][0], Direction::Below))
    }

    fn coefficients(cut: &Point1) -> ([i128; 1], Int<3>) {
        match cut.inside() {
            Direction::Below => ([1], Int::from_i64(-cut.at())),
            Direction::Above => ([-1], Int::from_i64(cut.at())),
        }
    }

    fn touches(_: &Point1, _: &Point1, _: &[[i64; 1]; 1]) -> bool {
        false
    }
}

impl Cast<2> for Dim2 {
    const MAX_COORDINATE: i64 = MAX_COORDINATE;

    fn fragment(corners: &[[i64; 2]; 2]) -> Result<Segment2> {
        let [from, to] = *corners;
        Segment2::between(from, to).ok_or_else(|| {
            if from == to {
                return without_extent();
            }
            let text = "a segment has an end beyond the lattice of 2^53 steps; scale the segments \
                        down, or choose a coarser pitch";
            Error::new(ErrorKind::TooLarge, text)
        })
    }

    fn coefficients(cut: &Line2) -> ([i128; 2], Int<3>) {
        let (normal, c) = cut.coefficients();
        (normal.map(i128::from), Int::from_i128(c))
    }

    fn touches(piece: &Segment2, cut: &Line2, facet: &[[i64; 2]; 2]) -> bool {
        let ends = facet.map(Point2::lattice);
        let is_end = |p: &Point2| ends.iter().any(|end| end.order(p).is_eq());
        piece
            .points()
            .iter()
            .any(|p| Self::side(cut, p) == Side::On && !is_end(p))
    }
}

impl Cast<3> for Dim3 {
    const MAX_COORDINATE: i64 = MAX_COORDINATE - 1;

    fn fragment(corners: &[[i64; 3]; 3]) -> Result<Polygon> {
        let [a, b, c] = corners;
        let plane = Plane::through(a, b, c).ok_or_else(without_extent)?;
        Ok(Polygon::triangle(corners, Arc::new(plane)))
    }

    fn coefficients(cut: &Arc<Plane>) -> ([i128; 3], Int<3>) {
        (*cut.normal(), *cut.offset())
    }

    fn touches(piece: &Polygon, cut: &Arc<Plane>, facet: &[[i64; 3]; 3]) -> bool {
        let corners = piece.corners().iter();
        let on = corners.filter(|c| c.at.side_of(cut) == Side::On);
        on.into_iter()
            .any(|c| c.at.as_lattice().is_none_or(|p| !facet.contains(p)))
    }
}
