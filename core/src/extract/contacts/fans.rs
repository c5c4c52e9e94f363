//! Splitting of edges and vertices where a closed surface touches itself.
//!
//! Triangles are given by vertex numbers; all geometry comes from [`Radial`]. Half-edge `3 t + k` leaves
//! corner `k` of triangle `t`; the two share this number. Invariant of the result: every directed edge has
//! exactly one opposite by index, and the triangles around a vertex form one fan.

mod radial;
#[cfg(test)]
mod tests;

use std::fmt;

use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::VertexId;
use crate::mesh::surfaces::Counts;

/// Marks a corner of a triangle that does not belong to a fan (a ring of triangles around a vertex) yet.
const NONE: usize = usize::MAX;

/// The exact geometry that the splitting of edges and vertices asks for.
pub trait Radial {
    /// Outward normal of a triangle's plane, exact up to a positive factor, with components below 2^120.
    fn normal(&self, triangle: u32) -> [i128; 3];

    /// Signs of the three coordinates of b − a, exact.
    fn direction(&self, a: VertexId, b: VertexId) -> [Sign; 3];
}

/// A surface in which the triangles around each vertex form one closed ring (fan).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Split {
    /// The triangles, in the given order, with the new vertices.
    pub corners: Vec<[VertexId; 3]>,
    /// For each new vertex the old vertex that it copies. The first copy has the number of its old vertex;
    /// further copies follow.
    pub origin: Vec<VertexId>,
    /// Edges with more than two triangles: two old vertices, the lower number first, in increasing order.
    pub split_edges: Vec<[VertexId; 2]>,
    /// Old vertices with more than one copy, in increasing order.
    pub split_vertices: Vec<VertexId>,
    /// The counts of the surface in which triangles are joined exactly where they bound a wedge of the inside
    /// together. Two copies of an edge may have the same ends in it.
    pub counts: Counts,
}

/// The reasons why triangles are not a closed oriented surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// A corner is not the index of a vertex, or two corners of the triangle are the same.
    BadTriangle {
        /// The number of the triangle.
        triangle: usize,
    },
    /// The edge is not used equally often in both directions.
    Open {
        /// The edge's vertices, the lower number first.
        edge: [VertexId; 2],
    },
    /// There are too many triangles, or too many copies of vertices, to count them in 32 bits.
    TooMany,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadTriangle { triangle } => write!(
                f,
                "triangle {triangle} does not have three different vertices"
            ),
            Self::Open { edge: [a, b] } => write!(f, "the surface is not closed at edge {a} {b}"),
            Self::TooMany => write!(f, "the surface has too many triangles or vertices"),
        }
    }
}

impl std::error::Error for Error {}

/// Splits a closed surface until it is a manifold by index.
///
/// At an edge of more than two triangles, the two triangles that bound the same wedge of the inside stay
/// joined. If two copies of the edge would then have the same ends, they exchange their opposite half-edges,
/// which separates the outside between the two wedges.
///
/// # Order
/// Triangles keep their order. Copies are numbered by the first triangle that uses them.
///
/// # Cost
/// Linear in the triangles where nothing is split.
///
/// # Errors
/// [`Error`] when the triangles are not closed, or not triangles of `vertex_count` vertices.
///
/// # Example
/// ```
/// use bspcsg::arith::Sign;
/// use bspcsg::extract::contacts::fans::{split_fans, Radial};
/// use bspcsg::mesh::handle::VertexId;
///
/// /// Nothing is asked: no edge has more than two triangles.
/// struct Nothing;
///
/// impl Radial for Nothing {
///     fn normal(&self, _: u32) -> [i128; 3] {
///         [0; 3]
///     }
///     fn direction(&self, _: VertexId, _: VertexId) -> [Sign; 3] {
///         [Sign::Zero; 3]
///     }
/// }
///
/// // Two tetrahedra that touch at vertex 0.
/// let faces = |[a, b, c, d]: [u32; 4]| [[a, c, b], [a, b, d], [a, d, c], [b, c, d]];
/// let triangles = [faces([0, 1, 2, 3]), faces([0, 4, 5, 6])].concat();
/// let split = split_fans(&VertexId::rows(triangles), 7, &Nothing)?;
/// assert_eq!(split.split_vertices, [VertexId(0)]);
/// assert_eq!(split.origin.len(), 8);
/// # Ok::<(), bspcsg::extract::contacts::fans::Error>(())
/// ```
pub fn split_fans<R: Radial>(
    triangles: &[[VertexId; 3]],
    vertex_count: u32,
    radial: &R,
) -> Result<Split, Error> {
    check_triangles(triangles, vertex_count)?;
    let mut surface = Surface {
        triangles,
        mates: vec![0; 3 * triangles.len()],
    };
    let crowded = surface.pair_all(vertex_count, radial)?;
    let mut fans = Fans::new(&surface);
    let counts = surface.counts(&fans);
    for edge in &crowded {
        poll();
        fans.tell_apart(&mut surface, &edge.forward);
    }
    let split_edges = crowded.iter().map(|edge| edge.ends).collect();
    fans.number(&surface, vertex_count, split_edges, counts)
}

fn check_triangles(triangles: &[[VertexId; 3]], vertex_count: u32) -> Result<(), Error> {
    let is_good =
        |&[a, b, c]: &[VertexId; 3]| a != b && b != c && c != a && a.max(b).max(c).0 < vertex_count;
    u32::try_from(triangles.len()).map_err(|_| Error::TooMany)?;
    match triangles.iter().position(|corners| !is_good(corners)) {
        Some(triangle) => Err(Error::BadTriangle { triangle }),
        None => Ok(()),
    }
}

/// Triangles and, for every half-edge, the number of its opposite half-edge.
struct Surface<'a> {
    triangles: &'a [[VertexId; 3]],
    mates: Vec<usize>,
}

/// An edge of more than two triangles.
struct Crowded {
    /// The edge's vertices, the lower number first.
    ends: [VertexId; 2],
    /// The half-edges that run from the lower to the higher vertex.
    forward: Vec<usize>,
}

impl Surface<'_> {
    fn pair(&mut self, g: usize, h: usize) {
        self.mates[g] = h;
        self.mates[h] = g;
    }

    /// Pairs each half-edge with an opposite one; returns the edges of more than two triangles, ordered by
    /// vertices.
    fn pair_all<R: Radial>(
        &mut self,
        vertex_count: u32,
        radial: &R,
    ) -> Result<Vec<Crowded>, Error> {
        let mut crowded = Vec::new();
        let triangles = self.triangles;
        let (starts, mut halves) = self.halves_by_lower_end(vertex_count);
        for bounds in starts.windows(2) {
            let around = &mut halves[bounds[0]..bounds[1]];
            around.sort_unstable_by_key(|&half| self.edge_key(half));
            for halves in around.chunk_by(|&g, &h| ends(triangles, g) == ends(triangles, h)) {
                crowded.extend(self.pair_edge(halves, radial)?);
            }
        }
        Ok(crowded)
    }

    /// Groups half-edges by the lower of their vertices; returns where each group starts, and all
    /// half-edges.
    fn halves_by_lower_end(&self, vertex_count: u32) -> (Vec<usize>, Vec<usize>) {
        let group = |half: usize| ends(self.triangles, half)[0].index();
        let mut starts = vec![0; vertex_count as usize + 1];
        for half in 0..self.mates.len() {
            poll();
            starts[group(half) + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut free = starts.clone();
        let mut halves = vec![0; self.mates.len()];
        for half in 0..self.mates.len() {
            poll();
            let slot = &mut free[group(half)];
            halves[*slot] = half;
            *slot += 1;
        }
        (starts, halves)
    }

    fn is_forward(&self, half: usize) -> bool {
        origin(self.triangles, half) < origin(self.triangles, next(half))
    }

    /// The sort key of a half-edge among the half-edges with the same lower vertex: by edge, then forward
    /// ones first.
    fn edge_key(&self, half: usize) -> (VertexId, bool, usize) {
        (ends(self.triangles, half)[1], !self.is_forward(half), half)
    }

    /// Pairs the half-edges of one edge, of which the forward ones come first; returns the edge if there are
    /// more than two.
    fn pair_edge<R: Radial>(
        &mut self,
        halves: &[usize],
        radial: &R,
    ) -> Result<Option<Crowded>, Error> {
        let ends = ends(self.triangles, halves[0]);
        let (forward, backward) =
            halves.split_at(halves.partition_point(|&half| self.is_forward(half)));
        match (forward, backward) {
            (&[g], &[h]) => {
                self.pair(g, h);
                Ok(None)
            }
            _ if forward.len() == backward.len() => {
                for (g, h) in radial::wedges(radial, ends, forward, backward) {
                    poll();
                    self.pair(g, h);
                }
                Ok(Some(Crowded {
                    ends,
                    forward: forward.to_vec(),
                }))
            }
            _ => Err(Error::Open { edge: ends }),
        }
    }

    /// Counts vertices, one for each fan, edges and connected surfaces.
    fn counts(&self, fans: &Fans) -> Counts {
        let mut sets = DisjointSets::of_one(self.triangles.len());
        for (half, mate) in self.mates.iter().enumerate() {
            sets.join(as_number(half / 3), as_number(mate / 3));
        }
        Counts {
            vertices: fans.count,
            edges: self.mates.len() / 2,
            open_edges: 0,
            surfaces: (0..sets.end()).filter(|t| sets.least(*t) == *t).count(),
        }
    }

    /// Returns the next corner, in the ring of triangles around a vertex, after a given corner.
    fn turn(&self, corner: usize) -> usize {
        self.mates[next(next(corner))]
    }
}

fn origin(triangles: &[[VertexId; 3]], half: usize) -> VertexId {
    triangles[half / 3][half % 3]
}

/// The vertices of a half-edge, the lower number first.
fn ends(triangles: &[[VertexId; 3]], half: usize) -> [VertexId; 2] {
    let (a, b) = (origin(triangles, half), origin(triangles, next(half)));
    [a.min(b), a.max(b)]
}

fn next(half: usize) -> usize {
    if half % 3 == 2 {
        half - 2
    } else {
        half + 1
    }
}

/// The corners of triangles around vertices, grouped into connected fans (rings of triangles).
struct Fans {
    /// For each corner the number of its fan.
    of: Vec<usize>,
    count: usize,
}

impl Fans {
    fn new(surface: &Surface) -> Self {
        let mut fans = Self {
            of: vec![NONE; surface.mates.len()],
            count: 0,
        };
        for corner in 0..fans.of.len() {
            poll();
            if fans.of[corner] == NONE {
                fans.label(surface, corner);
            }
        }
        fans
    }

    /// Gives a new fan number to all corners around the vertex of corner `start` that are reached by
    /// turning.
    fn label(&mut self, surface: &Surface, start: usize) {
        let mut corner = start;
        while self.of[corner] != self.count {
            self.of[corner] = self.count;
            corner = surface.turn(corner);
        }
        self.count += 1;
    }

    /// Exchanges opposite half-edges at an edge until no two copies of the edge have the same two end
    /// vertices.
    ///
    /// Each end of a copy belongs to a fan (ring of triangles around a vertex). An exchange between two
    /// half-edges that share a fan cuts the fan in two. Fans are never joined, so copies that differ stay
    /// different.
    fn tell_apart(&mut self, surface: &mut Surface, forward: &[usize]) {
        for (i, &g) in forward.iter().enumerate() {
            for &h in &forward[i + 1..] {
                if self.of[g] == self.of[h] && self.of[next(g)] == self.of[next(h)] {
                    let (mate_g, mate_h) = (surface.mates[g], surface.mates[h]);
                    surface.pair(g, mate_h);
                    surface.pair(h, mate_g);
                    self.label(surface, h);
                    self.label(surface, next(h));
                }
            }
        }
    }

    /// Gives each fan (ring of triangles around a vertex) its own copy of the vertex; returns the triangles
    /// over these copies.
    fn number(
        &self,
        surface: &Surface,
        vertex_count: u32,
        split_edges: Vec<[VertexId; 2]>,
        counts: Counts,
    ) -> Result<Split, Error> {
        let mut copies: Vec<Option<VertexId>> = vec![None; self.count];
        let mut is_used = vec![false; vertex_count as usize];
        let mut origin: Vec<VertexId> = (0..vertex_count).map(VertexId).collect();
        let mut corners = surface.triangles.to_vec();
        for (corner, &fan) in self.of.iter().enumerate() {
            let vertex = &mut corners[corner / 3][corner % 3];
            let copy = match copies[fan] {
                Some(copy) => copy,
                None if !std::mem::replace(&mut is_used[vertex.index()], true) => *vertex,
                None => {
                    let copy = u32::try_from(origin.len()).map_err(|_| Error::TooMany)?;
                    let copy = VertexId(copy);
                    origin.push(*vertex);
                    copy
                }
            };
            copies[fan] = Some(copy);
            *vertex = copy;
        }
        let mut split_vertices = origin[vertex_count as usize..].to_vec();
        split_vertices.sort_unstable();
        split_vertices.dedup();
        Ok(Split {
            corners,
            origin,
            split_edges,
            split_vertices,
            counts,
        })
    }
}
