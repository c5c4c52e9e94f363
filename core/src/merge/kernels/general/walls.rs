//! The walls on an element: pieces of segments between which and what else nothing crosses them, and
//! inside which operands they lie.
//!
//! Labels begin at the border or at what surrounds a closed curve. They go along the curves, and
//! change where another operand's curve crosses.

use std::sync::Arc;

use smallvec::SmallVec;

use super::curves::Joints;
use super::cutting::Special;
use super::segment::Segment;
use super::stops::Stops;
use super::Labels;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// The segments on an element, with what crosses them.
pub(super) struct Walls {
    /// With the inside of their operands on their left.
    pub(super) segments: Vec<Segment>,
    pub(super) joints: Joints,
    stops: Stops,
    /// For each segment the other operands inside which it begins.
    starts: SmallVec<[Option<Labels>; 2]>,
}

/// A piece of a segment that nothing crosses.
pub(super) struct Wall<'a> {
    pub(super) segment: usize,
    pub(super) from: &'a Arc<Vertex>,
    pub(super) to: &'a Arc<Vertex>,
    /// The labels on its left and on its right, once they are known.
    pub(super) sides: Option<[Labels; 2]>,
}

impl Walls {
    pub(super) fn new(segments: Vec<Segment>, joints: Joints, stops: Stops) -> Self {
        let starts = SmallVec::from_elem(None, segments.len());
        Self {
            segments,
            joints,
            stops,
            starts,
        }
    }

    /// Return whether the labels of a segment are known.
    pub(super) fn is_known(&self, segment: usize) -> bool {
        self.starts[segment].is_some()
    }

    /// The walls, in the order of the segments.
    pub(super) fn walls(&self) -> impl Iterator<Item = Wall<'_>> {
        (0..self.segments.len()).flat_map(|i| self.walls_of(i))
    }

    /// The walls of a segment, in the order in which it runs.
    fn walls_of(&self, segment: usize) -> impl Iterator<Item = Wall<'_>> {
        let Segment { from, to, .. } = &self.segments[segment];
        let bit = self.segments[segment].bit();
        let stops = self.stops.on(segment);
        let (mut from, mut labels) = (&from.at, self.starts[segment]);
        (0..=stops.len()).map(move |i| {
            let sides = labels.map(|right| [right | bit, right]);
            let end = stops.get(i).map_or(&to.at, |stop| &stop.at);
            labels = labels.and_then(|l| stops.get(i)?.beyond(l).ok());
            let from = std::mem::replace(&mut from, end);
            Wall {
                segment,
                from,
                to: end,
                sides,
            }
        })
    }

    /// Labels all that hangs together with a segment, given the labels where that begins.
    pub(super) fn spread(&mut self, start: usize, labels: Labels) -> Result<(), Special> {
        let mut open: SmallVec<[(usize, Labels); 4]> = SmallVec::new();
        open.push((start, labels));
        while let Some((i, mut labels)) = open.pop() {
            poll();
            match self.starts[i].replace(labels) {
                None => {}
                Some(known) if known == labels => continue,
                Some(_) => return Err(Special),
            }
            for stop in self.stops.on(i) {
                poll();
                labels = stop.beyond(labels)?;
                let there = labels & !self.segments[stop.other].bit();
                open.push((stop.other, self.stops.at_start(stop.other, i, there)));
            }
            open.extend(self.joints.next(i).map(|next| (next, labels)));
        }
        Ok(())
    }
}
