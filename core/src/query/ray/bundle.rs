//! Rays that go together, in single precision: what decides which boxes they may meet.
//!
//! # Error
//! In the frame a scene lies in [−1, 1]. A ray is taken from where it enters that stretch of its
//! main axis, so that it meets the scene at main distances t from 0 to 2 only, and moves by at most
//! t on each axis. Let u = 2^-24. A distance of a box's plane is a difference, times an inverse
//! that was rounded once: off by less than 4u of itself, as if the plane had moved by 8u < 2^-21. An
//! inverse that is cut at [`STEEP`] moves the ray by 2·2^-40. The start is found in doubles, off by
//! less than 2^-49 of the way from the origin. [`Start::slack`] is more than the sum of all: a ray
//! that meets a box goes through each of its slabs, all starts within the slack being tried.

use super::cell::{above, below, Frame};
use super::line::Ray;
use super::treelet::{Wide, WIDTH};

/// The largest inverse slope.
const STEEP: f64 = (1u64 << 40) as f64;

/// The slack of a start beside that of the way to it.
const BLUR: f64 = 1.0 / (1u64 << 20) as f64;

/// The slack of the way to a start, for each unit of its length.
const DRIFT: f64 = 1.0 / (1u64 << 49) as f64;

/// A ray in the frame.
#[derive(Clone, Copy, Debug)]
pub struct Start<const D: usize> {
    main: usize,
    at: [f64; D],
    slope: [f64; D],
    /// The main distance from the origin.
    skipped: f64,
    slack: f64,
}

impl<const D: usize> Start<D> {
    /// A ray where it enters the frame's stretch of its main axis.
    #[inline]
    pub fn of(ray: &Ray<D>, frame: &Frame<D>) -> Self {
        let near = &ray.near;
        let origin: [f64; D] = std::array::from_fn(|k| frame.inward(k, near.origin[k]));
        let main = near.main;
        let skipped = (-1.0 - near.heading * origin[main]).max(0.0);
        let slope: [f64; D] = std::array::from_fn(|k| near.shear[k] * near.heading);
        let far = origin.iter().fold(skipped, |far, c| far.max(c.abs()));
        Self {
            main,
            at: std::array::from_fn(|k| origin[k] + slope[k] * skipped),
            slope,
            skipped,
            slack: BLUR + DRIFT * far,
        }
    }

    fn inverse(&self, axis: usize) -> f32 {
        let slope = self.slope[axis];
        if slope.abs() * STEEP < 1.0 {
            (if slope < 0.0 { -STEEP } else { STEEP }) as f32
        } else {
            (1.0 / slope) as f32
        }
    }

    /// Planes of boxes seen from all starts within the slack.
    fn view(&self, axis: usize) -> View {
        let (at, inverse) = (self.at[axis], self.inverse(axis));
        let (low, high) = (below(at - self.slack), above(at + self.slack));
        // Seen from beyond, near planes are nearer and far planes farther.
        let backward = self.slope[axis] < 0.0;
        let (near, far) = if backward { (low, high) } else { (high, low) };
        View {
            near,
            near_inverse: inverse,
            far,
            far_inverse: inverse,
        }
    }

    /// Return whether slopes have the same signs and the same largest one.
    fn goes_with(&self, other: &Self) -> bool {
        let same = |k: usize| (self.slope[k] < 0.0) == (other.slope[k] < 0.0);
        self.main == other.main && (0..D).all(same)
    }

    fn widen(&mut self, other: &Self, more: fn(f64, f64) -> f64) {
        for k in 0..D {
            self.at[k] = more(self.at[k], other.at[k]);
            self.slope[k] = more(self.slope[k], other.slope[k]);
        }
    }
}

/// The places of planes of boxes along an axis, and the inverse slopes there.
#[derive(Clone, Copy, Debug, Default)]
struct View {
    near: f32,
    near_inverse: f32,
    far: f32,
    far_inverse: f32,
}

impl View {
    /// The view around another, too, which looks the same way.
    #[inline]
    fn with(&self, other: &Self, backward: bool) -> Self {
        let (late, early) = if backward {
            (least as Choice, most as Choice)
        } else {
            (most as Choice, least as Choice)
        };
        Self {
            near: late(self.near, other.near),
            near_inverse: early(self.near_inverse, other.near_inverse),
            far: early(self.far, other.far),
            far_inverse: late(self.far_inverse, other.far_inverse),
        }
    }
}

type Choice = fn(f32, f32) -> f32;

#[inline]
fn least(a: f32, b: f32) -> f32 {
    if b < a {
        b
    } else {
        a
    }
}

#[inline]
fn most(a: f32, b: f32) -> f32 {
    if b > a {
        b
    } else {
        a
    }
}

/// Up to `N` rays of one octant, and the beam around them.
#[derive(Clone, Debug)]
pub struct Bundle<const D: usize, const N: usize> {
    /// The side of a box that is met first: 1, the high one, where slopes are negative.
    first: [usize; D],
    near: [[f32; N]; D],
    far: [[f32; N]; D],
    inverse: [[f32; N]; D],
    /// Beyond these distances nothing matters to a ray.
    limits: [f32; N],
    beam: [View; D],
    scale: f64,
    skipped: [f64; N],
}

impl<const D: usize, const N: usize> Bundle<D, N> {
    /// The bundle of rays, at least one and at most `N`, with the depths beyond which nothing
    /// matters; `None` if they do not go the same way or stray farther apart than `width`.
    pub fn of(
        rays: &[Ray<D>],
        frame: &Frame<D>,
        width: f64,
        depth: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let lead = Start::of(rays.first()?, frame);
        let mut bundle = Self::of_one(&lead, frame);
        let (mut low, mut high) = (lead, lead);
        for (i, ray) in rays.iter().enumerate() {
            if i > 0 {
                let start = Start::of(ray, frame);
                if !start.goes_with(&lead) {
                    return None;
                }
                bundle.add(i, &start);
                low.widen(&start, f64::min);
                high.widen(&start, f64::max);
            }
            bundle.set_limit(i, depth(i));
        }
        let spread = |k: usize| high.at[k] - low.at[k] + high.slope[k] - low.slope[k];
        (0..D).all(|k| spread(k) <= width).then_some(bundle)
    }

    fn of_one(lead: &Start<D>, frame: &Frame<D>) -> Self {
        let mut bundle = Self {
            first: [0; D],
            near: [[0.0; N]; D],
            far: [[0.0; N]; D],
            inverse: [[0.0; N]; D],
            limits: [f32::NEG_INFINITY; N],
            beam: [View::default(); D],
            scale: frame.scale,
            skipped: [0.0; N],
        };
        for k in 0..D {
            let view = lead.view(k);
            bundle.first[k] = usize::from(lead.slope[k] < 0.0);
            bundle.beam[k] = view;
            bundle.near[k] = [view.near; N];
            bundle.far[k] = [view.far; N];
            bundle.inverse[k] = [view.near_inverse; N];
        }
        bundle.skipped[0] = lead.skipped - lead.slack;
        bundle
    }

    fn add(&mut self, ray: usize, start: &Start<D>) {
        for k in 0..D {
            let view = start.view(k);
            self.beam[k] = self.beam[k].with(&view, self.first[k] == 1);
            self.near[k][ray] = view.near;
            self.far[k][ray] = view.far;
            self.inverse[k][ray] = view.near_inverse;
        }
        self.skipped[ray] = start.skipped - start.slack;
    }

    /// The distance beyond which nothing matters to any ray.
    #[inline]
    pub fn limit(&self) -> f32 {
        self.limits.iter().fold(
            f32::NEG_INFINITY,
            |most, l| if *l > most { *l } else { most },
        )
    }

    /// From now on nothing beyond a depth matters to a ray.
    #[inline]
    pub fn set_limit(&mut self, ray: usize, depth: f64) {
        self.limits[ray] = above(depth * self.scale - self.skipped[ray]);
    }

    /// The distances at which the beam enters the boxes of a node, and whether it does.
    #[inline]
    pub fn enters(&self, node: &Wide<D>, limit: f32) -> ([f32; WIDTH], [bool; WIDTH]) {
        let mut from = [0.0f32; WIDTH];
        let mut to = [limit; WIDTH];
        for k in 0..D {
            let (near, far) = (
                &node.bounds[self.first[k]][k],
                &node.bounds[1 - self.first[k]][k],
            );
            let view = &self.beam[k];
            for i in 0..WIDTH {
                let enter = (near[i] - view.near) * view.near_inverse;
                let leave = (far[i] - view.far) * view.far_inverse;
                from[i] = if enter > from[i] { enter } else { from[i] };
                to[i] = if leave < to[i] { leave } else { to[i] };
            }
        }
        let mut enters = [false; WIDTH];
        for i in 0..WIDTH {
            enters[i] = from[i] <= to[i];
        }
        (from, enters)
    }

    /// Mark the rays that enter a box of a node.
    #[inline]
    pub fn entering(&self, node: &Wide<D>, lane: usize) -> [bool; N] {
        let mut from = [0.0f32; N];
        let mut to = self.limits;
        for k in 0..D {
            let (low, high) = (
                node.bounds[self.first[k]][k][lane],
                node.bounds[1 - self.first[k]][k][lane],
            );
            for i in 0..N {
                let enter = (low - self.near[k][i]) * self.inverse[k][i];
                let leave = (high - self.far[k][i]) * self.inverse[k][i];
                from[i] = if enter > from[i] { enter } else { from[i] };
                to[i] = if leave < to[i] { leave } else { to[i] };
            }
        }
        let mut enters = [false; N];
        for i in 0..N {
            enters[i] = from[i] <= to[i];
        }
        enters
    }
}
