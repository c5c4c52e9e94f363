//! Finds the first facet on a ray, all facets on a ray, and whether a facet lies before a target.

use std::cmp::Ordering;

use super::block::Block;
use super::facet::{meet, Facet, Meeting};
use super::filter::{Depth, Filter, Probe, ROUNDING};
use super::line::Ray;
use super::scene::Scene;
use super::walk::walk;
use crate::arith::Sign;

/// A facet that a ray meets, and where it meets it.
#[derive(Clone, Debug)]
pub struct Found<const D: usize> {
    /// The facet's index in the scene.
    pub facet: u32,
    /// The corners of the facet, in lattice steps.
    pub corners: Facet<D>,
    /// The first point that the facet has in common with the ray.
    pub meeting: Meeting<D>,
}

/// The nearest facet found on a ray during a search, with its depth in doubles.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The facet's index in the scene.
    pub facet: u32,
    depth: Depth,
}

impl Candidate {
    /// The largest value that the exact depth can have.
    pub fn high(&self) -> f64 {
        self.depth.high()
    }
}

/// The facet that a ray meets first, and its corners.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<const D: usize> {
    /// The facet's index in the scene.
    pub facet: u32,
    /// The corners of the facet, in lattice steps.
    pub corners: Facet<D>,
}

impl<const D: usize> Nearest<D> {
    #[inline]
    fn of(scene: &Scene<D>, best: &Candidate) -> Self {
        Self {
            facet: best.facet,
            corners: scene.facets()[best.facet as usize],
        }
    }

    /// Returns the exact meeting of the facet with a ray; `None` if there is none.
    pub fn met(&self, ray: &Ray<D>) -> Option<Found<D>> {
        exact(ray, self.facet, &self.corners)
    }
}

/// The end of the part of a ray that is tested for facets.
#[derive(Clone, Copy, Debug)]
pub enum Reach {
    /// Just before the target, which is at parameter 1.
    Target,
    /// Just before this parameter, in lengths of the given direction; compared after rounding.
    Parameter(f64),
}

/// A ray, prepared for tests against the facets of a scene.
pub struct Query<'a, const D: usize> {
    scene: &'a Scene<D>,
    ray: &'a Ray<D>,
    filter: Filter<D>,
}

impl<'a, const D: usize> Query<'a, D> {
    /// Prepares a ray for tests against a scene.
    pub fn new(scene: &'a Scene<D>, ray: &'a Ray<D>) -> Self {
        let cell = scene.cell();
        let filter = Filter::new(ray, &cell.low, &cell.high);
        Self { scene, ray, filter }
    }

    /// Returns the facet that the ray meets first; if several share that point, the first of the input.
    pub fn first(&self) -> Option<Found<D>> {
        let rays = std::slice::from_ref(self.ray);
        firsts(self.scene, rays, |ray, nearest| nearest?.met(ray)).pop()?
    }

    /// Tests a block against a ray, and updates the nearest facet `best`; returns the depth of `best`.
    #[inline]
    pub fn offer_block(&self, best: &mut Option<Candidate>, block: &Block<D>) -> f64 {
        self.try_block(best, block, |_, _| {});
        best.map_or(f64::INFINITY, |best| best.high())
    }

    /// Tests a facet, and updates the nearest facet `best`; returns the facet's depth if the ray meets it.
    #[inline]
    pub fn offer(&self, best: &mut Option<Candidate>, facet: u32) -> Option<Depth> {
        let found = self.candidate(facet, self.probe(facet))?;
        *best = Some(best.map_or(found, |old| self.nearer(old, found)));
        Some(found.depth)
    }

    /// Tests the facets of a block, updates the nearest facet `best`, and calls `hit` for each facet met.
    #[inline]
    pub fn try_block(
        &self,
        best: &mut Option<Candidate>,
        block: &Block<D>,
        mut hit: impl FnMut(u32, Depth),
    ) {
        self.filter.probe_block(block, |lane, probe| {
            let facet = block.facets()[lane];
            if let Some(found) = self.candidate(facet, probe) {
                hit(facet, found.depth);
                *best = Some(best.map_or(found, |old| self.nearer(old, found)));
            }
        });
    }

    /// Returns the exact meeting of the ray with its nearest facet.
    pub fn found(&self, nearest: &Candidate) -> Option<Found<D>> {
        Nearest::of(self.scene, nearest).met(self.ray)
    }

    /// Returns all facets on the ray in the order of their first points, then of the input.
    pub fn all(&self) -> Vec<Found<D>> {
        alls(self.scene, std::slice::from_ref(self.ray))
            .pop()
            .unwrap_or_default()
    }

    /// Returns true if a facet has a point strictly between the ray's start and `reach`.
    pub fn occluded(&self, reach: Reach) -> bool {
        blocked(self.scene, std::slice::from_ref(self.ray), |_| reach) == [true]
    }

    /// Tests a facet in doubles.
    pub fn probe(&self, facet: u32) -> Probe {
        self.filter.probe(&self.scene.facets()[facet as usize])
    }

    #[inline]
    fn candidate(&self, facet: u32, probe: Probe) -> Option<Candidate> {
        let depth = match probe {
            Probe::Miss => return None,
            Probe::Hit(depth) => depth,
            Probe::Doubt => self.exact_depth(facet)?,
        };
        Some(Candidate { facet, depth })
    }

    #[cold]
    fn exact_depth(&self, facet: u32) -> Option<Depth> {
        Some(depth_of(self.ray, self.meeting(facet)?.at.to_f64()))
    }

    fn meeting(&self, facet: u32) -> Option<Meeting<D>> {
        meet(self.ray, &self.scene.facets()[facet as usize])
    }

    #[inline]
    fn nearer(&self, old: Candidate, new: Candidate) -> Candidate {
        if new.depth.low() > old.depth.high() || new.facet == old.facet {
            old
        } else if new.depth.high() < old.depth.low() {
            new
        } else {
            self.exactly_nearer(old, new)
        }
    }

    #[cold]
    fn exactly_nearer(&self, old: Candidate, new: Candidate) -> Candidate {
        let order = match (self.meeting(new.facet), self.meeting(old.facet)) {
            (Some(a), Some(b)) => a.at.cmp(&b.at),
            // Both candidates meet the ray, so this does not happen.
            _ => Ordering::Equal,
        };
        if order.then_with(|| new.facet.cmp(&old.facet)) == Ordering::Less {
            new
        } else {
            old
        }
    }

    fn limit(&self, reach: Reach) -> Depth {
        match reach {
            Reach::Target => depth_of(self.ray, 1.0),
            Reach::Parameter(t) => {
                let half = self.ray.exponent() / 2;
                let scale = [half, self.ray.exponent() - half].map(|e| 2f64.powi(-e));
                let steps = self.scene.pitch().steps(t) * scale[0] * scale[1];
                depth_of(self.ray, steps)
            }
        }
    }

    fn blocks(&self, corners: &Facet<D>, probe: Probe, reach: Reach, limit: &Depth) -> bool {
        match probe {
            Probe::Miss => false,
            Probe::Hit(depth) if depth.high() < limit.low() => true,
            Probe::Hit(depth) if depth.low() > limit.high() => false,
            _ => self.exactly_blocks(corners, reach),
        }
    }

    #[cold]
    fn exactly_blocks(&self, corners: &Facet<D>, reach: Reach) -> bool {
        let Some(meeting) = meet(self.ray, corners) else {
            return false;
        };
        let before = match reach {
            Reach::Target => meeting.at < super::Ratio::ONE,
            Reach::Parameter(t) => self.scene.parameter(&meeting.at, self.ray.exponent()) < t,
        };
        before && meeting.until.sign() == Sign::Positive
    }
}

/// Finds the first facet on each ray, and computes a result from it.
pub fn firsts<const D: usize, T>(
    scene: &Scene<D>,
    rays: &[Ray<D>],
    answer: impl Fn(&Ray<D>, Option<Nearest<D>>) -> T,
) -> Vec<T> {
    let best = candidates(scene, rays);
    // Reads all corners first, so that their cache misses overlap.
    let nearest = |best: Option<Candidate>| Some(Nearest::of(scene, &best?));
    let nearest: Vec<Option<Nearest<D>>> = best.into_iter().map(nearest).collect();
    let pairs = rays.iter().zip(nearest);
    pairs.map(|(ray, nearest)| answer(ray, nearest)).collect()
}

/// Returns the nearest facet on each ray, with its depth in doubles.
pub fn candidates<const D: usize>(scene: &Scene<D>, rays: &[Ray<D>]) -> Vec<Option<Candidate>> {
    let queries = queries(scene, rays);
    let mut best = vec![None; rays.len()];
    walk(
        scene,
        rays,
        |_| f64::INFINITY,
        |ray, block| queries[ray].offer_block(&mut best[ray], block),
    );
    best
}

/// Returns all facets on each ray in the order of their first points, then of the input.
pub fn alls<const D: usize>(scene: &Scene<D>, rays: &[Ray<D>]) -> Vec<Vec<Found<D>>> {
    let met = likely(scene, rays).into_iter();
    let exact = |(ray, facets): (&Ray<D>, Vec<u32>)| {
        let corners = |facet: u32| &scene.facets()[facet as usize];
        let found = facets.into_iter().filter_map(|f| exact(ray, f, corners(f)));
        let mut found: Vec<Found<D>> = found.collect();
        found.sort_by(|a, b| {
            let order = a.meeting.at.cmp(&b.meeting.at);
            order.then_with(|| a.facet.cmp(&b.facet))
        });
        found
    };
    rays.iter().zip(met).map(exact).collect()
}

/// Returns for each ray the facets that the ray may meet, because computations in doubles cannot exclude it.
pub fn likely<const D: usize>(scene: &Scene<D>, rays: &[Ray<D>]) -> Vec<Vec<u32>> {
    let queries = queries(scene, rays);
    let mut met = vec![Vec::new(); rays.len()];
    walk(
        scene,
        rays,
        |_| f64::INFINITY,
        |ray, block| {
            queries[ray]
                .filter
                .probe_block(block, |lane, _| met[ray].push(block.facets()[lane]));
            f64::INFINITY
        },
    );
    met
}

/// Returns for each ray whether a facet has a point strictly between the ray's start and a given end
/// (`Reach`).
pub fn blocked<const D: usize>(
    scene: &Scene<D>,
    rays: &[Ray<D>],
    reach: impl Fn(usize) -> Reach,
) -> Vec<bool> {
    let queries = queries(scene, rays);
    let limit = |ray: usize| queries[ray].limit(reach(ray));
    let limits: Vec<Depth> = (0..rays.len()).map(limit).collect();
    let mut blocked = vec![false; rays.len()];
    walk(
        scene,
        rays,
        |ray| limits[ray].high(),
        |ray, block| {
            let (query, limit, found) = (&queries[ray], &limits[ray], &mut blocked[ray]);
            query.filter.probe_block(block, |lane, probe| {
                *found = *found || query.blocks(&block.lane(lane), probe, reach(ray), limit);
            });
            if *found {
                f64::NEG_INFINITY
            } else {
                limit.high()
            }
        },
    );
    blocked
}

/// Returns the exact meeting of a ray with a facet; `None` if there is none.
fn exact<const D: usize>(ray: &Ray<D>, facet: u32, corners: &Facet<D>) -> Option<Found<D>> {
    let meeting = meet(ray, corners)?;
    let corners = *corners;
    Some(Found {
        facet,
        corners,
        meeting,
    })
}

fn queries<'a, const D: usize>(scene: &'a Scene<D>, rays: &'a [Ray<D>]) -> Vec<Query<'a, D>> {
    rays.iter().map(|ray| Query::new(scene, ray)).collect()
}

/// Converts a parameter of a ray, which has at most four rounding errors, to a depth.
fn depth_of<const D: usize>(ray: &Ray<D>, parameter: f64) -> Depth {
    let lead = ray.direction()[ray.near.main].unsigned_abs() as f64;
    let z = parameter * lead;
    // A depth too large for a double is no limit; the error of one too small is below every step.
    let error = z.abs() * 16.0 * ROUNDING + f64::MIN_POSITIVE * lead;
    if z.is_finite() {
        Depth { z, error }
    } else {
        Depth { z, error: 0.0 }
    }
}
