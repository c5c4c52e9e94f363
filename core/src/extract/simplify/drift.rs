//! Bounds the distance between the surface before and after simplifying.
//!
//! There is a map from the old surface onto the new one that is affine on each triangle: a collapse
//! moves the vertex, and with it the triangles around, to the other end of the edge. So each old
//! vertex goes to a new one, and no point moves farther than the farthest corner of its triangle.
//! The map is onto, so the same bound holds from the new surface to the old one.
//!
//! A flip first divides the long edge of a sliver, next to the third corner, and then collapses the new
//! point onto that corner. The new point also becomes a vertex of the old surface. Its position there is
//! known only as well as the ends of the edge are; the uncertainty is its slack.

use super::sizes::distance_above;
use crate::arith::convert::as_number;
use crate::geometry::doubles::Point;
use crate::mesh::handle::VertexId;

/// For each vertex, the points of the old surface that were moved to it, and a bound on their distance.
pub struct Drift {
    witnesses: Vec<Witness>,
    /// For each vertex, a bound on its distance from the old points that were moved to it.
    bounds: Vec<f64>,
}

/// A point of the old surface that was moved to a vertex. The witnesses of one vertex form a ring through
/// `next`, in which the vertex itself has its own number.
struct Witness {
    place: Point,
    /// A bound on the distance of the old point from this position.
    slack: f64,
    next: u32,
}

/// The old points that a change moves to a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Arrival {
    /// All old points that were moved to another vertex before.
    Vertex(VertexId),
    /// A point of an edge, by its position and its slack.
    Point(Point, f64),
}

impl Drift {
    /// Starts with each vertex at its own position.
    pub fn new(vertices: &[Point]) -> Self {
        let alone = |(v, place): (u32, &Point)| Witness {
            place: *place,
            slack: 0.0,
            next: v,
        };
        Self {
            witnesses: (0..).zip(vertices).map(alone).collect(),
            bounds: vec![0.0; vertices.len()],
        }
    }

    /// Returns a bound on the distance of a vertex from the old points that were moved to it.
    pub fn at(&self, v: VertexId) -> f64 {
        self.bounds[v.index()]
    }

    /// Returns the bound at vertex `to` after more points are moved to it; `None` if it exceeds `limit`.
    pub fn with(
        &self,
        (to, place): (VertexId, &Point),
        arrival: Arrival,
        limit: f64,
    ) -> Option<f64> {
        let far = match arrival {
            Arrival::Vertex(v) => self.farthest(v, place, limit)?,
            Arrival::Point(p, slack) => above(distance_above(&p, place), slack),
        };
        (far <= limit).then(|| far.max(self.at(to)))
    }

    /// Returns the largest distance of a point from the old points at vertex `v`; `None` if it exceeds
    /// `limit`.
    fn farthest(&self, v: VertexId, place: &Point, limit: f64) -> Option<f64> {
        let mut farthest = 0.0f64;
        let mut at = v.0;
        loop {
            let witness = &self.witnesses[at as usize];
            farthest = farthest.max(above(distance_above(&witness.place, place), witness.slack));
            at = witness.next;
            if farthest > limit {
                return None;
            }
            if at == v.0 {
                return Some(farthest);
            }
        }
    }

    /// Records that points were moved to a vertex, and the bound after that.
    pub fn follow(&mut self, to: VertexId, arrival: Arrival, bound: f64) {
        let to = to.index();
        let from = match arrival {
            Arrival::Vertex(v) => v.index(),
            Arrival::Point(place, slack) => {
                let next = as_number(self.witnesses.len());
                self.witnesses.push(Witness { place, slack, next });
                next as usize
            }
        };
        let next = self.witnesses[from].next;
        self.witnesses[from].next = std::mem::replace(&mut self.witnesses[to].next, next);
        self.bounds[to] = bound;
    }

    /// Returns a bound on the distance of any point of the old or the new surface from the other surface.
    pub fn bound(&self) -> f64 {
        self.bounds.iter().fold(0.0, |m, b| m.max(*b))
    }
}

/// The sum of two numbers, rounded up; exact if the second is zero.
fn above(x: f64, y: f64) -> f64 {
    if y == 0.0 {
        x
    } else {
        (x + y).next_up()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: [Point; 4] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [3.0, 4.0, 0.0],
    ];

    fn near(found: Option<f64>, expected: f64) -> bool {
        found.is_some_and(|f| f >= expected && f < expected * (1.0 + 1e-14))
    }

    #[test]
    fn the_farthest_that_came_counts() {
        let mut drift = Drift::new(&ROW);
        assert!(near(
            drift.with((VertexId(1), &ROW[1]), Arrival::Vertex(VertexId(0)), 9.0),
            1.0
        ));
        drift.follow(VertexId(1), Arrival::Vertex(VertexId(0)), 1.0);
        // Not the sum of the two distances, 1 + 2, but the distance to the first vertex.
        assert!(near(
            drift.with((VertexId(2), &ROW[2]), Arrival::Vertex(VertexId(1)), 9.0),
            3.0
        ));
        drift.follow(VertexId(2), Arrival::Vertex(VertexId(1)), 3.0);
        assert!(near(
            drift.with((VertexId(3), &ROW[3]), Arrival::Vertex(VertexId(2)), 9.0),
            5.0
        ));
        assert_eq!(
            drift.with((VertexId(3), &ROW[3]), Arrival::Vertex(VertexId(2)), 4.9),
            None
        );
    }

    #[test]
    fn what_came_before_stays() {
        let mut drift = Drift::new(&ROW);
        drift.follow(VertexId(2), Arrival::Vertex(VertexId(3)), 4.0);
        assert!(near(
            drift.with((VertexId(2), &ROW[2]), Arrival::Vertex(VertexId(1)), 9.0),
            4.0
        ));
        drift.follow(VertexId(2), Arrival::Vertex(VertexId(1)), 4.0);
        assert!(drift.bound().to_bits() == 4.0f64.to_bits());
        assert!(near(
            drift.with((VertexId(0), &ROW[0]), Arrival::Vertex(VertexId(2)), 9.0),
            5.0
        ));
    }

    #[test]
    fn points_of_edges_bring_their_slack() {
        let mut drift = Drift::new(&ROW);
        let middle = Arrival::Point([2.0, 0.0, 0.0], 0.5);
        assert!(near(drift.with((VertexId(1), &ROW[1]), middle, 9.0), 1.5));
        drift.follow(VertexId(1), middle, 1.5);
        assert!(near(
            drift.with((VertexId(0), &ROW[0]), Arrival::Vertex(VertexId(1)), 9.0),
            2.5
        ));
    }
}
