//! The triangulated surface of a solid with exact corners, and where it touches itself.

pub mod facet;
pub mod near;
pub mod passing;

use std::sync::Arc;

use self::facet::Facet;
use self::near::LatticeBox;
use crate::extract::joining::patches::Patches;
use crate::extract::mesh::ExactMesh;
use crate::geometry::plane::Plane;
use crate::geometry::points;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::{OrientedFace, VertexId};
use crate::tree::solid::Solid;

/// The triangulated surface of a solid with exact corners.
pub struct Surface<'a> {
    solid: &'a Solid,
    patches: &'a Patches,
    mesh: &'a ExactMesh,
}

impl<'a> Surface<'a> {
    /// Makes the surface of a solid from its mesh, of which each triangle lies in faces of one patch.
    pub fn new(solid: &'a Solid, patches: &'a Patches, mesh: &'a ExactMesh) -> Self {
        Self {
            solid,
            patches,
            mesh,
        }
    }

    /// The mesh of the surface.
    pub fn mesh(&self) -> &'a ExactMesh {
        self.mesh
    }

    /// The patches of faces, of which each triangle lies in one.
    pub fn patches(&self) -> &'a Patches {
        self.patches
    }

    /// The vertices of each triangle.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.mesh.triangles
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.mesh.vertices.len()
    }

    /// The exact position of a vertex.
    pub fn vertex(&self, vertex: VertexId) -> Vertex {
        self.mesh.vertex(vertex, self.solid)
    }

    /// The source face that a triangle lies in.
    pub fn face(&self, triangle: u32) -> OrientedFace {
        self.mesh.faces[triangle as usize]
    }

    /// The patch number of the face that a triangle lies in.
    pub fn patch(&self, triangle: u32) -> u32 {
        let face = self.face(triangle).face;
        self.patches.of(face, self.solid.sources().get(face.slot))
    }

    /// The plane of a triangle; the outside of the solid may be on either side.
    pub fn plane(&self, triangle: u32) -> Arc<Plane> {
        let face = self.face(triangle);
        self.solid.sources().get(face.slot()).plane(face.id())
    }

    /// Returns on which side of a triangle's plane a point lies; `Plus` is outside the solid at the
    /// triangle.
    pub fn side(&self, triangle: u32, point: &Vertex) -> Side {
        let [a, b, c] = self.corners(triangle).map(|corner| corner.approx());
        points::clear_side([a, b, c, point.approx()]).or_exact(|| {
            let side = point.side_of(&self.plane(triangle));
            if self.face(triangle).orientation.is_opposite() {
                side.opposite()
            } else {
                side
            }
        })
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Vertex; 3] {
        self.mesh.triangles[triangle as usize].map(|vertex| self.vertex(vertex))
    }

    /// The sides of a triangle's plane on which the corners of another triangle lie; `Plus` is outside the
    /// solid at the triangle.
    pub fn sides(&self, triangle: u32, other: u32) -> [Side; 3] {
        self.corners(other)
            .each_ref()
            .map(|p| self.side(triangle, p))
    }

    /// A triangle with its corners and plane.
    pub fn facet(&self, triangle: u32) -> Facet {
        Facet {
            corners: self.corners(triangle),
            plane: self.plane(triangle),
        }
    }

    /// A box around the whole surface.
    pub fn space(&self) -> LatticeBox {
        let vertices = VertexId::all().take(self.mesh.vertices.len());
        vertices.fold(LatticeBox::NOTHING, |all, vertex| {
            poll();
            all.with(&LatticeBox::around([&self.vertex(vertex)]))
        })
    }

    /// A box around the given triangles.
    pub fn space_of(&self, triangles: &[u32]) -> LatticeBox {
        let spaces = triangles
            .iter()
            .map(|t| LatticeBox::around(&self.corners(*t)));
        spaces.fold(LatticeBox::NOTHING, |all, one| all.with(&one))
    }

    /// Returns the triangles whose boxes overlap `space`, each with its own box.
    pub fn triangles_in(&self, space: &LatticeBox) -> Vec<(u32, LatticeBox)> {
        let boxed = |triangle: u32| {
            poll();
            let around = LatticeBox::around(&self.corners(triangle));
            around.overlaps(space).then_some((triangle, around))
        };
        let all = (0u32..).take(self.mesh.triangles.len());
        all.filter_map(boxed).collect()
    }
}
