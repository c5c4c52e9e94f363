//! Finds edges of a surface that lie inside faces of the same surface.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use super::near::{near_pairs, Element, LatticeBox};
use super::surface::Surface;
use crate::arith::convert::as_number;
use crate::error::Result;
use crate::extract::joining::chords::EdgeContact;
use crate::extract::joining::patches::Patches;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::topology::{ends, Topology, NONE};
use crate::tree::solid::Solid;

/// Returns the reflex edges of a reduced solid's surface that lie inside a face: there two parts of the
/// solid touch, and the face extends over both. Exact.
///
/// An edge is reflex if the solid fills more than half of the space around it. An edge that is not reflex
/// only touches a face from outside, and does not connect two parts of the solid.
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
    let surface = Surface::of(solid, patches)?;
    let folds = Folds::of(&surface);
    let contact = |[edge, triangle]: [u32; 2]| {
        let edge = &folds.reflex[edge as usize];
        EdgeContact {
            ends: edge.ends.clone().map(Arc::new),
            beside: edge.beside.map(|t| surface.face(t)),
            face: surface.face(triangle),
        }
    };
    Ok(folds.contacts().into_iter().map(contact).collect())
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

    /// Returns pairs of a reflex edge and a triangle such that the interior of the triangle, or of its flat
    /// part (connected coplanar triangles), contains the edge. For each edge inside a flat part there is at
    /// least one pair.
    fn contacts(&self) -> Vec<[u32; 2]> {
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
    /// part and is not on the part's boundary.
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
            let bounds = edge.beside.iter().any(|t| self.flats.holding(*t) == flat);
            let triangle = self.flats.triangles(flat)[0];
            if !bounds && edge.lies_in_plane_of(triangle, self.surface) {
                found.push([flat, number]);
            }
            Some(())
        });
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Adds a pair for each edge that lies inside a triangle at one of its ends; returns the edges without
    /// such a triangle.
    fn at_corners(
        &self,
        edges: impl Iterator<Item = u32>,
        triangles: &[u32],
        found: &mut Vec<[u32; 2]>,
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
            let mut near = vertices.iter().filter_map(|v| around.get(v)).flatten();
            let holding = near.find(|triangle| self.is_in_middle(*edge, **triangle));
            found.extend(holding.map(|triangle| [*edge, *triangle]));
            holding.is_none()
        };
        edges.filter(is_left).collect()
    }

    /// Adds all pairs of an edge and a triangle for which [`Self::is_in_middle`] is true.
    fn compare(&self, edges: &[u32], triangles: &[u32], found: &mut Vec<[u32; 2]>) {
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
            if self.is_in_middle(edge, triangle) {
                found.push([edge, triangle]);
            }
            Some(())
        });
    }

    /// Returns true if an edge in a triangle's plane has a point in the triangle's interior, or overlaps an
    /// edge that the triangle shares with another triangle of its flat part (connected coplanar triangles).
    fn is_in_middle(&self, edge: u32, triangle: u32) -> bool {
        poll();
        let ends = self.reflex[edge as usize].ends.each_ref();
        let facet = self.surface.facet(triangle);
        let flat = self.flats.holding(triangle);
        let goes_on = |half: u32| {
            let mate = self.topology.mates()[half as usize];
            mate != NONE && self.flats.holding(FaceId::of_half_edge(mate).0) == flat
        };
        let mut inner = (0usize..).zip(FaceId(triangle).half_edges());
        facet.has_inside(ends) || inner.any(|(i, half)| goes_on(half) && facet.has_along(i, ends))
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
    use super::*;
    use crate::extract::assemble::assemble_patches;
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
        let places = |c: &EdgeContact| c.ends.each_ref().map(|end| end.as_lattice().copied());
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
        let found = edge_contacts(&solid, &plain).expect("bounded");
        let divided = plain.divided(&found);
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
