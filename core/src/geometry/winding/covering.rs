//! Tests whether directed outlines in the plane wind around each point at most once.
//!
//! The outline of triangles consists of the edges that belong to only one triangle. If all triangles turn
//! left, the number of triangles that cover a point is the winding number of the outline around it. If this
//! number is at most one, no two triangles overlap. The test costs a sweep over the outline instead of a test
//! of all pairs.

use std::cmp::Ordering;

use crate::arith::Sign;
use crate::geometry::doubles::turn;
use crate::interrupt::poll;

/// A point of the plane in finite doubles.
pub type PlanarPoint = [f64; 2];

/// A directed edge with its ends sorted in the order in which a sweep to the right meets them: by x, then by
/// y.
#[derive(Clone, Copy, Debug)]
struct SweptEdge {
    left: PlanarPoint,
    right: PlanarPoint,
    /// True if the edge runs from `left` to `right`: the winding number is then one more above the edge than
    /// below.
    forward: bool,
}

/// Return whether closed outlines wind around each point of the plane once or not at all.
///
/// May return false negatives, where outlines touch at points other than common ends of edges.
///
/// # Source
/// Shamos, Hoey 1976, "Geometric intersection problems": a sweep that ends at the first crossing.
///
/// # Cost
/// n log n comparisons for n edges; inserting an edge also shifts the indices of all edges above it.
///
/// # Example
/// ```
/// use bspcsg::geometry::winding::covering::winds_at_most_once;
///
/// let around = |p: [[f64; 2]; 3]| [[p[0], p[1]], [p[1], p[2]], [p[2], p[0]]];
/// let low = around([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
/// let beside = around([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
/// let above = around([[0.2, 0.2], [1.2, 0.2], [0.2, 1.2]]);
/// assert!(winds_at_most_once(&low));
/// assert!(!winds_at_most_once(&[low, above].concat()));
/// // The edges in between run both ways, and overlap: leave them out.
/// assert!(!winds_at_most_once(&[low, beside].concat()));
/// assert!(winds_at_most_once(&[low[0], low[2], beside[0], beside[1]]));
/// ```
pub fn winds_at_most_once(edges: &[[PlanarPoint; 2]]) -> bool {
    let edges: Vec<SweptEdge> = edges.iter().map(SweptEdge::of).collect();
    let mut starts: Vec<u32> = (0u32..).zip(&edges).map(|(k, _)| k).collect();
    starts.sort_unstable_by(|a, b| {
        let [a, b] = [a, b].map(|k| &edges[*k as usize]);
        compare(&a.left, &b.left)
    });
    let mut stops: Vec<PlanarPoint> = edges.iter().flat_map(|e| [e.left, e.right]).collect();
    stops.sort_unstable_by(compare);
    stops.dedup_by(|a, b| is_same(a, b));
    let mut sweep = Sweep {
        edges: &edges,
        starts: &starts,
        above: Vec::new(),
    };
    stops.iter().all(|stop| sweep.advance_to(stop))
}

impl SweptEdge {
    fn of([from, to]: &[PlanarPoint; 2]) -> Self {
        let forward = compare(from, to) == Ordering::Less;
        let (left, right) = if forward { (*from, *to) } else { (*to, *from) };
        Self {
            left,
            right,
            forward,
        }
    }

    /// The side of the edge on which a point lies: positive above, zero on its line.
    fn turn_to(&self, p: &PlanarPoint) -> Sign {
        turn([self.left, self.right, *p])
    }
}

/// The state of a sweep to the right over edges.
struct Sweep<'a> {
    edges: &'a [SweptEdge],
    /// The edges that the sweep has not reached yet, sorted by their left ends.
    starts: &'a [u32],
    /// The edges that cross the sweep line, in order from bottom to top.
    above: Vec<u32>,
}

impl Sweep<'_> {
    fn edge(&self, number: u32) -> &SweptEdge {
        &self.edges[number as usize]
    }

    /// Advances the sweep to a vertex (stop); returns true if the outlines are found to wind at most once
    /// around points there and up to the next stop.
    fn advance_to(&mut self, stop: &PlanarPoint) -> bool {
        poll();
        let first = self
            .above
            .partition_point(|k| self.edge(*k).turn_to(stop) == Sign::Positive);
        let through = self.above[first..].iter();
        let count = through
            .take_while(|k| self.edge(**k).turn_to(stop) == Sign::Zero)
            .count();
        let ending = &self.above[first..first + count];
        if ending.iter().any(|k| !is_same(&self.edge(*k).right, stop)) {
            return false;
        }
        let beginning = self.beginning_at(stop);
        let mut beginning = beginning.to_vec();
        beginning.sort_unstable_by(|a, b| self.order(*a, *b));
        let is_apart = |w: &[u32]| self.order(w[0], w[1]) == Ordering::Less;
        if !beginning.windows(2).all(is_apart) {
            return false;
        }
        let after = first + beginning.len();
        self.above.splice(first..first + count, beginning);
        self.takes_turns(first, after, count) && self.stays_apart(first, after)
    }

    /// Removes and returns the edges whose left end is the vertex `stop`; all edges with earlier left ends
    /// must be removed already.
    fn beginning_at(&mut self, stop: &PlanarPoint) -> &[u32] {
        let begins = |k: &u32| is_same(&self.edges[*k as usize].left, stop);
        let count = self.starts.iter().take_while(|k| begins(k)).count();
        let (beginning, later) = self.starts.split_at(count);
        self.starts = later;
        beginning
    }

    /// The upward order of two edges with the same left end; equal if they overlap.
    fn order(&self, a: u32, b: u32) -> Ordering {
        let turn = self.edge(a).turn_to(&self.edge(b).right);
        turn.order().reverse()
    }

    /// Return whether, from bottom to top, the edges at the indices `first` to `after` enter and leave the
    /// inside alternately, and the numbers of edges that end and begin at the stop have an even sum, so that
    /// all edges above alternate, too.
    fn takes_turns(&self, first: usize, after: usize, ended: usize) -> bool {
        let in_turn = |at: usize| self.edge(self.above[at]).forward == at.is_multiple_of(2);
        (ended + after - first).is_multiple_of(2) && (first..after).all(in_turn)
    }

    /// Return whether edges that have become neighbours on the sweep line, on either side of the index
    /// `first` and of the index `after`, do not meet farther right except in a common end.
    fn stays_apart(&self, first: usize, after: usize) -> bool {
        let below = first.checked_sub(1).is_none_or(|k| self.is_below(k));
        below && (first == after || self.is_below(after - 1))
    }

    /// Return whether the edge at an index stays below the next edge of the sweep line; true if there is no
    /// next one.
    fn is_below(&self, at: usize) -> bool {
        let Some(pair) = self.above.get(at..at + 2) else {
            return true;
        };
        let [a, b] = [pair[0], pair[1]].map(|k| self.edge(k));
        match compare(&a.right, &b.right) {
            Ordering::Equal => true,
            Ordering::Less => b.turn_to(&a.right) == Sign::Negative,
            Ordering::Greater => a.turn_to(&b.right) == Sign::Positive,
        }
    }
}

/// The order in which a sweep to the right stops at points: by x, then by y.
fn compare(a: &PlanarPoint, b: &PlanarPoint) -> Ordering {
    let order = |i: usize| a[i].partial_cmp(&b[i]).unwrap_or(Ordering::Equal);
    order(0).then_with(|| order(1))
}

fn is_same(a: &PlanarPoint, b: &PlanarPoint) -> bool {
    compare(a, b) == Ordering::Equal
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn outline(corners: &[[i32; 2]]) -> Vec<[PlanarPoint; 2]> {
        let point = |k: usize| corners[k % corners.len()].map(f64::from);
        (0..corners.len())
            .map(|k| [point(k), point(k + 1)])
            .collect()
    }

    #[test]
    fn a_ring_winds_once_and_two_rings_in_each_other_do_not() {
        let outer = outline(&[[0, 0], [9, 0], [9, 9], [0, 9]]);
        let hole = outline(&[[3, 3], [3, 6], [6, 6], [6, 3]]);
        let inner = outline(&[[3, 3], [6, 3], [6, 6], [3, 6]]);
        assert!(winds_at_most_once(&[outer.clone(), hole.clone()].concat()));
        assert!(!winds_at_most_once(&[outer.clone(), inner].concat()));
        assert!(!winds_at_most_once(&hole));
        assert!(winds_at_most_once(&outer));
    }

    #[test]
    fn corners_may_touch_and_edges_may_not() {
        let left = outline(&[[0, 0], [4, 0], [4, 4], [0, 4]]);
        let corner = outline(&[[4, 4], [8, 4], [8, 8], [4, 8]]);
        let edge = outline(&[[4, 1], [8, 1], [8, 3], [4, 3]]);
        assert!(winds_at_most_once(&[left.clone(), corner].concat()));
        assert!(!winds_at_most_once(&[left, edge].concat()));
    }

    /// The winding number of edges around a point that lies on none of them.
    fn winding(edges: &[[PlanarPoint; 2]], p: PlanarPoint) -> i32 {
        let crossed = |[a, b]: &[PlanarPoint; 2]| {
            let up = a[1] <= p[1] && p[1] < b[1];
            let down = b[1] <= p[1] && p[1] < a[1];
            let left = turn([*a, *b, p]);
            i32::from(up && left == Sign::Positive) - i32::from(down && left == Sign::Negative)
        };
        edges.iter().map(crossed).sum()
    }

    proptest! {
        /// Wherever the test returns true, the outlines wind around each point of a fine grid at most once.
        #[test]
        fn yes_is_right(corners in prop::collection::vec(prop::array::uniform2(0..6i32), 3..9)) {
            let edges = outline(&corners);
            let edges: Vec<_> = edges.into_iter().filter(|e| !is_same(&e[0], &e[1])).collect();
            if winds_at_most_once(&edges) {
                for k in 0..70 * 70 {
                    let p = [k / 70, k % 70].map(|i| f64::from(i) / 11.0 - 0.2037);
                    let number = winding(&edges, p);
                    prop_assert!(number == 0 || number == 1, "{number} around {p:?}");
                }
            }
        }

        /// A star-shaped outline winds once around its centre; the order of its edges must not matter.
        #[test]
        fn stars_wind_once(radii in prop::collection::vec(1..40i32, 3..40), turned in 0..9i32) {
            let count = f64::from(u32::try_from(radii.len()).unwrap());
            let edges: Vec<[PlanarPoint; 2]> = {
                let point = |k: usize| {
                    let turns = f64::from(u32::try_from(k % radii.len()).unwrap()) / count;
                    let angle = std::f64::consts::TAU * turns + f64::from(turned);
                    let radius = f64::from(radii[k % radii.len()]);
                    [radius * angle.cos(), radius * angle.sin()]
                };
                (0..radii.len()).map(|k| [point(k), point(k + 1)]).collect()
            };
            prop_assert!(winds_at_most_once(&edges));
            let back: Vec<_> = edges.iter().map(|[a, b]| [*b, *a]).collect();
            prop_assert!(!winds_at_most_once(&back));
        }
    }
}
