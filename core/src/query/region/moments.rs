//! Exact lengths, areas and volumes of sets, and the first moments of sets of the plane.

use num_bigint::BigInt;
use num_integer::Integer;

use crate::error::{Error, ErrorKind, Result};
use crate::geometry::polygon::Polygon;
use crate::geometry::spaces::dim1::{Dim1, Direction};
use crate::geometry::spaces::dim2::{Lattice2, Point2};
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::unbounded::big;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::grid::Pitch;
use crate::query::measure::{in_powers, pairwise_sum, Fraction};
use crate::tree::partition::{is_bounded, walls, Label, PartitionTree};
use crate::tree::plane::Boundary;

type Ratio = (BigInt, BigInt);

fn unbounded() -> Error {
    let text =
        "the set reaches to infinity and has no finite measure; intersect the set with a bounded \
                one first";
    Error::new(ErrorKind::Unbounded, text)
}

/// Returns the exact length of a bounded set on the line, in model units.
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

/// Returns the exact area of a bounded set of the plane, in square model units.
///
/// # Errors
/// `Unbounded`.
pub fn area(boundary: &Boundary, pitch: Pitch) -> Result<Fraction> {
    let doubled = Doubled::of(boundary)?;
    let (n, d) = pairwise_sum(doubled.cut);
    Ok(in_powers(
        n + doubled.whole * &d,
        d * 2,
        pitch.exponent(),
        2,
    ))
}

/// Returns a lower and an upper bound of the area, in square model units; they differ by at most 2^-127
/// square steps for each edge that ends in a constructed corner.
///
/// # Cost
/// One short quotient for each edge with a constructed corner; the exact sum multiplies all denominators.
///
/// # Errors
/// `Unbounded`.
pub fn area_bounds(boundary: &Boundary, pitch: Pitch) -> Result<[Fraction; 2]> {
    let doubled = Doubled::of(boundary)?;
    let rounded = |(n, d): &Ratio| Integer::div_floor(&(n << BINARY_PLACES), d);
    let sum: BigInt = doubled.cut.iter().map(rounded).sum();
    let low = (doubled.whole << BINARY_PLACES) + sum;
    let high = &low + BigInt::from(doubled.cut.len());
    let units = BigInt::from(2) << BINARY_PLACES;
    Ok([low, high].map(|bound| in_powers(bound, units.clone(), pitch.exponent(), 2)))
}

/// The number of binary places of each quotient that bounds an area.
const BINARY_PLACES: usize = 128;

/// Twice an area: the sum over edges between lattice points, and a fraction for each other edge.
struct Doubled {
    whole: BigInt,
    cut: Vec<Ratio>,
}

/// The sum of this many products of lattice coordinates fits into 127 bits.
const CHUNK: usize = 1 << 16;

impl Doubled {
    fn of(boundary: &Boundary) -> Result<Self> {
        if boundary.outer == Label::In || !boundary.is_closed() {
            return Err(unbounded());
        }
        let (mut whole, mut cut) = (BigInt::ZERO, Vec::new());
        for chunk in boundary.edges.chunks(CHUNK) {
            let mut sum = 0i128;
            for edge in chunk {
                poll();
                let [p, q] = boundary.points(edge);
                match (p.as_lattice(), q.as_lattice()) {
                    (Some(p), Some(q)) => sum += lattice_cross(p, q),
                    _ => cut.push(doubled(p, q)),
                }
            }
            whole += sum;
        }
        Ok(Self { whole, cut })
    }
}

fn lattice_cross([a, b]: Lattice2, [c, d]: Lattice2) -> i128 {
    i128::from(a) * i128::from(d) - i128::from(b) * i128::from(c)
}

/// Returns the exact first moments ∫x and ∫y of a bounded set of the plane, in cubic model units.
///
/// # Errors
/// `Unbounded`.
pub fn moments(boundary: &Boundary, pitch: Pitch) -> Result<[Fraction; 2]> {
    if boundary.outer == Label::In || !boundary.is_closed() {
        return Err(unbounded());
    }
    Ok([0, 1].map(|axis| {
        let terms = boundary.edges.iter().map(|edge| {
            let [p, q] = boundary.points(edge);
            let (n, d) = doubled(p, q);
            let [(a, v), (b, w)] = [p, q].map(|point| coordinate(point, axis));
            (n * (a * &w + b * &v), d * v * w)
        });
        let (n, d) = pairwise_sum(terms.collect());
        in_powers(n, d * 6, pitch.exponent(), 3)
    }))
}

/// Returns the exact volume of a bounded set in space, in cubic model units.
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

fn coordinate(point: &Point2, axis: usize) -> Ratio {
    let (x, w) = point.coordinates();
    (big(&x[axis]), big(w))
}

/// The cross product of two points as a fraction.
fn doubled(p: &Point2, q: &Point2) -> Ratio {
    let [(a, v), (d, w)] = [coordinate(p, 0), coordinate(q, 1)];
    let [(b, _), (c, _)] = [coordinate(p, 1), coordinate(q, 0)];
    (a * d - b * c, v * w)
}

/// Six times the volumes of the tetrahedra between the origin and the triangles of a convex polygon.
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
