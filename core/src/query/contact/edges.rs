//! Finds edges of a surface at which other walls of the same surface pass inside the solid.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use crate::arith::convert::as_number;
use crate::error::Result;
use crate::extract::assemble::assemble_patches;
use crate::extract::joining::chords::EdgeContact;
use crate::extract::joining::patches::Patches;
use crate::extract::surface::near::{near_pairs, Element, LatticeBox};
use crate::extract::surface::passing::{contacts_of, Mate, WallPair};
use crate::extract::surface::Surface;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::topology::{ends, Topology, NONE};
use crate::tree::solid::Solid;

/// Returns the reflex edges of a reduced solid's surface that lie inside a face, or that overlap an edge of
/// two other faces inside the solid: there two parts of the solid touch, but their walls go over into each
/// other. Exact.
///
/// An edge is reflex if the solid fills more than half of the space around it. An edge that is not reflex
/// only touches other walls from outside, and does not connect two parts of the solid, unless walls of the
/// surface pass through one another (see `extract/surface/passing.rs`).
///
/// # Cost
/// Proportional to the mesh, the pairs of a reflex edge and a flat part of the surface whose boxes overlap,
/// and the pairs of an edge and a triangle in one plane whose boxes overlap.
///
/// # Errors
/// `Unbounded`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::extract::joining::patches::Patches;
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::contact::edge_contacts;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// assert!(edge_contacts(&solid, &Patches::default())?.is_empty());
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn edge_contacts(solid: &Solid, patches: &Patches) -> Result<Vec<EdgeContact>> {
    let mesh = assemble_patches(solid, patches)?;
    let surface = Surface::new(solid, patches, &mesh);
    let folds = Folds::of(&surface);
    let found = folds.overlaps().into_iter();
    Ok(found.flat_map(|overlap| folds.contacts(&overlap)).collect())
}

/// A reflex edge, by its number, that overlaps a triangle in its plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Overlap {
    edge: u32,
    triangle: u32,
    /// The triangle's edge that overlaps the reflex edge; `None` inside the triangle or its flat part
    /// (connected coplanar triangles).
    along: Option<usize>,
}

/// An edge around which the solid fills more than a half turn.
struct ReflexEdge {
    ends: [Vertex; 2],
    /// The vertex numbers of the two ends.
    vertices: [VertexId; 2],
    /// The two triangles that share the edge.
    beside: [u32; 2],
}

impl ReflexEdge {
    /// Makes a reflex edge of its two half-edges.
    fn of([half, mate]: [u32; 2], surface: &Surface) -> Self {
        let vertices = <[VertexId; 2]>::from(ends(surface.triangles(), half));
        Self {
            ends: vertices.map(|vertex| surface.vertex(vertex)),
            vertices,
            beside: [half, mate].map(|half| FaceId::of_half_edge(half).0),
        }
    }

    /// The two triangles that share the edge.
    fn walls(&self, surface: &Surface) -> WallPair {
        let [wall, mate] = self.beside;
        let corners = surface.triangles()[mate as usize];
        let apex = corners.iter().position(|v| !self.vertices.contains(v));
        let mate = Mate {
            wall: mate,
            apex: apex.unwrap_or(0),
        };
        WallPair {
            wall,
            mate: Some(mate),
        }
    }

    /// Returns true if the edge lies in the plane of a triangle.
    fn lies_in_plane_of(&self, triangle: u32, surface: &Surface) -> bool {
        let corners = surface.triangles()[triangle as usize];
        let mut ends = self.ends.iter().zip(&self.vertices);
        ends.all(|(end, v)| corners.contains(v) || surface.side(triangle, end) == Side::On)
    }

    /// The edge as the corners of a triangle without area, for computing boxes.
    fn corners(&self) -> [Vertex; 3] {
        let [from, to] = &self.ends;
        [from.clone(), to.clone(), to.clone()]
    }

    fn element(&self) -> Element {
        Element {
            operand: 0,
            space: LatticeBox::around(&self.ends),
        }
    }
}

/// The reflex edges of a surface (the solid fills more than half of the space around each), and its flat
/// parts: connected coplanar triangles of one patch.
struct Folds<'a> {
    surface: &'a Surface<'a>,
    topology: Topology,
    reflex: Vec<ReflexEdge>,
    flats: FlatParts,
}

impl<'a> Folds<'a> {
    fn of(surface: &'a Surface<'a>) -> Self {
        let triangles = surface.triangles();
        let topology = Topology::new(triangles, surface.vertex_count());
        let mut sets = DisjointSets::of_one(triangles.len());
        let mut reflex = Vec::new();
        for (half, &mate) in (0u32..).zip(topology.mates()) {
            poll();
            if mate == NONE || mate < half {
                continue;
            }
            let [triangle, other] = [half, mate].map(|half| FaceId::of_half_edge(half).0);
            let apex = triangles[other as usize][(mate as usize + 2) % 3];
            match surface.side(triangle, &surface.vertex(apex)) {
                Side::On if surface.patch(triangle) == surface.patch(other) => {
                    sets.join(triangle, other);
                }
                Side::Minus | Side::On => {}
                Side::Plus => reflex.push(ReflexEdge::of([half, mate], surface)),
            }
        }
        Self {
            surface,
            topology,
            reflex,
            flats: FlatParts::of(&mut sets),
        }
    }

    /// Returns the contacts at which the faces of an overlap are divided.
    fn contacts(&self, overlap: &Overlap) -> Vec<EdgeContact> {
        let edge = &self.reflex[overlap.edge as usize];
        let hull = edge.ends.iter().cloned().map(Arc::new).collect();
        if overlap.along.is_some() {
            let other = WallPair::at(overlap.triangle, overlap.along, &self.topology);
            return contacts_of(self.surface, [edge.walls(self.surface), other], &hull);
        }
        vec![EdgeContact {
            hull,
            beside: edge.beside.map(|t| self.surface.face(t)),
            face: self.surface.face(overlap.triangle),
        }]
    }

    /// Returns the overlaps of reflex edges and triangles that lie inside the solid. For each edge inside a
    /// flat part (connected coplanar triangles) there is at least one.
    fn overlaps(&self) -> Vec<Overlap> {
        let mut found = Vec::new();
        for run in self.in_planes().chunk_by(|a, b| a[0] == b[0]) {
            let edges = run.iter().map(|[_, edge]| *edge);
            let triangles = self.flats.triangles(run[0][0]);
            let left = self.at_corners(edges, triangles, &mut found);
            if !left.is_empty() {
                self.compare(&left, triangles, &mut found);
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Returns pairs of a flat part and a reflex edge whose boxes overlap; the edge lies in the plane of the
    /// part.
    fn in_planes(&self) -> Vec<[u32; 2]> {
        if self.reflex.is_empty() {
            return Vec::new();
        }
        let first = as_number(self.reflex.len());
        let mut elements: Vec<Element> = self.reflex.iter().map(ReflexEdge::element).collect();
        elements.extend(self.flats.all().map(|flat| Element {
            operand: 1,
            space: self.surface.space_of(self.flats.triangles(flat)),
        }));
        let corners = |number: u32| match number.checked_sub(first) {
            None => Some(self.reflex[number as usize].corners()),
            Some(flat) => match self.flats.triangles(flat) {
                [triangle] => Some(self.surface.corners(*triangle)),
                _ => None,
            },
        };
        let mut found = Vec::new();
        near_pairs(&elements, corners, |one, other| {
            poll();
            let (number, flat) = (one.min(other), one.max(other) - first);
            let edge = &self.reflex[number as usize];
            let triangles = self.flats.triangles(flat);
            let is_own = matches!(triangles, [triangle] if edge.beside.contains(triangle));
            if !is_own && edge.lies_in_plane_of(triangles[0], self.surface) {
                found.push([flat, number]);
            }
            Some(())
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Adds the overlaps of edges with triangles at one of their ends; returns the edges that do not lie
    /// inside such a triangle.
    fn at_corners(
        &self,
        edges: impl Iterator<Item = u32>,
        triangles: &[u32],
        found: &mut Vec<Overlap>,
    ) -> Vec<u32> {
        let mut around: HashMap<VertexId, Vec<u32>> = HashMap::default();
        for triangle in triangles {
            poll();
            for vertex in self.surface.triangles()[*triangle as usize] {
                around.entry(vertex).or_default().push(*triangle);
            }
        }
        let is_left = |edge: &u32| {
            let vertices = &self.reflex[*edge as usize].vertices;
            let near = vertices.iter().filter_map(|v| around.get(v)).flatten();
            let overlaps = near.filter_map(|triangle| self.overlap(*edge, *triangle));
            let mut inside = overlaps.filter(|overlap| overlap.along.is_none());
            let first = inside.next();
            found.extend(first);
            first.is_none()
        };
        edges.filter(is_left).collect()
    }

    /// Adds all overlaps of some edges and triangles of one plane.
    fn compare(&self, edges: &[u32], triangles: &[u32], found: &mut Vec<Overlap>) {
        let reflex = |edge: &u32| &self.reflex[*edge as usize];
        let mut elements: Vec<Element> = edges.iter().map(|e| reflex(e).element()).collect();
        elements.extend(triangles.iter().map(|triangle| Element {
            operand: 1,
            space: self.surface.space_of(&[*triangle]),
        }));
        let triangle = |number: u32| triangles[number as usize - edges.len()];
        let corners = |number: u32| {
            let edge = edges.get(number as usize).map(reflex);
            Some(edge.map_or_else(
                || self.surface.corners(triangle(number)),
                ReflexEdge::corners,
            ))
        };
        near_pairs(&elements, corners, |one, other| {
            let (edge, triangle) = (edges[one.min(other) as usize], triangle(one.max(other)));
            found.extend(self.overlap(edge, triangle));
            Some(())
        });
    }

    /// Returns how a reflex edge in a triangle's plane overlaps the triangle, if it has a point in the
    /// triangle's interior, or overlaps an edge of it and the triangle is inside the solid there.
    fn overlap(&self, edge: u32, triangle: u32) -> Option<Overlap> {
        poll();
        let reflex = &self.reflex[edge as usize];
        if reflex.beside.contains(&triangle) {
            return None;
        }
        let ends = reflex.ends.each_ref();
        let facet = self.surface.facet(triangle);
        let overlap = |along| Overlap {
            edge,
            triangle,
            along,
        };
        if facet.has_inside(ends) {
            return Some(overlap(None));
        }
        let along = (0..3).find(|i| facet.has_along(*i, ends))?;
        if self.goes_on(triangle, along) {
            return Some(overlap(None));
        }
        let apex = &facet.corners[(along + 2) % 3];
        let walls = reflex.walls(self.surface);
        walls
            .has_inside(apex, self.surface)
            .then(|| overlap(Some(along)))
    }

    /// Returns true if a triangle shares an edge with another triangle of its flat part (connected coplanar
    /// triangles).
    fn goes_on(&self, triangle: u32, edge: usize) -> bool {
        let mate = self.topology.mates()[3 * triangle as usize + edge];
        let flat = self.flats.holding(triangle);
        mate != NONE && self.flats.holding(FaceId::of_half_edge(mate).0) == flat
    }
}

/// The flat parts of a surface: coplanar triangles that are connected across edges.
struct FlatParts {
    /// The triangles, grouped by flat part.
    order: Vec<u32>,
    /// The index in `order` at which each part starts; the last entry is the end.
    starts: Vec<usize>,
    /// The number of the part of each triangle.
    of: Vec<u32>,
}

impl FlatParts {
    fn of(sets: &mut DisjointSets) -> Self {
        let names: Vec<u32> = (0..sets.end())
            .map(|triangle| sets.least(triangle))
            .collect();
        let mut order: Vec<u32> = (0..sets.end()).collect();
        order.sort_by_key(|triangle| names[*triangle as usize]);
        let (mut starts, mut of) = (vec![0], vec![0; order.len()]);
        for part in order.chunk_by(|a, b| names[*a as usize] == names[*b as usize]) {
            poll();
            for triangle in part {
                of[*triangle as usize] = as_number(starts.len() - 1);
            }
            starts.push(starts.last().map_or(0, |start| start + part.len()));
        }
        Self { order, starts, of }
    }

    /// The numbers of all flat parts.
    fn all(&self) -> std::ops::Range<u32> {
        0..as_number(self.starts.len() - 1)
    }

    /// The triangles of a flat part.
    fn triangles(&self, part: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.starts[part as usize + i]);
        &self.order[start..end]
    }

    /// The number of the part that contains a triangle.
    fn holding(&self, triangle: u32) -> u32 {
        self.of[triangle as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::super::divided;
    use super::*;
    use crate::geometry::plane::Lattice;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, prism, tetrahedron};
    use crate::mesh::surfaces::counts;

    /// A box with a groove whose inner edge lies at y = `tip`; it touches the opposite wall if that is 8.
    fn grooved(tip: i64) -> Solid {
        let wedge = prism(&[[2, 0, 0], [6, 0, 0], [4, tip, 0]], 4);
        made_of(&[cuboid([0; 3], [8, 8, 4]), wedge], Term::Xor)
    }

    fn contacts(solid: &Solid) -> Vec<[Option<Lattice>; 2]> {
        let found = edge_contacts(solid, &Patches::default()).expect("bounded");
        let places = |c: &EdgeContact| [0, 1].map(|i| c.hull[i].as_lattice().copied());
        let mut ends: Vec<_> = found.iter().map(places).collect();
        for pair in &mut ends {
            pair.sort_unstable();
        }
        ends.dedup();
        ends
    }

    #[test]
    fn an_edge_in_the_middle_of_a_wall_is_found_and_divides_it() {
        let solid = grooved(8);
        assert_eq!(contacts(&solid), [[Some([4, 8, 0]), Some([4, 8, 4])]]);
        let plain = Patches::default();
        let divided = divided(&solid, &plain)
            .expect("bounded")
            .expect("edges inside walls");
        assert!(edge_contacts(&solid, &divided).expect("bounded").is_empty());
        let surfaces = |patches| {
            let mesh = assemble_patches(&solid, patches).expect("bounded");
            counts(&mesh.triangles, mesh.vertices.len()).surfaces
        };
        assert_eq!([&plain, &divided].map(surfaces), [1, 2]);
    }

    #[test]
    fn an_edge_short_of_a_wall_is_none() {
        assert!(contacts(&grooved(7)).is_empty());
    }

    #[test]
    fn an_edge_along_the_diagonal_of_a_wall_is_found() {
        let ends = [[2, 2, 8], [6, 6, 8]];
        for mirrored in [false, true] {
            let place = |[x, y, z]: Lattice| [if mirrored { 8 - x } else { x }, y, z];
            let mut corners = [ends[0], ends[1], [6, 2, 4], [2, 6, 4]].map(place);
            if mirrored {
                corners.swap(2, 3);
            }
            let solids = [cuboid([0; 3], [8; 3]), tetrahedron(corners)];
            let mut expected = ends.map(|p| Some(place(p)));
            expected.sort_unstable();
            assert_eq!(contacts(&made_of(&solids, Term::Xor)), [expected]);
        }
    }

    #[test]
    fn an_edge_that_touches_a_wall_from_outside_divides_nothing() {
        let roof = prism(&[[2, 12, 0], [4, 8, 0], [6, 12, 0]], 4);
        let solid = made_of(&[cuboid([0; 3], [8, 8, 4]), roof], Term::Or);
        assert!(contacts(&solid).is_empty());
    }
}
