//! Flips edges to widen the narrow angles of a triangulation, and checks that it is one.

use std::cmp::Ordering;
use std::collections::VecDeque;

use super::{Error, Planar};
use crate::arith::Sign;
use crate::interrupt::poll;

const NONE: usize = usize::MAX;

/// The largest number of flips per triangle, so that flipping takes linear time.
///
/// Circles, stars, combs and plates need up to two; a grid of 158 by 158 holes would need fifty, and stops
/// before its angles are the widest. The bound also ends cycles that rounding might cause.
const FLIPS_PER_TRIANGLE: usize = 16;

/// Triangles and their opposite half-edges. Half-edge `3 t + k` runs from corner `k` of triangle `t` to the
/// next.
struct Mates {
    triangles: Vec<[u32; 3]>,
    /// For each half-edge its opposite, or `NONE` on the boundary.
    mates: Vec<usize>,
}

/// A half-edge packed into one integer for sorting: its edge, its direction, its number.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Half(u128);

impl Half {
    /// The bit of the direction; the lower bits store the number.
    const FORWARD: u128 = 1 << 63;

    fn new(a: u32, b: u32, number: usize) -> Self {
        let edge = u128::from(a.min(b)) << 96 | u128::from(a.max(b)) << 64;
        let forward = if a < b { Self::FORWARD } else { 0 };
        Self(edge | forward | (number as u128 & (Self::FORWARD - 1)))
    }

    fn edge(self) -> u64 {
        (self.0 >> 64) as u64
    }

    fn is_forward(self) -> bool {
        self.0 & Self::FORWARD != 0
    }

    fn number(self) -> usize {
        let number = self.0 & (Self::FORWARD - 1);
        if number == Self::FORWARD - 1 {
            NONE
        } else {
            number as usize
        }
    }
}

/// Flips edges inside strictly convex quadrilaterals while that widens the narrowest angle.
///
/// # Errors
/// [`Error::Crossing`] unless every half-edge has exactly one opposite or is one of `boundary`.
pub(super) fn improve<P: Planar>(
    points: &P,
    triangles: Vec<[u32; 3]>,
    boundary: &[(u32, u32)],
) -> Result<Vec<[u32; 3]>, Error> {
    Ok(flipped(points, Mates::new(triangles, boundary)?))
}

/// Flips edges of the few ears of one loop; needs no check, because ear clipping makes each diagonal once.
pub(super) fn improve_ears<P: Planar>(points: &P, ears: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    if ears.len() == 1 {
        return ears;
    }
    let mut mesh = Mates::of_ears(ears);
    if mesh.triangles.len() > 2 {
        return flipped(points, mesh);
    }
    if let Some(half) = (0..3).find(|h| mesh.should_flip(points, *h)) {
        mesh.flip(half);
    }
    mesh.triangles
}

fn flipped<P: Planar>(points: &P, mut mesh: Mates) -> Vec<[u32; 3]> {
    let mut budget = FLIPS_PER_TRIANGLE * mesh.triangles.len();
    // A queue (first in, first out) spreads a limited number of flips over the whole region.
    let mut pending: VecDeque<usize> = (0..mesh.mates.len())
        .filter(|&h| mesh.is_first(h))
        .collect();
    while let Some(half) = pending.pop_front().filter(|_| budget > 0) {
        poll();
        if mesh.should_flip(points, half) {
            budget -= 1;
            pending.extend(mesh.flip(half));
        }
    }
    mesh.triangles
}

impl Mates {
    fn new(triangles: Vec<[u32; 3]>, boundary: &[(u32, u32)]) -> Result<Self, Error> {
        let count = 3 * triangles.len();
        let mut mesh = Self {
            triangles,
            mates: vec![NONE; count],
        };
        let mut halves: Vec<Half> = Vec::with_capacity(count + boundary.len());
        let inner = (0..count).map(|h| Half::new(mesh.origin(h), mesh.head(h), h));
        halves.extend(inner);
        // A boundary edge stands for the missing half-edge on its other side.
        halves.extend(boundary.iter().map(|&(a, b)| Half::new(b, a, NONE)));
        halves.sort_unstable();
        for pair in halves.chunk_by(|p, q| p.edge() == q.edge()) {
            poll();
            let vertex = (pair[0].edge() >> 32) as u32;
            let (g, h) = match pair {
                [g, h] if !g.is_forward() && h.is_forward() => (g.number(), h.number()),
                _ => return Err(Error::Crossing { vertex }),
            };
            match (g, h) {
                (NONE, NONE) => return Err(Error::Overlap { vertex }),
                (NONE, _) | (_, NONE) => {}
                _ => mesh.pair(g, h),
            }
        }
        Ok(mesh)
    }

    /// Finds opposite half-edges by comparing all pairs, which is fastest for a few triangles.
    fn of_ears(triangles: Vec<[u32; 3]>) -> Self {
        let count = 3 * triangles.len();
        let mut mesh = Self {
            triangles,
            mates: vec![NONE; count],
        };
        for h in 3..count {
            let (a, b) = (mesh.origin(h), mesh.head(h));
            let before = 0..h - h % 3;
            if let Some(g) = before
                .rev()
                .find(|g| mesh.origin(*g) == b && mesh.head(*g) == a)
            {
                mesh.pair(g, h);
            }
        }
        mesh
    }

    fn pair(&mut self, g: usize, h: usize) {
        if g != NONE {
            self.mates[g] = h;
        }
        if h != NONE {
            self.mates[h] = g;
        }
    }

    fn origin(&self, half: usize) -> u32 {
        self.triangles[half / 3][half % 3]
    }

    fn head(&self, half: usize) -> u32 {
        self.origin(next(half))
    }

    fn apex(&self, half: usize) -> u32 {
        self.origin(next(next(half)))
    }

    /// Returns true for one of the two half-edges of every inner edge, the one with the lower number.
    fn is_first(&self, half: usize) -> bool {
        self.mates[half] != NONE && half < self.mates[half]
    }

    /// Returns true if the two angles opposite an edge exceed 180 degrees together and the edge can be
    /// flipped.
    ///
    /// Of four points on one circle, the first in lexicographic order is not joined to the opposite one, as
    /// if it lay farther out: then there is one best triangulation, wherever the flips begin.
    fn should_flip<P: Planar>(&self, points: &P, half: usize) -> bool {
        let mate = self.mates[half];
        if mate == NONE {
            return false;
        }
        let (a, b, c, d) = (
            self.origin(half),
            self.head(half),
            self.apex(half),
            self.apex(mate),
        );
        let is_wide = match points.opposite_angles([a, b], [c, d]) {
            Ordering::Greater => true,
            Ordering::Equal => is_least_of_ends(points, [a, b], [c, d]),
            Ordering::Less => false,
        };
        let is_left = |p, q, r| points.orient(p, q, r) == Sign::Positive;
        is_wide && is_left(c, a, d) && is_left(d, b, c)
    }

    /// Replaces an edge by the other diagonal; returns the four half-edges around the quadrilateral.
    fn flip(&mut self, half: usize) -> [usize; 4] {
        let mate = self.mates[half];
        let (a, b, c, d) = (
            self.origin(half),
            self.head(half),
            self.apex(half),
            self.apex(mate),
        );
        let (s, t) = (half / 3, mate / 3);
        let outer =
            [next(next(half)), next(mate), next(next(mate)), next(half)].map(|h| self.mates[h]);
        self.triangles[s] = [c, a, d];
        self.triangles[t] = [d, b, c];
        let around = [3 * s, 3 * s + 1, 3 * t, 3 * t + 1];
        for (h, mate) in around.into_iter().zip(outer) {
            self.pair(h, mate);
        }
        self.pair(3 * s + 2, 3 * t + 2);
        around
    }
}

fn next(half: usize) -> usize {
    if half % 3 == 2 {
        half - 2
    } else {
        half + 1
    }
}

/// Returns true if the first of four points in lexicographic order is one of `ends`.
fn is_least_of_ends<P: Planar>(points: &P, ends: [u32; 2], apexes: [u32; 2]) -> bool {
    let lesser = |[a, b]: [u32; 2]| {
        if points.compare(a, b) == Ordering::Less {
            a
        } else {
            b
        }
    };
    points.compare(lesser(ends), lesser(apexes)) == Ordering::Less
}
