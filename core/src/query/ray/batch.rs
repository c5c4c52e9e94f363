//! Casts many rays on all threads of the pool; results are in the order of the rays.

use rayon::prelude::*;

use super::answer::{hit, nearest_hit, Hit};
use super::crossings::{stretches, Stretch};
use super::first::{alls, blocked, candidates, firsts, Candidate, Found, Reach};
use super::line::Ray;
use super::order::sorted;
use super::ratio::Ratio;
use super::scene::Scene;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::{carried, spend};
use crate::merge::rule::Rule;
use crate::mesh::tasks::in_pool;

/// The number of rays that a thread reads and casts together: some ten kB.
const RAYS_PER_CHUNK: usize = 64;

/// The least number of chunks of rays that a thread takes at once.
const MIN_CHUNKS_PER_THREAD: usize = 8;

/// An interval of a ray inside a closed set, with its ends in doubles and the indices of the facets there.
#[derive(Clone, Copy, Debug)]
pub struct Inside {
    /// The parameters at which the interval begins and ends; infinite if it has no end.
    pub t: [f64; 2],
    /// The input indices of the facets at its ends; −1 if the ray starts inside, or never leaves.
    pub facets: [i64; 2],
}

/// Rays as two flat arrays: their origins, and their directions or targets.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    /// The coordinates of the origins, one origin after the other.
    pub origins: &'a [f64],
    /// The coordinates of the directions or targets, one after the other.
    pub heads: &'a [f64],
}

impl Rays<'_> {
    /// Casts all rays and returns the results. `answer` computes the results of rays, which it gets with
    /// their numbers; `ray` makes a ray from a snapped origin and a head (direction or target); `along` gives
    /// the rough direction from an origin and a head, for sorting.
    fn map<const D: usize, T: Send>(
        &self,
        scene: &Scene<D>,
        along: impl Fn([f64; D], [f64; D]) -> [f64; D],
        ray: impl Fn([i64; D], [f64; D]) -> Result<Ray<D>> + Sync,
        answer: impl Fn(&[u32], &[Ray<D>]) -> Vec<T> + Sync,
    ) -> Result<Vec<T>> {
        if self.origins.len() != self.heads.len() || !self.origins.len().is_multiple_of(D) {
            let text = format!("origins and directions must both have shape (n, {D})");
            return Err(Error::new(ErrorKind::Shape, text));
        }
        let count = self.origins.len() / D;
        let read = |i: u32| [self.origins, self.heads].map(|flat| point(flat, i as usize));
        let made = |[origin, head]: [[f64; D]; 2]| ray(scene.snap(&origin)?, head);
        let given: Vec<u32> = (0..count as u32).collect();
        let rough = |i: usize| {
            let (origin, head) = (point(self.origins, i), point(self.heads, i));
            (origin.map(|c| scene.pitch().steps(c)), along(origin, head))
        };
        let Some(order) = sorted(count, scene.frame(), rough) else {
            return in_order(&given, &read, &made, &answer);
        };
        match in_order(&order, &read, &made, &answer) {
            Ok(answers) => Ok(restored(&order, answers)),
            // A different error may come first in the order of the input.
            Err(_) => in_order(&given, &read, &made, &answer),
        }
    }

    fn cast<const D: usize, T: Send>(
        &self,
        scene: &Scene<D>,
        answer: impl Fn(&[u32], &[Ray<D>]) -> Vec<T> + Sync,
    ) -> Result<Vec<T>> {
        let ray = |origin, direction: [f64; D]| Ray::new(origin, &direction);
        self.map(scene, |_, direction| direction, ray, answer)
    }

    /// Returns the first hit of each ray; `None` for a ray without a hit.
    ///
    /// # Errors
    /// `Shape`; `NonFinite`, `TooLarge` and `BadNormal` with the ray's number; `Cancelled`.
    pub fn first<const D: usize>(&self, scene: &Scene<D>) -> Result<Vec<Option<Hit<D>>>> {
        self.cast(scene, |_, rays| {
            firsts(scene, rays, |ray, best| nearest_hit(scene, ray, &best?))
        })
    }

    /// Returns the input index of the first facet on each ray; −1 for a ray without a hit.
    ///
    /// # Errors
    /// As for `first`.
    pub fn facets<const D: usize>(&self, scene: &Scene<D>) -> Result<Vec<i64>> {
        let number = |best: Candidate| i64::from(scene.number(best.facet));
        self.cast(scene, |_, rays| {
            let found = candidates(scene, rays).into_iter();
            found.map(|best| best.map_or(-1, number)).collect()
        })
    }

    /// Returns all hits of each ray in order; with `merge`, only the first of several at one point.
    ///
    /// # Errors
    /// As for `first`.
    pub fn all<const D: usize>(&self, scene: &Scene<D>, merge: bool) -> Result<Vec<Vec<Hit<D>>>> {
        let rounded = |(ray, mut found): (&Ray<D>, Vec<Found<D>>)| {
            if merge {
                found.dedup_by(|next, kept| next.meeting.at == kept.meeting.at);
            }
            found.iter().map(|f| hit(scene, ray, f)).collect()
        };
        self.cast(scene, |_, rays| {
            let found = rays.iter().zip(alls(scene, rays));
            found.map(rounded).collect()
        })
    }

    /// Returns the intervals of each ray inside a bounded set; `outside` is the winding number far away.
    ///
    /// # Errors
    /// As for `first`; `NotClosed` if the facets are not closed.
    pub fn inside<const D: usize>(
        &self,
        scene: &Scene<D>,
        rule: Rule,
        outside: i32,
    ) -> Result<Vec<Vec<Inside>>> {
        scene.require_closed()?;
        let number = |f: Option<u32>| f.map_or(-1, |f| i64::from(scene.number(f)));
        let of_ray = |ray: &Ray<D>| {
            let found = stretches(scene, ray, rule, outside).into_iter();
            let t = |at: &Ratio| scene.parameter(at, ray.exponent());
            let rounded = |s: Stretch| Inside {
                t: [t(&s.from), s.end.map_or(f64::INFINITY, |end| t(&end.0))],
                facets: [s.entry, s.end.map(|end| end.1)].map(number),
            };
            found.map(rounded).collect()
        };
        self.cast(scene, |_, rays| rays.iter().map(of_ray).collect())
    }

    /// Returns for each origin whether a facet lies strictly between it and its target; both are snapped.
    ///
    /// # Errors
    /// As for `first`; `BadNormal` where origin and target are one lattice point.
    pub fn hidden<const D: usize>(&self, scene: &Scene<D>) -> Result<Vec<bool>> {
        self.map(
            scene,
            |origin, target| std::array::from_fn(|k| target[k] - origin[k]),
            |origin, target| Ray::between(origin, &scene.snap(&target)?),
            |_, rays| blocked(scene, rays, |_| Reach::Target),
        )
    }

    /// Returns for each ray whether it meets a facet at a parameter strictly between 0 and its limit.
    ///
    /// # Errors
    /// As for `first`; `Shape` unless there is one limit for each ray.
    pub fn blocked<const D: usize>(&self, scene: &Scene<D>, limits: &[f64]) -> Result<Vec<bool>> {
        if limits.len() * D != self.origins.len() {
            let text = "there must be one limit for each ray";
            return Err(Error::new(ErrorKind::Shape, text));
        }
        self.cast(scene, |numbers, rays| {
            blocked(scene, rays, |i| {
                Reach::Parameter(limits[numbers[i] as usize])
            })
        })
    }
}

/// Casts rays in the given order; returns their answers, or the first error in this order.
fn in_order<const D: usize, T: Send>(
    order: &[u32],
    read: &(impl Fn(u32) -> [[f64; D]; 2] + Sync),
    made: &(impl Fn([[f64; D]; 2]) -> Result<Ray<D>> + Sync),
    answer: &(impl Fn(&[u32], &[Ray<D>]) -> Vec<T> + Sync),
) -> Result<Vec<T>> {
    let chunk = carried(|numbers: &[u32]| {
        spend(RAYS_PER_CHUNK);
        // Reads all rays first, so that their cache misses overlap.
        let mut given = [[[0.0; D]; 2]; RAYS_PER_CHUNK];
        for (place, i) in given.iter_mut().zip(numbers) {
            *place = read(*i);
        }
        let mut rays = Vec::with_capacity(RAYS_PER_CHUNK);
        for (given, i) in given.into_iter().zip(numbers) {
            rays.push(made(given).map_err(|e| at_ray(&e, *i as usize))?);
        }
        Ok(answer(numbers, &rays))
    });
    let mut all = Vec::with_capacity(order.len());
    if !in_pool() {
        for numbers in order.chunks(RAYS_PER_CHUNK) {
            all.extend(chunk(numbers)?);
        }
        return Ok(all);
    }
    let chunks = order
        .par_chunks(RAYS_PER_CHUNK)
        .with_min_len(MIN_CHUNKS_PER_THREAD);
    let answers: Vec<Result<Vec<T>>> = chunks.map(chunk).collect();
    for answers in answers {
        all.extend(answers?);
    }
    Ok(all)
}

/// Puts answers in the order of the input.
fn restored<T>(order: &[u32], answers: Vec<T>) -> Vec<T> {
    let mut places: Vec<Option<T>> = Vec::new();
    places.resize_with(order.len(), || None);
    for (number, answer) in order.iter().zip(answers) {
        places[*number as usize] = Some(answer);
    }
    places.into_iter().flatten().collect()
}

fn point<const D: usize>(flat: &[f64], i: usize) -> [f64; D] {
    std::array::from_fn(|k| flat[i * D + k])
}

fn at_ray(error: &Error, number: usize) -> Error {
    if error.kind() == ErrorKind::Cancelled {
        return error.clone();
    }
    let text = format!("ray {number}: {}", error.message());
    Error::at(error.kind(), vec![number as u64], text)
}
