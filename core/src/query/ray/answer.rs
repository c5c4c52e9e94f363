//! Exact hits as doubles.

use super::first::Found;
use super::line::Ray;
use super::scene::Scene;
use crate::arith::{ratio_to_f64, Int};

/// The part of a facet in which a ray meets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// In the facet's relative interior.
    Interior,
    /// On an edge of a triangle, between its ends.
    Edge,
    /// In a corner of a triangle or at an end of a segment.
    Vertex,
}

/// A hit in model units.
#[derive(Clone, Copy, Debug)]
pub struct Hit<const D: usize> {
    /// The facet's place in the input.
    pub number: u32,
    /// The point is origin + t · direction; correctly rounded (but for subnormal numbers).
    pub t: f64,
    /// The part of the facet.
    pub kind: Kind,
    /// Barycentric coordinates, correctly rounded; zero exactly where they are.
    pub weights: [f64; D],
    /// The point, by the weights.
    pub point: [f64; D],
}

/// Rounds what was found.
pub fn hit<const D: usize>(scene: &Scene<D>, ray: &Ray<D>, found: &Found<D>) -> Hit<D> {
    let exact = &found.meeting.weights;
    let sum = exact.iter().fold(Int::ZERO, |sum, w| sum + *w);
    let weights = exact.map(|w| ratio_to_f64(&w, &sum));
    Hit {
        number: scene.number(found.facet),
        t: scene.parameter(&found.meeting.at, ray.exponent()),
        kind: kind(exact),
        weights,
        point: scene.position(&found.corners, &weights),
    }
}

fn kind<const D: usize, const N: usize>(weights: &[Int<N>; D]) -> Kind {
    let zeros = weights.iter().filter(|w| w.is_zero()).count();
    match zeros {
        0 => Kind::Interior,
        _ if zeros + 1 == D => Kind::Vertex,
        _ => Kind::Edge,
    }
}
