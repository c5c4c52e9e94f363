//! The status of a sweep: the stretches of lines that the sweep line meets, in order from below.

use smallvec::SmallVec;

use crate::geometry::side::Side;
use crate::geometry::spaces::dim2::{Point2, RoundedLine};

/// A stretch of a line with one or more strands, from the last stop on it to the next.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// The line, directed to the right; its minus side is above.
    pub line: RoundedLine,
    /// The stop where the first strand ends.
    pub right: u32,
    /// The strands.
    pub strands: SmallVec<[u32; 2]>,
    /// The increase of the winding number from below to above.
    pub rise: i32,
    /// The winding number below.
    pub below: i32,
    /// The faces of the result below and above.
    pub faces: [u32; 2],
    /// The corner of the result where it began to separate inside from outside, if it does.
    pub start: Option<u32>,
}

impl Stretch {
    /// The winding number above.
    pub(super) fn above(&self) -> i32 {
        self.below + self.rise
    }
}

/// The place of a point among the stretches on the sweep line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The number of stretches below it.
    pub first: usize,
    /// The number of stretches below it and through it.
    pub last: usize,
}

/// The stretches, in order from below.
#[derive(Debug, Default)]
pub(super) struct Status {
    order: Vec<u32>,
    stretches: Vec<Stretch>,
    free: Vec<u32>,
}

impl Status {
    /// The stretch at an index from below.
    pub(super) fn at(&self, place: usize) -> &Stretch {
        &self.stretches[self.order[place] as usize]
    }

    /// The number of stretches.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// Return the place of a point on the sweep line; `stop` is its number, if it is a corner.
    pub(super) fn place(&self, point: &Point2, stop: Option<u32>) -> Place {
        let side = |number: &u32| {
            let stretch = &self.stretches[*number as usize];
            if Some(stretch.right) == stop {
                Side::On
            } else {
                stretch.line.side_of(point)
            }
        };
        // Above a line to the right is its minus side.
        let first = self.order.partition_point(|n| side(n) == Side::Minus);
        let through = self.order[first..]
            .iter()
            .take_while(|n| side(n) == Side::On);
        let last = first + through.count();
        Place { first, last }
    }

    /// Replaces the stretches through a point.
    ///
    /// # Cost
    /// If their number changes, four bytes are moved for each stretch above.
    pub(super) fn exchange(&mut self, place: Place, others: SmallVec<[Stretch; 2]>) {
        let through = &self.order[place.first..place.last];
        if through.len() == others.len() {
            for (number, stretch) in through.iter().zip(others) {
                self.stretches[*number as usize] = stretch;
            }
            return;
        }
        self.free.extend(&self.order[place.first..place.last]);
        let mut numbers: SmallVec<[u32; 4]> = SmallVec::new();
        for stretch in others {
            numbers.push(self.kept(stretch));
        }
        self.order.splice(place.first..place.last, numbers);
    }

    fn kept(&mut self, stretch: Stretch) -> u32 {
        if let Some(number) = self.free.pop() {
            self.stretches[number as usize] = stretch;
            return number;
        }
        self.stretches.push(stretch);
        crate::arith::convert::as_number(self.stretches.len()) - 1
    }
}
