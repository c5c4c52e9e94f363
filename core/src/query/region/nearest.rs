//! Finds the nearest point on many segments of the plane, in doubles.

use std::cmp::Ordering;

use crate::arith::convert::as_whole;
use crate::interrupt::poll;

type Point = [f64; 2];

/// Segments of the plane in a hierarchy of boxes, for finding the nearest point.
#[derive(Debug)]
pub struct Nearest {
    /// The segments, sorted along a space-filling curve, each with its number in the input.
    segments: Vec<(usize, [Point; 2])>,
    /// The boxes of each level, each around [`ITEMS_PER_BOX`] items of the level below, from the segments
    /// up.
    levels: Vec<Vec<Extent>>,
}

/// The number of segments, or of smaller boxes, in one box of the hierarchy.
const ITEMS_PER_BOX: usize = 8;

/// The number of steps of the space-filling curve along each axis.
const CURVE_STEPS: f64 = 65_535.0;

/// A box is skipped only if it is farther than the best point by more than the rounding of doubles.
const SLACK: f64 = 1.0 - 8.0 * f64::EPSILON;

#[derive(Clone, Copy, Debug)]
struct Extent {
    low: Point,
    high: Point,
}

impl Nearest {
    /// Builds the hierarchy of boxes over segments.
    pub fn of(segments: Vec<[Point; 2]>) -> Self {
        let all = Extent::around(segments.iter().map(Extent::of));
        let mut segments: Vec<_> = segments.into_iter().enumerate().collect();
        segments.sort_by_cached_key(|(_, segment)| all.place(segment));
        let boxes: Vec<Extent> = segments
            .iter()
            .map(|(_, segment)| Extent::of(segment))
            .collect();
        let mut levels = vec![grouped(&boxes)];
        while let Some(last) = levels.last().filter(|level| level.len() > 1) {
            levels.push(grouped(last));
        }
        Self { segments, levels }
    }

    /// Returns the point of all segments nearest to `point`; of several, the one on the first segment.
    pub fn to(&self, point: Point) -> Option<Point> {
        let mut best = (f64::INFINITY, usize::MAX, None);
        let mut pending: Vec<(f64, usize, usize)> = vec![(0.0, self.levels.len(), 0)];
        while let Some((bound, level, place)) = pending.pop() {
            poll();
            if bound * SLACK > best.0 {
                continue;
            }
            let Some(below) = level.checked_sub(1) else {
                self.look(place, point, &mut best);
                continue;
            };
            let first = pending.len();
            let places = ITEMS_PER_BOX * place..ITEMS_PER_BOX * place + ITEMS_PER_BOX;
            let boxes = places.filter_map(|i| Some((i, self.levels[below].get(i)?)));
            pending.extend(boxes.map(|(i, b)| (b.distance(point), below, i)));
            pending[first..].sort_by(|a, b| b.0.total_cmp(&a.0));
        }
        best.2
    }

    /// Compares the segments in a box of the lowest level with the best point.
    fn look(&self, place: usize, point: Point, best: &mut (f64, usize, Option<Point>)) {
        for (number, segment) in self
            .segments
            .iter()
            .skip(ITEMS_PER_BOX * place)
            .take(ITEMS_PER_BOX)
        {
            let foot = foot(point, segment);
            let distance = squared(point, foot);
            let closer = distance.total_cmp(&best.0).then(number.cmp(&best.1));
            if closer == Ordering::Less {
                *best = (distance, *number, Some(foot));
            }
        }
    }
}

/// Returns a box around each group of [`ITEMS_PER_BOX`] boxes.
fn grouped(boxes: &[Extent]) -> Vec<Extent> {
    boxes
        .chunks(ITEMS_PER_BOX)
        .map(|some| Extent::around(some.iter().copied()))
        .collect()
}

impl Extent {
    fn of(segment: &[Point; 2]) -> Self {
        let [p, q] = segment;
        Self {
            low: [p[0].min(q[0]), p[1].min(q[1])],
            high: [p[0].max(q[0]), p[1].max(q[1])],
        }
    }

    fn around(boxes: impl Iterator<Item = Self>) -> Self {
        let nothing = Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        boxes.fold(nothing, |a, b| Self {
            low: [a.low[0].min(b.low[0]), a.low[1].min(b.low[1])],
            high: [a.high[0].max(b.high[0]), a.high[1].max(b.high[1])],
        })
    }

    /// Returns the index of a segment's middle on a space-filling curve through this box.
    fn place(&self, [p, q]: &[Point; 2]) -> u64 {
        let step = |axis: usize| {
            let size = self.high[axis] - self.low[axis];
            let part = (p[axis] / 2.0 + q[axis] / 2.0 - self.low[axis]) / size;
            as_whole(part.clamp(0.0, 1.0) * CURVE_STEPS).unsigned_abs()
        };
        let (x, y) = (step(0), step(1));
        (0..16).fold(0, |place, bit| {
            place | (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1)
        })
    }

    /// The squared distance of a point from the box.
    fn distance(&self, point: Point) -> f64 {
        let gap = |i: usize| {
            (self.low[i] - point[i])
                .max(point[i] - self.high[i])
                .max(0.0)
        };
        gap(0) * gap(0) + gap(1) * gap(1)
    }
}

fn squared(p: Point, q: Point) -> f64 {
    (p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1])
}

/// The point of a segment that is nearest to `point`.
fn foot(point: Point, [p, q]: &[Point; 2]) -> Point {
    let along = [q[0] - p[0], q[1] - p[1]];
    let length = squared(*p, *q);
    let part =
        |from: Point| ((point[0] - from[0]) * along[0] + (point[1] - from[1]) * along[1]) / length;
    let moved = |from: Point, t: f64| [from[0] + t * along[0], from[1] + t * along[1]];
    let t = part(*p);
    if t <= 0.0 || length == 0.0 {
        return *p;
    }
    if t >= 1.0 {
        return *q;
    }
    // On a segment far longer than its distance, the first quotient has an error of the rounding of the
    // length.
    let near = moved(*p, t);
    moved(near, part(near))
}
