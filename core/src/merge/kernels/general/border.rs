//! The border of an element: the ends of curves on it, and inside which operands it lies between
//! them.

use std::sync::Arc;

use smallvec::SmallVec;

use super::curves::sort_between;
use super::cutting::Special;
use super::segment::Segment;
use super::Labels;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;

/// The border of an element with the ends of curves on it, counterclockwise.
#[derive(Default)]
pub(super) struct Border {
    ends: Vec<BorderEnd>,
    /// Inside which operands the corners lie.
    pub(super) corners: SmallVec<[Labels; 6]>,
}

/// The end of a segment on the border.
pub(super) struct BorderEnd {
    edge: usize,
    at: Arc<Vertex>,
    /// The segment.
    pub(super) segment: usize,
    /// The bit of its operand in labels.
    bit: Labels,
    /// True if the border beyond lies inside the operand: the segment ends here.
    pub(super) enters: bool,
}

/// A piece of the border between ends and corners.
pub(super) struct BorderArc<'a> {
    pub(super) from: &'a Arc<Vertex>,
    pub(super) to: &'a Arc<Vertex>,
    /// The edge of the element.
    pub(super) edge: usize,
    pub(super) labels: Labels,
}

impl BorderEnd {
    /// The labels beyond, given those before.
    fn beyond(&self, labels: Labels) -> Labels {
        if self.enters {
            labels | self.bit
        } else {
            labels & !self.bit
        }
    }
}

impl Border {
    /// With the ends of segments; those of one operand must enter it and leave it by turns.
    pub(super) fn new(polygon: &Polygon, segments: &[Segment]) -> Result<Self, Special> {
        let mut ends = Vec::new();
        for (number, segment) in segments.iter().enumerate() {
            for (end, enters) in [(&segment.from, false), (&segment.to, true)] {
                ends.extend(end.edge.map(|edge| BorderEnd {
                    edge,
                    at: Arc::clone(&end.at),
                    segment: number,
                    bit: segment.bit(),
                    enters,
                }));
            }
        }
        ends.sort_by_key(|end| end.edge);
        let corners = polygon.corners();
        for run in ends.chunk_by_mut(|a, b| a.edge == b.edge) {
            let edge = [run[0].edge, (run[0].edge + 1) % corners.len()];
            sort_between(edge.map(|i| &corners[i].at), run, |end| &end.at);
        }
        let meet = |w: &[BorderEnd]| w[0].edge == w[1].edge && w[0].at.same(&w[1].at);
        if !by_turns(&ends) || ends.windows(2).any(meet) {
            return Err(Special);
        }
        let corners = SmallVec::new();
        Ok(Self { ends, corners })
    }

    /// The operands whose curves end on the border.
    pub(super) fn operands(&self) -> Labels {
        self.ends.iter().fold(0, |all, end| all | end.bit)
    }

    /// Labels the corners, given inside which of the operands without ends the border lies.
    pub(super) fn label(&mut self, polygon: &Polygon, others: Labels) {
        // Before its first end the border lies as it does after the last one.
        let mut labels = self.ends.iter().fold(others, |l, end| end.beyond(l));
        let mut ends = self.ends.iter().peekable();
        for i in 0..polygon.corners().len() {
            self.corners.push(labels);
            while let Some(end) = ends.next_if(|end| end.edge == i) {
                labels = end.beyond(labels);
            }
        }
    }

    /// The ends at which segments begin, with the labels of other operands there.
    pub(super) fn beginnings(&self) -> impl Iterator<Item = (usize, Labels)> + '_ {
        let mut labels = self.corners[0];
        self.ends.iter().filter_map(move |end| {
            labels = end.beyond(labels);
            (!end.enters).then_some((end.segment, labels))
        })
    }

    /// The arcs between ends and corners.
    pub(super) fn arcs<'a>(&'a self, polygon: &'a Polygon) -> Vec<BorderArc<'a>> {
        let corners = polygon.corners();
        let mut arcs = Vec::with_capacity(corners.len() + self.ends.len());
        let mut ends = self.ends.iter().peekable();
        for (edge, corner) in corners.iter().enumerate() {
            let (mut from, mut labels) = (&corner.at, self.corners[edge]);
            let mut arc = |from, to, labels| {
                arcs.push(BorderArc {
                    from,
                    to,
                    edge,
                    labels,
                });
            };
            while let Some(end) = ends.next_if(|end| end.edge == edge) {
                arc(from, &end.at, labels);
                (from, labels) = (&end.at, end.beyond(labels));
            }
            arc(from, &corners[(edge + 1) % corners.len()].at, labels);
        }
        arcs
    }
}

/// Return whether each operand is entered and left by turns, all around.
fn by_turns(ends: &[BorderEnd]) -> bool {
    let (mut seen, mut labels): (Labels, Labels) = (0, 0);
    ends.iter().chain(ends).all(|end| {
        let inside = labels & end.bit != 0;
        let turns = seen & end.bit == 0 || inside != end.enters;
        seen |= end.bit;
        labels = end.beyond(labels);
        turns
    })
}
