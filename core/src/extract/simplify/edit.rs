//! Changes that remove a short edge or a sliver, and whether they are allowed.

use super::drift::{Arrival, Drift};
use super::sizes::{height, rounding_of, swept};
use super::surface::{place_of, Surface};
use crate::geometry::doubles::vector::{difference, dot, normal};
use crate::geometry::doubles::{is_flat, Triangle};
use crate::mesh::handle::VertexId;

/// A vertex with more triangles is not moved: checking each edge there costs a pass over all of them.
pub const MAX_TRIANGLES_PER_VERTEX: usize = 64;

/// Triangles lower than this share of the tolerance are not made, unless one was as low before: further
/// collapses would not remove them.
const MIN_HEIGHT_SHARE: f64 = 0.25;

/// A change to try, given by vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Act {
    /// The edge between two vertices is shrunk to one of its ends.
    Collapse([VertexId; 2]),
    /// An edge a → b with the triangles a b c and b a d becomes the edge c d.
    Flip([VertexId; 4]),
}

/// A change that is allowed: the surface stays closed and near, with one fan at each vertex.
#[derive(Clone, Debug)]
pub struct Edit {
    /// The change.
    pub act: Act,
    /// The changed triangles with their new corners; a triangle that vanishes has one corner three times.
    pub changes: Vec<(u32, [VertexId; 3])>,
    /// The vertex to which points of the old surface are moved.
    pub target: VertexId,
    /// The points that are moved to the target.
    pub arrival: Arrival,
    /// The bound on the drift at the target after the change.
    pub bound: f64,
    /// Six times the volume between the surface before and after the change.
    swept: f64,
}

impl Act {
    /// Yields the vertices that the change names.
    pub fn corners(&self) -> impl Iterator<Item = VertexId> + '_ {
        match self {
            Self::Collapse(ends) => ends.iter().copied(),
            Self::Flip(corners) => corners.iter().copied(),
        }
    }
}

impl Edit {
    /// Yields the corners of the changed triangles that do not vanish.
    pub fn corners(&self) -> impl Iterator<Item = VertexId> + '_ {
        let left = self.changes.iter().map(|c| c.1).filter(|c| c[0] != c[1]);
        left.flatten()
    }

    /// The vertex that the change removes; `None` for a flip.
    pub fn going(&self) -> Option<VertexId> {
        match self.act {
            Act::Collapse([from, _]) => Some(from),
            Act::Flip(_) => None,
        }
    }

    /// Returns the tetrahedra between the surface before and after the change.
    pub fn bodies(&self) -> Vec<[VertexId; 4]> {
        let left = self.changes.iter().map(|c| c.1).filter(|c| c[0] != c[1]);
        match self.act {
            Act::Collapse([from, _]) => left.map(|[p, q, r]| [from, p, q, r]).collect(),
            Act::Flip(corners) => vec![corners],
        }
    }
}

/// A surface, its drift, and the tolerance that changes must respect.
pub struct Limits<'a> {
    /// The surface before the change.
    pub surface: &'a Surface<'a>,
    /// How far each vertex's old points were moved already.
    pub drift: &'a Drift,
    /// The largest drift allowed.
    pub tolerance: f64,
}

impl Limits<'_> {
    /// Returns the edit for a change; `None` if it is not allowed. Of the two ends of a collapse the one
    /// with the smaller volume change is taken.
    pub fn edit(&self, act: Act, is_refused: impl Fn(&Act) -> bool) -> Option<Edit> {
        match act {
            Act::Collapse([a, b]) => {
                let ways = [[a, b], [b, a]].map(Act::Collapse);
                let open = ways.into_iter().filter(|way| !is_refused(way));
                let edits = open.filter_map(|way| self.collapse(way));
                let cost = |e: &Edit| (e.swept, e.bound);
                edits.reduce(|e, f| if cost(&f) < cost(&e) { f } else { e })
            }
            Act::Flip(corners) => self.flip(corners),
        }
    }

    /// Moves the first vertex of a collapse to the second; `None` if that is not allowed.
    fn collapse(&self, act: Act) -> Option<Edit> {
        let Act::Collapse([from, to]) = act else {
            return None;
        };
        let star = self.surface.star(from);
        if star.len() > MAX_TRIANGLES_PER_VERTEX || !self.may_be_joined(from, to) {
            return None;
        }
        let (place, arrival) = (self.surface.place(to), Arrival::Vertex(from));
        let mut edit = Edit {
            act,
            changes: Vec::new(),
            target: to,
            arrival,
            bound: self.drift.with((to, place), arrival, self.tolerance)?,
            swept: 0.0,
        };
        let mut least = f64::INFINITY;
        for &t in star {
            least = least.min(self.change(&mut edit, t, [from, to])?);
        }
        let lowest = |m: f64, t: &u32| m.min(height(&self.surface.corners(*t)));
        let before = star.iter().fold(MIN_HEIGHT_SHARE * self.tolerance, lowest);
        (least >= before).then_some(edit)
    }

    /// Adds the new corners of a triangle to an edit; returns its new height, `None` if it is not allowed.
    fn change(&self, edit: &mut Edit, t: u32, [from, to]: [VertexId; 2]) -> Option<f64> {
        let old = self.surface.triangles[t as usize];
        if old.contains(&to) {
            edit.changes.push((t, [to; 3]));
            return Some(f64::INFINITY);
        }
        let new = old.map(|v| if v == from { to } else { v });
        let (corners, moved) = (self.surface.corners(t), self.surface.places(&new));
        let at = place_of(from, &old);
        let edge = [&corners[(at + 1) % 3], &corners[(at + 2) % 3]];
        edit.swept += swept(&corners[at], &moved[at], edge);
        edit.changes.push((t, new));
        self.is_fit(&corners, &moved).then(|| height(&moved))
    }

    /// Returns whether the link condition is true: the ends of an edge have exactly two neighbours in
    /// common, the third corners of the edge's triangles, and are not those of a tetrahedron.
    fn may_be_joined(&self, from: VertexId, to: VertexId) -> bool {
        let surface = self.surface;
        let others = surface.neighbours(from).filter(|v| *v != to);
        let common = others.filter(|v| surface.are_joined(*v, to)).take(3);
        let is_tetrahedron = surface.star(from).len() == 3 && surface.star(to).len() == 3;
        !is_tetrahedron && common.count() == 2
    }

    /// Returns whether a triangle may become another one: the new one has an area and does not turn over. A
    /// sliver may turn over, because its orientation means little.
    fn is_fit(&self, old: &Triangle, new: &Triangle) -> bool {
        let turns = || dot(&normal(old), &normal(new)) <= 0.0;
        !is_flat(new) && (height(old) <= self.tolerance || !turns())
    }

    /// Replaces an edge by the other diagonal of its two triangles, one of them a sliver; `None` if not
    /// allowed.
    fn flip(&self, [a, b, c, d]: [VertexId; 4]) -> Option<Edit> {
        let surface = self.surface;
        if c == d || surface.are_joined(c, d) {
            return None;
        }
        let (sliver, mate) = (surface.left_of(a, b)?, surface.left_of(b, a)?);
        let arrival = self.beside([a, b, c])?;
        let bound = self
            .drift
            .with((c, surface.place(c)), arrival, self.tolerance)?;
        let (old, made) = (surface.corners(mate), [[a, d, c], [d, b, c]]);
        let new = made.map(|t| surface.places(&t));
        let least = |triangles: [&Triangle; 2]| height(triangles[0]).min(height(triangles[1]));
        let better = least([&new[0], &new[1]]) > least([&surface.corners(sliver), &old]);
        (better && new.iter().all(|t| self.is_fit(&old, t))).then(|| Edit {
            act: Act::Flip([a, b, c, d]),
            changes: vec![(sliver, made[0]), (mate, made[1])],
            target: c,
            arrival,
            bound,
            swept: 0.0,
        })
    }

    /// Returns the point of the edge a → b nearest to c; `None` if it is not strictly between the ends.
    fn beside(&self, [a, b, c]: [VertexId; 3]) -> Option<Arrival> {
        let [p, q, r] = [a, b, c].map(|v| self.surface.place(v));
        let along = difference(q, p);
        let share = dot(&difference(r, p), &along) / dot(&along, &along);
        let place = [0, 1, 2].map(|i| p[i] + share * along[i]);
        let slack = self.drift.at(a).max(self.drift.at(b)) + rounding_of(p, q);
        (share > 0.0 && share < 1.0).then_some(Arrival::Point(place, slack))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The corners of an octahedron in general position: two tips, and a ring of four corners between them.
    pub(in crate::extract::simplify) const PLACES: [[f64; 3]; 6] = [
        [0.9, 0.0, 0.5],
        [0.1, 0.0, -2.0],
        [1.0, 0.0, 0.1],
        [0.0, 1.0, 0.0],
        [-1.0, 0.1, 0.0],
        [0.0, -1.0, -0.1],
    ];

    fn collapse(triangles: &[[u32; 3]], ends: [u32; 2]) -> Option<Edit> {
        let triangles = VertexId::rows(triangles.iter().copied());
        let (surface, ends) = (Surface::of(&PLACES, &triangles), ends.map(VertexId));
        let limits = Limits {
            surface: &surface,
            drift: &Drift::new(&PLACES),
            tolerance: 9.0,
        };
        limits.may_be_joined(ends[0], ends[1]).then_some(())?;
        limits.edit(Act::Collapse(ends), |_| false)
    }

    #[test]
    fn an_octahedron_loses_an_edge() {
        let around = [[2, 3], [3, 4], [4, 5], [5, 2]];
        let triangles = around.map(|[a, b]| [[0, a, b], [1, b, a]]).concat();
        let edit = collapse(&triangles, [0, 2]).expect("the link condition holds");
        assert_eq!(edit.changes.len(), 4);
        assert_eq!(edit.corners().count(), 6);
        assert_eq!(edit.bodies().len(), 2);
    }

    #[test]
    fn a_tetrahedron_stays() {
        let triangles = [[0, 2, 3], [0, 3, 4], [0, 4, 2], [2, 4, 3]];
        assert!(collapse(&triangles, [0, 2]).is_none());
    }

    #[test]
    fn ends_with_a_third_neighbour_in_common_stay_apart() {
        let triangles = [[2, 3], [3, 4], [4, 2]]
            .map(|[a, b]| [[0, a, b], [1, b, a]])
            .concat();
        assert!(collapse(&triangles, [2, 3]).is_none());
        assert!(collapse(&triangles, [0, 2]).is_some());
    }

    #[test]
    fn only_slivers_may_turn() {
        let (surface, drift) = (Surface::of(&PLACES, &[]), Drift::new(&PLACES));
        let is_fit = |tolerance: f64, old: &Triangle, new: &Triangle| {
            let limits = Limits {
                surface: &surface,
                drift: &drift,
                tolerance,
            };
            limits.is_fit(old, new)
        };
        let [a, b, c] = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(is_fit(0.5, &[a, b, c], &[a, b, [0.0, 0.1, 0.0]]));
        assert!(!is_fit(0.5, &[a, b, c], &[a, b, [0.0, -0.1, 0.0]]));
        assert!(is_fit(2.0, &[a, b, c], &[a, b, [0.0, -0.1, 0.0]]));
        assert!(!is_fit(2.0, &[a, b, c], &[a, b, [1.0, 0.0, 0.0]]));
    }
}
