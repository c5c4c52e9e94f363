//! Triangulates one short loop by cutting off its corners (ears).

use smallvec::SmallVec;

use super::{Error, Planar};
use crate::arith::Sign;
use crate::interrupt::poll;

/// Loops of at most this many corners are clipped; for longer ones the sweep is faster.
const MAX_CORNERS_CLIPPED: usize = 8;

/// The vertices of a short loop, in order.
pub(super) type Loop = SmallVec<[u32; MAX_CORNERS_CLIPPED]>;

/// Returns the vertices of `edges` in order if they form one short loop that visits no vertex twice.
pub(super) fn small_loop(edges: &[(u32, u32)]) -> Option<Loop> {
    if !(3..=MAX_CORNERS_CLIPPED).contains(&edges.len()) {
        return None;
    }
    let mut corners = Loop::new();
    let (first, mut reached) = edges[0];
    corners.push(first);
    while reached != first {
        if corners.len() == edges.len() || corners.contains(&reached) {
            return None;
        }
        corners.push(reached);
        reached = edges.iter().find(|edge| edge.0 == reached)?.1;
    }
    (corners.len() == edges.len()).then_some(corners)
}

/// Triangulates a loop by cutting off one corner at a time.
///
/// An ear is a strictly convex corner whose closed triangle contains no other corner. Because the triangle
/// is closed, no diagonal passes through a vertex between collinear edges, so a simple loop remains.
pub(super) fn clip_ears<P: Planar>(points: &P, mut corners: Loop) -> Result<Vec<[u32; 3]>, Error> {
    if let [a, b, c] = corners[..] {
        let is_left = points.orient(a, b, c) == Sign::Positive;
        return is_left
            .then(|| vec![[a, b, c]])
            .ok_or(Error::Crossing { vertex: a });
    }
    let mut triangles = Vec::with_capacity(corners.len() - 2);
    let mut turns: SmallVec<[Sign; MAX_CORNERS_CLIPPED]> = (0..corners.len())
        .map(|k| turn(points, &corners, k))
        .collect();
    while corners.len() > 3 {
        poll();
        let ear = (0..corners.len()).find(|&k| is_ear(points, &corners, &turns, k));
        let ear = ear.ok_or(Error::Crossing { vertex: corners[0] })?;
        triangles.push(around(&corners, ear));
        corners.remove(ear);
        turns.remove(ear);
        let after = ear % corners.len();
        let before = (ear + corners.len() - 1) % corners.len();
        turns[after] = turn(points, &corners, after);
        turns[before] = turn(points, &corners, before);
    }
    if turns[0] != Sign::Positive {
        return Err(Error::Crossing { vertex: corners[0] });
    }
    triangles.push(around(&corners, 1));
    Ok(triangles)
}

/// The corner at index `k`, between the corner before it and the one after it.
fn around(corners: &[u32], k: usize) -> [u32; 3] {
    let n = corners.len();
    [corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]]
}

fn turn<P: Planar>(points: &P, corners: &[u32], k: usize) -> Sign {
    let [a, b, c] = around(corners, k);
    points.orient(a, b, c)
}

/// Returns true if the corner at index `k` is strictly convex and its triangle contains no other corner.
///
/// Tests only corners that are not strictly convex: if the triangle contains a corner, it contains such a
/// one.
fn is_ear<P: Planar>(points: &P, corners: &[u32], turns: &[Sign], k: usize) -> bool {
    if turns[k] != Sign::Positive {
        return false;
    }
    let ear = around(corners, k);
    let blunt = corners
        .iter()
        .zip(turns)
        .filter(|(v, turn)| **turn != Sign::Positive && !ear.contains(v));
    !blunt.into_iter().any(|(&v, _)| is_in(points, ear, v))
}

fn is_in<P: Planar>(points: &P, [a, b, c]: [u32; 3], v: u32) -> bool {
    let is_inside = |p: u32, q: u32| points.orient(p, q, v) != Sign::Negative;
    is_inside(c, a) && is_inside(a, b) && is_inside(b, c)
}
