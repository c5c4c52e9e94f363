//! Sources: the immutable input meshes and half-spaces whose faces the trees of solids refer to.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::Arc;

use super::cached::Cached;
use super::chain::is_closed;
use super::finding::{Finding, Severity};
use super::grid::Pitch;
use super::handle::{FaceId, VertexId};
use super::images::Images;
use super::links;
use super::topology::{open_edges, Topology};
use super::triangles::TriangleMesh;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::line::PlaneResidues;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Polygon;

/// An immutable input of solids: a mesh on the lattice, or the boundary of a half-space.
#[derive(Debug)]
pub struct Source {
    id: u64,
    pitch: Pitch,
    shape: Shape,
    open: Cached<Vec<VertexId>>,
    irregular: Cached<Vec<VertexId>>,
    blurred: Cached<Vec<VertexId>>,
    topology: Cached<Topology>,
    cell: Cached<Option<Cell>>,
    snapped: [Cached<bool>; 8],
    close: Cached<Vec<[u32; 2]>>,
    own_pairs: Cached<Option<Vec<[FaceId; 2]>>>,
    passing: Cached<Vec<[u32; 2]>>,
    images: Images<Self>,
    findings: Vec<Finding>,
}

/// The geometry of a source: a mesh or a plane.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A closed mesh of triangles on the lattice.
    Mesh(TriangleMesh),
    /// The boundary of a half-space: one unbounded face.
    HalfSpace(Arc<Plane>),
}

/// If fewer than one in this many vertices of a mesh are used, only the used vertices are examined for
/// irregular ones. Otherwise all are examined, and the result is stored for the next operation.
const USED_ONLY_IF_ONE_IN: usize = 4;

/// The code of the finding that vertices were welded at import.
pub(super) const WELDED: &str = "welded";

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

impl Source {
    /// A source of this shape with a new id; ids increase with each call and have no other meaning.
    pub fn new(pitch: Pitch, shape: Shape, findings: Vec<Finding>) -> Self {
        Self {
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            pitch,
            shape,
            open: Cached::new(),
            irregular: Cached::new(),
            blurred: Cached::new(),
            topology: Cached::new(),
            cell: Cached::new(),
            snapped: Default::default(),
            close: Cached::new(),
            own_pairs: Cached::new(),
            passing: Cached::new(),
            images: Images::default(),
            findings,
        }
    }

    /// A source of a mesh whose vertices at open edges and whose smallest cell are known already.
    pub fn checked(
        mesh: TriangleMesh,
        pitch: Pitch,
        open: Vec<VertexId>,
        cell: Cell,
        findings: Vec<Finding>,
    ) -> Self {
        Self {
            open: Cached::of(open),
            cell: Cached::of(Some(cell)),
            ..Self::new(pitch, Shape::Mesh(mesh), findings)
        }
    }

    /// The same source with further findings.
    #[must_use]
    pub fn with_findings(mut self, findings: Vec<Finding>) -> Self {
        self.findings.extend(findings);
        self
    }

    /// The same source with its pairs of close faces, taken from the source of which it is an image.
    #[must_use]
    pub fn with_close_pairs(self, pairs: Vec<[u32; 2]>) -> Self {
        Self {
            close: Cached::of(pairs),
            ..self
        }
    }

    /// A source of the same shape and findings with a new id.
    #[must_use]
    pub fn renamed(&self) -> Self {
        let named = Self::new(self.pitch, self.shape.clone(), self.findings.clone());
        Self {
            open: self.open.clone(),
            cell: self.cell.clone(),
            close: self.close.clone(),
            passing: self.passing.clone(),
            ..named
        }
    }

    /// The images of this source under lattice motions, as far as they are in use.
    pub fn images(&self) -> &Images<Self> {
        &self.images
    }

    /// The number that distinguishes the source from all others of the process.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// The lattice step of the source.
    pub fn pitch(&self) -> Pitch {
        self.pitch
    }

    /// Return the findings of import, and a note of the vertices at which the surface is not manifold.
    pub fn findings(&self) -> Vec<Finding> {
        let mut findings = self.findings.clone();
        findings.extend(self.irregularity());
        findings
    }

    fn irregularity(&self) -> Option<Finding> {
        let irregular = self.irregular_vertices();
        let places: Vec<u64> = irregular.iter().map(|v| u64::from(v.0)).collect();
        let text =
            "more than two faces share an edge, or separate fans of faces meet, at these vertices";
        let finding = || Finding::about("non_manifold", Severity::Note, &places, text);
        (!places.is_empty()).then(finding)
    }

    /// The geometry of the source.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The triangle mesh; `None` for a half-space.
    pub fn mesh(&self) -> Option<&TriangleMesh> {
        match &self.shape {
            Shape::Mesh(mesh) => Some(mesh),
            Shape::HalfSpace(_) => None,
        }
    }

    /// The number of faces; 1 for a half-space.
    pub fn face_count(&self) -> usize {
        self.mesh().map_or(1, |m| m.faces.len())
    }

    /// The numbers of all faces, ascending.
    pub fn face_ids(&self) -> impl Iterator<Item = FaceId> {
        FaceId::all().take(self.face_count())
    }

    /// The end vertices of edges without an opposite by index, ascending. Such edges cancel only along their
    /// lines, as at T-junctions.
    pub fn open_vertices(&self) -> &[VertexId] {
        let Some(mesh) = self.mesh() else {
            return &[];
        };
        self.open.get_or_make(|| {
            if is_closed(&mesh.faces) {
                return Vec::new();
            }
            self.topology()
                .map_or_else(Vec::new, |t| t.open_vertices(&mesh.faces))
        })
    }

    /// The vertices on edges of more than two faces, or with several fans of faces, ascending.
    ///
    /// Computed on first use.
    pub fn irregular_vertices(&self) -> &[VertexId] {
        let Some(mesh) = self.mesh() else {
            return &[];
        };
        self.irregular.get_or_make(|| {
            if self.open_vertices().is_empty() {
                return links::irregular(&mesh.faces, mesh.vertices.len());
            }
            self.topology()
                .map_or_else(Vec::new, |t| t.irregular().to_vec())
        })
    }

    /// The vertices in [`Self::irregular_vertices`] for which `is_used` is true; `used` is the number of used
    /// vertices.
    pub fn irregular_among(
        &self,
        is_used: impl Fn(VertexId) -> bool,
        used: usize,
    ) -> Vec<VertexId> {
        let known = self.irregular.get().is_some() || !self.open_vertices().is_empty();
        match self.mesh() {
            Some(mesh) if !known && used < mesh.vertices.len() / USED_ONLY_IF_ONE_IN => {
                let all = VertexId::all().take(mesh.vertices.len());
                let used = all.filter(|v| is_used(*v)).collect();
                links::irregular_among(used, &mesh.faces, mesh.vertices.len())
            }
            _ => {
                let all = self.irregular_vertices().iter().copied();
                all.filter(|v| is_used(*v)).collect()
            }
        }
    }

    /// Return whether the surface is closed: each edge cancels with opposite edges between the same vertices
    /// or along the same line. True for all imported meshes.
    pub fn is_closed(&self) -> bool {
        let Some(mesh) = self.mesh() else {
            return true;
        };
        let open = |t: &Topology| open_edges(&mesh.vertices, &mesh.faces, t.unpaired());
        self.open_vertices().is_empty() || self.topology().is_none_or(|t| open(t).is_empty())
    }

    /// Return whether import left out no face of the mesh and welded no vertices; false for a half-space.
    pub fn is_as_given(&self) -> bool {
        !self.is_welded() && self.mesh().is_some_and(|m| m.numbers.is_none())
    }

    /// Return whether the given mesh stays closed wherever rounding moves its corners: no face was left out,
    /// no corner lies inside an edge of another face, and welded vertices have equal doubles.
    pub fn closes_when_moved(&self) -> bool {
        self.mesh().is_none_or(|m| m.numbers.is_none())
            && self.open_vertices().is_empty()
            && self.blurred_vertices().is_empty()
    }

    fn is_welded(&self) -> bool {
        self.findings.iter().any(|f| f.code == WELDED)
    }

    /// The vertices that were welded with others of different doubles, ascending: faces around them do not
    /// have exactly the corners that were given.
    pub fn blurred_vertices(&self) -> &[VertexId] {
        match self.mesh() {
            Some(mesh) if self.is_welded() => self.blurred.get_or_make(|| mesh.blurred()),
            _ => &[],
        }
    }

    /// The cached answer whether the mesh crosses itself once its coordinates on the axes marked true are
    /// snapped to the lattice; empty if not yet computed.
    pub fn crosses_once_snapped(&self, axes: [bool; 3]) -> &Cached<bool> {
        let [x, y, z] = axes.map(usize::from);
        &self.snapped[x + 2 * y + 4 * z]
    }

    /// The pairs of faces that touch on the lattice but share no edge; empty if not yet computed.
    pub fn close_pairs(&self) -> &Cached<Vec<[u32; 2]>> {
        &self.close
    }

    /// The pairs of faces that may share more than corners and edges; the cached value is `None` if they are
    /// too many to be listed.
    pub fn own_pairs(&self) -> &Cached<Option<Vec<[FaceId; 2]>>> {
        &self.own_pairs
    }

    /// The pairs of faces at which walls of the mesh pass through one another in an edge, although each face
    /// bounds the solid; known if the mesh was compared with itself.
    pub fn passing_pairs(&self) -> &Cached<Vec<[u32; 2]>> {
        &self.passing
    }

    /// The known pairs of faces that may cross although they bound the solid as a whole.
    pub fn suspected_pairs(&self) -> Vec<[u32; 2]> {
        let known = [&self.close, &self.passing].map(Cached::get);
        known.into_iter().flatten().flatten().copied().collect()
    }

    /// The pairing of half-edges with their mates, computed on first use; `None` for a half-space.
    pub fn topology(&self) -> Option<&Topology> {
        let mesh = self.mesh()?;
        Some(
            self.topology
                .get_or_make(|| Topology::new(&mesh.faces, mesh.vertices.len())),
        )
    }

    /// The plane of a face.
    ///
    /// # Panics
    /// Never for faces of this source: import left out all faces without area.
    pub fn plane(&self, face: FaceId) -> Arc<Plane> {
        match &self.shape {
            Shape::Mesh(mesh) => {
                let [a, b, c] = mesh.corners(face);
                let plane = Plane::through(&a, &b, &c);
                Arc::new(plane.expect("faces without area were left out at import"))
            }
            Shape::HalfSpace(plane) => Arc::clone(plane),
        }
    }

    /// The coefficients of a face's plane modulo primes and up to a common factor, for the keys of lines in
    /// the plane.
    pub fn plane_residues(&self, face: FaceId) -> PlaneResidues<'_> {
        match &self.shape {
            Shape::Mesh(mesh) => PlaneResidues::through(&mesh.corners(face)),
            Shape::HalfSpace(plane) => PlaneResidues::of(plane),
        }
    }

    /// Return whether a face is perpendicular to an axis.
    pub fn is_orthogonal(&self, face: FaceId) -> bool {
        match &self.shape {
            Shape::Mesh(mesh) => {
                let [a, b, c] = mesh.corners(face);
                (0..3).any(|i| a[i] == b[i] && b[i] == c[i])
            }
            Shape::HalfSpace(plane) => plane.only_axis().is_some(),
        }
    }

    /// The part of a face inside a cell, or `None` if it has no area.
    pub fn clip(&self, face: FaceId, cell: &Cell) -> Option<Polygon> {
        match &self.shape {
            Shape::Mesh(mesh) => {
                let corners = mesh.corners(face);
                Polygon::triangle(&corners, self.plane(face)).clipped(cell)
            }
            Shape::HalfSpace(plane) => Polygon::span(plane, cell),
        }
    }

    /// The lowest and highest corner of the lattice box around these faces; `None` if there are no faces.
    pub fn box_around(&self, faces: &[FaceId]) -> Option<(Lattice, Lattice)> {
        let boxes = faces.iter().map(|face| self.face_box(*face));
        boxes.reduce(|(low, high), (l, h)| {
            let low = each_axis(|i| low[i].min(l[i]));
            (low, each_axis(|i| high[i].max(h[i])))
        })
    }

    /// The lowest and highest corner of the lattice box around a face; the whole lattice for a half-space.
    pub fn face_box(&self, face: FaceId) -> (Lattice, Lattice) {
        match &self.shape {
            Shape::Mesh(mesh) => mesh.face_box(face),
            Shape::HalfSpace(_) => (*Cell::UNIVERSE.low(), Cell::UNIVERSE.high()),
        }
    }

    /// The index of a face in the input, before import left out any faces.
    pub fn number(&self, face: FaceId) -> u32 {
        self.mesh()
            .and_then(|m| m.numbers.as_ref())
            .map_or(face.0, |n| n[face.index()])
    }

    /// The smallest cell around all vertices, or the cell of the whole lattice for a half-space; `None` if
    /// there are no vertices.
    pub fn cell(&self) -> Option<Cell> {
        *self.cell.get_or_make(|| match &self.shape {
            Shape::Mesh(mesh) => mesh.bounds().map(|(low, high)| Cell::around(&low, &high)),
            Shape::HalfSpace(_) => Some(Cell::UNIVERSE),
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::grid::Pitch;
    use crate::mesh::import::import;

    #[test]
    fn only_what_closes_by_its_own_corners_closes_when_moved() {
        let corners = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let is_closed = |more: [f64; 3], faces: &[[i64; 3]]| {
            let vertices = [&corners[..], &[more]].concat();
            let source = import(&vertices, faces, Pitch::new(0).ok());
            source.expect("it is closed").closes_when_moved()
        };
        assert!(is_closed([1.0; 3], &faces));
        // One face has a corner of its own, which is welded.
        let loose = [[4, 2, 1], faces[1], faces[2], faces[3]];
        assert!(is_closed([0.0; 3], &loose));
        assert!(!is_closed([0.1, 0.0, 0.0], &loose));
        // One face has an edge that a vertex divides, first without and then with a further face that has no
        // area.
        let divided = [[0, 2, 4], [4, 2, 1], faces[1], faces[2], faces[3]];
        assert!(!is_closed([1.0, 0.0, 0.0], &divided));
        let flat = [&divided[..], &[[0, 4, 1]]].concat();
        assert!(!is_closed([1.0, 0.0, 0.0], &flat));
    }
}
