//! The faces of a mesh that may meet faces of another mesh.

use std::sync::Arc;

use super::boxes::{order, BoxTree, RoundedBox};
use super::occupancy::Occupancy;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, Slot};
use crate::mesh::source::Source;
use crate::mesh::tasks::each_chunk;
use crate::mesh::triangles::TriangleMesh;

/// A mesh as an operand, with its source and its index (slot) in the table of sources.
#[derive(Clone, Copy, Debug)]
pub(super) struct Operand<'a> {
    pub(super) slot: Slot,
    pub(super) source: &'a Arc<Source>,
    pub(super) mesh: &'a TriangleMesh,
    /// The low and the high corner of the box around all vertices.
    pub(super) bounds: [Lattice; 2],
}

/// The faces of an operand that reach into the window (the intersection of both meshes' boxes), each with its
/// box.
#[derive(Debug, Default)]
pub(super) struct FacesInWindow {
    pub(super) faces: Vec<FaceId>,
    pub(super) boxes: Vec<RoundedBox>,
}

/// The faces of an operand that may meet faces of the other operand, sorted along a space-filling curve.
#[derive(Debug)]
pub(super) struct Candidates {
    pub(super) faces: Vec<FaceId>,
    pub(super) triangles: Vec<Triangle>,
    pub(super) tree: BoxTree,
}

impl<'a> Operand<'a> {
    /// Makes an operand of a source; `None` if the source is not a mesh, or has no vertices.
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

    /// Returns the corners of a face in doubles.
    pub(super) fn triangle(&self, face: FaceId) -> Triangle {
        self.mesh.corners(face).map(|corner| corner.map(as_double))
    }

    /// Returns the faces whose boxes meet the given box, ascending.
    pub(super) fn faces_in_window(&self, [low, high]: &[Point; 2]) -> FacesInWindow {
        let found = each_chunk(&self.mesh.faces, |first, chunk| {
            let mut inside = FacesInWindow::default();
            for id in (first..first + chunk.len()).map(|i| FaceId(as_number(i))) {
                let [a, b, c] = self.triangle(id);
                let least = each_axis(|i| a[i].min(b[i]).min(c[i]));
                let most = each_axis(|i| a[i].max(b[i]).max(c[i]));
                if (0..3).all(|i| least[i] <= high[i] && most[i] >= low[i]) {
                    inside.faces.push(id);
                    inside.boxes.push(RoundedBox::between(&least, &most));
                }
            }
            inside
        });
        found
            .into_iter()
            .reduce(FacesInWindow::with)
            .unwrap_or_default()
    }

    /// Returns the faces that reach into cells of the coarse grid `others` that the other operand's faces
    /// reach into; the intervals (slabs) that both operands' faces cover along diagonals must have the same
    /// `origin`.
    pub(super) fn candidates(
        &self,
        within: &FacesInWindow,
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

    /// Returns all faces of the mesh, sorted along a space-filling curve.
    pub(super) fn tree(&self) -> Candidates {
        Candidates::of(self, &self.mesh.face_ids().collect::<Vec<_>>())
    }

    /// Returns some faces of the mesh, prepared to be compared with each other.
    pub(super) fn comparable(&self, faces: &[FaceId]) -> Candidates {
        let mut made = Candidates::of(self, faces);
        made.tree = made
            .tree
            .with_slabs(&made.triangles, &self.bounds[0].map(as_double));
        made
    }
}

impl FacesInWindow {
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
