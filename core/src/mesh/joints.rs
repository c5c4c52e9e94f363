//! How the faces of a closed mesh meet, as far as that is out of the ordinary.

use super::chain::is_closed;
use super::links;
use super::tasks::{both, CHUNK};
use super::topology::{ends, Topology};
use super::triangles::TriangleMesh;
use crate::arith::convert::as_number;

/// Vertices where faces do not meet two at each edge and in one fan.
#[derive(Debug, Default)]
pub struct Joints {
    /// Vertices at the ends of edges that more than two faces use, or with several fans, sorted.
    pub irregular: Vec<u32>,
    /// Vertices at the ends of edges that have no opposite by index, sorted: the ends of edges
    /// that cancel along lines only, as at T-junctions.
    pub open: Vec<u32>,
}

impl Joints {
    /// The joints of a mesh that is closed, by index or along lines.
    pub fn of(mesh: &TriangleMesh) -> Self {
        Self::of_closed(mesh).unwrap_or_else(|| {
            Self::of_open(mesh, &Topology::new(&mesh.faces, mesh.vertices.len()))
        })
    }

    /// The joints of a mesh whose edges have their opposites by index; `None` for others.
    pub fn of_closed(mesh: &TriangleMesh) -> Option<Self> {
        let faces = &mesh.faces;
        let links = || links::irregular(faces, mesh.vertices.len());
        let (closed, irregular) = both(faces.len() > CHUNK, || is_closed(faces), links);
        closed.then_some(Self {
            irregular,
            open: Vec::new(),
        })
    }

    /// The joints of a mesh of which some edges have no opposite by index.
    pub fn of_open(mesh: &TriangleMesh, topology: &Topology) -> Self {
        let half_ends = |half: usize| <[u32; 2]>::from(ends(&mesh.faces, as_number(half)));
        let mut open: Vec<u32> = topology.unpaired().flat_map(half_ends).collect();
        open.sort_unstable();
        open.dedup();
        Self {
            irregular: topology.irregular().to_vec(),
            open,
        }
    }
}
