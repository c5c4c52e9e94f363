//! The part of a mesh that is being mended, and small changes of this part.

use std::collections::BTreeSet;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};
use smallvec::SmallVec;

use super::blocks::Blocks;
use crate::arith::convert::as_number;
use crate::extract::rounding::crossings::Faults;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::doubles::{Point, Triangle};
use crate::mesh::faces::edges;
use crate::mesh::handle::VertexId;

/// The format of the floating-point numbers in which coordinates are delivered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Doubles, with 53 significant bits.
    Double,
    /// Single precision, with 24 significant bits.
    Single,
}

impl Precision {
    /// The nearest number of this format.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounding is what is asked for"
    )]
    pub fn round(self, x: f64) -> f64 {
        match self {
            Self::Double => x,
            Self::Single => f64::from(x as f32),
        }
    }

    /// The distance from the absolute value of `x` to the next larger number of this format.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounding is what is asked for"
    )]
    pub(super) fn spacing(self, x: f64) -> f64 {
        match self {
            Self::Double => x.abs().next_up() - x.abs(),
            Self::Single => f64::from((x.abs() as f32).next_up()) - self.round(x.abs()),
        }
    }
}

/// The distance by which a change may move the surface, in spacings of doubles at the largest coordinate:
/// rounding moves a point by half a spacing on each axis, and two surfaces in opposite directions.
const MAX_SPACINGS_MOVED: f64 = 4.0;

/// The number of comparisons of boxes, at one to six nanoseconds each, after which mending stops.
const MAX_BOX_COMPARISONS: usize = 2_000_000_000;

/// The number of comparisons of boxes that take as long as one comparison of triangles, which takes between
/// 20, where doubles decide, and 1000, where both lie nearly in a plane (benchmark `triangles in doubles`).
pub(super) const BOXES_PER_TRIANGLE_TEST: usize = 100;

/// The numbers of the triangles around a vertex.
pub(super) type Star = SmallVec<[u32; 8]>;

/// A part of a mesh that is being mended. Triangles keep their numbers; removed ones are `None`.
pub struct Mending {
    /// The vertices; copies of vertices are added at the end.
    pub vertices: Vec<Point>,
    /// The corners of each triangle, or `None` if it was removed.
    pub triangles: Vec<Option<[VertexId; 3]>>,
    /// True for vertices that must not move, because some of their triangles are outside this part.
    pub(super) fixed: Vec<bool>,
    /// True for vertices of inputs, into which other vertices are merged.
    pub(super) given: Vec<bool>,
    pub(super) extents: Vec<Extent>,
    pub(super) blocks: Blocks,
    /// For each vertex the triangles around it, ascending.
    pub(super) stars: Vec<Star>,
    pub(super) flat: BTreeSet<u32>,
    /// Each crossing pair of triangles in both orders, so that the pairs that contain one triangle are a
    /// contiguous range.
    pub(super) crossings: BTreeSet<[u32; 2]>,
    pub(super) halves: HashMap<[VertexId; 2], u32>,
    pub(super) precision: Precision,
    /// The distance of neighbouring floating-point numbers at the largest coordinate.
    pub(super) spacing: f64,
    /// For each vertex, a bound on how far the vertex, or any vertex merged into it, was moved.
    pub(super) drifts: Vec<f64>,
    pub(super) work: usize,
    pub(super) moved: HashSet<VertexId>,
}

/// A change to try: new positions of vertices, and new corners of triangles.
#[derive(Debug, Default)]
pub(super) struct Edit {
    pub(super) moves: Vec<(VertexId, Point)>,
    pub(super) triangles: Vec<(u32, Option<[VertexId; 3]>)>,
    /// The vertex into which another vertex is merged, and the distance by which that moves the other
    /// vertex.
    pub(super) drift: Option<(VertexId, f64)>,
    /// For each vertex to be added, the vertex that it copies: the triangles around that vertex are no longer
    /// connected and need two vertices.
    pub(super) copies: Vec<VertexId>,
}

impl Mending {
    /// Prepares a part of a mesh, with all its faults, for mending.
    pub fn new(
        vertices: Vec<Point>,
        triangles: Vec<[VertexId; 3]>,
        [fixed, given]: [Vec<bool>; 2],
        precision: Precision,
        faults: &Faults,
    ) -> Self {
        let largest = vertices
            .iter()
            .flatten()
            .fold(0.0f64, |m, x| m.max(x.abs()));
        let corners = |t: &[VertexId; 3]| t.map(|v| vertices[v.index()]);
        let extents: Vec<Extent> = triangles.iter().map(|t| Extent::of(&corners(t))).collect();
        let mut stars = vec![Star::new(); vertices.len()];
        for (t, &v) in (0u32..)
            .zip(&triangles)
            .flat_map(|(t, c)| c.iter().map(move |v| (t, v)))
        {
            stars[v.index()].push(t);
        }
        let ends = |(t, c): (usize, &[VertexId; 3])| edges(*c).map(|e| (e, as_number(t)));
        let drifts = vec![0.0; vertices.len()];
        let halves = triangles.iter().enumerate().flat_map(ends).collect();
        Self {
            triangles: triangles.into_iter().map(Some).collect(),
            vertices,
            fixed,
            given,
            blocks: Blocks::new(&extents),
            extents,
            stars,
            flat: faults.flat.iter().copied().collect(),
            crossings: faults.crossings.iter().copied().flat_map(both).collect(),
            halves,
            precision,
            spacing: precision.spacing(largest),
            drifts,
            work: MAX_BOX_COMPARISONS,
            moved: HashSet::default(),
        }
    }

    /// Returns true if mending moved a vertex.
    pub fn is_moved(&self, vertex: VertexId) -> bool {
        self.moved.contains(&vertex)
    }

    /// Returns the pairs of triangles that still cross, and each flat triangle as a pair with itself.
    pub fn faults(&self) -> Vec<[u32; 2]> {
        let flat = self.flat.iter().map(|t| [*t, *t]);
        let crossings = self.crossings.iter().filter(|pair| pair[0] < pair[1]);
        crossings.copied().chain(flat).collect()
    }

    /// Returns a bound on the distance of `place` from the original position of a vertex, and from the
    /// original positions of all vertices merged into it.
    pub(super) fn drift(&self, v: VertexId, place: &Point) -> f64 {
        self.drifts[v.index()] + distance(&self.vertices[v.index()], place)
    }

    pub(super) fn reach(&self) -> f64 {
        MAX_SPACINGS_MOVED * self.spacing
    }

    /// The triangles around a vertex, ascending.
    pub(super) fn star(&self, v: VertexId) -> Star {
        self.stars[v.index()].clone()
    }

    /// Yields the pairs of triangles that contain `t` and cross, the lower number of each pair first.
    pub(super) fn crossings_of(&self, t: u32) -> impl Iterator<Item = [u32; 2]> + '_ {
        let own = self.crossings.range([t, 0]..=[t, u32::MAX]);
        own.map(|&[t, u]| [t.min(u), t.max(u)])
    }

    pub(super) fn corners(&self, t: u32) -> Option<Triangle> {
        let corners = self.triangles[t as usize]?;
        Some(corners.map(|v| self.vertices[v.index()]))
    }
}

/// Returns a pair of triangles in both orders.
pub(super) fn both([t, u]: [u32; 2]) -> [[u32; 2]; 2] {
    [[t, u], [u, t]]
}

pub(super) fn distance(p: &Point, q: &Point) -> f64 {
    let square = |i: usize| (p[i] - q[i]) * (p[i] - q[i]);
    (square(0) + square(1) + square(2)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_numbers_lie_farther_apart_than_doubles() {
        assert!(Precision::Double.round(0.1).to_bits() == 0.1f64.to_bits());
        assert!(Precision::Single.round(0.1).to_bits() == f64::from(0.1f32).to_bits());
        let spacings = [Precision::Double, Precision::Single].map(|p| p.spacing(-1.0));
        assert!(spacings[0].to_bits() == f64::EPSILON.to_bits());
        assert!(spacings[1].to_bits() == f64::from(f32::EPSILON).to_bits());
    }
}
