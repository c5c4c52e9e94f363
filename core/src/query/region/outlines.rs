//! The boundary of a plane region as simple closed loops, with the nesting of holes and islands.

use std::cmp::Ordering;

use rustc_hash::FxHashMap as HashMap;

use crate::arith::Sign;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::spaces::dim2::Point2;
use crate::interrupt::poll;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Edge};

/// A simple closed loop with the region on its left: outer loops run counterclockwise, holes clockwise.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The corners in order, starting with the one smallest in x, then y.
    pub corners: Vec<Point2>,
    /// The index of the loop directly around this one: the outer loop of a hole, the hole around an island.
    pub parent: Option<usize>,
    /// True if the loop bounds a hole.
    pub is_hole: bool,
}

/// Returns the loops of a bounded region's boundary.
///
/// Loops touch each other in corners at most; a loop that would touch itself is split there. If a corner of
/// one loop lies on a side of another loop, both have a corner there.
///
/// # Order
/// By first corner; the order depends on the set alone.
///
/// # Errors
/// `Unbounded`.
pub fn outlines(boundary: &Boundary) -> Result<Vec<Outline>> {
    if boundary.outer == Label::In || !boundary.is_closed() {
        let text =
            "the region reaches to infinity and has no closed outlines; intersect the region \
                    with a bounded one first";
        return Err(Error::new(ErrorKind::Unbounded, text));
    }
    let mut loops: Vec<Vec<usize>> = Vec::new();
    for closed in traced(boundary)? {
        poll();
        loops.extend(simple(boundary, &closed));
    }
    for edges in &mut loops {
        rotate_to_first(boundary, edges);
    }
    loops.sort_by_key(|l| (boundary.edges[l[0]].ends, boundary.edges[l[0]].inside));
    Ok(nested(boundary, &loops))
}

/// Returns closed walks along the boundary, each around one connected part of the region.
fn traced(boundary: &Boundary) -> Result<Vec<Vec<usize>>> {
    let mut seen = vec![false; boundary.edges.len()];
    let mut walks = Vec::new();
    for start in 0..boundary.edges.len() {
        let mut walk = Vec::new();
        let mut at = start;
        while !seen[at] {
            poll();
            seen[at] = true;
            walk.push(at);
            at = next_edge(boundary, &boundary.edges[at])
                .ok_or_else(|| Error::internal("a boundary ends in the middle of the plane"))?;
        }
        if !walk.is_empty() {
            walks.push(walk);
        }
    }
    Ok(walks)
}

/// Returns the first edge, clockwise from `edge`, among the edges that leave the vertex where `edge` ends.
fn next_edge(boundary: &Boundary, edge: &Edge) -> Option<usize> {
    let back = direction(edge).map(|d| -d);
    let mut leaving = boundary.leaving(edge.ends[1]);
    let first = leaving.next()?;
    Some(leaving.fold(first, |best, i| {
        let [a, b] = [i, best].map(|k| direction(&boundary.edges[k]));
        if clockwise(&back, &a, &b) == Ordering::Less {
            i
        } else {
            best
        }
    }))
}

fn direction(edge: &Edge) -> [i128; 2] {
    let ([a, b], _) = edge.line.coefficients();
    [-i128::from(b), i128::from(a)]
}

fn cross(a: &[i128; 2], b: &[i128; 2]) -> i128 {
    a[0] * b[1] - a[1] * b[0]
}

/// Compares two directions by their clockwise angles from a third one, in (0, 2π].
fn clockwise(from: &[i128; 2], a: &[i128; 2], b: &[i128; 2]) -> Ordering {
    let quarter = |d: &[i128; 2]| {
        let along = from[0] * d[0] + from[1] * d[1];
        match (Sign::of(cross(from, d)), Sign::of(along)) {
            (Sign::Negative, _) => 0,
            (Sign::Zero, Sign::Negative) => 1,
            (Sign::Positive, _) => 2,
            (Sign::Zero, _) => 3,
        }
    };
    let turn = || cross(a, b).cmp(&0);
    quarter(a).cmp(&quarter(b)).then_with(turn)
}

/// Splits a closed walk at each vertex that it passes twice.
fn simple(boundary: &Boundary, walk: &[usize]) -> Vec<Vec<usize>> {
    let mut loops = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut place: HashMap<u32, usize> = HashMap::default();
    for &edge in walk {
        poll();
        place.insert(boundary.edges[edge].ends[0], open.len());
        open.push(edge);
        if let Some(&start) = place.get(&boundary.edges[edge].ends[1]) {
            let closed = open.split_off(start);
            for e in &closed {
                poll();
                place.remove(&boundary.edges[*e].ends[0]);
            }
            loops.push(closed);
        }
    }
    loops
}

fn rotate_to_first(boundary: &Boundary, edges: &mut [usize]) {
    let first = (0..edges.len()).min_by_key(|&i| boundary.edges[edges[i]].ends[0]);
    edges.rotate_left(first.unwrap_or(0));
}

/// Returns true if a loop runs clockwise; it starts at its first corner, which is convex.
fn is_hole(boundary: &Boundary, edges: &[usize]) -> bool {
    let [first, last] = [edges[0], edges[edges.len() - 1]].map(|i| direction(&boundary.edges[i]));
    cross(&last, &first) < 0
}

fn nested(boundary: &Boundary, loops: &[Vec<usize>]) -> Vec<Outline> {
    let holes: Vec<bool> = loops.iter().map(|l| is_hole(boundary, l)).collect();
    // A connected part of the region has one outer loop; a part of the complement has at most one hole
    // around it.
    let mut outer = HashMap::default();
    let mut around = HashMap::default();
    for (i, edges) in loops.iter().enumerate() {
        poll();
        for edge in edges.iter().map(|e| &boundary.edges[*e]) {
            if holes[i] {
                around.insert(edge.outside, i);
            } else {
                outer.insert(edge.inside, i);
            }
        }
    }
    let parent = |i: usize| {
        let mut edges = loops[i].iter().map(|e| &boundary.edges[*e]);
        if holes[i] {
            edges.find_map(|e| outer.get(&e.inside))
        } else {
            edges.find_map(|e| around.get(&e.outside))
        }
    };
    let outline = |(i, edges): (usize, &Vec<usize>)| Outline {
        corners: edges
            .iter()
            .map(|e| boundary.corners[boundary.edges[*e].ends[0] as usize].point)
            .collect(),
        parent: parent(i).copied(),
        is_hole: holes[i],
    };
    loops.iter().enumerate().map(outline).collect()
}
