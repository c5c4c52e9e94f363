//! The stops of a sweep over the plane: the given corners in order, and the crossings of segments found
//! during the sweep.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::arith::convert::as_number;
use crate::interrupt::poll;
use crate::tree::plane::Corner;

/// The distinct points among the given corners, ordered by x, then y.
#[derive(Debug)]
pub(super) struct Stops {
    /// For each stop (distinct point), the index of a given corner at this point.
    pub corners: Vec<u32>,
    /// For each given corner, the index of the stop (distinct point) at its position.
    pub stop_of: Vec<u32>,
}

impl Stops {
    pub(super) fn of(corners: &[Corner]) -> Self {
        let mut keys: Vec<Key> = (0..).zip(corners).map(Key::of).collect();
        keys.sort_unstable();
        if !keys.iter().all(|key| key.is_lattice) {
            // The order in doubles is almost the exact one, so a stable sort is fast.
            keys.sort_by(|a, b| a.order(b, corners).then(a.number.cmp(&b.number)));
        }
        let mut stops = Self {
            corners: Vec::with_capacity(keys.len()),
            stop_of: vec![0; keys.len()],
        };
        let equal = |a: &Key, b: &Key| a.order(b, corners) == Ordering::Equal;
        for group in keys.chunk_by(equal) {
            poll();
            for key in group {
                stops.stop_of[key.number as usize] = as_number(stops.corners.len());
            }
            // A lattice point, if there is one, stands for the stop: tests of it are the cheapest.
            let lattice = group.iter().find(|key| key.is_lattice);
            stops.corners.push(lattice.unwrap_or(&group[0]).number);
        }
        stops
    }
}

/// A corner's key for sorting by its coordinates in doubles; the order of lattice points is exact.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    /// An integer that increases with x, then y.
    rank: u128,
    number: u32,
    is_lattice: bool,
}

impl Key {
    fn of((number, corner): (u32, &Corner)) -> Self {
        let [x, y] = corner.point.approx().map(|x| u128::from(rank(x)));
        Self {
            rank: x << 64 | y,
            number,
            is_lattice: corner.point.as_lattice().is_some(),
        }
    }

    /// Returns the exact order of two corners by x, then y.
    fn order(&self, other: &Self, corners: &[Corner]) -> Ordering {
        if self.is_lattice && other.is_lattice {
            return self.rank.cmp(&other.rank);
        }
        let [p, q] = [self, other].map(|key| &corners[key.number as usize].point);
        p.order(q)
    }
}

/// Returns an integer that increases with the double x, and is the same for 0.0 and -0.0.
fn rank(x: f64) -> u64 {
    let bits = (x + 0.0).to_bits();
    if bits >> 63 == 0 {
        bits | 1 << 63
    } else {
        !bits
    }
}

/// The known crossings of segments to the right of the sweep line, nearest first.
#[derive(Debug, Default)]
pub(super) struct Crossings(BinaryHeap<Crossing>);

#[derive(Debug)]
struct Crossing(Corner);

impl Crossings {
    pub(super) fn extend(&mut self, corner: Option<Corner>) {
        self.0.extend(corner.map(Crossing));
    }

    /// Removes and returns the next crossing if it comes before `corner` in the order of the sweep; drops
    /// further copies of it, and crossings equal to `corner`.
    pub(super) fn next_before(&mut self, corner: Option<&Corner>) -> Option<Corner> {
        let order = |known: &Crossing| {
            corner.map_or(Ordering::Less, |corner| known.0.point.order(&corner.point))
        };
        loop {
            match order(self.0.peek()?) {
                Ordering::Greater => return None,
                // The sweep stops at this corner anyway.
                Ordering::Equal => drop(self.0.pop()),
                Ordering::Less => break,
            }
        }
        let next = self.0.pop()?;
        while self.0.peek().is_some_and(|other| *other == next) {
            self.0.pop();
        }
        Some(next.0)
    }
}

impl Ord for Crossing {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.point.order(&self.0.point)
    }
}

impl PartialOrd for Crossing {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Crossing {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Crossing {}
