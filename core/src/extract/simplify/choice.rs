//! Lists the possible changes of a round, and chooses independent ones.

use super::edit::{Act, Edit, Limits, MAX_TRIANGLES_PER_VERTEX};
use super::sizes::{height, lengths};
use super::surface::Surface;
use crate::arith::convert::as_number;
use crate::interrupt::poll;
use crate::mesh::faces::edges;
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::each_chunk;

/// A change to try, after the length of its edge or the height of its sliver.
type Wanted = (f64, Act);

impl Surface<'_> {
    /// Lists the changes at triangles with an awake vertex: collapses before flips, the smallest first.
    pub fn acts(&self, awake: &[bool], tolerance: f64) -> Vec<Act> {
        let of = |first: usize, triangles: &[[VertexId; 3]]| {
            let some = (as_number(first)..).zip(triangles);
            let near = some.filter(|(_, t)| t.iter().any(|v| awake[v.index()]));
            let all = near.flat_map(|(t, _)| self.acts_at(t, tolerance));
            all.collect::<Vec<Wanted>>()
        };
        let mut all = each_chunk(self.triangles, of).concat();
        all.sort_unstable_by(|a, b| {
            let kinds = is_flip(&a.1).cmp(&is_flip(&b.1));
            kinds.then(a.0.total_cmp(&b.0)).then(a.1.cmp(&b.1))
        });
        all.dedup();
        all.into_iter().map(|(_, act)| act).collect()
    }

    /// Returns a collapse of each short edge of a triangle, and a flip of its longest edge if it is a
    /// sliver.
    fn acts_at(&self, t: u32, tolerance: f64) -> Vec<Wanted> {
        let corners = self.corners(t);
        let lengths = lengths(&corners);
        let edges = edges(self.triangles[t as usize]);
        let short = (0..3).filter(|i| lengths[*i] <= tolerance);
        let mut all: Vec<Wanted> = short
            .map(|i| {
                let [a, b] = edges[i];
                (lengths[i], Act::Collapse([a.min(b), a.max(b)]))
            })
            .collect();
        let height = height(&corners);
        if height <= tolerance && lengths.iter().any(|l| *l > tolerance) {
            let longest = (1..3).fold(0, |m, i| if lengths[i] > lengths[m] { i } else { m });
            all.extend(self.flip_of(edges[longest]).map(|act| (height, act)));
        }
        all
    }

    fn flip_of(&self, [a, b]: [VertexId; 2]) -> Option<Act> {
        let apex = |from: VertexId, to: VertexId| {
            let corners = &self.triangles[self.left_of(from, to)? as usize];
            corners.iter().copied().find(|v| *v != from && *v != to)
        };
        Some(Act::Flip([a, b, apex(a, b)?, apex(b, a)?]))
    }
}

/// The independent changes chosen for a round, and those that wait.
pub struct Chosen {
    /// Changes that are independent of each other.
    pub edits: Vec<Edit>,
    /// Changes that may be possible after the chosen ones.
    pub waiting: Vec<Act>,
}

/// Chooses independent changes greedily, in the order of `wanted`.
///
/// Flips, which come last, wait until no edge can be collapsed, because collapses use less of the tolerance.
pub fn chosen(limits: &Limits, wanted: &[Act], is_refused: impl Fn(&Act) -> bool) -> Chosen {
    let mut locks = vec![Lock::default(); limits.surface.vertices.len()];
    let mut chosen = Chosen {
        edits: Vec::new(),
        waiting: Vec::new(),
    };
    let flips = wanted.partition_point(|act| !is_flip(act));
    for (k, act) in wanted.iter().enumerate() {
        poll();
        let is_early = k >= flips && chosen.has_collapse();
        if is_early || is_locked(limits.surface, &locks, act) {
            chosen.waiting.push(*act);
        } else if let Some(edit) = limits.edit(*act, &is_refused) {
            lock(limits.surface, &mut locks, &edit.act);
            chosen.edits.push(edit);
        }
    }
    chosen
}

impl Chosen {
    fn has_collapse(&self) -> bool {
        self.edits.first().is_some_and(|edit| !is_flip(&edit.act))
    }
}

fn is_flip(act: &Act) -> bool {
    matches!(act, Act::Flip(_))
}

/// What chosen changes do at a vertex.
#[derive(Clone, Copy, Default)]
struct Lock {
    /// The vertex is an end of a collapsed edge.
    ends: bool,
    /// The vertex is a neighbour of a removed vertex.
    beside: bool,
    /// The vertex is a corner of a triangle whose edge is flipped.
    turns: bool,
}

/// Returns true if a change must wait, because a chosen change alters what it reads.
///
/// A collapse reads the neighbours of both ends, and the triangles around the removed end. A flip reads its
/// two triangles, whether their apexes are joined, and the drift at its corners.
fn is_locked(surface: &Surface, locks: &[Lock], act: &Act) -> bool {
    let at = |v: &VertexId| locks[v.index()];
    match act {
        Act::Collapse(ends) => {
            let taken = |v: &VertexId| at(v).ends || at(v).beside || at(v).turns;
            let may_go = ends
                .iter()
                .filter(|v| surface.star(**v).len() <= MAX_TRIANGLES_PER_VERTEX);
            ends.iter().any(taken)
                || may_go
                    .flat_map(|v| surface.neighbours(*v))
                    .any(|v| at(&v).ends)
        }
        Act::Flip(corners) => {
            corners.iter().any(|v| at(v).ends) || corners[..3].iter().any(|v| at(v).turns)
        }
    }
}

fn lock(surface: &Surface, locks: &mut [Lock], act: &Act) {
    match act {
        Act::Collapse(ends) => {
            for v in ends {
                locks[v.index()].ends = true;
            }
            for v in surface.neighbours(ends[0]) {
                locks[v.index()].beside = true;
            }
        }
        Act::Flip(corners) => {
            for v in corners {
                locks[v.index()].turns = true;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drift::Drift;
    use super::*;

    /// The vertices of a tetrahedron, and a vertex on one of its edges, close to the edge's end.
    const PLACES: [[f64; 3]; 5] = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.001, 0.0, 0.0],
    ];
    const FACES: [[u32; 3]; 6] = [
        [0, 2, 4],
        [4, 2, 1],
        [0, 4, 3],
        [4, 1, 3],
        [0, 3, 2],
        [1, 2, 3],
    ];

    #[test]
    fn a_short_edge_is_collapsed_first_and_only_where_vertices_are_awake() {
        let faces = VertexId::rows(FACES);
        let surface = Surface::of(&PLACES, &faces);
        let acts = surface.acts(&[true; 5], 0.01);
        assert_eq!(acts[0], Act::Collapse([0, 4].map(VertexId)));
        assert!(surface.acts(&[false; 5], 0.01).is_empty());
    }

    #[test]
    fn what_was_refused_is_not_chosen_again() {
        let faces = VertexId::rows(FACES);
        let surface = Surface::of(&PLACES, &faces);
        let limits = Limits {
            surface: &surface,
            drift: &Drift::new(&PLACES),
            tolerance: 0.01,
        };
        let wanted = [Act::Collapse([0, 4].map(VertexId))];
        assert_eq!(chosen(&limits, &wanted, |_| false).edits.len(), 1);
        assert!(chosen(&limits, &wanted, |_| true).edits.is_empty());
    }
}
