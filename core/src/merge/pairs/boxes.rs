//! Pairs of boxes that overlap, found by halving the space around them.

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::interrupt::spend;

/// Up to this many boxes are compared all with all: halving them costs about as much.
const FEW: usize = 96;

/// Up to this many that halving does not separate are compared even so: a sweep costs about as much.
pub const SOME: usize = 384;

/// So many pairs of boxes are compared in the time of one unit of work.
const PAIRS: usize = 16;

/// An element with its box in short integers.
#[derive(Clone, Copy)]
pub struct Boxed {
    extent: ShortBox,
    /// Its operand.
    pub operand: u32,
    /// Its number.
    pub number: u32,
}

impl Boxed {
    /// An element of an operand, its number, and the ends of its box shortened by some bits.
    pub fn new(operand: usize, number: u32, ends: [&Lattice; 2], shift: u32) -> Self {
        Self {
            extent: ShortBox::new(ends, shift),
            operand: as_number(operand),
            number,
        }
    }
}

/// By how many bits coordinates up to this size are shortened to fit into 31 with their sign.
pub fn shift_of(size: u64) -> u32 {
    (u64::BITS - size.leading_zeros()).saturating_sub(30)
}

/// The upper ends of a box and its lower ends, negated; or, turned, the lower ends and the upper
/// ones, negated. Two boxes overlap if those of one, turned, nowhere exceed those of the other.
#[derive(Clone, Copy)]
struct ShortBox([i32; 8]);

/// The elements that reach into a box of space.
struct Task {
    elements: Vec<Boxed>,
    space: Space,
}

/// The places above `low`, up to `high`.
///
/// A pair belongs to the space that holds the lowest corner of what the two have in common.
#[derive(Clone, Copy)]
pub struct Space {
    low: [i32; 3],
    high: [i32; 3],
}

/// Calls `meet` for all pairs of different operands whose boxes overlap, and `crowd` for elements
/// that halving does not separate, with the space in which their pairs are still to be found.
///
/// Elements of one operand follow each other.
pub fn pairs(
    elements: Vec<Boxed>,
    mut meet: impl FnMut(u32, u32),
    mut crowd: impl FnMut(&[Boxed], &Space) -> Option<()>,
) -> Option<()> {
    let space = Space::around(&elements);
    let mut open = vec![Task { elements, space }];
    while let Some(task) = open.pop() {
        spend(task.elements.len());
        let halved = task.elements.len() > FEW && task.halve(&mut open);
        if halved {
            continue;
        }
        if task.elements.len() <= SOME {
            compare_all(&task.elements, &task.space, &mut meet);
        } else {
            crowd(&task.elements, &task.space)?;
        }
    }
    Some(())
}

/// Calls `meet` for the pairs that belong to a space, comparing all elements with all of other
/// operands.
pub fn compare_all(elements: &[Boxed], space: &Space, meet: &mut impl FnMut(u32, u32)) {
    let mut end = 0;
    for run in elements.chunk_by(|a, b| a.operand == b.operand) {
        let start = end;
        end += run.len();
        for one in &elements[start..end] {
            spend(1 + (elements.len() - end) / PAIRS);
            let wanted = one.extent.turned();
            for other in &elements[end..] {
                if wanted.overlaps(&other.extent) && space.owns(one, other) {
                    meet(one.number, other.number);
                }
            }
        }
    }
}

/// Calls `meet` for the pairs of two groups that belong to a space, comparing all with all.
pub fn compare_groups(first: &[Boxed], second: &[Boxed], space: &Space, meet: impl Fn(u32, u32)) {
    for one in first {
        spend(1 + second.len() / PAIRS);
        let wanted = one.extent.turned();
        for other in second {
            if wanted.overlaps(&other.extent) && space.owns(one, other) {
                meet(one.number, other.number);
            }
        }
    }
}

impl ShortBox {
    #[allow(clippy::cast_possible_truncation, reason = "the shift leaves 31 bits")]
    fn new([low, high]: [&Lattice; 2], shift: u32) -> Self {
        let short = |x: i64| (x >> shift) as i32;
        let [a, b, c] = low.map(short);
        let [x, y, z] = high.map(short);
        Self([x, y, z, 0, -a, -b, -c, 0])
    }

    fn low(&self, axis: usize) -> i32 {
        -self.0[4 + axis]
    }

    fn high(&self, axis: usize) -> i32 {
        self.0[axis]
    }

    fn turned(&self) -> Self {
        let [x, y, z, _, a, b, c, _] = self.0;
        Self([-a, -b, -c, 0, -x, -y, -z, 0])
    }

    #[inline]
    fn overlaps(&self, other: &Self) -> bool {
        let exceeds = self.0.iter().zip(&other.0).map(|(a, b)| a > b);
        !exceeds.fold(false, |any, one| any | one)
    }
}

impl Space {
    fn around(elements: &[Boxed]) -> Self {
        let low = |i: usize| elements.iter().map(|e| e.extent.low(i)).min();
        let high = |i: usize| elements.iter().map(|e| e.extent.high(i)).max();
        Self {
            low: each_axis(|i| low(i).map_or(0, |x| x - 1)),
            high: each_axis(|i| high(i).unwrap_or(0)),
        }
    }

    /// Return whether a pair belongs here.
    pub fn owns(&self, a: &Boxed, b: &Boxed) -> bool {
        (0..3).all(|i| {
            let corner = a.extent.low(i).max(b.extent.low(i));
            self.low[i] < corner && corner <= self.high[i]
        })
    }
}

impl Task {
    /// Divides the elements among the halves of the space; false if no axis separates them.
    fn halve(&self, open: &mut Vec<Self>) -> bool {
        let wide = |i: &usize| self.space.high[*i] - self.space.low[*i] > 1;
        let counted = |i: usize| (self.counts(i), i);
        let best = (0..3).filter(wide).map(counted);
        let Some(([few, many], axis)) = best.min_by_key(|(counts, _)| counts[0] + counts[1]) else {
            return false;
        };
        if 4 * (few + many) > 5 * self.elements.len() {
            return false;
        }
        let at = self.middle(axis);
        let (mut below, mut above) = (self.space, self.space);
        below.high[axis] = at;
        above.low[axis] = at;
        self.push(below, few, |e| e.extent.low(axis) <= at, open);
        self.push(above, many, |e| e.extent.high(axis) > at, open);
        true
    }

    fn middle(&self, axis: usize) -> i32 {
        self.space.low[axis].midpoint(self.space.high[axis])
    }

    /// Count the elements that the lower and the upper half would have.
    fn counts(&self, axis: usize) -> [usize; 2] {
        let at = self.middle(axis);
        let count = |[below, above]: [u32; 2], e: &Boxed| {
            [
                below + u32::from(e.extent.low(axis) <= at),
                above + u32::from(e.extent.high(axis) > at),
            ]
        };
        self.elements.iter().fold([0; 2], count).map(|n| n as usize)
    }

    fn push(
        &self,
        space: Space,
        count: usize,
        reaches: impl Fn(&&Boxed) -> bool,
        open: &mut Vec<Self>,
    ) {
        let mut elements: Vec<Boxed> = Vec::with_capacity(count);
        elements.extend(self.elements.iter().filter(reaches));
        let alone = |e: &Boxed| e.operand == elements[0].operand;
        if !elements.iter().all(alone) {
            open.push(Self { elements, space });
        }
    }
}
