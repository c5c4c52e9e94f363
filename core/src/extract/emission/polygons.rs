//! Triangulates polygons of a mesh under construction: plane groups, and whole faces with inserted points.

use std::sync::Arc;

use rayon::prelude::*;

use super::assembly::Assembly;
use super::origin::Owners;
use crate::extract::failure::Overlap;
use crate::extract::joining::group::PlaneGroup;
use crate::extract::joining::seams::{Edge, InnerPoints};
use crate::extract::triangulate::{triangulate, Planar};
use crate::extract::vertices::Projection;
use crate::geometry::plane::Plane;
use crate::interrupt::{carried, poll};
use crate::mesh::handle::OrientedFace;
use crate::mesh::tasks::{in_pool, CHUNK};

/// Triangles of table points, each with the source face that it lies in.
type Triangles = Vec<([u32; 3], OrientedFace)>;

impl Assembly<'_> {
    /// Triangulates a whole face with the points inserted on its edges, and appends the triangles.
    pub(in crate::extract) fn emit_split(
        &mut self,
        face: OrientedFace,
        inner: &[Vec<u32>; 3],
    ) -> Result<(), Overlap> {
        let (slot, id) = (face.slot(), face.id());
        let source = Arc::clone(self.sources.get(slot));
        let Some(mesh) = source.mesh() else {
            return Ok(());
        };
        let flip = face.orientation.is_opposite();
        let corners = mesh.vertices_of(id).map(|v| self.point_of(slot, mesh, v));
        let mut ring = Vec::new();
        for i in 0..3 {
            ring.push(corners[i]);
            let inner = inner[i].iter();
            if flip {
                ring.extend(inner.rev());
            } else {
                ring.extend(inner);
            }
        }
        if flip {
            ring.reverse();
        }
        let edges: Vec<(u32, u32)> = (0..ring.len())
            .map(|i| (ring[i], ring[(i + 1) % ring.len()]))
            .collect();
        let plane = source.plane(id);
        let plane = if flip {
            plane.flipped()
        } else {
            (*plane).clone()
        };
        for triangle in self.triangulated(&plane, &edges, &[face])? {
            self.push(triangle, face);
        }
        Ok(())
    }

    /// Triangulates plane groups and appends the triangles; frees each group as soon as it is done.
    pub(in crate::extract) fn emit_groups(
        &mut self,
        groups: Vec<PlaneGroup>,
        mut edges: &[Edge],
        inner: &InnerPoints,
    ) -> Result<(), Overlap> {
        let mut groups = groups.into_iter().peekable();
        let mut first = 0;
        while groups.peek().is_some() {
            poll();
            let mut batch = Vec::new();
            let mut size = 0;
            while let Some(group) = groups.next_if(|_| size < CHUNK) {
                let (own, rest) = edges.split_at(group.edges().len());
                batch.push((group, first, own));
                first += own.len();
                size += own.len();
                edges = rest;
            }
            let triangulate = carried(|(group, first, own): (PlaneGroup, usize, &[Edge])| {
                self.triangulated_group(&group, &chain(own, first, inner))
            });
            let made: Vec<Result<Triangles, Overlap>> = if in_pool() && batch.len() > 1 {
                batch.into_par_iter().map(triangulate).collect()
            } else {
                batch.into_iter().map(triangulate).collect()
            };
            for triangles in made {
                for (triangle, face) in triangles? {
                    self.push(triangle, face);
                }
            }
        }
        Ok(())
    }

    /// Returns the triangles of a plane group, each with the source face that it lies in.
    fn triangulated_group(
        &self,
        group: &PlaneGroup,
        chain: &[(u32, u32)],
    ) -> Result<Triangles, Overlap> {
        let triangles = self.triangulated(&group.plane, chain, &group.faces)?;
        if let [face] = group.faces[..] {
            return Ok(triangles.into_iter().map(|t| (t, face)).collect());
        }
        let view = Projection::onto(&group.plane, &self.table);
        let owners = Owners::new(group, &view, self.sources);
        let faces = owners.at_centres(&triangles, &view);
        Ok(triangles.into_iter().zip(faces).collect())
    }

    /// Returns the triangles of the region that `edges` bound in a plane; an error names `faces`.
    fn triangulated(
        &self,
        plane: &Plane,
        edges: &[(u32, u32)],
        faces: &[OrientedFace],
    ) -> Result<Vec<[u32; 3]>, Overlap> {
        let view = Projection::onto(plane, &self.table);
        let overlap = |sign: String| Overlap {
            sign,
            faces: faces.to_vec(),
        };
        let triangles = triangulate(&view, edges)
            .map_err(|e| overlap(format!("an outline could not be triangulated: {e}")))?;
        if self.verify && !covers_once(&view, edges, &triangles) {
            return Err(overlap("faces in one plane overlap".to_owned()));
        }
        Ok(triangles)
    }
}

/// Divides edges at points inside them, in order; the edge at index k has the number `first` + k in `inner`.
fn chain(edges: &[Edge], first: usize, inner: &InnerPoints) -> Vec<(u32, u32)> {
    let mut chain = Vec::with_capacity(edges.len());
    for (edge, i) in edges.iter().zip(first..) {
        poll();
        let mut at = edge.from;
        for next in inner.get(&i).into_iter().flatten() {
            chain.push((at, *next));
            at = *next;
        }
        chain.push((at, edge.to));
    }
    chain
}

/// Returns true if the sum of the triangles' areas, in doubles, equals the area inside the edges up to one
/// millionth.
fn covers_once(view: &Projection, edges: &[(u32, u32)], triangles: &[[u32; 3]]) -> bool {
    let Some(origin) = edges.first().map(|e| view.approx(e.0)) else {
        return true;
    };
    let at = |p: u32| {
        let [x, y] = view.approx(p);
        [x - origin[0], y - origin[1]]
    };
    let turn = |a: u32, b: u32| {
        let (p, q) = (at(a), at(b));
        p[0] * q[1] - p[1] * q[0]
    };
    let enclosed: f64 = edges.iter().map(|e| turn(e.0, e.1)).sum();
    let covered: f64 = triangles
        .iter()
        .map(|t| turn(t[0], t[1]) + turn(t[1], t[2]) + turn(t[2], t[0]))
        .sum();
    (enclosed - covered).abs() <= 1e-6 * covered.abs()
}
