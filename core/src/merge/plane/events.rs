//! The stops of a sweep: the corners in order, and the crossings that it finds on its way.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::arith::convert::as_number;
use crate::interrupt::poll;
use crate::tree::plane::Corner;

/// The distinct corners by x, then y, and the place of each given corner among them.
#[derive(Debug)]
pub(super) struct Stops {
    /// The number of a given corner for each stop.
    pub corners: Vec<u32>,
    /// The number of a stop for each given corner.
    pub places: Vec<u32>,
}

impl Stops {
    pub(super) fn of(corners: &[Corner]) -> Self {
        let mut keys: Vec<Key> = (0..).zip(corners).map(Key::of).collect();
        keys.sort_unstable_by(|a, b| a.order(b, corners).then(a.number.cmp(&b.number)));
        let mut stops = Self {
            corners: Vec::with_capacity(keys.len()),
            places: vec![0; keys.len()],
        };
        let equal = |a: &Key, b: &Key| a.order(b, corners) == Ordering::Equal;
        for group in keys.chunk_by(equal) {
            poll();
            for key in group {
                stops.places[key.number as usize] = as_number(stops.corners.len());
            }
            // Questions about lattice points are the cheapest.
            let lattice = group.iter().find(|key| key.is_lattice);
            stops.corners.push(lattice.unwrap_or(&group[0]).number);
        }
        stops
    }
}

/// A corner's place in doubles, and how far off they may be.
struct Key {
    at: [f64; 2],
    slack: [f64; 2],
    number: u32,
    is_lattice: bool,
}

/// Coordinates of constructed points are within two units in the last place.
const SLACK: f64 = 4.0 * f64::EPSILON;

impl Key {
    fn of((number, corner): (u32, &Corner)) -> Self {
        let at = corner.point.approx();
        let is_lattice = corner.point.as_lattice().is_some();
        let slack = if is_lattice { 0.0 } else { SLACK };
        Self {
            at,
            slack: at.map(|x| x.abs() * slack),
            number,
            is_lattice,
        }
    }

    fn order(&self, other: &Self, corners: &[Corner]) -> Ordering {
        for axis in [0, 1] {
            let gap = self.at[axis] - other.at[axis];
            let slack = self.slack[axis] + other.slack[axis];
            if gap.abs() > slack {
                return gap.total_cmp(&0.0);
            }
            if slack > 0.0 {
                let [p, q] = [self, other].map(|key| &corners[key.number as usize].point);
                return p.order(q);
            }
        }
        Ordering::Equal
    }
}

/// Crossings ahead of a sweep, the nearest first.
#[derive(Debug, Default)]
pub(super) struct Crossings(BinaryHeap<Crossing>);

#[derive(Debug)]
struct Crossing(Corner);

impl Crossings {
    pub(super) fn extend(&mut self, corner: Option<Corner>) {
        self.0.extend(corner.map(Crossing));
    }

    /// The next crossing, if it does not lie beyond a corner; equal ones count as one.
    pub(super) fn before(&mut self, corner: Option<&Corner>) -> Option<Corner> {
        let order = |known: &Crossing| {
            corner.map_or(Ordering::Less, |corner| known.0.point.order(&corner.point))
        };
        loop {
            match order(self.0.peek()?) {
                Ordering::Greater => return None,
                // The corner itself stops the sweep here.
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
