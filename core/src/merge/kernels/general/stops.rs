//! The points in which segments of different operands cross on an element.

use std::sync::Arc;

use super::curves::{each_near_pair, sort_between};
use super::cutting::Special;
use super::points::Points;
use super::segment::{Crossed, Segment};
use super::Labels;
use crate::geometry::plane::Plane;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;

/// A point of a segment in which one of another operand crosses it.
pub(super) struct Stop {
    on: usize,
    /// The point.
    pub(super) at: Arc<Vertex>,
    /// The segment that crosses.
    pub(super) other: usize,
    /// The bit of that one's operand in labels.
    bit: Labels,
    /// True if the way on leads into that operand.
    enters: bool,
}

/// The stops of all segments, in the order in which segments run.
#[derive(Default)]
pub(super) struct Stops {
    stops: Vec<Stop>,
    /// For each segment where its stops begin, and then where the last ones end; empty if there are
    /// no stops.
    firsts: Vec<usize>,
}

impl Stop {
    /// The labels before the point, given those beyond it.
    fn before(&self, labels: Labels) -> Labels {
        if self.enters {
            labels & !self.bit
        } else {
            labels | self.bit
        }
    }

    /// The labels beyond the point, given those before it.
    pub(super) fn beyond(&self, labels: Labels) -> Result<Labels, Special> {
        if self.before(labels) == labels {
            Ok(labels ^ self.bit)
        } else {
            Err(Special)
        }
    }
}

impl Stops {
    /// Those of segments on an element; segments of one operand must not meet, nor others in any
    /// way but that they cross.
    pub(super) fn of(
        crossed: &Crossed,
        segments: &[Segment],
        points: &mut Points,
    ) -> Result<Self, Special> {
        let mut stops = Vec::new();
        each_near_pair(segments, |a, b| {
            let (first, second) = (&segments[a], &segments[b]);
            if first.operand == second.operand {
                return Err(Special);
            }
            let enters = [first.enters(second)?, second.enters(first)?];
            let element = (crossed.polygon.support(), crossed.number);
            let planes = [element, first.face(), second.face()];
            let at = points.of_three(planes).ok_or(Special)?;
            for (on, other, enters) in [(a, b, enters[0]), (b, a, enters[1])] {
                stops.push(Stop {
                    on,
                    at: Arc::clone(&at),
                    other,
                    bit: segments[other].bit(),
                    enters,
                });
            }
            Ok(())
        })?;
        Self::sorted(stops, segments)
    }

    /// In order; no two may be in one place.
    fn sorted(mut stops: Vec<Stop>, segments: &[Segment]) -> Result<Self, Special> {
        if stops.is_empty() {
            return Ok(Self::default());
        }
        stops.sort_by_key(|stop| (stop.on, stop.other));
        for run in stops.chunk_by_mut(|a, b| a.on == b.on) {
            let Segment { from, to, .. } = &segments[run[0].on];
            sort_between([&from.at, &to.at], run, |stop| &stop.at);
            if run.windows(2).any(|w| w[0].at.same(&w[1].at)) {
                return Err(Special);
            }
        }
        let first = |i: usize| stops.partition_point(|stop| stop.on < i);
        let firsts = (0..=segments.len()).map(first).collect();
        Ok(Self { stops, firsts })
    }

    /// Those on a segment.
    pub(super) fn on(&self, segment: usize) -> &[Stop] {
        match self.firsts.get(segment..segment + 2) {
            Some(ends) => &self.stops[ends[0]..ends[1]],
            None => &[],
        }
    }

    /// The labels where a segment begins, given those at the point in which another one crosses it.
    pub(super) fn at_start(&self, segment: usize, other: usize, labels: Labels) -> Labels {
        let stops = self.on(segment);
        let passed = stops.iter().position(|stop| stop.other == other);
        let passed = &stops[..passed.map_or(0, |i| i + 1)];
        passed.iter().rev().fold(labels, |l, stop| stop.before(l))
    }
}

impl Segment {
    fn face(&self) -> (&Arc<Plane>, u32) {
        (&self.plane, self.number)
    }

    /// Return whether one that crosses another enters that one's operand; they must truly cross.
    fn enters(&self, other: &Self) -> Result<bool, Special> {
        let side = |at: &Vertex| at.side_of(&other.plane);
        match [side(&self.from.at), side(&self.to.at)] {
            [Side::Minus, Side::Plus] => Ok(other.plus),
            [Side::Plus, Side::Minus] => Ok(!other.plus),
            _ => Err(Special),
        }
    }
}
