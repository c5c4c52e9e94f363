//! Crossings and overlaps of the triangles of a mesh in doubles, exactly.
//!
//! Surfaces may touch: points and edges that two parts of a mesh share are no crossings, whether or
//! not they are vertices and edges of both.

use rustc_hash::FxHashMap as HashMap;

use super::company::{in_company, Faces};
use super::terrains::terrains;
use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::doubles::meeting::{
    folds_over, has_no_area, interleave, meeting, passes, Meeting,
};
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;
use crate::merge::pairs::{pairs_of_many, Boxed, Swept};
use crate::mesh::handle::VertexId;
use crate::mesh::topology::NONE;

/// The faults that keep a mesh from being embedded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Pairs of triangles that cross or overlap, the lower first, in ascending order.
    pub crossings: Vec<[u32; 2]>,
    /// Triangles without area, ascending. They lie in their neighbours' edges and cross nothing.
    pub flat: Vec<u32>,
}

impl Faults {
    /// Return whether there are none.
    pub fn is_empty(&self) -> bool {
        self.crossings.is_empty() && self.flat.is_empty()
    }

    /// Return the number of faults.
    pub fn count(&self) -> usize {
        self.crossings.len() + self.flat.len()
    }
}

/// The faults of some triangles, ascending, among themselves and with all others, and those of
/// other triangles of different parties.
///
/// Others of one party, such as the faces of one input that are as they came, are not compared with
/// each other.
pub fn faults(faces: &Faces, some: &[u32], party: impl Fn(u32) -> u32) -> Faults {
    let has_area = |t: u32| !has_no_area(&faces.corners(t));
    let mut elements = in_company(faces, some, &party);
    elements.retain(|(_, t)| has_area(*t));
    let next = elements.last().map_or(0, |other| other.0 + 1);
    let (own, flat) = parties(faces, some, next);
    elements.extend(own);
    let mut search = Search {
        faces,
        crossings: Vec::new(),
        doubtful: Vec::new(),
    };
    candidates(faces, &elements, |t, u| search.look_at(t, u));
    search.settle();
    search.crossings.sort_unstable();
    search.crossings.dedup();
    Faults {
        crossings: search.crossings,
        flat,
    }
}

/// Some triangles by parties, from a number on, and those that have no area: each is a party of its
/// own, but for those of one terrain, which do not cross each other.
fn parties(faces: &Faces, some: &[u32], next: u32) -> (Vec<(u32, u32)>, Vec<u32>) {
    let pieces = terrains(faces, some);
    let alone = as_number(some.len());
    let party = |(at, piece): (u32, u32)| next + if piece == NONE { at } else { alone + piece };
    let numbered = (0u32..).zip(pieces).map(party).zip(some.iter().copied());
    let has_area = |e: &(u32, u32)| !has_no_area(&faces.corners(e.1));
    let (mut own, flat): (Vec<_>, Vec<_>) = numbered.partition(has_area);
    own.sort_unstable();
    (own, flat.into_iter().map(|e| e.1).collect())
}

/// The faults of a mesh.
pub fn all_faults(faces: &Faces) -> Faults {
    let all: Vec<u32> = (0..as_number(faces.triangles.len())).collect();
    faults(faces, &all, |_| 0)
}

/// For directed edges the third corner of the triangle there, if there is one.
type Apexes = HashMap<[VertexId; 2], Option<VertexId>>;

/// A search for crossings.
struct Search<'a> {
    faces: &'a Faces<'a>,
    crossings: Vec<[u32; 2]>,
    /// Pairs that meet along edges: whether surfaces cross there depends on neighbours.
    doubtful: Vec<([u32; 2], Meeting)>,
}

impl Search<'_> {
    fn look_at(&mut self, t: u32, u: u32) {
        poll();
        let pair = [t.min(u), t.max(u)];
        let (p, q) = (self.faces.corners(pair[0]), self.faces.corners(pair[1]));
        if let Some(edge) = self.common_edge(pair) {
            if folds_over(&p, &q, edge) {
                self.crossings.push(pair);
            }
            return;
        }
        match meeting(&p, &q) {
            Meeting::Clear => {}
            Meeting::Crossing | Meeting::Overlap => self.crossings.push(pair),
            meeting => self.doubtful.push((pair, meeting)),
        }
    }

    /// The edge of the second triangle of a pair at which the two are mates, by its number.
    fn common_edge(&self, [t, u]: [u32; 2]) -> Option<usize> {
        let [a, b, c] = self.faces.triangles[t as usize];
        let [d, e, f] = self.faces.triangles[u as usize];
        let own = |from: VertexId, to: VertexId| {
            from == a && to == b || from == b && to == c || from == c && to == a
        };
        if own(e, d) {
            Some(0)
        } else if own(f, e) {
            Some(1)
        } else {
            own(d, f).then_some(2)
        }
    }

    fn ends(&self, triangle: u32, edge: usize) -> [VertexId; 2] {
        let corners = &self.faces.triangles[triangle as usize];
        [corners[edge], corners[(edge + 1) % 3]]
    }

    /// Decides about the doubtful pairs, by the neighbours across the edges at which they meet.
    fn settle(&mut self) {
        let doubtful = std::mem::take(&mut self.doubtful);
        let edges = |(pair, meeting): &([u32; 2], Meeting)| match *meeting {
            Meeting::FirstEdge(i) => vec![self.ends(pair[0], i)],
            Meeting::SecondEdge(j) => vec![self.ends(pair[1], j)],
            Meeting::Edges(i, j) => vec![self.ends(pair[0], i), self.ends(pair[1], j)],
            _ => Vec::new(),
        };
        let wanted = doubtful.iter().flat_map(edges).map(|[a, b]| [b, a]);
        let apexes = self.apexes(wanted.map(|e| (e, None)).collect());
        for (pair, meeting) in doubtful {
            let mate = |which: usize, edge: usize| {
                let [a, b] = self.ends(pair[which], edge);
                let apex = apexes.get(&[b, a]).copied().flatten()?;
                Some(self.faces.vertices[apex.place()])
            };
            let corners = pair.map(|t| self.faces.corners(t));
            if crosses_at(meeting, &corners, mate) {
                self.crossings.push(pair);
            }
        }
    }

    /// The apexes of the triangles at some directed edges.
    fn apexes(&self, mut at: Apexes) -> Apexes {
        if at.is_empty() {
            return at;
        }
        let mut is_end = vec![false; self.faces.vertices.len()];
        for v in at.keys().flatten() {
            is_end[v.place()] = true;
        }
        for &[a, b, c] in self.faces.triangles {
            for [from, to, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
                if is_end[from.place()]
                    && is_end[to.place()]
                    && let Some(found) = at.get_mut(&[from, to])
                {
                    *found = Some(apex);
                }
            }
        }
        at
    }
}

/// Return whether surfaces cross where two triangles meet like this; `mate` gives the apex of the
/// triangle across an edge of the first or the second. What has no neighbour crosses what it lies
/// in.
pub fn crosses_at(
    meeting: Meeting,
    [p, q]: &[Triangle; 2],
    mate: impl Fn(usize, usize) -> Option<Point>,
) -> bool {
    let apex = |t: &Triangle, edge: usize| t[(edge + 2) % 3];
    let crossing = match meeting {
        Meeting::Clear => Some(false),
        Meeting::Crossing | Meeting::Overlap => Some(true),
        Meeting::FirstEdge(i) => mate(0, i).map(|m| passes(q, [&apex(p, i), &m])),
        Meeting::SecondEdge(j) => mate(1, j).map(|m| passes(p, [&apex(q, j), &m])),
        Meeting::Edges(i, j) => mate(0, i).zip(mate(1, j)).map(|(m, n)| {
            let axis = [&p[i], &p[(i + 1) % 3]];
            interleave(axis, [&apex(p, i), &m], [&apex(q, j), &n])
        }),
    };
    crossing.unwrap_or(true)
}

/// Calls `meet` for the pairs of different parties that may meet; triangles come by party.
fn candidates(faces: &Faces, all: &[(u32, u32)], mut meet: impl FnMut(u32, u32)) {
    let corners = |k: u32| faces.corners(all[k as usize].1);
    let numbers = 0..as_number(all.len());
    let extents: Vec<Extent> = numbers.clone().map(|k| Extent::of(&corners(k))).collect();
    let Some(whole) = extents.iter().copied().reduce(|a, b| a.joined(&b)) else {
        return;
    };
    let scale = Scale::of(&whole);
    let party = |k: u32| all[k as usize].0 as usize;
    let boxed = |k: u32| {
        let (low, high) = scale.ends(&extents[k as usize]);
        Boxed::new(party(k), k, [&low, &high], Scale::BITS - 30)
    };
    let swept = |k: u32| {
        let [a, b, c] = corners(k);
        let (low, high) = scale.ends(&extents[k as usize]);
        Swept {
            operand: party(k),
            low,
            high,
            corners: Some([scale.image(&a), scale.image(&b), scale.image(&c)]),
        }
    };
    pairs_of_many(numbers.map(boxed).collect(), swept, |i, j| {
        meet(all[i as usize].1, all[j as usize].1);
    });
}

/// The image of a box on integers; monotone, so that boxes that overlap do so there.
struct Scale {
    low: Point,
    factor: f64,
}

impl Scale {
    /// Of the images' coordinates.
    const BITS: u32 = 40;

    fn of(all: &Extent) -> Self {
        let size = (0..3).fold(0.0f64, |m, i| m.max(all.high[i] - all.low[i]));
        let factor = as_double(1u64 << Self::BITS) / size;
        Self {
            low: all.low,
            // A mesh in one place, or too small to be told apart, has one image.
            factor: if factor.is_finite() { factor } else { 0.0 },
        }
    }

    fn image(&self, p: &Point) -> Point {
        each_axis(|i| (p[i] - self.low[i]) * self.factor)
    }

    fn ends(&self, extent: &Extent) -> (Lattice, Lattice) {
        let whole = |p: &Point| {
            let image = self.image(p);
            each_axis(|i| as_whole(image[i]))
        };
        (whole(&extent.low), whole(&extent.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    /// The faults of two tetrahedra, the second moved up.
    fn faults_of_two(up: f64) -> Faults {
        let places = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 4.0]];
        let above = places.map(|[x, y, z]| [x + 0.25, y + 0.25, z + up]);
        let second = TETRAHEDRON.map(|t| t.map(|v| v + 4));
        let faces = Faces {
            vertices: &[places, above].concat(),
            triangles: &VertexId::rows([TETRAHEDRON, second].concat()),
        };
        all_faults(&faces)
    }

    #[test]
    fn pairs_that_cross_are_found_and_neighbours_are_not() {
        let found = faults_of_two(2.0);
        assert!(found.flat.is_empty() && !found.crossings.is_empty());
        assert!(found.crossings.iter().all(|[t, u]| *t < 4 && *u >= 4));
        assert!(faults_of_two(9.0).is_empty());
    }

    #[test]
    fn triangles_without_area_are_faults_of_their_own() {
        let vertices = [[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let faces = Faces {
            vertices: &vertices,
            triangles: &VertexId::rows([[0, 1, 2], [2, 1, 0]]),
        };
        assert_eq!(all_faults(&faces).flat, [0, 1]);
    }
}
