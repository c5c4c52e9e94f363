//! The boundary of a plane set as maximal edges between numbered corners.

use std::cmp::Ordering;

use crate::arith::convert::as_number;
use crate::error::Result;
use crate::geometry::spaces::dim2::{Dim2, Lattice2, Line2, Point2, Segment2};
use crate::interrupt::poll;
use crate::tree::partition::{classify_corner, walls, Label, PartitionTree, Wall};

/// A boundary of directed edges between corners, with the set on the left.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// The label outside all edges, at the lowest corner of the frame.
    pub outer: Label,
    /// The corners, ordered by x, then y.
    pub corners: Vec<Corner>,
    /// The edges, ordered by their first corners, then their last ones.
    pub edges: Vec<Edge>,
}

/// A point of the plane and two lines that cross there.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// The place of the corner.
    pub point: Point2,
    lines: [Line2; 2],
}

/// A maximal piece of the boundary on one line.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// The line, the set on its minus side.
    pub line: Line2,
    /// The numbers of its first and last corner.
    pub ends: [u32; 2],
    /// The number of the set's part on its left.
    pub inside: u32,
    /// The number of the complement's part on its right.
    pub outside: u32,
}

impl Corner {
    /// A lattice point.
    pub fn lattice(at: Lattice2) -> Self {
        Self {
            point: Point2::lattice(at),
            lines: [0, 1].map(|axis| Line2::axis_cut(axis, at[axis])),
        }
    }

    /// The place where two lines cross; `None` if they are parallel.
    pub fn crossing(p: Line2, q: Line2) -> Option<Self> {
        let point = Point2::meet(&p, &q)?;
        let lines = [p, q];
        Some(Self { point, lines })
    }

    /// A point of a line that another line crosses there.
    fn of(point: Point2, lines: [Line2; 2]) -> Self {
        match point.as_lattice() {
            Some(at) => Self::lattice(at),
            None => Self { point, lines },
        }
    }

    /// The two lines; they are not parallel.
    pub fn lines(&self) -> &[Line2; 2] {
        &self.lines
    }

    /// A line that crosses the given one here.
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
    /// The boundary of the empty set or the whole plane.
    pub fn uniform(label: Label) -> Self {
        Self {
            outer: label,
            corners: Vec::new(),
            edges: Vec::new(),
        }
    }

    /// The boundary of a tree's set; a point where only two collinear pieces meet is not a corner.
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

    /// The boundary from sorted corners and unsorted edges.
    pub fn sorted(outer: Label, corners: Vec<Corner>, mut edges: Vec<Edge>) -> Self {
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.inside));
        Self {
            outer,
            corners,
            edges,
        }
    }

    /// Return whether every edge has a successor: the set or its complement is bounded.
    pub fn is_closed(&self) -> bool {
        let mut balance = vec![0i32; self.corners.len()];
        for edge in &self.edges {
            poll();
            balance[edge.ends[0] as usize] += 1;
            balance[edge.ends[1] as usize] -= 1;
        }
        balance.iter().all(|count| *count == 0)
    }

    /// The edges that leave a corner.
    pub fn leaving(&self, corner: u32) -> std::ops::Range<usize> {
        let before = self.edges.partition_point(|e| e.ends[0] < corner);
        before..self.edges.partition_point(|e| e.ends[0] <= corner)
    }

    /// The first and the last point of an edge.
    pub fn points(&self, edge: &Edge) -> [&Point2; 2] {
        edge.ends.map(|i| &self.corners[i as usize].point)
    }

    /// An edge as a segment.
    pub fn segment(&self, edge: &Edge) -> Segment2 {
        let ends = edge.ends.map(|i| &self.corners[i as usize]);
        let limits = ends.map(|corner| corner.limit(&edge.line));
        Segment2::limited(edge.line, limits, ends.map(|corner| corner.point))
    }

    /// The boundary of the complement.
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

    /// Return whether two sets are equal: their boundaries agree, except for the numbers of parts.
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

/// Joins pieces where one ends, the next begins on the same line, and no other piece meets them.
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

/// For each piece, the piece that continues it.
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
