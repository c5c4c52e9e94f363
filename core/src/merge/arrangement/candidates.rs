//! The faces of two meshes that may meet: those that reach into the intersection of both boxes.

use std::sync::Arc;

use super::boxes::{order, Bounds, BoxTree};
use super::occupancy::Occupancy;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, Slot};
use crate::mesh::source::Source;
use crate::mesh::tasks::each_chunk;
use crate::mesh::triangles::TriangleMesh;

/// A mesh that is an operand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operand<'a> {
    pub(super) slot: Slot,
    pub(super) source: &'a Arc<Source>,
    pub(super) mesh: &'a TriangleMesh,
    /// The lattice box around all vertices.
    pub(super) bounds: [Lattice; 2],
}

/// Faces of an operand in the window, with their boxes.
#[derive(Debug, Default)]
pub(super) struct Within {
    pub(super) faces: Vec<FaceId>,
    pub(super) boxes: Vec<Bounds>,
}

/// The faces of an operand that may meet the other one, in spatial order.
#[derive(Debug)]
pub(super) struct Candidates {
    pub(super) faces: Vec<FaceId>,
    pub(super) triangles: Vec<Triangle>,
    pub(super) tree: BoxTree,
}

impl<'a> Operand<'a> {
    /// The operand of a source; `None` if it is not a mesh, or has no vertices.
    pub(super) fn new(slot: Slot, source: &'a Arc<Source>) -> Option<Self> {
        let mesh = source.mesh()?;
        let (low, high) = mesh.bounds()?;
        Some(Self {
            slot,
            source,
            mesh,
            bounds: [low, high],
        })
    }

    /// The corners of a face.
    pub(super) fn triangle(&self, face: FaceId) -> Triangle {
        self.mesh.corners(face).map(|corner| corner.map(as_double))
    }

    /// The faces that reach into a window, ascending, with their boxes.
    pub(super) fn within(&self, [low, high]: &[Point; 2]) -> Within {
        let found = each_chunk(&self.mesh.faces, |first, chunk| {
            let mut some = Within::default();
            for id in (first..first + chunk.len()).map(|i| FaceId(as_number(i))) {
                let [a, b, c] = self.triangle(id);
                let least = each_axis(|i| a[i].min(b[i]).min(c[i]));
                let most = each_axis(|i| a[i].max(b[i]).max(c[i]));
                if (0..3).all(|i| least[i] <= high[i] && most[i] >= low[i]) {
                    some.faces.push(id);
                    some.boxes.push(Bounds::between(&least, &most));
                }
            }
            some
        });
        found.into_iter().reduce(Within::with).unwrap_or_default()
    }

    /// The faces that may meet others; slabs of both operands use one origin.
    pub(super) fn candidates(
        &self,
        within: &Within,
        others: &Occupancy,
        origin: &Point,
    ) -> Candidates {
        let both = within.faces.iter().zip(&within.boxes);
        let faces = both.filter(|(_, bounds)| others.meets(bounds));
        let faces: Vec<FaceId> = faces.map(|(id, _)| *id).collect();
        let mut made = Candidates::of(self, &faces);
        made.tree = made.tree.with_slabs(&made.triangles, origin);
        made
    }

    /// All faces, in spatial order.
    pub(super) fn tree(&self) -> Candidates {
        Candidates::of(self, &self.mesh.face_ids().collect::<Vec<_>>())
    }
}

impl Within {
    fn with(mut self, mut other: Self) -> Self {
        self.faces.append(&mut other.faces);
        self.boxes.append(&mut other.boxes);
        self
    }
}

impl Candidates {
    fn of(operand: &Operand, given: &[FaceId]) -> Self {
        let triangles: Vec<Triangle> = given.iter().map(|id| operand.triangle(*id)).collect();
        let order = order(&triangles);
        let faces = order.iter().map(|i| given[*i as usize]).collect();
        let triangles: Vec<Triangle> = order.iter().map(|i| triangles[*i as usize]).collect();
        let tree = BoxTree::new(&triangles);
        Self {
            faces,
            triangles,
            tree,
        }
    }
}
