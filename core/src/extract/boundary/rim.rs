//! Finds the edges at which the whole faces of a source (entirely boundary) end, by their vertices, without
//! opposite half-edges.
//!
//! Two faces at an edge share both ends of the edge. So a whole face can lie beside a cut or removed face
//! only if such faces meet at one of its corners. Few whole faces have such a corner, and only these are
//! compared edge by edge.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;

use super::leaves::{Fate, Fates};
use crate::arith::convert::as_number;
use crate::geometry::line::LineKey;
use crate::geometry::side::Orientation;
use crate::interrupt::{carried, poll, spend};
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{FaceId, Slot, SourceFace, VertexId};
use crate::mesh::source::Source;
use crate::mesh::tasks::{in_pool, CHUNK};
use crate::mesh::triangles::TriangleMesh;

/// Bit of a vertex at a whole face (entirely boundary) in its source's orientation; `TURNED`: at a whole face
/// turned around; `OTHER`: at a face that is cut or gone.
const KEPT: u8 = 1;
const TURNED: u8 = 2;
const OTHER: u8 = 4;
/// Bit of a vertex on an edge that has no opposite by vertex numbers, but that other edges on the same line
/// cancel.
const OPEN: u8 = 8;

/// For each source, by slot, the vertices and edges at which its whole faces (entirely boundary) meet faces
/// that are cut or gone.
#[derive(Debug)]
pub struct Rims {
    by_slot: Vec<Rim>,
    /// For each source, the half-edges of its whole faces that share a corner with a cut or removed face, by
    /// their two ends; made on first use.
    by_ends: Vec<OnceLock<HashMap<[VertexId; 2], u32>>>,
    /// For each slot, the faces around each vertex of its source; made on first use.
    around: Vec<OnceLock<Around>>,
    /// Sources, by index (slot), whose faces' fates (whole, cut or gone) have changed since their rims were
    /// found.
    outdated: BTreeSet<Slot>,
}

/// An edge of a whole face that has no other whole face of the same orientation on its other side.
#[derive(Clone, Copy, Debug)]
pub struct FrontierEdge {
    /// The slot of the face's source.
    pub slot: Slot,
    /// The number of the half-edge: three times its face's number, plus its index in the face.
    pub half: u32,
}

impl FrontierEdge {
    /// The face that this edge bounds.
    pub fn face(&self) -> SourceFace {
        SourceFace::new(self.slot, FaceId::of_half_edge(self.half))
    }

    /// The line that this edge lies on.
    pub fn line(&self, sources: &Sources) -> LineKey {
        let mesh = sources.get(self.slot).mesh();
        let ends = mesh.map(|m| half_edge_ends(m, self.half).map(|v| m.vertices[v.index()]));
        let [a, b] = ends.unwrap_or([[0; 3], [1, 0, 0]]);
        LineKey::of_edge(&a, &b)
    }
}

impl Rims {
    /// Finds for each source the vertices at which its whole faces (entirely boundary) meet faces that are
    /// cut or gone.
    pub fn of(fates: &Fates, sources: &Sources) -> Self {
        let slots: Vec<Slot> = Slot::all().take(fates.sources()).collect();
        let rim = carried(|slot: &Slot| Rim::of(sources.get(*slot), fates.of(*slot)));
        let large = in_pool() && fates.faces() > CHUNK;
        Self {
            by_slot: if large {
                slots.par_iter().map(rim).collect()
            } else {
                slots.iter().map(rim).collect()
            },
            by_ends: vec![OnceLock::new(); fates.sources()],
            around: vec![OnceLock::new(); fates.sources()],
            outdated: BTreeSet::new(),
        }
    }

    /// Marks as outdated which vertices of a source lie between whole faces and other faces, because faces of
    /// the source have become whole, cut or gone.
    pub fn outdated(&mut self, slot: Slot) {
        self.outdated.insert(slot);
    }

    /// Finds again the vertices between whole faces and other faces, for each source marked as outdated.
    pub fn renew(&mut self, fates: &Fates, sources: &Sources) {
        for slot in std::mem::take(&mut self.outdated) {
            self.by_slot[slot.index()] = Rim::of(sources.get(slot), fates.of(slot));
            self.by_ends[slot.index()] = OnceLock::new();
        }
    }

    /// The vertices at which whole faces (entirely boundary) of the source with the index `slot` meet other
    /// faces.
    pub fn get(&self, slot: Slot) -> &Rim {
        &self.by_slot[slot.index()]
    }

    /// Returns the half-edges of whole faces that have no opposite in a whole face of the same orientation.
    pub fn frontier(&self, fates: &Fates, sources: &Sources) -> Vec<FrontierEdge> {
        let mut found = Vec::new();
        for (rim, (slot, fates)) in self.by_slot.iter().zip(fates.by_slot()) {
            if let Some(mesh) = sources.get(slot).mesh() {
                let halves = rim.half_edges(mesh, fates).into_iter();
                found.extend(halves.map(|half| FrontierEdge { slot, half }));
            }
        }
        found
    }

    /// Returns the face on the other side of a half-edge; `None` if no whole face can be there.
    ///
    /// A face with a corner at a cut or removed face is found by its edges, any other face by its corners.
    pub fn across(&self, slot: Slot, half: u32, sources: &Sources) -> Option<FaceId> {
        let mesh = sources.get(slot).mesh()?;
        let rim = self.get(slot);
        let [a, b] = half_edge_ends(mesh, half);
        if !rim.is_used(a) || !rim.is_used(b) {
            return None;
        }
        if rim.is_mixed(a) || rim.is_mixed(b) {
            let by_ends = self.by_ends[slot.index()].get_or_init(|| rim.by_ends(mesh));
            return by_ends.get(&[b, a]).map(|mate| FaceId::of_half_edge(*mate));
        }
        let around = self.around[slot.index()].get_or_init(|| Around::of(mesh));
        let mut faces = around.faces(a).iter();
        let has_mate = |face: &&FaceId| {
            let mut halves = face.half_edges();
            halves.any(|h| half_edge_ends(mesh, h) == [b, a])
        };
        faces.find(has_mate).copied()
    }
}

/// The faces around each vertex of a mesh.
#[derive(Clone, Debug)]
struct Around {
    /// For each vertex, the index in `faces` at which its faces start; the last entry is the length of
    /// `faces`.
    starts: Vec<u32>,
    faces: Vec<FaceId>,
}

impl Around {
    fn of(mesh: &TriangleMesh) -> Self {
        let mut starts = vec![0u32; mesh.vertices.len() + 1];
        for vertex in mesh.faces.iter().flatten() {
            starts[vertex.index()] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut faces = vec![FaceId(0); sum as usize];
        for (face, corners) in mesh.faces.iter().enumerate().rev() {
            poll();
            for vertex in corners {
                let start = &mut starts[vertex.index()];
                *start -= 1;
                faces[*start as usize] = FaceId(as_number(face));
            }
        }
        Self { starts, faces }
    }

    /// The faces around a vertex, ascending.
    fn faces(&self, vertex: VertexId) -> &[FaceId] {
        let [start, end] = [0, 1].map(|i| self.starts[vertex.index() + i] as usize);
        &self.faces[start..end]
    }
}

/// The vertices at which faces of one source have different fates (whole, cut or gone), and the whole faces
/// with such a corner.
#[derive(Debug, Default)]
pub struct Rim {
    /// For each vertex, those of the bits `KEPT`, `TURNED`, `OTHER` and `OPEN` that apply.
    touch: Vec<u8>,
    /// The whole faces (entirely boundary) with a corner at which faces of different fates or orientations
    /// meet, ascending.
    near: Vec<FaceId>,
}

impl Rim {
    /// Finds the vertices at which a source's whole faces (entirely boundary) meet faces that are cut or
    /// gone; empty if `fates` is empty.
    fn of(source: &Source, fates: &[Fate]) -> Self {
        let (Some(mesh), false) = (source.mesh(), fates.is_empty()) else {
            return Self::default();
        };
        let mut rim = Self {
            touch: touch(mesh, fates),
            near: Vec::new(),
        };
        for vertex in source.open_vertices() {
            rim.touch[vertex.index()] |= OPEN;
        }
        if rim.touch.iter().any(|t| is_mixed(*t)) {
            let near = |(_, (corners, fate)): &(FaceId, (&[VertexId; 3], &Fate))| {
                matches!(fate, Fate::Whole(_)) && corners.iter().any(|v| rim.is_mixed(*v))
            };
            let faces = FaceId::all().zip(mesh.faces.iter().zip(fates));
            rim.near = faces.filter(near).map(|f| f.0).collect();
        }
        rim
    }

    /// Return whether a vertex is a corner of a whole face.
    pub fn is_used(&self, vertex: VertexId) -> bool {
        self.touch[vertex.index()] & (KEPT | TURNED) != 0
    }

    /// The number of vertices that are corners of whole faces.
    pub fn used_count(&self) -> usize {
        self.used().filter(|used| *used).count()
    }

    /// For each vertex whether it is a corner of a whole face.
    pub fn used(&self) -> impl Iterator<Item = bool> + '_ {
        self.touch.iter().map(|touch| touch & (KEPT | TURNED) != 0)
    }

    /// Returns true if faces that differ in orientation or in fate (whole or not) meet at a vertex, or if a
    /// whole face meets an open edge there.
    fn is_mixed(&self, vertex: VertexId) -> bool {
        is_mixed(self.touch[vertex.index()])
    }

    /// Returns the half-edges of whole faces that have no opposite of the same orientation, ascending.
    fn half_edges(&self, mesh: &TriangleMesh, fates: &[Fate]) -> Vec<u32> {
        let mut halves: Vec<Half> = Vec::new();
        for &face in &self.near {
            poll();
            for number in face.half_edges() {
                let ends = half_edge_ends(mesh, number);
                if ends.iter().all(|v| self.is_mixed(*v)) {
                    halves.push(Half::new(number, ends, fates[face.index()]));
                }
            }
        }
        halves.sort_unstable_by_key(|h| (h.edge, h.turned, h.backward, h.number));
        let mut alone = Vec::new();
        for edge in halves.chunk_by(|a, b| (a.edge, a.turned) == (b.edge, b.turned)) {
            poll();
            let (forward, backward) = edge.split_at(edge.partition_point(|h| !h.backward));
            let pairs = forward.len().min(backward.len());
            let rest = forward[pairs..].iter().chain(&backward[pairs..]);
            alone.extend(rest.map(|h| h.number));
        }
        alone.sort_unstable();
        alone
    }

    /// Maps the two ends of a half-edge to its number, for whole faces that share a corner with a cut or
    /// removed face.
    fn by_ends(&self, mesh: &TriangleMesh) -> HashMap<[VertexId; 2], u32> {
        let halves = self.near.iter().flat_map(|face| face.half_edges());
        let mut by_ends = HashMap::default();
        for half in halves {
            by_ends.entry(half_edge_ends(mesh, half)).or_insert(half);
        }
        by_ends
    }
}

/// A half-edge of a whole face, with the fields by which half-edges are sorted into edges.
struct Half {
    edge: [VertexId; 2],
    turned: bool,
    backward: bool,
    number: u32,
}

impl Half {
    fn new(number: u32, [a, b]: [VertexId; 2], fate: Fate) -> Self {
        Self {
            edge: [a.min(b), a.max(b)],
            turned: fate == Fate::Whole(Orientation::Opposite),
            backward: a > b,
            number,
        }
    }
}

/// Returns true if more than one of the bits `KEPT`, `TURNED`, `OTHER` and `OPEN` of a vertex is set.
fn is_mixed(touch: u8) -> bool {
    touch & touch.wrapping_sub(1) != 0
}

fn touch(mesh: &TriangleMesh, fates: &[Fate]) -> Vec<u8> {
    let mut touch = vec![0; mesh.vertices.len()];
    for (faces, fates) in mesh.faces.chunks(CHUNK).zip(fates.chunks(CHUNK)) {
        spend(faces.len());
        for (&[a, b, c], fate) in faces.iter().zip(fates) {
            let kind = match fate {
                Fate::Whole(Orientation::Same) => KEPT,
                Fate::Whole(Orientation::Opposite) => TURNED,
                Fate::Cut | Fate::Gone => OTHER,
            };
            touch[a.index()] |= kind;
            touch[b.index()] |= kind;
            touch[c.index()] |= kind;
        }
    }
    touch
}

/// The vertices at which a half-edge starts and ends.
pub fn half_edge_ends(mesh: &TriangleMesh, half: u32) -> [VertexId; 2] {
    let face = mesh.vertices_of(FaceId::of_half_edge(half));
    let corner = half as usize % 3;
    [face[corner], face[(corner + 1) % 3]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extract::boundary::collect::collect;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, tetrahedra};

    #[test]
    fn whole_faces_end_where_their_neighbours_are_cut() {
        let solid = made_of(&tetrahedra(), Term::Or);
        let sources = Sources::new(solid.sources().clone());
        let boundary = collect(&solid, &sources);
        let rims = Rims::of(&boundary.fates, &sources);
        let frontier = rims.frontier(&boundary.fates, &sources);
        // The last face of the first tetrahedron is cut, beside three whole faces; that of the second is
        // whole, beside three cut faces.
        assert_eq!(frontier.len(), 6);
        let is_whole = |e: &FrontierEdge| matches!(boundary.fates[e.face()], Fate::Whole(_));
        assert!(frontier.iter().all(is_whole));
    }

    #[test]
    fn half_edges_run_around_their_face() {
        let solid = cuboid([0; 3], [1; 3]);
        let mesh = solid.sources().get(Slot(0)).mesh().expect("a mesh");
        let [a, b, c] = mesh.vertices_of(FaceId(5));
        let ends = FaceId(5)
            .half_edges()
            .map(|half| half_edge_ends(mesh, half));
        assert_eq!(ends.collect::<Vec<_>>(), [[a, b], [b, c], [c, a]]);
    }
}
