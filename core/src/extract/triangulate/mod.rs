//! Exact triangulation of planar polygons with holes.
//!
//! Knows the points of one plane only by id and by the exact answers of [`Planar`]; floats only give them a
//! rough order. Ear clipping triangulates a single short loop, one sweep all other regions; flips of edges
//! then widen the narrow angles. They end at the constrained Delaunay triangulation, with ties broken by the
//! points alone: it does not depend on ids or on the order of the edges. Invariant: every triangle that
//! leaves this module turns strictly left, and the triangles' edges are the given boundary edges once each
//! and every other edge once in each direction.
//!
//! # Source
//! Hertel, Mehlhorn 1983 (sweep); Meisters 1975 (ears); Lawson 1977 (flips).

mod clip;
mod flip;
mod order;
mod outline;
mod relabel;
mod sweep;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;
use std::fmt;

use crate::arith::Sign;

/// Exact questions about the points of one plane, asked by id.
///
/// Different ids must stand for different points, and all answers must agree with one assignment of
/// coordinates.
///
/// # Example
/// ```
/// use std::cmp::Ordering;
///
/// use bspcsg::arith::Sign;
/// use bspcsg::extract::triangulate::{triangulate, Planar};
///
/// struct Points(Vec<[i32; 2]>);
///
/// impl Planar for Points {
///     fn compare(&self, a: u32, b: u32) -> Ordering {
///         self.0[a as usize].cmp(&self.0[b as usize])
///     }
///
///     fn orient(&self, a: u32, b: u32, c: u32) -> Sign {
///         let [a, b, c] = [a, b, c].map(|p| self.0[p as usize]);
///         let left = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
///         Sign::of(left)
///     }
///
///     fn opposite_angles(&self, ends: [u32; 2], apexes: [u32; 2]) -> Ordering {
///         let [[a, b], [c, d]] = [ends, apexes].map(|pair| pair.map(|p| self.0[p as usize]));
///         let angle = |apex: [i32; 2], p: [i32; 2], q: [i32; 2]| {
///             let [u, v] = [p, q].map(|p| [p[0] - apex[0], p[1] - apex[1]]);
///             [u[0] * v[0] + u[1] * v[1], u[0] * v[1] - u[1] * v[0]]
///         };
///         let ([cos_c, sin_c], [cos_d, sin_d]) = (angle(c, a, b), angle(d, b, a));
///         0.cmp(&(cos_c * sin_d + cos_d * sin_c))
///     }
///
///     fn approx(&self, a: u32) -> [f64; 2] {
///         self.0[a as usize].map(f64::from)
///     }
/// }
///
/// let square = Points(vec![[0, 0], [1, 0], [1, 1], [0, 1]]);
/// let triangles = triangulate(&square, &[(0, 1), (1, 2), (2, 3), (3, 0)])?;
/// assert_eq!(triangles.len(), 2);
/// # Ok::<(), bspcsg::extract::triangulate::Error>(())
/// ```
pub trait Planar {
    /// Lexicographic order of two points by (x, y).
    fn compare(&self, a: u32, b: u32) -> Ordering;

    /// The turn of the path from a over b to c.
    ///
    /// - `Positive`: left turn, the triangle abc is counterclockwise
    /// - `Zero`: the three points are collinear
    /// - `Negative`: right turn
    fn orient(&self, a: u32, b: u32, c: u32) -> Sign;

    /// Compares the sum of the angles at two apexes, on the left and the right of an edge, to 180 degrees.
    ///
    /// - `Greater`: the sum is larger, so each apex lies inside the circle through the other three points
    /// - `Equal`: the four points lie on one circle
    /// - `Less`: the sum is smaller
    fn opposite_angles(&self, ends: [u32; 2], apexes: [u32; 2]) -> Ordering;

    /// The point in floats, for a rough order that [`Planar::compare`] then corrects.
    fn approx(&self, a: u32) -> [f64; 2];
}

/// A reason why edges do not bound a region. Every variant names a vertex at the fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// The vertex has different numbers of arriving and leaving edges.
    Open {
        /// Id of the vertex.
        vertex: u32,
    },
    /// Two edges at the vertex lie on each other, or an edge there has no length.
    Overlap {
        /// Id of the vertex.
        vertex: u32,
    },
    /// Near the vertex the edges cross, or the region is not on their left.
    Crossing {
        /// Id of the vertex.
        vertex: u32,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { vertex } => write!(f, "the boundary is not closed at vertex {vertex}"),
            Self::Overlap { vertex } => write!(f, "boundary edges overlap at vertex {vertex}"),
            Self::Crossing { vertex } => {
                write!(
                    f,
                    "the edges near vertex {vertex} are not the boundary of a region on their left"
                )
            }
        }
    }
}

impl std::error::Error for Error {}

/// Triangulates the region on the left of directed boundary edges.
///
/// Any number of outer boundaries and holes is allowed, and boundaries may touch at vertices. Edges meet
/// only at their ends, and no vertex lies inside an edge. Corners of 180 degrees are kept as corners.
///
/// # Order
/// Triangles are counterclockwise; their order is a function of the edges and the points alone. Which
/// triangles these are depends on the points only, unless the flips end early.
///
/// # Cost
/// O(n log n) questions for n edges; the flips are bounded by a multiple of n.
///
/// # Errors
/// [`Error`] when the edges do not bound a region.
pub fn triangulate<P: Planar>(points: &P, edges: &[(u32, u32)]) -> Result<Vec<[u32; 3]>, Error> {
    if let Some(corners) = clip::small_loop(edges) {
        let triangles = clip::clip_ears(points, corners)?;
        return Ok(flip::improve_ears(points, triangles));
    }
    triangulate_by_sweep(points, edges)
}

fn triangulate_by_sweep<P: Planar>(
    points: &P,
    edges: &[(u32, u32)],
) -> Result<Vec<[u32; 3]>, Error> {
    let (local, edges) = relabel::Relabelled::new(points, edges)?;
    let triangles = sweep::sweep(&local, &edges)
        .and_then(|triangles| flip::improve(&local, triangles, &edges))
        .map_err(|error| local.restore_error(error))?;
    Ok(local.restore(&triangles))
}
