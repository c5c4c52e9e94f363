//! Decides whether surfaces cross at edges along which triangles meet.

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use crate::geometry::doubles::meeting::Meeting;
use crate::geometry::doubles::sheets::{surface_crosses_plane, surfaces_cross, Sheet, Sheets};
use crate::geometry::doubles::Triangle;
use crate::mesh::faces::{edges, Faces};
use crate::mesh::handle::VertexId;

/// Returns true if surfaces cross where two triangles meet. `sheets(i, k)` gives the triangles (sheets) at
/// edge k of the first (i = 0) or second (i = 1) triangle. A surface that ends at an edge inside a triangle
/// counts as crossing it.
pub fn crosses_at(
    meeting: Meeting,
    [p, q]: &[Triangle; 2],
    sheets: impl Fn(usize, usize) -> Sheets,
) -> bool {
    match meeting {
        Meeting::Clear => false,
        Meeting::Crossing | Meeting::Overlap => true,
        Meeting::FirstEdge(i) => surface_crosses_plane(q, &sheets(0, i)),
        Meeting::SecondEdge(j) => surface_crosses_plane(p, &sheets(1, j)),
        Meeting::Edges(i, j) => {
            surfaces_cross([&p[i], &p[(i + 1) % 3]], [&sheets(0, i), &sheets(1, j)])
        }
    }
}

/// Returns the pairs of triangles that meet along edges at which surfaces cross.
///
/// # Cost
/// A pass over the triangles; the triangles around an edge are sorted once for each triangle or edge that
/// this edge meets.
pub fn crossing(faces: &Faces, mut pairs: Vec<([u32; 2], Meeting)>) -> Vec<[u32; 2]> {
    let there = AtEdges::of(faces, &pairs);
    let mut known = HashMap::default();
    pairs.retain(|(pair, meeting)| {
        let place = Place::of(faces, *pair, *meeting);
        *known
            .entry(place)
            .or_insert_with(|| there.cross_at(*pair, *meeting))
    });
    pairs.into_iter().map(|(pair, _)| pair).collect()
}

/// An edge by its two vertices, the lower number first.
type Edge = [VertexId; 2];

fn edge_of(faces: &Faces, triangle: u32, edge: usize) -> Edge {
    sorted(edges(faces.triangles[triangle as usize])[edge])
}

fn sorted([a, b]: Edge) -> Edge {
    [a.min(b), a.max(b)]
}

/// Returns the edges at which two triangles meet, none if they do not meet at an edge.
fn edges_at(faces: &Faces, [t, u]: [u32; 2], meeting: Meeting) -> SmallVec<[Edge; 2]> {
    let of = |triangle, edge| edge_of(faces, triangle, edge);
    match meeting {
        Meeting::FirstEdge(i) => [of(t, i)].into_iter().collect(),
        Meeting::SecondEdge(j) => [of(u, j)].into_iter().collect(),
        Meeting::Edges(i, j) => [of(t, i), of(u, j)].into_iter().collect(),
        Meeting::Clear | Meeting::Crossing | Meeting::Overlap => SmallVec::new(),
    }
}

/// A key for the location at which two triangles meet: two edges that meet, or an edge and the triangle that
/// it meets.
#[derive(PartialEq, Eq, Hash)]
struct Place {
    edges: SmallVec<[Edge; 2]>,
    triangle: Option<u32>,
}

impl Place {
    fn of(faces: &Faces, pair: [u32; 2], meeting: Meeting) -> Self {
        let mut edges = edges_at(faces, pair, meeting);
        edges.sort_unstable();
        let triangle = match meeting {
            Meeting::FirstEdge(_) => Some(pair[1]),
            Meeting::SecondEdge(_) => Some(pair[0]),
            _ => None,
        };
        Self { edges, triangle }
    }
}

/// The sheets (triangles at an edge, by their apexes) at each edge where triangles meet.
struct AtEdges<'a> {
    faces: &'a Faces<'a>,
    sheets: HashMap<Edge, Sheets>,
}

impl<'a> AtEdges<'a> {
    fn of(faces: &'a Faces, pairs: &[([u32; 2], Meeting)]) -> Self {
        let wanted = pairs
            .iter()
            .flat_map(|(pair, met)| edges_at(faces, *pair, *met));
        let sheets = wanted.map(|e| (e, Sheets::new())).collect();
        let mut there = Self { faces, sheets };
        if !there.sheets.is_empty() {
            there.collect();
        }
        there
    }

    /// Finds all triangles at the edges that are keys of `sheets`, and records them there.
    fn collect(&mut self) {
        let mut is_end = vec![false; self.faces.vertices.len()];
        for v in self.sheets.keys().flatten() {
            is_end[v.index()] = true;
        }
        for &triangle in self.faces.triangles {
            for (k, [a, b]) in edges(triangle).into_iter().enumerate() {
                if is_end[a.index()]
                    && is_end[b.index()]
                    && let Some(found) = self.sheets.get_mut(&sorted([a, b]))
                {
                    let apex = self.faces.vertices[triangle[(k + 2) % 3].index()];
                    let is_along = a < b;
                    found.push(Sheet { apex, is_along });
                }
            }
        }
    }

    fn cross_at(&self, pair: [u32; 2], meeting: Meeting) -> bool {
        let sheets = |which: usize, edge: usize| {
            let edge = edge_of(self.faces, pair[which], edge);
            self.sheets.get(&edge).cloned().unwrap_or_default()
        };
        crosses_at(meeting, &pair.map(|t| self.faces.corners(t)), sheets)
    }
}
