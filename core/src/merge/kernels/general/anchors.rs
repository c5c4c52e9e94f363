//! Anchors: points that several elements of an operand share.
//!
//! Whether an anchor is inside the other operands holds for all elements that share it. Anchors are vertices
//! of meshes, corners of parts of faces, and points in which edges leave the cell.

use std::sync::Arc;

use super::scene::{is_well_inside, Element, ElementKind, PointName, Scene, Triangle};
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::{Carrier, Corner, Polygon};
use crate::geometry::vertex::Vertex;
use crate::geometry::vertices::VertexTable;
use crate::mesh::handle::{Slot, VertexId};
use crate::tree::node::Part;

/// A point inside the cell at which the faces of one operand, or pieces of its cut faces, may meet.
#[derive(Clone)]
pub(super) struct Anchor {
    pub(super) name: PointName,
    pub(super) position: AnchorPosition,
}

/// The position of an anchor (a point at which faces of one operand may meet): a lattice point or a
/// constructed point.
#[derive(Clone)]
pub(super) enum AnchorPosition {
    Lattice(Lattice),
    Exact(Arc<Vertex>),
}

/// Gives names to the corners of parts of faces; equal points of different parts get the same name.
pub(super) struct PointNames<'a> {
    parts: &'a [(&'a Arc<Part>, Slot)],
    points: VertexTable,
}

impl<'a> PointNames<'a> {
    /// Starts to name the corners of all parts in a scene.
    pub(super) fn of(scene: &'a Scene) -> Self {
        Self {
            parts: &scene.parts,
            points: VertexTable::default(),
        }
    }

    fn anchor(&mut self, part: usize, vertex: &Arc<Vertex>) -> Anchor {
        let (part, slot) = self.parts[part];
        let own = vertex.as_lattice().and_then(|p| vertex_at(part, p));
        let name = match own {
            Some(vertex) => PointName::Vertex(slot, vertex),
            None => PointName::Point(self.points.number_of(vertex)),
        };
        let position = AnchorPosition::Exact(Arc::clone(vertex));
        Anchor { name, position }
    }
}

/// Returns the vertex of a part's face at a lattice point; `None` if the face has no corner there.
fn vertex_at(part: &Part, position: &Lattice) -> Option<VertexId> {
    let mesh = part.source.mesh()?;
    let corner = mesh.corners(part.face).iter().position(|c| c == position)?;
    Some(mesh.vertices_of(part.face)[corner])
}

impl Element<'_> {
    /// Returns the corners inside the cell of this face, or piece of a cut face, at which other faces of the
    /// operand may meet it.
    pub(super) fn anchors(&self, cell: &Cell, names: &mut PointNames) -> Vec<Anchor> {
        match &self.kind {
            ElementKind::Face(triangle) => self
                .vertices_in(cell)
                .map(|i| Anchor::at_vertex(triangle, i))
                .collect(),
            ElementKind::Piece(part, shape) => {
                let corners = shape.polygon.corners().iter().map(|c| &c.at);
                corners
                    .filter(|v| is_well_inside(v, cell))
                    .map(|v| names.anchor(*part, v))
                    .collect()
            }
            ElementKind::Part(number, apart) => {
                let corners = apart.part().edges.iter().map(|e| &e.from);
                corners
                    .filter(|v| is_well_inside(v, cell))
                    .map(|v| names.anchor(*number, v))
                    .collect()
            }
            ElementKind::Plane(..) => Vec::new(),
        }
    }

    /// Returns the points in which edges of this face, or piece of a cut face, leave the cell, and which
    /// neighbouring faces share; `clipped` is its part in the cell.
    pub(super) fn anchors_at_walls(
        &self,
        clipped: &Polygon,
        names: &mut PointNames,
    ) -> Vec<Anchor> {
        let corners = clipped.corners();
        let n = corners.len();
        match &self.kind {
            ElementKind::Face(triangle) => {
                let at_wall =
                    |i: usize| Anchor::at_wall(triangle, &corners[(i + n - 1) % n], &corners[i]);
                (0..n).filter_map(at_wall).collect()
            }
            ElementKind::Piece(part, _) => {
                let mut at_corner = |c: &Corner| names.anchor(*part, &c.at);
                corners.iter().map(&mut at_corner).collect()
            }
            ElementKind::Plane(..) | ElementKind::Part(..) => Vec::new(),
        }
    }
}

impl Anchor {
    fn at_vertex(triangle: &Triangle, corner: usize) -> Self {
        Self {
            name: triangle.point_name(corner),
            position: AnchorPosition::Lattice(triangle.corners[corner]),
        }
    }

    /// Returns, as an anchor, the point in which an edge of a face meets a wall of the cell at the given
    /// corner of the clipped face; `None` if the corner is no such point.
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
            name: PointName::Crossing(triangle.face.slot, [a.min(b), a.max(b)], wall),
            position: AnchorPosition::Exact(Arc::clone(&corner.at)),
        })
    }

    /// Returns true if `corner` is the point of this anchor.
    pub(super) fn is_at(&self, corner: &Arc<Vertex>) -> bool {
        match &self.position {
            AnchorPosition::Lattice(p) => corner.as_lattice() == Some(p),
            AnchorPosition::Exact(vertex) => Arc::ptr_eq(vertex, corner),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::outline::BareEdge;
    use crate::geometry::plane::Plane;
    use crate::merge::kernels::general::scene::Scene;
    use crate::merge::scenes::{crossing, tetrahedra};
    use crate::mesh::handle::FaceId;

    /// Returns a part, without an outline, of a solid's first face.
    fn part() -> Arc<Part> {
        let solid = &tetrahedra()[0];
        let source = Arc::clone(solid.sources().get(Slot(0)));
        let edges: Vec<BareEdge> = Vec::new();
        Arc::new(Part::new(source, FaceId::ONLY, Cell::UNIVERSE, edges))
    }

    #[test]
    fn equal_corners_have_one_name_however_they_are_made() {
        let part = part();
        let mut names = PointNames {
            parts: &[(&part, Slot(0))],
            points: VertexTable::default(),
        };
        let mut name = |vertex: Vertex| names.anchor(0, &Arc::new(vertex)).name;
        let wall = |axis: usize, at: i64| Arc::new(Plane::axis_cut(axis, at));
        let met = |at: Lattice| Vertex::meet(&wall(0, at[0]), &wall(1, at[1]), &wall(2, at[2]));
        let first = name(met([7, 5, 3]).expect("a corner"));
        assert!(first == name(met([7, 5, 3]).expect("a corner")));
        assert!(first != name(met([7, 5, 9]).expect("a corner")));
        // A vertex of the face has the same name as for whole faces.
        let mesh = part.source.mesh().expect("a mesh");
        let (corner, vertex) = (mesh.corners(part.face)[1], mesh.vertices_of(part.face)[1]);
        assert!(name(Vertex::lattice(corner)) == PointName::Vertex(Slot(0), vertex));
    }

    /// A small cell around a corner of a solid contains this corner, and edges that leave the cell.
    #[test]
    fn neighbours_share_the_points_in_which_edges_leave_the_cell() {
        let shared = crossing();
        let (operands, cell) = (shared.operands(), Cell::around(&[0; 3], &[3; 3]));
        let scene = Scene::new(&cell, &operands[..1], &shared.sources);
        let faces = &scene.elements[..3];
        let mut names = PointNames::of(&scene);
        assert!(faces
            .iter()
            .all(|face| face.anchors(&cell, &mut names).len() == 1));
        let mut at_walls = |face: &Element| {
            let clipped = face.polygon_in(&cell).expect("it meets the cell");
            face.anchors_at_walls(&clipped, &mut names)
        };
        let walls: Vec<Vec<Anchor>> = faces.iter().map(&mut at_walls).collect();
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
