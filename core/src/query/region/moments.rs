//! Exact length, area, volume, and the first moments of the plane.

use num_bigint::BigInt;

use super::outlines::Outline;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::dim1::{Dim1, Direction};
use crate::geometry::dim2::Point2;
use crate::geometry::dim3::Dim3;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::mesh::grid::Pitch;
use crate::query::exact::big;
use crate::query::measure::{in_powers, pairwise_sum, Fraction};
use crate::tree::partition::{is_bounded, walls, PartitionTree};

type Ratio = (BigInt, BigInt);

fn unbounded() -> Error {
    let text = "the set reaches to infinity and has no finite measure";
    Error::new(ErrorKind::Unbounded, text)
}

/// The exact length of a bounded set on the line, in model units.
///
/// # Errors
/// `Unbounded`.
pub fn length(tree: &PartitionTree<Dim1>, pitch: Pitch) -> Result<Fraction> {
    if !is_bounded(tree) {
        return Err(unbounded());
    }
    let signed = |at: i64, inside| match inside {
        Direction::Below => i128::from(at),
        Direction::Above => -i128::from(at),
    };
    let ends = walls(tree)?.into_iter().map(|w| w.fragment);
    let sum: i128 = ends.map(|end| signed(end.at(), end.inside())).sum();
    let one = BigInt::from(1);
    Ok(in_powers(BigInt::from(sum), one, pitch.exponent(), 1))
}

/// The exact area inside closed outlines, in square model units.
pub fn area(outlines: &[Outline], pitch: Pitch) -> Fraction {
    let (n, d) = pairwise_sum(edges(outlines).map(|(p, q)| doubled(p, q)).collect());
    in_powers(n, d * 2, pitch.exponent(), 2)
}

/// The exact first moments ∫x and ∫y inside closed outlines, in cubic model units.
pub fn moments(outlines: &[Outline], pitch: Pitch) -> [Fraction; 2] {
    [0, 1].map(|axis| {
        let terms = edges(outlines).map(|(p, q)| {
            let (n, d) = doubled(p, q);
            let [(a, v), (b, w)] = [p, q].map(|point| coordinate(point, axis));
            (n * (a * &w + b * &v), d * v * w)
        });
        let (n, d) = pairwise_sum(terms.collect());
        in_powers(n, d * 6, pitch.exponent(), 3)
    })
}

/// The exact volume of a bounded set in space, in cubic model units.
///
/// # Errors
/// `Unbounded`.
pub fn volume(tree: &PartitionTree<Dim3>, pitch: Pitch) -> Result<Fraction> {
    if !is_bounded(tree) {
        return Err(unbounded());
    }
    let pieces = walls(tree)?;
    let fans = pieces.iter().flat_map(|wall| fan(&wall.fragment));
    let (n, d) = pairwise_sum(fans.collect());
    Ok(in_powers(n, d * 6, pitch.exponent(), 3))
}

fn edges(outlines: &[Outline]) -> impl Iterator<Item = (&Point2, &Point2)> {
    outlines.iter().flat_map(|outline| {
        let next = outline.corners.iter().cycle().skip(1);
        outline.corners.iter().zip(next)
    })
}

fn coordinate(point: &Point2, axis: usize) -> Ratio {
    let (x, w) = point.coordinates();
    (big(&x[axis]), big(w))
}

/// The cross product of two points.
fn doubled(p: &Point2, q: &Point2) -> Ratio {
    let [(a, v), (d, w)] = [coordinate(p, 0), coordinate(q, 1)];
    let [(b, _), (c, _)] = [coordinate(p, 1), coordinate(q, 0)];
    (a * d - b * c, v * w)
}

/// Six times the volumes of the tetrahedra from the origin over a convex polygon's triangles.
fn fan(polygon: &Polygon) -> Vec<Ratio> {
    let corners: Vec<&Vertex> = polygon.corners().iter().map(|c| &*c.at).collect();
    let pairs = corners.windows(2).skip(1);
    pairs
        .map(|pair| determinant([corners[0], pair[0], pair[1]]))
        .collect()
}

fn determinant(corners: [&Vertex; 3]) -> Ratio {
    let [a, b, c] = corners.map(|v| {
        let h = v.coordinates();
        (h.x.map(|x| big(&x)), big(&h.w))
    });
    let minor = |i: usize, j: usize| &b.0[i] * &c.0[j] - &b.0[j] * &c.0[i];
    let value = &a.0[0] * minor(1, 2) + &a.0[1] * minor(2, 0) + &a.0[2] * minor(0, 1);
    (value, a.1 * b.1 * c.1)
}
