//! The boundary of a set of the plane as maximal edges between numbered corners.

use std::cmp::Ordering;

use crate::arith::convert::as_number;
use crate::error::Result;
use crate::geometry::spaces::dim2::{Dim2, Lattice2, Line2, Point2, Segment2};
use crate::interrupt::poll;
use crate::tree::partition::{classify_corner, walls, Label, PartitionTree, Wall};

/// The boundary of a set of the plane: directed edges between corners, with the set on their left.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// The label at the frame's corner of least coordinates, outside all closed edges.
    pub outer: Label,
    /// The corners, ordered by x, then by y.
    pub corners: Vec<Corner>,
    /// The edges, ordered by the number of their first corner, then of their last corner.
    pub edges: Vec<Edge>,
}

/// A corner of a boundary: a point of the plane and two lines that cross there.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// The exact position of the corner.
    pub point: Point2,
    lines: [Line2; 2],
}

/// A maximal edge of a boundary: an interval of a line.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// The line of the edge, with the set on its minus side.
    pub line: Line2,
    /// The numbers of the edge's first and last corner.
    pub ends: [u32; 2],
    /// The number of the set's connected part on the left of the edge.
    pub inside: u32,
    /// The number of the complement's connected part on the right of the edge.
    pub outside: u32,
}

impl Corner {
    /// The corner at a lattice point.
    pub fn lattice(at: Lattice2) -> Self {
        Self {
            point: Point2::lattice(at),
            lines: [0, 1].map(|axis| Line2::axis_cut(axis, at[axis])),
        }
    }

    /// The corner where two lines cross; `None` if they are parallel.
    pub fn crossing(p: Line2, q: Line2) -> Option<Self> {
        let point = Point2::meet(&p, &q)?;
        let lines = [p, q];
        Some(Self { point, lines })
    }

    /// The corner at a point where two lines cross.
    fn of(point: Point2, lines: [Line2; 2]) -> Self {
        match point.as_lattice() {
            Some(at) => Self::lattice(at),
            None => Self { point, lines },
        }
    }

    /// The two lines that cross in the corner.
    pub fn lines(&self) -> &[Line2; 2] {
        &self.lines
    }

    /// One of the corner's two lines that crosses the given line.
    fn limit(&self, line: &Line2) -> Line2 {
        let [p, q] = self.lines;
        if p.is_parallel(line) {
            q
        } else {
            p
        }
    }
}

impl Boundary {
    /// The boundary of the empty set (`Out`) or of the whole plane (`In`): it has no edges.
    pub fn uniform(label: Label) -> Self {
        Self {
            outer: label,
            corners: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// The boundary of a tree's set; a point where only two edges on one line meet is not a corner.
    ///
    /// # Errors
    /// `Internal` for a broken tree.
    pub fn of(tree: &PartitionTree<Dim2>) -> Result<Self> {
        let joined = joined(&walls(tree)?);
        let corner = |wall: &Wall<Dim2>, end: usize| {
            let segment = &wall.fragment;
            let limits = segment.limits();
            Corner::of(segment.points()[end], [*segment.line(), limits[end]])
        };
        let corners = joined.iter().flat_map(|w| [corner(w, 0), corner(w, 1)]);
        let mut corners: Vec<Corner> = corners.collect();
        corners.sort_by(|a, b| a.point.order(&b.point));
        corners.dedup_by(|a, b| a.point.order(&b.point) == Ordering::Equal);
        let number = |point: &Point2| {
            as_number(corners.partition_point(|c| c.point.order(point) == Ordering::Less))
        };
        let edge = |wall: &Wall<Dim2>| Edge {
            line: *wall.fragment.line(),
            ends: wall.fragment.points().map(|p| number(&p)),
            inside: wall.inside.0,
            outside: wall.outside.0,
        };
        let edges = joined.iter().map(edge).collect();
        Ok(Self::sorted(classify_corner(tree), corners, edges))
    }

    /// The boundary with these corners, which are sorted, and these edges, which need not be.
    pub fn sorted(outer: Label, corners: Vec<Corner>, mut edges: Vec<Edge>) -> Self {
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.inside));
        Self {
            outer,
            corners,
            edges,
        }
    }

    /// Return whether as many edges end as begin at each corner: the set or its complement is then bounded.
    pub fn is_closed(&self) -> bool {
        let mut balance = vec![0i32; self.corners.len()];
        for edge in &self.edges {
            poll();
            balance[edge.ends[0] as usize] += 1;
            balance[edge.ends[1] as usize] -= 1;
        }
        balance.iter().all(|count| *count == 0)
    }

    /// The range of indices of the edges that begin at a corner.
    pub fn leaving(&self, corner: u32) -> std::ops::Range<usize> {
        let before = self.edges.partition_point(|e| e.ends[0] < corner);
        before..self.edges.partition_point(|e| e.ends[0] <= corner)
    }

    /// The exact first and last point of an edge.
    pub fn points(&self, edge: &Edge) -> [&Point2; 2] {
        edge.ends.map(|i| &self.corners[i as usize].point)
    }

    /// The edge as a segment of its line.
    pub fn segment(&self, edge: &Edge) -> Segment2 {
        let ends = edge.ends.map(|i| &self.corners[i as usize]);
        let limits = ends.map(|corner| corner.limit(&edge.line));
        Segment2::limited(edge.line, limits, ends.map(|corner| corner.point))
    }

    /// The boundary of the complement: each edge reversed, with the label exchanged.
    #[must_use]
    pub fn complement(&self) -> Self {
        let turned = |edge: &Edge| Edge {
            line: edge.line.flipped(),
            ends: [edge.ends[1], edge.ends[0]],
            inside: edge.outside,
            outside: edge.inside,
        };
        let edges = self.edges.iter().map(turned).collect();
        Self::sorted(self.outer.complement(), self.corners.clone(), edges)
    }

    /// Return whether the two sets are equal: all but the numbers of connected parts agree.
    pub fn equals(&self, other: &Self) -> bool {
        let same_place = |(a, b): (&Corner, &Corner)| a.point.order(&b.point) == Ordering::Equal;
        let same_edge = |(a, b): (&Edge, &Edge)| a.line == b.line && a.ends == b.ends;
        self.outer == other.outer
            && self.corners.len() == other.corners.len()
            && self.edges.len() == other.edges.len()
            && self.corners.iter().zip(&other.corners).all(same_place)
            && self.edges.iter().zip(&other.edges).all(same_edge)
    }
}

/// Joins boundary segments of one line where one ends, the next begins and no other segment meets them.
fn joined(pieces: &[Wall<Dim2>]) -> Vec<Wall<Dim2>> {
    let next = successors(pieces);
    let mut follows = vec![false; pieces.len()];
    next.iter().flatten().for_each(|&i| follows[i] = true);
    let heads = (0..pieces.len()).filter(|&i| !follows[i]);
    let edge = |head: usize| {
        let last = std::iter::successors(Some(head), |&i| next[i]).last();
        let last = &pieces[last.unwrap_or(head)];
        let mut edge = pieces[head].clone();
        edge.fragment = edge.fragment.joined(&last.fragment);
        edge
    };
    heads.map(edge).collect()
}

/// For each boundary segment, the index of the segment that continues it on the same line, if any.
fn successors(pieces: &[Wall<Dim2>]) -> Vec<Option<usize>> {
    let mut ends: Vec<(&Point2, usize, usize)> = Vec::with_capacity(2 * pieces.len());
    for (i, piece) in pieces.iter().enumerate() {
        poll();
        let [first, last] = piece.fragment.points();
        ends.extend([(first, 0, i), (last, 1, i)]);
    }
    ends.sort_by(|a, b| a.0.order(b.0).then(a.1.cmp(&b.1)));
    let mut next = vec![None; pieces.len()];
    for place in ends.chunk_by(|a, b| a.0.order(b.0) == Ordering::Equal) {
        if let [(_, 0, leaving), (_, 1, arriving)] = place {
            let straight = pieces[*arriving].fragment.line() == pieces[*leaving].fragment.line();
            next[*arriving] = straight.then_some(*leaving);
        }
    }
    next
}
