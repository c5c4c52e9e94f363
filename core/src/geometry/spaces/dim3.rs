//! Space: hyperplanes are planes with coprime integer coefficients, fragments are convex polygons.
//!
//! # Bits
//! Every plane comes from lattice points or the frame, so the widest predicate is the side of a meet of three
//! planes (`arith::bounds`).

use std::sync::Arc;

use super::space::Space;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Plane;
use crate::geometry::polygon::{Polygon, PolygonSplit};
use crate::geometry::side::{Orientation, Side, Split};
use crate::geometry::vertex::Vertex;

/// Space with integer lattice coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dim3;

impl Space for Dim3 {
    const DIM: usize = 3;
    type Point = Vertex;
    type Hyperplane = Arc<Plane>;
    type Fragment = Polygon;
    type Frame = Cell;

    fn side(cut: &Arc<Plane>, point: &Vertex) -> Side {
        point.side_of(cut)
    }

    fn coincide(a: &Arc<Plane>, b: &Arc<Plane>) -> Option<Orientation> {
        a.coincides(b)
    }

    fn split(piece: &Polygon, cut: &Arc<Plane>) -> Split<Polygon> {
        // Comparing coefficients first avoids exact zeros for all corners.
        if let Some(orientation) = Self::coincide(piece.support(), cut) {
            return Split::Coplanar(orientation);
        }
        match piece.split(cut) {
            // A polygon of positive area lies in no plane but its own.
            PolygonSplit::Minus | PolygonSplit::Coplanar => Split::Minus,
            PolygonSplit::Plus => Split::Plus,
            PolygonSplit::Both(minus, plus) => Split::Both { minus, plus },
        }
    }

    fn span(cut: &Arc<Plane>, frame: &Cell) -> Option<Polygon> {
        Polygon::span(cut, frame)
    }

    fn hyperplane(piece: &Polygon) -> &Arc<Plane> {
        piece.support()
    }

    fn reversed(piece: &Polygon) -> Polygon {
        piece.flipped()
    }

    fn rims(piece: &Polygon) -> Vec<Arc<Plane>> {
        let rim = |corner: &crate::geometry::polygon::Corner| corner.edge.plane(piece.support());
        piece.corners().iter().map(rim).map(Arc::new).collect()
    }
}
