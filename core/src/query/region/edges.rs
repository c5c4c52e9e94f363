//! The boundary of a plane region as maximal edges between numbered vertices.

use std::cmp::Ordering;

use crate::error::Result;
use crate::geometry::dim2::{Dim2, Point2, Segment2};
use crate::interrupt::poll;
use crate::tree::partition::{walls, PartitionTree, Wall};

/// A boundary in edges, each from one vertex to another, the region on the left.
#[derive(Debug, Default)]
pub struct Boundary {
    /// The vertices, ordered by x, then y.
    pub vertices: Vec<Point2>,
    /// The edges, ordered by their first vertices.
    pub edges: Vec<Edge>,
}

/// A maximal piece of the boundary on one line.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Where.
    pub segment: Segment2,
    /// The numbers of its first and last vertex.
    pub ends: [usize; 2],
    /// The number of the region's part on its left.
    pub inside: usize,
    /// The number of the complement's part on its right.
    pub outside: usize,
}

impl Boundary {
    /// The boundary of a region; a place where nothing but two collinear pieces meet is no vertex.
    ///
    /// It depends on the set alone, not on its tree.
    ///
    /// # Errors
    /// `Internal` for a broken tree.
    pub fn of(tree: &PartitionTree<Dim2>) -> Result<Self> {
        let pieces = numbered(walls(tree)?);
        let edges = joined(&pieces);
        let points = edges.iter().flat_map(|e| *e.segment.points());
        let vertices = distinct(points.collect());
        let edges = edges.into_iter().map(|mut edge| {
            edge.ends = edge.segment.points().map(|p| number(&vertices, &p));
            edge
        });
        let mut edges: Vec<Edge> = edges.collect();
        edges.sort_by_key(|edge| edge.ends);
        Ok(Self { vertices, edges })
    }

    /// The edges that leave a vertex.
    pub fn leaving(&self, vertex: usize) -> std::ops::Range<usize> {
        let before = self.edges.partition_point(|e| e.ends[0] < vertex);
        before..self.edges.partition_point(|e| e.ends[0] <= vertex)
    }
}

fn numbered(walls: Vec<Wall<Dim2>>) -> Vec<Edge> {
    let points = walls.iter().flat_map(|w| *w.fragment.points());
    let vertices = distinct(points.collect());
    let edge = |wall: Wall<Dim2>| Edge {
        ends: wall.fragment.points().map(|p| number(&vertices, &p)),
        segment: wall.fragment,
        inside: wall.inside,
        outside: wall.outside,
    };
    walls.into_iter().map(edge).collect()
}

fn distinct(mut points: Vec<Point2>) -> Vec<Point2> {
    points.sort_by(Point2::order);
    points.dedup_by(|a, b| a.order(b) == Ordering::Equal);
    points
}

/// The position of a point in the sorted list that holds it.
fn number(vertices: &[Point2], point: &Point2) -> usize {
    vertices.partition_point(|v| v.order(point) == Ordering::Less)
}

/// Pieces joined wherever one ends, the next begins on the same line, and nothing else is.
fn joined(pieces: &[Edge]) -> Vec<Edge> {
    let next = successors(pieces);
    let mut follows = vec![false; pieces.len()];
    next.iter().flatten().for_each(|&i| follows[i] = true);
    let heads = (0..pieces.len()).filter(|&i| !follows[i]);
    let edge = |head: usize| {
        let last = std::iter::successors(Some(head), |&i| next[i]).last();
        let last = &pieces[last.unwrap_or(head)];
        let mut edge = pieces[head].clone();
        edge.segment = edge.segment.joined(&last.segment);
        edge
    };
    heads.map(edge).collect()
}

/// For each piece the one that continues it.
fn successors(pieces: &[Edge]) -> Vec<Option<usize>> {
    let count = pieces
        .iter()
        .flat_map(|p| p.ends)
        .max()
        .map_or(0, |m| m + 1);
    let (mut arriving, mut leaving) = (vec![Vec::new(); count], vec![Vec::new(); count]);
    for (i, piece) in pieces.iter().enumerate() {
        poll();
        leaving[piece.ends[0]].push(i);
        arriving[piece.ends[1]].push(i);
    }
    let mut next = vec![None; pieces.len()];
    for (arriving, leaving) in arriving.iter().zip(&leaving) {
        if let ([a], [b]) = (arriving.as_slice(), leaving.as_slice()) {
            let straight = pieces[*a].segment.line() == pieces[*b].segment.line();
            next[*a] = straight.then_some(*b);
        }
    }
    next
}
