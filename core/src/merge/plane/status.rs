//! The status of a sweep over the plane: the segments that the sweep line meets, in order from below.

use smallvec::SmallVec;

use crate::geometry::side::Side;
use crate::geometry::spaces::dim2::{Point2, RoundedLine};

/// A segment of a line that the sweep line meets, of one or more overlapping input segments; it reaches from
/// the last stop on it to the next.
#[derive(Clone, Debug)]
pub(super) struct ActiveSegment {
    /// The line of the segment, directed to the right; its minus side is above.
    pub line: RoundedLine,
    /// The index of the stop at which the first of the input segments ends.
    pub right: u32,
    /// The indices of the overlapping input segments.
    pub strands: SmallVec<[u32; 2]>,
    /// The increase of the winding number from below the segment to above it.
    pub rise: i32,
    /// The winding number just below the segment.
    pub below: i32,
    /// The faces of the resulting boundary below and above the segment.
    pub faces: [u32; 2],
    /// The corner of the result from which on the segment separates inside from outside; `None` if it does
    /// not.
    pub start: Option<u32>,
}

impl ActiveSegment {
    /// Returns the winding number just above the segment.
    pub(super) fn above(&self) -> i32 {
        self.below + self.rise
    }
}

/// The position of a point in the order of the segments on the sweep line.
#[derive(Clone, Copy, Debug)]
pub(super) struct OrderRange {
    /// The number of segments below the point.
    pub first: usize,
    /// The number of segments below the point or through it.
    pub last: usize,
}

/// The segments that the sweep line meets, in order from below.
#[derive(Debug, Default)]
pub(super) struct Status {
    order: Vec<u32>,
    segments: Vec<ActiveSegment>,
    free: Vec<u32>,
}

impl Status {
    /// Returns the segment with this index in the order from below.
    pub(super) fn segment_at(&self, index: usize) -> &ActiveSegment {
        &self.segments[self.order[index] as usize]
    }

    /// Returns the number of segments on the sweep line.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// Returns the position of a point of the sweep line in the order of segments; `stop` is the index of the
    /// stop at this point, if an input segment begins or ends there.
    pub(super) fn range_at(&self, point: &Point2, stop: Option<u32>) -> OrderRange {
        let side = |number: &u32| {
            let segment = &self.segments[*number as usize];
            if Some(segment.right) == stop {
                Side::On
            } else {
                segment.line.side_of(point)
            }
        };
        // The minus side of a line to the right is above it.
        let first = self.order.partition_point(|n| side(n) == Side::Minus);
        let through = self.order[first..]
            .iter()
            .take_while(|n| side(n) == Side::On);
        let last = first + through.count();
        OrderRange { first, last }
    }

    /// Replaces the segments through a point by the segments that leave it to the right.
    ///
    /// # Cost
    /// If the number of segments changes, four bytes are moved for each segment above.
    pub(super) fn replace(&mut self, range: OrderRange, others: SmallVec<[ActiveSegment; 2]>) {
        let through = &self.order[range.first..range.last];
        if through.len() == others.len() {
            for (number, segment) in through.iter().zip(others) {
                self.segments[*number as usize] = segment;
            }
            return;
        }
        self.free.extend(&self.order[range.first..range.last]);
        let mut numbers: SmallVec<[u32; 4]> = SmallVec::new();
        for segment in others {
            numbers.push(self.store(segment));
        }
        self.order.splice(range.first..range.last, numbers);
    }

    fn store(&mut self, segment: ActiveSegment) -> u32 {
        if let Some(number) = self.free.pop() {
            self.segments[number as usize] = segment;
            return number;
        }
        self.segments.push(segment);
        crate::arith::convert::as_number(self.segments.len()) - 1
    }
}
