//! Anchors: points of an operand's boundary that its elements have in common.
//!
//! What is known of the other operands at an anchor holds for all elements that share it: the
//! vertices of a mesh, the corners of a part's pieces, and the points in which edges leave the cell.

use std::sync::Arc;

use super::scene::{Element, Name, Place, Triangle};
use crate::arith::convert::as_double;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::{Carrier, Corner, Polygon};
use crate::geometry::vertex::Vertex;

/// A point of an operand's boundary inside the cell.
#[derive(Clone)]
pub(super) struct Anchor {
    pub(super) name: Name,
    pub(super) place: Spot,
}

/// The place of an anchor.
#[derive(Clone)]
pub(super) enum Spot {
    Lattice(Lattice),
    Exact(Arc<Vertex>),
}

impl Element<'_> {
    /// The corners inside the cell that other elements of the operand may share.
    pub(super) fn anchors(&self, cell: &Cell) -> Vec<Anchor> {
        match &self.place {
            Place::Face(triangle) => self
                .vertices_in(cell)
                .map(|i| Anchor::at_vertex(triangle, i))
                .collect(),
            Place::Piece(_, shape) => {
                let corners = shape.polygon.corners().iter().map(|c| &c.at);
                corners
                    .filter(|v| is_well_inside(v, cell))
                    .map(Anchor::of_corner)
                    .collect()
            }
            Place::Plane(..) => Vec::new(),
        }
    }

    /// The points in which a face's own edges leave the cell: its neighbours share them.
    pub(super) fn anchors_at_walls(&self, clipped: &Polygon) -> Vec<Anchor> {
        let Place::Face(triangle) = &self.place else {
            return Vec::new();
        };
        let corners = clipped.corners();
        let n = corners.len();
        let at_wall = |i: usize| Anchor::at_wall(triangle, &corners[(i + n - 1) % n], &corners[i]);
        (0..n).filter_map(at_wall).collect()
    }
}

impl Anchor {
    fn at_vertex(triangle: &Triangle, corner: usize) -> Self {
        Self {
            name: triangle.name(corner),
            place: Spot::Lattice(triangle.corners[corner]),
        }
    }

    fn of_corner(vertex: &Arc<Vertex>) -> Self {
        Self {
            name: Name::Corner(Arc::as_ptr(vertex) as usize),
            place: Spot::Exact(Arc::clone(vertex)),
        }
    }

    /// The corner of a clipped face at which one of its own edges and a wall of the cell meet.
    #[allow(clippy::cast_possible_truncation, reason = "one of three axes")]
    fn at_wall(triangle: &Triangle, before: &Corner, corner: &Corner) -> Option<Self> {
        let (edge, wall) = match (&before.edge, &corner.edge) {
            (Carrier::Edge(edge), Carrier::Cut(wall, _))
            | (Carrier::Cut(wall, _), Carrier::Edge(edge)) => (edge.ends(), wall),
            _ => return None,
        };
        let axis = wall.only_axis()?;
        let wall = 2 * axis as u8 + u8::from(wall.normal()[axis] > 0);
        let [a, b] = triangle.ends_of([edge.0, edge.1])?;
        Some(Self {
            name: Name::Crossing(triangle.face.slot, [a.min(b), a.max(b)], wall),
            place: Spot::Exact(Arc::clone(&corner.at)),
        })
    }

    /// Return whether a corner is the anchor.
    pub(super) fn is_at(&self, corner: &Arc<Vertex>) -> bool {
        match &self.place {
            Spot::Lattice(p) => corner.as_lattice() == Some(p),
            Spot::Exact(vertex) => Arc::ptr_eq(vertex, corner),
        }
    }
}

/// Return whether a point certainly lies in a cell.
fn is_well_inside(vertex: &Vertex, cell: &Cell) -> bool {
    let ((least, most), low, high) = (vertex.bounds(), cell.low(), cell.high());
    (0..3).all(|i| least[i] >= as_double(low[i]) && most[i] <= as_double(high[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::kernels::general::scene::Scene;
    use crate::merge::scenes::crossing;

    /// In a small cell at its corner a solid has that corner, and edges that leave the cell.
    #[test]
    fn neighbours_share_the_points_in_which_edges_leave_the_cell() {
        let shared = crossing();
        let (operands, cell) = (shared.operands(), Cell::around(&[0; 3], &[3; 3]));
        let scene = Scene::new(&cell, &operands[..1], &shared.sources);
        let faces = &scene.elements[..3];
        assert!(faces.iter().all(|face| face.anchors(&cell).len() == 1));
        let at_walls = |face: &Element| {
            let clipped = face.polygon_in(&cell).expect("it meets the cell");
            face.anchors_at_walls(&clipped)
        };
        let walls: Vec<Vec<Anchor>> = faces.iter().map(at_walls).collect();
        assert!(walls.iter().all(|anchors| anchors.len() == 2));
        let shared = |a: &[Anchor], b: &[Anchor]| {
            a.iter()
                .filter(|x| b.iter().any(|y| x.name == y.name))
                .count()
        };
        assert_eq!(shared(&walls[0], &walls[1]), 1);
        assert_eq!(shared(&walls[1], &walls[2]), 1);
    }
}
