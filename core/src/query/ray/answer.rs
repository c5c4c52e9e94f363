//! Rounds exact hits of rays to doubles.

use super::first::{Found, Nearest};
use super::line::Ray;
use super::narrow::Narrow;
use super::scene::{in_lengths, Scene};
use crate::arith::{ratio_to_f64, Int};

/// The part of a facet that contains the point of a hit: its interior, an edge or a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// In the facet's relative interior.
    Interior,
    /// On an edge of a triangle, between its ends.
    Edge,
    /// In a corner of a triangle or at an end of a segment.
    Vertex,
}

/// A hit of a ray on a facet, in model units.
#[derive(Clone, Copy, Debug)]
pub struct Hit<const D: usize> {
    /// The index of the facet in the input.
    pub number: u32,
    /// The parameter: the point is origin + t · direction; correctly rounded, except for subnormal numbers.
    pub t: f64,
    /// The part of the facet in which the point lies.
    pub kind: Kind,
    /// The barycentric coordinates of the point, correctly rounded; zero only where exactly zero.
    pub weights: [f64; D],
    /// The point, computed from the barycentric coordinates.
    pub point: [f64; D],
}

/// Rounds an exact hit to doubles.
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

/// Returns the hit of the nearest facet, with narrow integers if they suffice; `None` if the ray misses it.
#[inline]
pub fn nearest_hit<const D: usize>(
    scene: &Scene<D>,
    ray: &Ray<D>,
    nearest: &Nearest<D>,
) -> Option<Hit<D>> {
    match narrow_hit(scene, ray, nearest) {
        None => widely(scene, ray, nearest),
        found => found,
    }
}

#[cold]
fn widely<const D: usize>(scene: &Scene<D>, ray: &Ray<D>, nearest: &Nearest<D>) -> Option<Hit<D>> {
    Some(hit(scene, ray, &nearest.met(ray)?))
}

fn narrow_hit<const D: usize>(
    scene: &Scene<D>,
    ray: &Ray<D>,
    nearest: &Nearest<D>,
) -> Option<Hit<D>> {
    let meeting = Narrow::of(ray, &nearest.corners)?;
    let weights = meeting.weights()?;
    let steps = meeting.parameter(scene.pitch())?;
    Some(Hit {
        number: scene.number(nearest.facet),
        t: in_lengths(steps, ray.exponent()),
        kind: of_zeros(meeting.zeros(), D),
        weights,
        point: scene.position(&nearest.corners, &weights),
    })
}

fn kind<const D: usize, const N: usize>(weights: &[Int<N>; D]) -> Kind {
    let zeros = weights.iter().filter(|w| w.is_zero()).count();
    of_zeros(zeros, D)
}

/// Returns the part of a facet that a point lies in, if `zeros` of its `corners` barycentric weights are
/// zero.
fn of_zeros(zeros: usize, corners: usize) -> Kind {
    match zeros {
        0 => Kind::Interior,
        _ if zeros + 1 == corners => Kind::Vertex,
        _ => Kind::Edge,
    }
}
