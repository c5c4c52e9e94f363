//! The convex pieces of parts of faces, with the boxes around them.

use std::sync::Arc;

use super::node::Part;
use crate::arith::convert::as_whole;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Polygon;

/// A convex piece of a part of a face.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The piece as a polygon.
    pub polygon: Polygon,
    /// The lowest and highest corner of a lattice box around the piece.
    pub around: [Lattice; 2],
}

/// The convex pieces of a part of a face, with boxes around them.
pub fn pieces(part: &Arc<Part>) -> Arc<[Piece]> {
    part.pieces().into_iter().map(Piece::of).collect()
}

impl Piece {
    fn of(polygon: Polygon) -> Self {
        let (low, high) = polygon.bounds();
        let (low, high) = (low.map(f64::floor), high.map(f64::ceil));
        Self {
            polygon,
            around: [low.map(as_whole), high.map(as_whole)],
        }
    }

    /// Return whether the box around the piece meets a cell; the piece itself may miss it.
    pub fn may_meet(&self, cell: &Cell) -> bool {
        let ([low, high], least, most) = (&self.around, cell.low(), cell.high());
        (0..3).all(|i| low[i] <= most[i] && high[i] >= least[i])
    }

    /// The part of the piece inside a cell, or `None` if it has no area.
    pub fn clipped(&self, cell: &Cell) -> Option<Polygon> {
        let polygon = self.may_meet(cell).then(|| self.polygon.clone());
        polygon.and_then(|polygon| polygon.clipped(cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::outline::BareEdge;
    use crate::mesh::handle::FaceId;
    use crate::mesh::import::import;

    /// The whole face of a tetrahedron as a part of that face.
    fn part() -> Arc<Part> {
        let corners = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let source = Arc::new(import(&corners, &faces, None).expect("a closed mesh"));
        let home = Cell::UNIVERSE;
        let polygon = source.clip(FaceId(0), &home).expect("it has an area");
        let edges = BareEdge::edges_of(&polygon).collect();
        Arc::new(Part::new(source, FaceId(0), home, edges))
    }

    #[test]
    fn a_piece_is_clipped_where_its_box_meets_a_cell() {
        let piece = &pieces(&part())[0];
        let [low, high] = piece.around;
        assert!(piece.clipped(&Cell::around(&low, &high)).is_some());
        let beyond = high.map(|x| x + 2);
        let far = Cell::around(&beyond, &beyond);
        assert!(!piece.may_meet(&far) && piece.clipped(&far).is_none());
    }
}
