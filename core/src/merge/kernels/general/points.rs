//! The points in which edges cross the planes of elements, computed once for all elements that share them.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::vertex::Vertex;

/// The points in which edges cross the planes of faces, as far as computed.
#[derive(Default)]
pub(super) struct Points {
    /// The points by the name of the edge and the number of the crossed face.
    on_edges: HashMap<(EdgeName, u32), Point>,
}

struct Point {
    at: Arc<Vertex>,
    /// The planes whose addresses name the edge; storing them here keeps their addresses unique.
    _planes: Option<[Arc<Plane>; 2]>,
}

/// The name of an edge, the same for all faces in the cell that have this edge.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum EdgeName {
    /// The ends of a lattice edge, the lower one first in lexicographic order.
    Lattice([Lattice; 2]),
    /// The addresses of the two planes that meet in the edge, the lower one first.
    Planes([usize; 2]),
}

impl EdgeName {
    fn of(edge: &Carrier, support: &Arc<Plane>) -> Self {
        match edge {
            Carrier::Edge(edge) => {
                let (a, b) = edge.ends();
                Self::Lattice([*a.min(b), *a.max(b)])
            }
            Carrier::Cut(plane, _) => {
                let address = |p: &Arc<Plane>| Arc::as_ptr(p) as usize;
                let (a, b) = (address(support), address(plane));
                Self::Planes([a.min(b), a.max(b)])
            }
        }
    }
}

impl Points {
    /// Returns the point in which an edge of a polygon crosses the plane of the face with the given number;
    /// `None` if they are parallel.
    pub(super) fn at(
        &mut self,
        (polygon, edge): (&Polygon, usize),
        (plane, number): (&Arc<Plane>, u32),
    ) -> Option<Arc<Vertex>> {
        let carrier = &polygon.corners()[edge].edge;
        let name = (EdgeName::of(carrier, polygon.support()), number);
        if let Some(known) = self.on_edges.get(&name) {
            return Some(Arc::clone(&known.at));
        }
        let at = Arc::new(carrier.meet(polygon.support(), plane)?);
        let planes = match carrier {
            Carrier::Edge(_) => None,
            Carrier::Cut(cut, _) => Some([Arc::clone(polygon.support()), Arc::clone(cut)]),
        };
        let known = Point {
            at: Arc::clone(&at),
            _planes: planes,
        };
        self.on_edges.insert(name, known);
        Some(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::triangle;

    #[test]
    fn faces_at_an_edge_share_the_point_in_which_it_crosses_an_element() {
        let crossed = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let faces = [
            triangle([[2, 2, -4], [2, 2, 4], [9, 3, 0]]),
            triangle([[2, 2, 4], [2, 2, -4], [-9, 5, 0]]),
        ];
        let mut points = Points::default();
        let mut at = |face: usize, number: u32| {
            let point = points.at((&faces[face], 0), (crossed.support(), number));
            point.expect("not parallel")
        };
        assert_eq!(at(0, 7).as_lattice(), Some(&[2, 2, 0]));
        assert!(Arc::ptr_eq(&at(0, 7), &at(1, 7)));
        assert!(!Arc::ptr_eq(&at(0, 7), &at(0, 8)));
    }
}
