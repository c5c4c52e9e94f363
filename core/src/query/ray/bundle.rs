//! Bundles of similar rays, in single precision: a conservative test of which boxes they meet.
//!
//! # Error
//! The frame maps a scene into [−1, 1] on each axis. A ray is taken from where it enters this interval on its
//! main axis. So it meets the scene only at main distances t from 0 to 2, and moves by at most t on each
//! axis. Let u = 2^-24. The distance of a box's plane is a difference times an inverse that was rounded once:
//! its relative error is below 4u, as if the plane had moved by 8u < 2^-21. An inverse that is cut at
//! [`MAX_INVERSE_SLOPE`] moves the ray by 2·2^-40. The start is found in doubles, with an error below 2^-49
//! of its distance from the origin. The slack of [`Starts::views`] exceeds the sum of these errors and of
//! rounding to single precision. So a ray that meets a box passes the test of each slab, which tries all
//! starts within the slack.

use super::cell::{above, Frame};
use super::line::{Near, Ray};
use super::treelet::{Wide, CHILDREN_PER_NODE};

/// The largest inverse of a slope; larger ones are replaced by it.
const MAX_INVERSE_SLOPE: f64 = (1u64 << 40) as f64;

/// The constant part of the slack of a ray's start.
const START_SLACK: f64 = 1.0 / (1u64 << 20) as f64;

/// The slack of a ray's start per unit of its distance from the origin.
const SLACK_PER_WAY: f64 = 1.0 / (1u64 << 49) as f64;

/// A bound on the error of rounding a coordinate in the frame to single precision, relative to the
/// coordinate.
const NARROWING: f64 = 1.0 / (1u64 << 23) as f64;

/// Up to `N` rays, each from the point where it enters the interval [−1, 1] on its main axis, in a frame that
/// maps the scene into this interval on each axis.
struct Starts<const D: usize, const N: usize> {
    at: [[f64; N]; D],
    slope: [[f64; N]; D],
    /// The distances, along the main axis, of the starts from the rays' origins.
    skipped: [f64; N],
    slack: [f64; N],
}

impl<const D: usize, const N: usize> Starts<D, N> {
    /// Takes 1 to `N` rays, with the main axis and the signs of the first ray; lanes without a ray repeat the
    /// first ray.
    #[inline]
    fn of(rays: &[Ray<D>], frame: &Frame<D>) -> Self {
        let lead = &rays[0].near;
        let (mut at, mut slope) = ([[0.0; N]; D], [[0.0; N]; D]);
        for i in 0..N {
            let near = rays.get(i).map_or(lead, |ray| &ray.near);
            for k in 0..D {
                at[k][i] = frame.inward(k, near.origin[k]);
                slope[k][i] = near.shear[k] * near.heading;
            }
        }
        let (mut skipped, mut far) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let gap = -1.0 - lead.heading * at[lead.main][i];
            skipped[i] = if gap > 0.0 { gap } else { 0.0 };
            far[i] = skipped[i];
        }
        for k in 0..D {
            for i in 0..N {
                let size = at[k][i].abs();
                far[i] = if size > far[i] { size } else { far[i] };
                at[k][i] += slope[k][i] * skipped[i];
            }
        }
        let mut slack = [0.0; N];
        for i in 0..N {
            slack[i] = START_SLACK + SLACK_PER_WAY * far[i];
        }
        Self {
            at,
            slope,
            skipped,
            slack,
        }
    }

    /// Bounds how much the rays differ on an axis, between their starts and one unit farther.
    #[inline]
    fn spread(&self, axis: usize) -> f64 {
        let range = |of: &[f64; N]| {
            let (mut low, mut high) = (of[0], of[0]);
            for c in of {
                low = if *c < low { *c } else { low };
                high = if *c > high { *c } else { high };
            }
            high - low
        };
        range(&self.at[axis]) + range(&self.slope[axis])
    }

    /// Returns, for each ray, the start for near sides of boxes, the start for far sides, and the inverse
    /// slope on an axis; the two starts bound all points within the slack of the true start.
    #[inline]
    fn views(&self, axis: usize) -> [[f32; N]; 3] {
        let backward = self.slope[axis][0] < 0.0;
        let steepest = if backward {
            -MAX_INVERSE_SLOPE
        } else {
            MAX_INVERSE_SLOPE
        };
        // Seen from behind the start, near planes are nearer and far planes farther.
        let sign = if backward { -1.0 } else { 1.0 };
        let (mut near, mut far, mut inverse) = ([0.0; N], [0.0; N], [0.0; N]);
        for i in 0..N {
            let (at, slope) = (self.at[axis][i], self.slope[axis][i]);
            let slack = (self.slack[i] + at.abs() * NARROWING) * sign;
            let steep = slope.abs() * MAX_INVERSE_SLOPE < 1.0;
            near[i] = (at + slack) as f32;
            far[i] = (at - slack) as f32;
            inverse[i] = (if steep { steepest } else { 1.0 / slope }) as f32;
        }
        [near, far, inverse]
    }
}

/// Returns true if two rays have the same main axis and slopes of the same signs.
#[inline]
fn alike<const D: usize>(a: &Ray<D>, b: &Ray<D>) -> bool {
    let (a, b) = (&a.near, &b.near);
    let falls = |near: &Near<D>, k: usize| near.shear[k] * near.heading < 0.0;
    a.main == b.main && (0..D).all(|k| falls(a, k) == falls(b, k))
}

/// A bundle's bounds along an axis: its starts for near planes and for far planes of boxes, and its inverse
/// slopes.
#[derive(Clone, Copy, Debug, Default)]
struct View {
    near: f32,
    near_inverse: f32,
    far: f32,
    far_inverse: f32,
}

impl View {
    /// Bounds the starts and inverse slopes of all rays of a bundle along an axis.
    #[inline]
    fn around<const N: usize>([near, far, inverse]: &[[f32; N]; 3], backward: bool) -> Self {
        let (late, early): (Choice<N>, Choice<N>) = if backward {
            (least, most)
        } else {
            (most, least)
        };
        Self {
            near: late(near),
            near_inverse: early(inverse),
            far: early(far),
            far_inverse: late(inverse),
        }
    }
}

type Choice<const N: usize> = fn(&[f32; N]) -> f32;

#[inline]
fn least<const N: usize>(of: &[f32; N]) -> f32 {
    of.iter().fold(of[0], |a, b| if *b < a { *b } else { a })
}

#[inline]
fn most<const N: usize>(of: &[f32; N]) -> f32 {
    of.iter().fold(of[0], |a, b| if *b > a { *b } else { a })
}

/// Up to `N` similar rays with directions in one octant, and a beam that contains the rays.
#[derive(Clone, Debug)]
pub struct Bundle<const D: usize, const N: usize> {
    /// For each axis the side of a box that rays meet first: 1, the high side, if slopes are negative.
    first: [usize; D],
    /// By axis: the starts for near planes, the starts for far planes, and the inverse slopes.
    views: [[[f32; N]; 3]; D],
    /// For each ray, the distance after which boxes are no longer visited.
    limits: [f32; N],
    beam: [View; D],
    scale: f64,
    skipped: [f64; N],
}

impl<const D: usize, const N: usize> Bundle<D, N> {
    /// Makes the bundle of 1 to `N` rays, each with the depth after which boxes are no longer visited for it;
    /// `None` if the octants or main axes of the rays differ, or the rays are more than `width` apart.
    #[inline]
    pub fn of(
        rays: &[Ray<D>],
        frame: &Frame<D>,
        width: f64,
        depth: impl Fn(usize) -> f64,
    ) -> Option<Self> {
        let (lead, others) = rays.split_first()?;
        if !others.iter().all(|ray| alike(lead, ray)) {
            return None;
        }
        let starts = Starts::of(rays, frame);
        if N > 1 && !(0..D).all(|k| starts.spread(k) <= width) {
            return None;
        }
        let mut bundle = Self::seen(&starts, frame);
        for i in 0..rays.len() {
            bundle.set_limit(i, depth(i));
        }
        Some(bundle)
    }

    #[inline]
    fn seen(starts: &Starts<D, N>, frame: &Frame<D>) -> Self {
        let mut bundle = Self {
            first: [0; D],
            views: [[[0.0; N]; 3]; D],
            limits: [f32::NEG_INFINITY; N],
            beam: [View::default(); D],
            scale: frame.scale,
            skipped: [0.0; N],
        };
        for k in 0..D {
            let backward = starts.slope[k][0] < 0.0;
            bundle.first[k] = usize::from(backward);
            bundle.views[k] = starts.views(k);
            bundle.beam[k] = View::around(&bundle.views[k], backward);
        }
        for i in 0..N {
            bundle.skipped[i] = starts.skipped[i] - starts.slack[i];
        }
        bundle
    }

    /// The largest distance, over all rays, after which boxes are no longer visited.
    #[inline]
    pub fn limit(&self) -> f32 {
        self.limits.iter().fold(
            f32::NEG_INFINITY,
            |most, l| if *l > most { *l } else { most },
        )
    }

    /// Sets the depth after which boxes are no longer visited for a ray.
    #[inline]
    pub fn set_limit(&mut self, ray: usize, depth: f64) {
        self.limits[ray] = above(depth * self.scale - self.skipped[ray]);
    }

    /// Returns, for each box of a node, the distance at which the bundle enters the box, and whether the
    /// bundle enters it at all.
    #[inline]
    pub fn enters(
        &self,
        node: &Wide<D>,
        limit: f32,
    ) -> ([f32; CHILDREN_PER_NODE], [bool; CHILDREN_PER_NODE]) {
        let mut from = [0.0f32; CHILDREN_PER_NODE];
        let mut to = [limit; CHILDREN_PER_NODE];
        for k in 0..D {
            let (near, far) = (
                &node.bounds[self.first[k]][k],
                &node.bounds[1 - self.first[k]][k],
            );
            let view = &self.beam[k];
            for i in 0..CHILDREN_PER_NODE {
                let enter = (near[i] - view.near) * view.near_inverse;
                let leave = (far[i] - view.far) * view.far_inverse;
                from[i] = if enter > from[i] { enter } else { from[i] };
                to[i] = if leave < to[i] { leave } else { to[i] };
            }
        }
        let mut enters = [false; CHILDREN_PER_NODE];
        for i in 0..CHILDREN_PER_NODE {
            enters[i] = from[i] <= to[i];
        }
        (from, enters)
    }

    /// Returns for each ray whether it enters the box in a lane of a node.
    #[inline]
    pub fn entering(&self, node: &Wide<D>, lane: usize) -> [bool; N] {
        let mut from = [0.0f32; N];
        let mut to = self.limits;
        for k in 0..D {
            let (low, high) = (
                node.bounds[self.first[k]][k][lane],
                node.bounds[1 - self.first[k]][k][lane],
            );
            let [near, far, inverse] = &self.views[k];
            for i in 0..N {
                let enter = (low - near[i]) * inverse[i];
                let leave = (high - far[i]) * inverse[i];
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
