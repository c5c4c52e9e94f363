//! Separates many long triangles by clipping them to small cells.
//!
//! The box of a long thin triangle (a needle) overlaps the boxes of many elements around it, so halving space
//! does not separate them. But a needle crosses few of the cells in its box, and its fragment in a cell has a
//! small box. Cells are turned with the needles, because boxes along a needle are smaller than boxes across
//! it.

use super::boxes::{BoxedElement, HalfOpenBox};
use super::clip::part_within;
use super::BoundedElement;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::vector::{cross, dot, unit};
use crate::geometry::doubles::{Point, Triangle};
use crate::interrupt::spend;

/// The padding of turned coordinates, as a share of the largest one; far above their rounding errors.
const SLACK: f64 = 1e-14;

/// The largest absolute value of a scaled coordinate.
const MAX_SCALED: f64 = 1_073_741_824.0;

/// The most fragments in a cell that are compared all with all; dividing the cell of fewer fragments costs
/// about as much.
const MAX_FRAGMENTS_COMPARED: usize = 64;

/// The number of equal intervals into which the candidate coordinates divide each axis of a cell.
const INTERVALS_PER_AXIS: usize = 16;

/// A division of a cell separates elements (triangles or parts of faces) if both parts together have at most
/// this share of the cell's pairs.
const MAX_SHARE_OF_PAIRS: f64 = 7.0 / 8.0;

/// The number of consecutive divisions that may separate nothing; a part with at most half of the pairs
/// starts the count again. Near the corner of a fan of needles (long thin triangles), dividing on one axis
/// leaves all needles on both sides, and dividing on another axis then separates them from other elements.
///
/// No division increases the number of pairs, so there are never more fragments than pairs.
const MAX_VAIN_DIVISIONS: u32 = 2;

/// The elements (triangles or parts of faces) that cells are to separate, and the cells still to be divided.
pub struct Crowd {
    /// For each element (a triangle or part of a face) the corners of its triangle, if known, turned and
    /// scaled.
    corners: Vec<Option<Triangle>>,
    /// A bound on the error of clipping.
    slack: f64,
    open: Vec<Fragments>,
}

/// Three perpendicular directions, and a factor that scales coordinates along them.
struct Frame {
    directions: [Point; 3],
    scale: f64,
}

/// The fragments of elements (triangles or parts of faces) in a cell, grouped by operand.
pub struct Fragments {
    /// The fragments' boxes, numbered by the index of the element (a triangle or part of a face).
    pub elements: Vec<BoxedElement>,
    pub half_open_box: HalfOpenBox,
    /// The number of consecutive further divisions that may separate nothing.
    patience: u32,
}

/// A candidate for dividing a cell: a coordinate `at` on an axis.
struct Division {
    axis: usize,
    at: i32,
    /// The numbers of pairs of fragments of different operands that reach below the coordinate, and above it.
    pairs: [f64; 2],
}

impl Division {
    /// Returns the sum of the numbers of pairs on both sides.
    fn remaining_pairs(&self) -> f64 {
        self.pairs[0] + self.pairs[1]
    }
}

impl Crowd {
    /// Starts the separation of elements (triangles or parts of faces), which are grouped by operand.
    pub fn of(elements: &[BoundedElement]) -> Self {
        let frame = Frame::along(elements);
        let corners: Vec<Option<Triangle>> = elements.iter().map(|e| frame.corners(e)).collect();
        let boxed = (0..)
            .zip(elements)
            .map(|(number, e)| frame.boxed(number, e));
        let boxed: Vec<BoxedElement> = boxed.collect();
        let coordinates = corners.iter().flatten().flatten().flatten();
        let size = coordinates.fold(MAX_SCALED, |most, x| most.max(x.abs()));
        let crowd = Self {
            corners,
            slack: SLACK * size,
            open: Vec::new(),
        };
        let half_open_box = HalfOpenBox::around(&boxed);
        let clipped = boxed
            .iter()
            .filter_map(|e| crowd.fragment(e, &half_open_box));
        let whole = Fragments {
            elements: clipped.collect(),
            half_open_box,
            patience: MAX_VAIN_DIVISIONS,
        };
        Self {
            open: vec![whole],
            ..crowd
        }
    }

    /// Clips the fragment `of` an element (a triangle or part of a face) to the smaller cell `half_open_box`;
    /// `None` if nothing is left.
    fn fragment(&self, of: &BoxedElement, half_open_box: &HalfOpenBox) -> Option<BoxedElement> {
        let Some(corners) = &self.corners[of.number as usize] else {
            return Some(*of);
        };
        let (low, high) = half_open_box.ends();
        // A cell contains the points from the lattice point after its low end to the one after its high end.
        let low = low.map(|x| f64::from(x) + 1.0 - self.slack);
        let high = high.map(|x| f64::from(x) + 1.0 + self.slack);
        let [low, high] = part_within(corners, &[low, high])?;
        of.within(
            low.map(|x| as_coordinate(x - self.slack)),
            high.map(|x| as_coordinate(x + self.slack)),
        )
    }

    /// Divides a cell at the candidate coordinate that leaves the fewest pairs, and clips the fragments;
    /// `None` if dividing does not pay.
    fn divide(&self, whole: &Fragments) -> Option<[Fragments; 2]> {
        let candidates = (0..3).flat_map(|axis| whole.divisions(axis));
        let best = candidates.min_by(|a, b| a.remaining_pairs().total_cmp(&b.remaining_pairs()))?;
        let Division { axis, at, .. } = best;
        let fragment = |e: &BoxedElement, half_open_box: &HalfOpenBox| {
            let crosses = e.is_below(axis, at) && e.is_above(axis, at);
            if crosses {
                self.fragment(e, half_open_box)
            } else {
                Some(*e)
            }
        };
        let part = |half_open_box: HalfOpenBox,
                    patience: u32,
                    reaches: fn(&BoxedElement, usize, i32) -> bool| {
            let own = whole.elements.iter().filter(|e| reaches(e, axis, at));
            Fragments {
                elements: own.filter_map(|e| fragment(e, &half_open_box)).collect(),
                half_open_box,
                patience,
            }
        };
        let patience = whole.patience_after(&best)?;
        let [below, above] = whole.half_open_box.divided(axis, at);
        Some([
            part(below, patience[0], BoxedElement::is_below),
            part(above, patience[1], BoxedElement::is_above),
        ])
    }
}

impl Frame {
    /// The frame whose first direction is that of the longest edge of all elements (triangles or parts of
    /// faces). Its third direction is perpendicular to this edge and to the edge that makes the largest
    /// product with it. The scale makes turned coordinates fit into 31 bits.
    fn along(elements: &[BoundedElement]) -> Self {
        let corners = elements.iter().filter_map(|e| e.corners.as_ref());
        let edges: Vec<Point> = corners.map(longest_edge).collect();
        let greatest = |size: &dyn Fn(&Point) -> f64| {
            let larger = |u: &&Point, v: &&Point| size(u).total_cmp(&size(v));
            edges.iter().max_by(larger).copied().unwrap_or_default()
        };
        let long = greatest(&|edge| dot(edge, edge));
        let other = greatest(&|edge| {
            let across = cross(&long, edge);
            dot(&across, &across)
        });
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let turned = unit(&long).zip(unit(&cross(&long, &other)));
        let directions = turned.map_or(axes, |(u, w)| [u, cross(&w, &u), w]);
        let ends = elements.iter().flat_map(|e| [e.low, e.high]).flatten();
        // Turned coordinates are at most √3 times as large.
        let size = 2.0 * as_double(ends.fold(1, |most, x| x.abs().max(most)));
        Self {
            directions,
            scale: MAX_SCALED / size,
        }
    }

    fn turned(&self, point: &Point) -> Point {
        self.directions.map(|d| dot(point, &d) * self.scale)
    }

    fn corners(&self, element: &BoundedElement) -> Option<Triangle> {
        element
            .corners
            .map(|corners| corners.map(|p| self.turned(&p)))
    }

    /// Returns the turned and scaled box around the box of an element (a triangle or part of a face).
    fn boxed(&self, number: u32, element: &BoundedElement) -> BoxedElement {
        let low = element.low.map(as_double);
        // Coordinates may be rounded down.
        let high = element.high.map(|x| as_double(x) + 1.0);
        let end = |direction: &Point, towards: [&Point; 2]| {
            let at = |i: usize| towards[usize::from(direction[i] > 0.0)][i];
            dot(direction, &each_axis(at)) * self.scale
        };
        let low_end = self
            .directions
            .map(|d| as_coordinate(end(&d, [&high, &low])) - 1);
        let high_end = self
            .directions
            .map(|d| as_coordinate(end(&d, [&low, &high])) + 1);
        BoxedElement::between(as_number(element.operand), number, low_end, high_end)
    }
}

fn longest_edge(corners: &Triangle) -> Point {
    let edge = |i: usize| each_axis(|k| corners[(i + 1) % 3][k] - corners[i][k]);
    let longer = |a: &Point, b: &Point| dot(a, a).total_cmp(&dot(b, b));
    (0..3).map(edge).max_by(longer).unwrap_or_default()
}

impl Iterator for Crowd {
    type Item = Fragments;

    /// Returns the fragments in the next cell that is not worth dividing. Any two elements (triangles or
    /// parts of faces) of different operands that meet have fragments with overlapping boxes in one of these
    /// cells.
    fn next(&mut self) -> Option<Fragments> {
        while let Some(whole) = self.open.pop() {
            spend(whole.elements.len());
            if whole.are_of_one_operand() {
                continue;
            }
            let is_crowded = whole.elements.len() > MAX_FRAGMENTS_COMPARED;
            match is_crowded.then(|| self.divide(&whole)).flatten() {
                Some(parts) => self.open.extend(parts),
                None => return Some(whole),
            }
        }
        None
    }
}

impl Fragments {
    /// Returns the patience (the number of further divisions that may separate nothing) of the two parts of a
    /// cell; `None` if the cell must not be divided there.
    fn patience_after(&self, division: &Division) -> Option<[u32; 2]> {
        let before = self.pairs();
        if division.remaining_pairs() <= MAX_SHARE_OF_PAIRS * before {
            return Some([MAX_VAIN_DIVISIONS; 2]);
        }
        let remaining = self.patience.checked_sub(1);
        let remaining = remaining.filter(|_| division.remaining_pairs() <= before)?;
        let of_part = |own: f64| {
            if 2.0 * own <= before {
                MAX_VAIN_DIVISIONS
            } else {
                remaining
            }
        };
        Some(division.pairs.map(of_part))
    }

    fn are_of_one_operand(&self) -> bool {
        let [first, last] = [self.elements.first(), self.elements.last()];
        first.map(|e| e.operand) == last.map(|e| e.operand)
    }

    /// Returns the number of pairs of fragments of different operands.
    fn pairs(&self) -> f64 {
        let mut all = Tally::default();
        self.runs().for_each(|run| all.add(run.iter().map(|_| 0)));
        all.pairs()[0]
    }

    /// Returns the fragments of each operand as a slice.
    fn runs(&self) -> impl Iterator<Item = &[BoxedElement]> {
        self.elements.chunk_by(|a, b| a.operand == b.operand)
    }

    /// Returns the candidate coordinates for dividing the cell on an axis, with the numbers of pairs on both
    /// sides.
    fn divisions(&self, axis: usize) -> impl Iterator<Item = Division> + use<> {
        let (low, high) = self.half_open_box.ends();
        let (low, length) = (low[axis], high[axis] - low[axis]);
        let scale = as_double(INTERVALS_PER_AXIS) / f64::from(length);
        let first_from = |x: i32| as_index((f64::from(x - low) * scale).ceil());
        let (mut below, mut above) = (Tally::default(), Tally::default());
        for run in self.runs() {
            let ends = || run.iter().map(BoxedElement::ends);
            below.add(ends().map(|(low, _)| first_from(low[axis])));
            above.add(ends().map(|(_, high)| INTERVALS_PER_AXIS - first_from(high[axis])));
        }
        let (below, above) = (below.pairs(), above.pairs());
        (1..INTERVALS_PER_AXIS).filter_map(move |k| {
            let at = low + as_coordinate(as_double(k) / scale);
            let pairs = [below[k], above[INTERVALS_PER_AXIS - 1 - k]];
            let is_inside = low < at && at < low + length;
            is_inside.then_some(Division { axis, at, pairs })
        })
    }
}

/// Counts of the elements (triangles or parts of faces) between one end of a cell's axis and each coordinate
/// at which the cell may be divided, from which the numbers of pairs follow.
#[derive(Default)]
struct Tally {
    /// For each coordinate at which a cell may be divided, the increase of the number of elements (triangles
    /// or parts of faces) from the previous coordinate to this one.
    more: [f64; INTERVALS_PER_AXIS + 1],
    /// For each coordinate at which a cell may be divided, the increase, from the previous coordinate, of the
    /// sum of the squares of the operands' numbers of elements (triangles or parts of faces).
    more_squares: [f64; INTERVALS_PER_AXIS + 1],
}

impl Tally {
    /// Adds the elements (triangles or parts of faces) of one operand, given for each the index of the
    /// coordinate at which it begins.
    fn add(&mut self, candidates: impl Iterator<Item = usize>) {
        let mut own = [0.0; INTERVALS_PER_AXIS + 1];
        candidates.for_each(|place| own[place] += 1.0);
        let mut before = 0.0;
        for (k, more) in own.into_iter().enumerate() {
            self.more[k] += more;
            self.more_squares[k] += (2.0 * before + more) * more;
            before += more;
        }
    }

    /// Returns for each coordinate at which a cell may be divided the number of pairs of elements (triangles
    /// or parts of faces) of different operands between it and the end of the axis at which counting began.
    fn pairs(&self) -> [f64; INTERVALS_PER_AXIS + 1] {
        let (mut count, mut squares) = (0.0, 0.0);
        std::array::from_fn(|k| {
            count += self.more[k];
            squares += self.more_squares[k];
            (count * count - squares) / 2.0
        })
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "places in a cell fit as its ends do"
)]
fn as_coordinate(x: f64) -> i32 {
    x.floor() as i32
}

/// Returns the index of a candidate coordinate, clamped to the ends of the axis.
#[allow(
    clippy::cast_sign_loss,
    clippy::cast_possible_truncation,
    reason = "the cast saturates"
)]
fn as_index(x: f64) -> usize {
    (x as usize).min(INTERVALS_PER_AXIS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_whole;

    /// A disc of needles from one corner to an arc of short walls; the needles are operand 0, and each wall
    /// is an operand of its own.
    fn disc(sides: u32) -> Vec<BoundedElement> {
        let corner = |k: u32| {
            let (y, x) = (f64::from(k) / f64::from(sides) * std::f64::consts::PI).sin_cos();
            [x, y, 0.0].map(|x| (x * 1e6).round() + 1e6)
        };
        let bounded = |operand: usize, corners: Triangle| {
            let end = |i: usize, most: fn(f64, f64) -> f64| {
                as_whole(most(corners[0][i], most(corners[1][i], corners[2][i])))
            };
            BoundedElement {
                operand,
                low: each_axis(|i| end(i, f64::min)),
                high: each_axis(|i| end(i, f64::max)),
                corners: Some(corners),
            }
        };
        let needle = |k: u32| bounded(0, [corner(0), corner(k), corner(k + 1)]);
        let wall = |k: u32| {
            let [x, y, _] = corner(k);
            bounded(k as usize, [corner(k), corner(k + 1), [x, y, 2e6]])
        };
        let needles = (1..sides).map(needle);
        needles.chain((1..sides).map(wall)).collect()
    }

    /// Twice as many needles and walls have about twice as many pairs in cells.
    #[test]
    fn needles_come_apart_from_walls_at_their_ends() {
        let pairs = |sides: u32| {
            Crowd::of(&disc(sides))
                .map(|cell| cell.pairs())
                .sum::<f64>()
        };
        let (half, whole) = (pairs(2000), pairs(4000));
        assert!(whole < 3.0 * half && whole < 1e6, "{half} {whole}");
    }

    #[test]
    fn those_with_a_common_corner_are_in_one_cell() {
        let bounded = disc(500);
        let cells: Vec<Fragments> = Crowd::of(&bounded).collect();
        let is_in =
            |cell: &Fragments, k: usize| cell.elements.iter().any(|e| e.number as usize == k);
        let needles = bounded.len() / 2;
        for k in 0..needles {
            assert!(
                cells
                    .iter()
                    .any(|cell| is_in(cell, k) && is_in(cell, needles + k)),
                "{k}"
            );
        }
    }
}
