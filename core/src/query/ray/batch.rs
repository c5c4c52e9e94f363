//! Many rays at once, on all threads of the pool; answers in the order of the rays.

use rayon::prelude::*;

use super::answer::{hit, Hit};
use super::crossings::{stretches, Stretch};
use super::first::{Query, Reach};
use super::line::Ray;
use super::ratio::Ratio;
use super::scene::Scene;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::{carried, poll};
use crate::merge::rule::Rule;
use crate::mesh::tasks::in_pool;

/// Rays that one thread takes at a time.
const CHUNK: usize = 512;

/// A stretch inside, in doubles: parameters, and the facets' places in the input.
#[derive(Clone, Copy, Debug)]
pub struct Inside {
    /// Where it begins and ends; infinite where it does not.
    pub t: [f64; 2],
    /// The facets at the ends; −1 where the ray starts inside or stays there.
    pub facets: [i64; 2],
}

/// Rays as flat arrays: origins, and directions or targets.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    /// Coordinates of the origins, one ray after the other.
    pub origins: &'a [f64],
    /// As many coordinates.
    pub heads: &'a [f64],
}

impl Rays<'_> {
    fn map<const D: usize, T: Send>(
        &self,
        scene: &Scene<D>,
        answer: impl Fn(usize, [i64; D], [f64; D]) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        if self.origins.len() != self.heads.len() || !self.origins.len().is_multiple_of(D) {
            let text = format!("origins and directions must both have shape (n, {D})");
            return Err(Error::new(ErrorKind::Shape, text));
        }
        let one = carried(|i: usize| {
            poll();
            let origin = scene.snap(&point(self.origins, i))?;
            answer(i, origin, point(self.heads, i))
        });
        let count = self.origins.len() / D;
        let answers: Vec<Result<T>> = if in_pool() {
            let rays = (0..count).into_par_iter();
            rays.with_min_len(CHUNK).map(one).collect()
        } else {
            (0..count).map(one).collect()
        };
        // The first error in the order of the rays, whatever the threads did.
        let numbered = answers.into_iter().enumerate();
        numbered
            .map(|(i, a)| a.map_err(|e| at_ray(&e, i)))
            .collect()
    }

    fn cast<const D: usize, T: Send>(
        &self,
        scene: &Scene<D>,
        answer: impl Fn(&Ray<D>) -> T + Sync,
    ) -> Result<Vec<T>> {
        self.map(scene, |_, origin, direction| {
            Ok(answer(&Ray::new(origin, &direction)?))
        })
    }

    /// The first hit of each ray.
    ///
    /// # Errors
    /// `Shape`; `NonFinite`, `TooLarge` and `BadNormal` with the ray's number; `Cancelled`.
    pub fn first<const D: usize>(&self, scene: &Scene<D>) -> Result<Vec<Option<Hit<D>>>> {
        self.cast(scene, |ray| {
            let found = Query::new(scene, ray).first()?;
            Some(hit(scene, ray, &found))
        })
    }

    /// All hits of each ray in order; `merge` keeps the first of those at one point.
    ///
    /// # Errors
    /// As for `first`.
    pub fn all<const D: usize>(&self, scene: &Scene<D>, merge: bool) -> Result<Vec<Vec<Hit<D>>>> {
        self.cast(scene, |ray| {
            let mut found = Query::new(scene, ray).all();
            if merge {
                found.dedup_by(|next, kept| next.meeting.at == kept.meeting.at);
            }
            found.iter().map(|f| hit(scene, ray, f)).collect()
        })
    }

    /// The stretches of each ray inside what the facets bound, `outside` being the winding number
    /// far away.
    ///
    /// # Errors
    /// As for `first`; `NotClosed` if the facets do not bound.
    pub fn inside<const D: usize>(
        &self,
        scene: &Scene<D>,
        rule: Rule,
        outside: i32,
    ) -> Result<Vec<Vec<Inside>>> {
        scene.require_closed()?;
        let number = |f: Option<u32>| f.map_or(-1, |f| i64::from(scene.number(f)));
        self.cast(scene, |ray| {
            let found = stretches(scene, ray, rule, outside).into_iter();
            let t = |at: &Ratio| scene.parameter(at, ray.exponent());
            let rounded = |s: Stretch| Inside {
                t: [t(&s.from), s.end.map_or(f64::INFINITY, |end| t(&end.0))],
                facets: [s.entry, s.end.map(|end| end.1)].map(number),
            };
            found.map(rounded).collect()
        })
    }

    /// Whether something lies strictly between each origin and its target; both are snapped.
    ///
    /// # Errors
    /// As for `first`; `BadNormal` where origin and target are one lattice point.
    pub fn hidden<const D: usize>(&self, scene: &Scene<D>) -> Result<Vec<bool>> {
        self.map(scene, |_, origin, target| {
            let ray = Ray::between(origin, &scene.snap(&target)?)?;
            Ok(Query::new(scene, &ray).occluded(Reach::Target))
        })
    }

    /// Whether something lies on each ray at a parameter strictly between 0 and its limit.
    ///
    /// # Errors
    /// As for `first`; `Shape` unless there is one limit for each ray.
    pub fn blocked<const D: usize>(&self, scene: &Scene<D>, limits: &[f64]) -> Result<Vec<bool>> {
        if limits.len() * D != self.origins.len() {
            let text = "there must be one limit for each ray";
            return Err(Error::new(ErrorKind::Shape, text));
        }
        self.map(scene, |i, origin, direction| {
            let ray = Ray::new(origin, &direction)?;
            Ok(Query::new(scene, &ray).occluded(Reach::Parameter(limits[i])))
        })
    }
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
