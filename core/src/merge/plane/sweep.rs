//! The sweep that computes which regions of the plane are inside outlines.

use smallvec::SmallVec;

use super::events::{Crossings, Stops};
use super::input::Outlines;
use super::output::Output;
use super::status::{ActiveSegment, OrderRange, Status};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::Side;
use crate::geometry::spaces::dim2::{Line2, Point2, RoundedLine};
use crate::interrupt::poll;
use crate::tree::partition::{Label, Location};
use crate::tree::plane::{Boundary, Corner};

/// Returns the boundary of the set of points of the plane for whose winding number `inside` is true.
///
/// The directed segments (strands) may cross, overlap and repeat.
///
/// # Cost
/// O((n + k) log n) for n segments that cross in k points, if the sweep line meets few of them at once.
///
/// # Errors
/// `NotClosed` if the segments do not define one winding number for every point.
///
/// # Example
/// ```
/// use bspcsg::merge::plane::{bounded, Outlines};
///
/// let mut squares = Outlines::default();
/// for shift in [0, 1] {
///     let corners = [[0, 0], [2, 0], [2, 2], [0, 2]].map(|[x, y]| [x + shift, y + shift]);
///     for i in 0..4 {
///         squares.push(corners[i], corners[(i + 1) % 4], 1)?;
///     }
/// }
/// assert_eq!(bounded(&squares, |number| number > 0)?.edges.len(), 8);
/// assert_eq!(bounded(&squares, |number| number > 1)?.edges.len(), 4);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn bounded(outlines: &Outlines, inside: impl Fn(i32) -> bool) -> Result<Boundary> {
    let mut sweep = Sweep::new(outlines, inside);
    while let Some(event) = sweep.next() {
        poll();
        sweep.process(&event)?;
    }
    Ok(sweep.into_boundary())
}

/// An input segment, directed to the right.
#[derive(Clone, Copy, Debug)]
struct SweptStrand {
    line: Line2,
    right: u32,
    rise: i32,
}

/// A point at which the sweep stops.
#[derive(Debug)]
pub(super) struct Event {
    /// The point of the stop.
    pub corner: Corner,
    /// The index of the point among the distinct end points of input segments; `None` at a crossing.
    pub stop: Option<u32>,
}

/// The state of a sweep over the plane from left to right.
pub(super) struct Sweep<'a, R> {
    outlines: &'a Outlines,
    inside: R,
    stops: Stops,
    /// The input segments by their left end; `starts` has for each stop the index of the first one that
    /// begins there.
    strands: Vec<SweptStrand>,
    starts: Vec<u32>,
    passed: u32,
    crossings: Crossings,
    status: Status,
    output: Output,
}

impl<'a, R: Fn(i32) -> bool> Sweep<'a, R> {
    pub(super) fn new(outlines: &'a Outlines, inside: R) -> Self {
        let stops = Stops::of(&outlines.corners);
        let (strands, starts) = swept_strands(outlines, &stops);
        Self {
            outlines,
            inside,
            stops,
            strands,
            starts,
            passed: 0,
            crossings: Crossings::default(),
            status: Status::default(),
            output: Output::new(),
        }
    }

    /// Advances to the next stop and returns it; `None` after the last one.
    pub(super) fn next(&mut self) -> Option<Event> {
        let stop = self.passed;
        let corner = self.corner(stop).copied();
        if let Some(corner) = self.crossings.next_before(corner.as_ref()) {
            return Some(Event { corner, stop: None });
        }
        self.passed += 1;
        corner.map(|corner| Event {
            corner,
            stop: Some(stop),
        })
    }

    /// Returns the point of the stop with this index; `None` after the last one.
    fn corner(&self, stop: u32) -> Option<&Corner> {
        let number = self.stops.corners.get(stop as usize)?;
        self.outlines.corners.get(*number as usize)
    }

    pub(super) fn into_boundary(self) -> Boundary {
        let outer = Label::from_inside((self.inside)(self.outlines.base));
        self.output.into_boundary(outer)
    }

    /// Returns true if exactly one side of the given segment is inside.
    fn separates(&self, segment: &ActiveSegment) -> bool {
        (self.inside)(segment.below) != (self.inside)(segment.above())
    }

    /// Processes a stop of the sweep (an end point or crossing of segments): ends the segments that reach it,
    /// and begins the segments that leave it to the right.
    pub(super) fn process(&mut self, event: &Event) -> Result<()> {
        let range = self.status.range_at(&event.corner.point, event.stop);
        let (winding, face) = self.winding_and_face_below(range.first);
        let leaving = self.leaving_segments(range, event.stop, winding);
        let upper = if range.first < range.last {
            let top = self.status.segment_at(range.last - 1);
            (top.above(), top.faces[1])
        } else {
            (winding, face)
        };
        if leaving.last().map_or(winding, ActiveSegment::above) != upper.0 {
            return Err(not_closed());
        }
        let leaving = self.with_faces_and_edges(leaving, range, &event.corner, [face, upper.1]);
        let count = leaving.len();
        self.status.replace(range, leaving);
        self.record_crossing(range.first);
        if count > 0 {
            self.record_crossing(range.first + count);
        }
        Ok(())
    }

    /// Returns the winding number and the face of the result just below the index `index` in the order of
    /// segments on the sweep line.
    fn winding_and_face_below(&self, index: usize) -> (i32, u32) {
        match index.checked_sub(1) {
            Some(lower) => {
                let lower = self.status.segment_at(lower);
                (lower.above(), lower.faces[1])
            }
            None => (self.outlines.base, 0),
        }
    }

    /// Returns the location of a point on the sweep line, which comes after the last stop and before the next
    /// one.
    pub(super) fn location(&self, point: &Point2) -> Location {
        let range = self.status.range_at(point, None);
        if range.first < range.last {
            return Location::On;
        }
        if (self.inside)(self.winding_and_face_below(range.first).0) {
            Location::In
        } else {
            Location::Out
        }
    }

    /// Returns the segments that leave a stop to the right, in order from below; `winding` is the winding
    /// number below them.
    fn leaving_segments(
        &self,
        range: OrderRange,
        stop: Option<u32>,
        winding: i32,
    ) -> SmallVec<[ActiveSegment; 2]> {
        let mut numbers: SmallVec<[u32; 4]> = SmallVec::new();
        for passing in range.first..range.last {
            let strands = self.status.segment_at(passing).strands.iter();
            let goes_on = |n: &&u32| Some(self.strands[**n as usize].right) != stop;
            numbers.extend(strands.filter(goes_on).copied());
        }
        if let Some(stop) = stop {
            let stop = stop as usize;
            numbers.extend(self.starts[stop]..self.starts[stop + 1]);
        }
        let line = |n: u32| &self.strands[n as usize].line;
        numbers.sort_by(|m, n| line(*m).turn(line(*n)));
        let mut below = winding;
        let groups = numbers.chunk_by(|m, n| line(*m) == line(*n));
        groups
            .map(|group| {
                let segment = self.active_segment(group, below);
                below = segment.above();
                segment
            })
            .collect()
    }

    /// Makes one segment of the sweep line's order from overlapping input segments on one line; `below` is
    /// the winding number below it.
    fn active_segment(&self, strands: &[u32], below: i32) -> ActiveSegment {
        let running = strands.iter().map(|n| &self.strands[*n as usize]);
        ActiveSegment {
            line: RoundedLine::of(self.strands[strands[0] as usize].line),
            right: running.clone().map(|s| s.right).min().unwrap_or(u32::MAX),
            strands: SmallVec::from_slice(strands),
            rise: running.map(|s| s.rise).sum(),
            below,
            faces: [0; 2],
            start: None,
        }
    }

    /// Sets the faces beside the segments that leave a stop, adds the edges of the result that end there, and
    /// begins new ones; `lower` and `upper` are the faces below and above all segments at the stop.
    fn with_faces_and_edges(
        &mut self,
        mut leaving: SmallVec<[ActiveSegment; 2]>,
        range: OrderRange,
        corner: &Corner,
        [lower, upper]: [u32; 2],
    ) -> SmallVec<[ActiveSegment; 2]> {
        let walls = leaving.iter().filter(|s| self.separates(s)).count();
        let (mut left, mut face) = (walls, lower);
        for segment in &mut leaving {
            segment.faces[0] = face;
            if self.separates(segment) {
                left -= 1;
                face = if left == 0 { upper } else { self.output.face() };
            }
            segment.faces[1] = face;
        }
        if walls == 0 {
            self.output.join(lower, upper);
        }
        let arriving = range.first..range.last;
        let arriving: SmallVec<[usize; 4]> = arriving
            .filter(|i| self.status.segment_at(*i).start.is_some())
            .collect();
        if !self.extend_edge(&arriving, &mut leaving, walls) {
            self.place_corner(&arriving, &mut leaving, walls, corner);
        }
        leaving
    }

    /// Extends the boundary edge that reaches a stop of the sweep instead of ending it there; returns false,
    /// without a change, unless exactly one edge reaches the stop and one leaves it, in the same line and
    /// with the same side inside.
    fn extend_edge(&self, arriving: &[usize], leaving: &mut [ActiveSegment], walls: usize) -> bool {
        let ([before], 1) = (arriving, walls) else {
            return false;
        };
        let before = self.status.segment_at(*before);
        let Some(after) = leaving.iter_mut().find(|s| self.separates(s)) else {
            return false;
        };
        let above = [before.above(), after.above()].map(&self.inside);
        let straight = before.line.line() == after.line.line() && above[0] == above[1];
        if straight {
            after.start = before.start;
        }
        straight
    }

    /// Adds a corner to the result if a boundary edge reaches or leaves a stop; ends the edges that reach it
    /// and begins those that leave it.
    fn place_corner(
        &mut self,
        arriving: &[usize],
        leaving: &mut [ActiveSegment],
        walls: usize,
        corner: &Corner,
    ) {
        if arriving.is_empty() && walls == 0 {
            return;
        }
        let here = self.output.corner(corner);
        for index in arriving {
            let segment = self.status.segment_at(*index);
            let above = Label::from_inside((self.inside)(segment.above()));
            if let Some(start) = segment.start {
                let line = *segment.line.line();
                self.output.edge(line, [start, here], segment.faces, above);
            }
        }
        for segment in leaving {
            if self.separates(segment) {
                segment.start = Some(here);
            }
        }
    }

    /// Records the crossing, if there is one, of the two neighbouring segments at the indices `index - 1` and
    /// `index` from below.
    fn record_crossing(&mut self, index: usize) {
        if index == 0 || index >= self.status.len() {
            return;
        }
        let (lower, upper) = (
            self.status.segment_at(index - 1),
            self.status.segment_at(index),
        );
        let end = |stop: u32| self.corner(stop).map(|corner| &corner.point);
        let on = |line: &RoundedLine, point: Option<&Point2>, side| {
            point.is_some_and(|point| line.side_of(point) == side)
        };
        let cross = if lower.right < upper.right {
            on(&upper.line, end(lower.right), Side::Minus)
        } else {
            lower.right > upper.right && on(&lower.line, end(upper.right), Side::Plus)
        };
        if cross {
            let lines = [lower, upper].map(|segment| *segment.line.line());
            self.crossings.extend(Corner::crossing(lines[0], lines[1]));
        }
    }
}

/// Returns the input segments sorted by left end, and for each stop the index of the first one that begins
/// there.
fn swept_strands(outlines: &Outlines, stops: &Stops) -> (Vec<SweptStrand>, Vec<u32>) {
    let mut strands = Vec::with_capacity(outlines.strands.len());
    for strand in &outlines.strands {
        let [from, to] = strand.ends.map(|end| stops.stop_of[end as usize]);
        let (left, line, rise) = if from < to {
            (from, strand.line, strand.weight)
        } else {
            (to, strand.line.flipped(), -strand.weight)
        };
        let right = from.max(to);
        strands.push((left, SweptStrand { line, right, rise }));
    }
    let mut starts = vec![0u32; stops.corners.len() + 1];
    for (left, _) in &strands {
        starts[*left as usize + 1] += 1;
    }
    for stop in 1..starts.len() {
        starts[stop] += starts[stop - 1];
    }
    let mut next = starts.clone();
    let mut order = vec![0u32; strands.len()];
    for (number, (left, _)) in (0u32..).zip(&strands) {
        order[next[*left as usize] as usize] = number;
        next[*left as usize] += 1;
    }
    let sorted = order.iter().map(|n| strands[*n as usize].1);
    (sorted.collect(), starts)
}

fn not_closed() -> Error {
    let text = "the outlines are not closed; at each point as many segments must end as begin";
    Error::new(ErrorKind::NotClosed, text)
}
