//! Triangulation by one sweep over the vertices, in lexicographic order.
//!
//! A vertical line moving right meets the region in intervals. Left of an interval lies a chain of
//! visited vertices, from the start of the interval's lower edge to the start of its upper edge.
//! The part between chain and line is not yet triangulated. No chain vertex is strictly convex seen
//! from there: each new vertex cuts off all such triangles at once.
//!
//! Ties in x are broken by y, as if the line leaned slightly. Corners at one vertex are taken as if
//! the region shrank there: closing ones first, opening ones last.

use std::cmp::Ordering;

use super::order::Order;
use super::outline::Outline;
use super::{Error, Planar};
use crate::arith::Sign;
use crate::interrupt::poll;

const NONE: usize = usize::MAX;

/// The kind of a corner for the sweep, in the order in which corners of one vertex are visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// An interval of the sweep line inside the region ends at the corner.
    End,
    /// The lower edge of an interval ends at the corner, and another one continues it.
    Lower,
    /// The upper edge of an interval ends at the corner, and another one continues it.
    Upper,
    /// Two intervals become one at the corner.
    Merge,
    /// One interval becomes two at the corner.
    Split,
    /// An interval of the sweep line inside the region starts at the corner.
    Start,
}

/// A vertex of an interval's chain, which are the vertices between its two edges that are not yet
/// triangulated; with the nodes below and above it.
struct Node {
    vertex: u32,
    down: usize,
    up: usize,
}

/// An interval of the sweep line inside the region, between two boundary edges, with its chain of vertices.
struct Interval {
    lower: usize,
    upper: usize,
    /// The lowest, the highest and the rightmost node in the interval's chain of vertices that are not yet
    /// triangulated.
    bottom: usize,
    top: usize,
    last: usize,
}

struct Sweep<'a, P> {
    points: &'a P,
    edges: &'a [(u32, u32)],
    nodes: Vec<Node>,
    intervals: Vec<Interval>,
    /// For each edge the interval that it bounds.
    interval_of: Vec<usize>,
    /// The open intervals, from bottom to top.
    order: Order,
    triangles: Vec<[u32; 3]>,
}

/// Triangulates the region left of `edges`, whose vertices are numbered from zero.
pub(super) fn sweep<P: Planar>(points: &P, edges: &[(u32, u32)]) -> Result<Vec<[u32; 3]>, Error> {
    let outline = Outline::new(points, edges)?;
    let kinds = kinds(points, edges, &outline)?;
    let mut sweep = Sweep {
        points,
        edges,
        nodes: Vec::with_capacity(edges.len() + edges.len() / 2),
        intervals: Vec::new(),
        interval_of: vec![NONE; edges.len()],
        order: Order::default(),
        triangles: Vec::with_capacity(edges.len()),
    };
    for corner in visits(points, edges, &kinds) {
        poll();
        let done = sweep.visit(kinds[corner], outline.previous(corner), corner);
        done.ok_or(Error::Crossing {
            vertex: edges[corner].0,
        })?;
    }
    match edges.first() {
        Some(edge) if !sweep.order.is_empty() => Err(Error::Crossing { vertex: edge.0 }),
        _ => Ok(sweep.triangles),
    }
}

fn kinds<P: Planar>(
    points: &P,
    edges: &[(u32, u32)],
    outline: &Outline,
) -> Result<Vec<Kind>, Error> {
    let rightward = |&(a, b): &(u32, u32)| match points.compare(a, b) {
        Ordering::Equal => Err(Error::Overlap { vertex: a }),
        order => Ok(order == Ordering::Less),
    };
    let rightward = edges
        .iter()
        .map(rightward)
        .collect::<Result<Vec<bool>, Error>>()?;
    let kind = |corner: usize| {
        let [a, b, c] = outline.corner(edges, corner);
        match (rightward[outline.previous(corner)], rightward[corner]) {
            (true, true) => Ok(Kind::Lower),
            (false, false) => Ok(Kind::Upper),
            (from_left, _) => match (points.orient(a, b, c), from_left) {
                (Sign::Zero, _) => Err(Error::Overlap { vertex: b }),
                (Sign::Positive, true) => Ok(Kind::End),
                (Sign::Negative, true) => Ok(Kind::Merge),
                (Sign::Positive, false) => Ok(Kind::Start),
                (Sign::Negative, false) => Ok(Kind::Split),
            },
        }
    };
    (0..edges.len()).map(kind).collect()
}

/// Returns the corners, named by the edge that leaves each, in the order of the sweep.
///
/// Sorting by floats first leaves little work for the exact comparison.
fn visits<P: Planar>(points: &P, edges: &[(u32, u32)], kinds: &[Kind]) -> Vec<usize> {
    let mut keyed: Vec<([f64; 2], usize)> = (0..edges.len())
        .map(|e| (points.approx(edges[e].0), e))
        .collect();
    keyed.sort_unstable_by(|(p, a), (q, b)| {
        p[0].total_cmp(&q[0])
            .then(p[1].total_cmp(&q[1]))
            .then(a.cmp(b))
    });
    let mut corners: Vec<usize> = keyed.into_iter().map(|(_, corner)| corner).collect();
    corners.sort_by(|&a, &b| {
        let (u, v) = (edges[a].0, edges[b].0);
        let place = if u == v {
            Ordering::Equal
        } else {
            points.compare(u, v).then(u.cmp(&v))
        };
        place.then_with(|| (kinds[a], a).cmp(&(kinds[b], b)))
    });
    corners
}

/// A step of the sweep returns `None` if the edges do not bound a region.
impl<P: Planar> Sweep<'_, P> {
    fn visit(&mut self, kind: Kind, into: usize, out: usize) -> Option<()> {
        let vertex = self.edges[out].0;
        match kind {
            Kind::Start => self.start(vertex, into, out),
            Kind::Lower => {
                let interval = self.bounded_by(into)?;
                self.extend_bottom(interval, vertex);
                self.set_lower(interval, out);
            }
            Kind::Upper => {
                let interval = self.bounded_by(out)?;
                self.extend_top(interval, vertex);
                self.set_upper(interval, into);
            }
            Kind::End => return self.end(vertex, into, out),
            Kind::Merge => return self.merge(vertex, into, out),
            Kind::Split => return self.split(vertex, into, out),
        }
        Some(())
    }

    fn start(&mut self, vertex: u32, into: usize, out: usize) {
        let node = self.push_node(vertex);
        let head = self.edges[out].1;
        let place = self
            .order
            .search(|interval| self.is_below_ray(interval, vertex, head));
        let interval = self.push_interval(out, into, node, node);
        self.order.insert(place, interval);
    }

    fn end(&mut self, vertex: u32, into: usize, out: usize) -> Option<()> {
        let interval = self.bounded_by(into)?;
        if self.bounded_by(out)? != interval {
            return None;
        }
        let rest = self.cut_up(vertex, self.intervals[interval].bottom);
        (rest == self.intervals[interval].top).then_some(())?;
        self.close(interval, vertex)
    }

    fn merge(&mut self, vertex: u32, into: usize, out: usize) -> Option<()> {
        let (below, above) = (self.bounded_by(out)?, self.bounded_by(into)?);
        if below == above {
            return None;
        }
        self.extend_top(below, vertex);
        self.extend_bottom(above, vertex);
        let node = self.intervals[below].top;
        let next = self.nodes[self.intervals[above].bottom].up;
        self.connect(node, next);
        self.intervals[below].top = self.intervals[above].top;
        self.set_upper(below, self.intervals[above].upper);
        self.close(above, vertex)
    }

    fn split(&mut self, vertex: u32, into: usize, out: usize) -> Option<()> {
        let place = self
            .order
            .search(|interval| self.is_below(interval, vertex));
        let below = self.order.before(place)?;
        let Interval {
            upper, top, last, ..
        } = self.intervals[below];
        let lower_rest = self.cut_down(vertex, last);
        let mut upper_rest = self.cut_up(vertex, last);
        let mut upper_top = top;
        if lower_rest == upper_rest {
            upper_rest = self.twin(last);
            upper_top = if top == last { upper_rest } else { top };
        }
        let (lower_node, upper_node) = (self.push_node(vertex), self.push_node(vertex));
        self.connect(lower_rest, lower_node);
        self.connect(upper_node, upper_rest);
        self.intervals[below].top = lower_node;
        self.intervals[below].last = lower_node;
        self.set_upper(below, into);
        let above = self.push_interval(out, upper, upper_node, upper_top);
        self.order.insert(place, above);
        Some(())
    }

    fn extend_bottom(&mut self, interval: usize, vertex: u32) {
        let rest = self.cut_up(vertex, self.intervals[interval].bottom);
        let node = self.push_node(vertex);
        self.connect(node, rest);
        self.intervals[interval].bottom = node;
        self.intervals[interval].last = node;
    }

    fn extend_top(&mut self, interval: usize, vertex: u32) {
        let rest = self.cut_down(vertex, self.intervals[interval].top);
        let node = self.push_node(vertex);
        self.connect(rest, node);
        self.intervals[interval].top = node;
        self.intervals[interval].last = node;
    }

    /// Cuts off triangles between `vertex` and the vertices of an interval's chain from `node` upwards;
    /// returns the last node used.
    fn cut_up(&mut self, vertex: u32, mut node: usize) -> usize {
        while self.nodes[node].up != NONE {
            let up = self.nodes[node].up;
            let corners = [vertex, self.nodes[up].vertex, self.nodes[node].vertex];
            if !self.emit(corners) {
                break;
            }
            node = up;
        }
        node
    }

    /// Cuts off triangles between `vertex` and the vertices of an interval's chain from `node` downwards;
    /// returns the last node used.
    fn cut_down(&mut self, vertex: u32, mut node: usize) -> usize {
        while self.nodes[node].down != NONE {
            let down = self.nodes[node].down;
            let corners = [vertex, self.nodes[node].vertex, self.nodes[down].vertex];
            if !self.emit(corners) {
                break;
            }
            node = down;
        }
        node
    }

    /// Appends a triangle if it turns strictly left; returns whether it does.
    fn emit(&mut self, corners: [u32; 3]) -> bool {
        let [a, b, c] = corners;
        let is_left = self.points.orient(a, b, c) == Sign::Positive;
        if is_left {
            self.triangles.push(corners);
        }
        is_left
    }

    fn push_node(&mut self, vertex: u32) -> usize {
        self.nodes.push(Node {
            vertex,
            down: NONE,
            up: NONE,
        });
        self.nodes.len() - 1
    }

    fn connect(&mut self, down: usize, up: usize) {
        self.nodes[down].up = up;
        self.nodes[up].down = down;
    }

    /// Moves the part of an interval's chain of vertices above `node` to a copy of the node, which it
    /// returns.
    fn twin(&mut self, node: usize) -> usize {
        let twin = self.push_node(self.nodes[node].vertex);
        let up = self.nodes[node].up;
        if up != NONE {
            self.connect(twin, up);
        }
        twin
    }

    fn push_interval(&mut self, lower: usize, upper: usize, bottom: usize, top: usize) -> usize {
        let interval = self.intervals.len();
        self.intervals.push(Interval {
            lower,
            upper,
            bottom,
            top,
            last: bottom,
        });
        self.set_lower(interval, lower);
        self.set_upper(interval, upper);
        interval
    }

    fn set_lower(&mut self, interval: usize, edge: usize) {
        self.intervals[interval].lower = edge;
        self.interval_of[edge] = interval;
    }

    fn set_upper(&mut self, interval: usize, edge: usize) {
        self.intervals[interval].upper = edge;
        self.interval_of[edge] = interval;
    }

    fn bounded_by(&self, edge: usize) -> Option<usize> {
        Some(self.interval_of[edge]).filter(|&interval| interval != NONE)
    }

    /// Removes from the order an interval whose lower edge ends at `vertex`; `None` if it is not there.
    fn close(&mut self, interval: usize, vertex: u32) -> Option<()> {
        let place = self.order.search(|other| self.is_below(other, vertex));
        let (intervals, edges) = (&self.intervals, self.edges);
        let touches = |other: usize| edges[intervals[other].lower].1 == vertex;
        self.order.remove(place, interval, touches).then_some(())
    }

    /// Returns true if the interval's lower edge passes strictly below a vertex.
    fn is_below(&self, interval: usize, vertex: u32) -> bool {
        let (a, b) = self.edges[self.intervals[interval].lower];
        a != vertex && b != vertex && self.points.orient(a, b, vertex) == Sign::Positive
    }

    /// Returns true if the interval's lower edge passes below `vertex`, or starts there and runs below
    /// `head`.
    fn is_below_ray(&self, interval: usize, vertex: u32, head: u32) -> bool {
        let (a, b) = self.edges[self.intervals[interval].lower];
        if a == vertex {
            return self.points.orient(a, b, head) == Sign::Positive;
        }
        self.is_below(interval, vertex)
    }
}
