//! Finds pairs of overlapping boxes by halving the space around them.

use std::cmp::Reverse;

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::interrupt::spend;

/// The most boxes that are compared all with all; halving the space of fewer boxes costs about as much.
const MAX_COMPARED: usize = 256;

/// The most boxes that are compared all with all if halving does not separate them; clipping fewer elements
/// to smaller cells costs about as much.
const MAX_COMPARED_UNSEPARATED: usize = 384;

/// The number of pairs of boxes compared per unit of work, after which the program checks whether to stop.
const PAIRS_PER_UNIT: usize = 16;

/// The number of boxes that are compared with one box at once.
const LANES: usize = 8;

/// A corner of a box, as 32-bit integers.
type Ends = [i32; 3];

/// A triangle, or a part of a face, with its box in 32-bit coordinates.
#[derive(Clone, Copy)]
pub struct BoxedElement {
    low: [i32; 3],
    high: [i32; 3],
    /// The index of the operand that the triangle or part belongs to.
    pub operand: u32,
    /// The number of the triangle or part, chosen by the caller.
    pub number: u32,
}

impl BoxedElement {
    /// Makes a triangle or part of a face with its operand's index, its number, and its box with `shift` low
    /// bits of each coordinate dropped.
    #[allow(clippy::cast_possible_truncation, reason = "the shift leaves 31 bits")]
    pub fn new(operand: usize, number: u32, [low, high]: [&Lattice; 2], shift: u32) -> Self {
        Self {
            low: each_axis(|i| (low[i] >> shift) as i32),
            high: each_axis(|i| (high[i] >> shift) as i32),
            operand: as_number(operand),
            number,
        }
    }

    /// Makes an element with its operand's index, its number, and the low and the high corner of its box.
    pub const fn between(operand: u32, number: u32, low: Ends, high: Ends) -> Self {
        Self {
            low,
            high,
            operand,
            number,
        }
    }

    /// Returns true if the boxes of two elements overlap.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// Returns the low and the high corner of the box.
    pub const fn ends(&self) -> (Ends, Ends) {
        (self.low, self.high)
    }

    /// Returns the triangle or part with its box clipped to the box from `low` to `high`; `None` if the boxes
    /// do not overlap.
    pub fn within(&self, low: Ends, high: Ends) -> Option<Self> {
        let part = Self {
            low: each_axis(|i| self.low[i].max(low[i])),
            high: each_axis(|i| self.high[i].min(high[i])),
            ..*self
        };
        let is_some = (0..3).all(|i| part.low[i] <= part.high[i]);
        is_some.then_some(part)
    }

    /// Returns true if the box begins at or below the coordinate `at` on an axis.
    pub const fn is_below(&self, axis: usize, at: i32) -> bool {
        self.low[axis] <= at
    }

    /// Returns true if the box extends above the coordinate `at` on an axis.
    pub const fn is_above(&self, axis: usize, at: i32) -> bool {
        self.high[axis] > at
    }
}

/// Returns how many low bits to drop so that coordinates of absolute value up to `size` fit into 31 bits with
/// their sign.
pub fn shift_of(size: u64) -> u32 {
    (u64::BITS - size.leading_zeros()).saturating_sub(30)
}

/// The lower and upper ends of `LANES` boxes by axis, to compare all of them with one box at once.
struct Lanes {
    low: [[i32; LANES]; 3],
    high: [[i32; LANES]; 3],
}

/// The elements (triangles or parts of faces) whose boxes reach into a box of space, grouped by operand.
pub struct ElementsInBox {
    elements: Vec<BoxedElement>,
    half_open_box: HalfOpenBox,
    /// The number of low bits dropped from the coordinates of the boxes.
    shift: u32,
}

/// The box of points with coordinates above `low` and up to `high`.
///
/// A pair of overlapping boxes belongs to the half-open box that contains the low corner of their
/// intersection, so that each pair is found in one half-open box only.
#[derive(Clone, Copy)]
pub struct HalfOpenBox {
    low: [i32; 3],
    high: [i32; 3],
}

/// Calls `report` for the pairs of elements (triangles or parts of faces) of different operands whose boxes
/// overlap, and returns the elements that halving does not separate, sorted by number; pairs of these are not
/// reported. Stops and returns `None` if `report` does.
pub fn crowded(
    part: ElementsInBox,
    mut report: impl FnMut(u32, u32) -> Option<()>,
) -> Option<Vec<BoxedElement>> {
    let mut crowded = Vec::new();
    part.halved(MAX_COMPARED, |part| {
        if part.elements.len() > MAX_COMPARED_UNSEPARATED {
            crowded.extend(part.elements);
            return Some(());
        }
        let half_open_box = part.half_open_box;
        compare_all(&part.elements, &half_open_box, |a, b| {
            half_open_box.if_pair_belongs(a, b, || report(a.number, b.number))
        })
    })?;
    Some(without_repetition(crowded))
}

/// Calls `report` for all pairs of elements (triangles or parts of faces) of different operands whose boxes
/// overlap, the earlier operand first. Compares all with all; stops and returns `None` if `report` does.
pub fn compare_all(
    elements: &[BoxedElement],
    half_open_box: &HalfOpenBox,
    mut report: impl FnMut(&BoxedElement, &BoxedElement) -> Option<()>,
) -> Option<()> {
    let operands = elements.chunk_by(|a, b| a.operand == b.operand).count();
    if 2 * operands > elements.len() {
        return compare_in_order(elements, half_open_box, report);
    }
    let lanes = Lanes::of(elements);
    let mut end = 0;
    for run in elements.chunk_by(|a, b| a.operand == b.operand) {
        let start = end;
        end += run.len();
        for one in &elements[start..end] {
            spend(1 + (elements.len() - end) / PAIRS_PER_UNIT);
            let mut goes_on = Some(());
            Lanes::each_overlapping(&lanes, end, one, |at| {
                let other = &elements[at];
                if goes_on.is_some() {
                    goes_on = report(one, other);
                }
            });
            goes_on?;
        }
    }
    Some(())
}

/// Calls `report` for all pairs of elements (triangles or parts of faces) of different operands whose boxes
/// overlap, the lower number first, where most operands have a single element. Sorts the boxes along the axis
/// on which they overlap least, and compares only those that overlap there.
fn compare_in_order(
    elements: &[BoxedElement],
    half_open_box: &HalfOpenBox,
    mut report: impl FnMut(&BoxedElement, &BoxedElement) -> Option<()>,
) -> Option<()> {
    let axis = half_open_box.sparsest(elements);
    let sorted = sorted_along(axis, elements);
    let lanes = Lanes::of(&sorted);
    for (next, one) in (1..).zip(&sorted) {
        let reached = sorted[next..].partition_point(|e| e.low[axis] <= one.high[axis]);
        spend(1 + reached / PAIRS_PER_UNIT);
        let mut goes_on = Some(());
        let reached = &lanes[..(next + reached).div_ceil(LANES)];
        Lanes::each_overlapping(reached, next, one, |at| {
            let other = &sorted[at];
            if goes_on.is_some() && one.operand != other.operand {
                let (a, b) = if one.number < other.number {
                    (one, other)
                } else {
                    (other, one)
                };
                goes_on = report(a, b);
            }
        });
        goes_on?;
    }
    Some(())
}

/// Returns the elements (triangles or parts of faces) sorted by the lower ends of their boxes on an axis.
fn sorted_along(axis: usize, elements: &[BoxedElement]) -> Vec<BoxedElement> {
    let begins = (0usize..).zip(elements).map(|(at, e)| (e.low[axis], at));
    let mut order: Vec<(i32, usize)> = begins.collect();
    order.sort_unstable();
    order.into_iter().map(|(_, at)| elements[at]).collect()
}

impl Lanes {
    /// Boxes that overlap no other box.
    const EMPTY: Self = Self {
        low: [[i32::MAX; LANES]; 3],
        high: [[i32::MIN; LANES]; 3],
    };

    /// Packs the boxes of elements (triangles or parts of faces) in order; empty boxes fill the last pack.
    fn of(elements: &[BoxedElement]) -> Vec<Self> {
        elements.chunks(LANES).map(Self::packed).collect()
    }

    fn packed(elements: &[BoxedElement]) -> Self {
        let mut lanes = Self::EMPTY;
        for (lane, e) in elements.iter().enumerate() {
            for i in 0..3 {
                lanes.low[i][lane] = e.low[i];
                lanes.high[i][lane] = e.high[i];
            }
        }
        lanes
    }

    /// Calls `found` with the indices, from `from` on, of the boxes that overlap the box of `one`.
    fn each_overlapping(
        all: &[Self],
        from: usize,
        one: &BoxedElement,
        mut found: impl FnMut(usize),
    ) {
        let first = from / LANES;
        for (block, lanes) in (first..).zip(&all[first.min(all.len())..]) {
            let missed = lanes.missed_by(one);
            if missed.iter().fold(!0, |all, one| all & one) == !0 {
                continue;
            }
            for (at, missed) in (block * LANES..).zip(&missed) {
                if *missed == 0 && at >= from {
                    found(at);
                }
            }
        }
    }

    /// Returns for each box a 32-bit word with all bits set if it misses the box of `one`, otherwise zero.
    /// Words as wide as the compared coordinates compile to vector instructions.
    #[inline]
    fn missed_by(&self, one: &BoxedElement) -> [u32; LANES] {
        let word = |b: bool| if b { !0u32 } else { 0 };
        let mut missed = [0; LANES];
        for i in 0..3 {
            for (lane, missed) in missed.iter_mut().enumerate() {
                *missed |= word(self.low[i][lane] > one.high[i]);
                *missed |= word(self.high[i][lane] < one.low[i]);
            }
        }
        missed
    }
}

impl HalfOpenBox {
    /// Returns the smallest space that contains the boxes of all elements (triangles or parts of faces).
    pub fn around(elements: &[BoxedElement]) -> Self {
        let low = |i: usize| elements.iter().map(|e| e.low[i]).min();
        let high = |i: usize| elements.iter().map(|e| e.high[i]).max();
        Self {
            low: each_axis(|i| low(i).map_or(0, |x| x - 1)),
            high: each_axis(|i| high(i).unwrap_or(0)),
        }
    }

    /// Returns the axis along which the boxes of elements (triangles or parts of faces) are shortest,
    /// relative to the space.
    fn sparsest(&self, elements: &[BoxedElement]) -> usize {
        let share = |i: usize| {
            let length = |e: &BoxedElement| f64::from(e.high[i]) - f64::from(e.low[i]);
            let size = f64::from(self.high[i]) - f64::from(self.low[i]);
            elements.iter().map(length).sum::<f64>() / size
        };
        let [x, y, z] = [0, 1, 2].map(share);
        if x <= y && x <= z {
            0
        } else {
            1 + usize::from(z < y)
        }
    }

    /// Returns the corner just below the lowest point of the space, and its highest point.
    pub const fn ends(&self) -> (Ends, Ends) {
        (self.low, self.high)
    }

    /// Returns the part of the space up to the coordinate `at` on an axis, and the part above it.
    pub const fn divided(&self, axis: usize, at: i32) -> [Self; 2] {
        let (mut below, mut above) = (*self, *self);
        below.high[axis] = at;
        above.low[axis] = at;
        [below, above]
    }

    /// Calls `report` if the pair of boxes belongs to this part of space, and returns its result; otherwise
    /// returns `Some(())`.
    fn if_pair_belongs(
        &self,
        a: &BoxedElement,
        b: &BoxedElement,
        report: impl FnOnce() -> Option<()>,
    ) -> Option<()> {
        if self.pair_belongs(a, b) {
            report()
        } else {
            Some(())
        }
    }

    /// Returns true if the low corner of the intersection of two boxes lies in this part of space.
    fn pair_belongs(&self, a: &BoxedElement, b: &BoxedElement) -> bool {
        (0..3).all(|i| {
            let corner = a.low[i].max(b.low[i]);
            self.low[i] < corner && corner <= self.high[i]
        })
    }
}

/// Returns the elements (triangles or parts of faces) sorted by number, without repetition.
fn without_repetition(mut elements: Vec<BoxedElement>) -> Vec<BoxedElement> {
    elements.sort_unstable_by_key(|e| e.number);
    elements.dedup_by_key(|e| e.number);
    elements
}

impl ElementsInBox {
    /// Makes a part of space around all elements (triangles or parts of faces), which must be grouped by
    /// operand; `shift` is the number of low bits dropped from their boxes.
    #[must_use]
    pub fn of(elements: Vec<BoxedElement>, shift: u32) -> Self {
        let half_open_box = HalfOpenBox::around(&elements);
        Self {
            elements,
            half_open_box,
            shift,
        }
    }

    /// Returns the number of low bits dropped from the coordinates of the boxes.
    #[must_use]
    pub const fn shift(&self) -> u32 {
        self.shift
    }

    /// Halves space into parts with at most `max_elements` elements (triangles or parts of faces) each, and
    /// adds one part with all elements that halving does not separate. Each pair of overlapping boxes belongs
    /// to one of the first parts, or is in the last one.
    #[must_use]
    pub fn divided(self, max_elements: usize) -> Vec<Self> {
        let shift = self.shift;
        let (mut parts, mut crowded) = (Vec::new(), Vec::new());
        let _ = self.halved(max_elements, |part| {
            if part.elements.len() <= max_elements {
                parts.push(part);
            } else {
                crowded.extend(part.elements);
            }
            Some(())
        });
        if !crowded.is_empty() {
            parts.push(Self::of(without_repetition(crowded), shift));
        }
        parts
    }

    /// Halves space, and calls `visit` for each part that has at most `max_elements` elements (triangles or
    /// parts of faces) or that halving does not separate; stops and returns `None` if `visit` does.
    fn halved(self, max_elements: usize, mut visit: impl FnMut(Self) -> Option<()>) -> Option<()> {
        let mut open = vec![self];
        while let Some(part) = open.pop() {
            spend(part.elements.len());
            let halved = part.elements.len() > max_elements && part.halve(&mut open);
            if !halved {
                visit(part)?;
            }
        }
        Some(())
    }

    /// Halves the space on an axis, and appends the halves with elements (triangles or parts of faces) of
    /// different operands to `open`. Returns false, without a change, if no axis separates the elements.
    ///
    /// It takes the longest axis that separates the elements: this is as good as the best one, and saves
    /// counting on all axes.
    fn halve(&self, open: &mut Vec<Self>) -> bool {
        let length = |i: usize| self.half_open_box.high[i] - self.half_open_box.low[i];
        let mut axes = [0, 1, 2];
        axes.sort_by_key(|i| Reverse(length(*i)));
        let wide = axes.into_iter().filter(|i| length(*i) > 1);
        let separates = |[few, many]: [usize; 2]| 4 * (few + many) <= 5 * self.elements.len();
        let mut counted = wide.map(|i| (i, self.counts(i)));
        let Some((axis, [few, many])) = counted.find(|c| separates(c.1)) else {
            return false;
        };
        let at = self.middle(axis);
        let [below, above] = self.half_open_box.divided(axis, at);
        self.push(below, few, |e| e.is_below(axis, at), open);
        self.push(above, many, |e| e.is_above(axis, at), open);
        true
    }

    fn middle(&self, axis: usize) -> i32 {
        self.half_open_box.low[axis].midpoint(self.half_open_box.high[axis])
    }

    /// Returns the numbers of elements (triangles or parts of faces) that reach into the lower and into the
    /// upper half on an axis.
    fn counts(&self, axis: usize) -> [usize; 2] {
        let at = self.middle(axis);
        let count = |[below, above]: [u32; 2], e: &BoxedElement| {
            [
                below + u32::from(e.is_below(axis, at)),
                above + u32::from(e.is_above(axis, at)),
            ]
        };
        self.elements.iter().fold([0; 2], count).map(|n| n as usize)
    }

    fn push(
        &self,
        half_open_box: HalfOpenBox,
        count: usize,
        reaches: impl Fn(&&BoxedElement) -> bool,
        open: &mut Vec<Self>,
    ) {
        let mut elements: Vec<BoxedElement> = Vec::with_capacity(count);
        elements.extend(self.elements.iter().filter(reaches));
        let alone = |e: &BoxedElement| e.operand == elements[0].operand;
        if !elements.iter().all(alone) {
            open.push(Self {
                elements,
                half_open_box,
                ..*self
            });
        }
    }
}
