//! The first facet on a ray, all facets on a ray, and whether one lies before a target.

use std::cmp::Ordering;

use super::facet::{meet, Meeting};
use super::filter::{Depth, Filter, Probe, ROUNDING};
use super::line::Ray;
use super::scene::Scene;
use super::walk::walk;

/// A facet on a ray, and where.
#[derive(Clone, Debug)]
pub struct Found<const D: usize> {
    /// The facet's index in the scene.
    pub facet: u32,
    /// The first point it has in common with the ray.
    pub meeting: Meeting<D>,
}

/// The nearest facet so far, its depth in doubles.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    facet: u32,
    depth: Depth,
}

impl Candidate {
    /// The most that the exact depth can be.
    pub fn high(&self) -> f64 {
        self.depth.high()
    }
}

/// Where on the ray a shadow test ends.
#[derive(Clone, Copy, Debug)]
pub enum Reach {
    /// Before parameter 1, where the target is.
    Target,
    /// Before this parameter of the given direction, compared after rounding.
    Parameter(f64),
}

/// A ray's questions to a scene.
pub struct Query<'a, const D: usize> {
    scene: &'a Scene<D>,
    ray: &'a Ray<D>,
    filter: Filter<D>,
}

impl<'a, const D: usize> Query<'a, D> {
    /// Questions of this ray.
    pub fn new(scene: &'a Scene<D>, ray: &'a Ray<D>) -> Self {
        let cell = scene.cell();
        let filter = Filter::new(ray, &cell.low, &cell.high);
        Self { scene, ray, filter }
    }

    /// The facet with the first point on the ray; of several there, the first of the input.
    pub fn first(&self) -> Option<Found<D>> {
        let mut best: Option<Candidate> = None;
        walk(self.scene, self.ray, f64::INFINITY, |facets| {
            for facet in facets {
                self.offer(&mut best, *facet);
            }
            best.map_or(f64::INFINITY, |b| b.high())
        });
        self.found(&best?)
    }

    /// Tests a facet and keeps it if it is nearer than the best; the depth of its hit, if any.
    #[inline]
    pub fn offer(&self, best: &mut Option<Candidate>, facet: u32) -> Option<Depth> {
        let found = self.candidate(facet)?;
        *best = Some(best.map_or(found, |old| self.nearer(old, found)));
        Some(found.depth)
    }

    /// The exact meeting with the nearest facet.
    pub fn found(&self, nearest: &Candidate) -> Option<Found<D>> {
        self.exact(nearest.facet)
    }

    /// All facets on the ray in the order of their first points, then of the input.
    pub fn all(&self) -> Vec<Found<D>> {
        let mut facets = self.touched();
        facets.retain(|f| !matches!(self.probe(*f), Probe::Miss));
        let mut found: Vec<_> = facets.into_iter().filter_map(|f| self.exact(f)).collect();
        found.sort_by(|a, b| {
            let order = a.meeting.at.cmp(&b.meeting.at);
            order.then_with(|| self.scene.order(a.facet, b.facet))
        });
        found
    }

    /// The facets of all leaves on the ray, each once.
    pub fn touched(&self) -> Vec<u32> {
        let mut facets = Vec::new();
        walk(self.scene, self.ray, f64::INFINITY, |leaf| {
            facets.extend_from_slice(leaf);
            f64::INFINITY
        });
        facets.sort_unstable();
        facets.dedup();
        facets
    }

    /// Whether a facet has a point strictly between the ray's start and its reach.
    pub fn occluded(&self, reach: Reach) -> bool {
        let limit = self.limit(reach);
        let mut blocked = false;
        walk(self.scene, self.ray, limit.high(), |facets| {
            blocked = blocked || facets.iter().any(|f| self.blocks(*f, reach, &limit));
            if blocked {
                f64::NEG_INFINITY
            } else {
                limit.high()
            }
        });
        blocked
    }

    /// What doubles tell of a facet.
    pub fn probe(&self, facet: u32) -> Probe {
        self.filter.probe(&self.scene.facets()[facet as usize])
    }

    fn exact(&self, facet: u32) -> Option<Found<D>> {
        let meeting = self.meeting(facet)?;
        Some(Found { facet, meeting })
    }

    fn meeting(&self, facet: u32) -> Option<Meeting<D>> {
        meet(self.ray, &self.scene.facets()[facet as usize])
    }

    #[inline]
    fn candidate(&self, facet: u32) -> Option<Candidate> {
        match self.probe(facet) {
            Probe::Miss => None,
            Probe::Hit(depth) => Some(Candidate { facet, depth }),
            Probe::Doubt => self.exact_candidate(facet),
        }
    }

    #[cold]
    fn exact_candidate(&self, facet: u32) -> Option<Candidate> {
        let depth = depth_of(self.ray, self.meeting(facet)?.at.to_f64());
        Some(Candidate { facet, depth })
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
            // Candidates do meet the ray.
            _ => Ordering::Equal,
        };
        if order.then_with(|| self.scene.order(new.facet, old.facet)) == Ordering::Less {
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

    fn blocks(&self, facet: u32, reach: Reach, limit: &Depth) -> bool {
        match self.probe(facet) {
            Probe::Miss => false,
            Probe::Hit(depth) if depth.high() < limit.low() => true,
            Probe::Hit(depth) if depth.low() > limit.high() => false,
            _ => self.exactly_blocks(facet, reach),
        }
    }

    #[cold]
    fn exactly_blocks(&self, facet: u32, reach: Reach) -> bool {
        let Some(meeting) = self.meeting(facet) else {
            return false;
        };
        let before = match reach {
            Reach::Target => meeting.at < super::Ratio::ONE,
            Reach::Parameter(t) => self.scene.parameter(&meeting.at, self.ray.exponent()) < t,
        };
        before && meeting.until.signum() > 0
    }
}

/// A depth from a ray's parameter, which carries at most four roundings.
fn depth_of<const D: usize>(ray: &Ray<D>, parameter: f64) -> Depth {
    let lead = ray.direction()[ray.near.main].unsigned_abs() as f64;
    let z = parameter * lead;
    // Parameters too large for doubles are no limit; too small ones are below every step.
    let error = z.abs() * 16.0 * ROUNDING + f64::MIN_POSITIVE * lead;
    if z.is_finite() {
        Depth { z, error }
    } else {
        Depth { z, error: 0.0 }
    }
}
