//! The trace of one other operand on an element: where that one's surface crosses it.
//!
//! The trace divides the element into a part inside the operand and one outside. The segments of
//! the trace and the arcs of the border between them are the outlines of both: nothing has to be
//! cut. What is not certain to be simple — loops beside other curves, curves that may cross, ends
//! that find no continuation — is left to the autopartition of `cutting`.

use std::sync::Arc;

use smallvec::SmallVec;

use super::curves::{may_cross, Joints};
use super::cutting::Special;
use super::nesting::View;
use super::points::Points;
use super::segment::{Crossed, Crosser, Segment};
use crate::geometry::outline::{order_along, BareEdge};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// An element divided by the surface of one other operand.
pub(super) struct Trace {
    pub(super) operand: usize,
    /// Marks of the corners that lie inside that operand.
    corners: SmallVec<[bool; 6]>,
    /// With the inside on their left.
    pub(super) segments: Vec<Segment>,
    /// The ends at which they leave the border and come back to it, counterclockwise.
    ends: Vec<BorderEnd>,
}

/// The end of a segment on the element's border.
struct BorderEnd {
    edge: usize,
    at: Arc<Vertex>,
    /// True if the border beyond lies inside the operand.
    enters: bool,
}

impl Trace {
    /// The trace of the crossers' operand; `None` if it has none, or none that is certain to be
    /// simple.
    pub(super) fn new(
        crossed: &Crossed,
        crossers: &[Crosser],
        points: &mut Points,
    ) -> Option<Self> {
        divided(crossed, crossers, points).ok()
    }

    /// Return for each corner whether it lies inside; closed curves must be nested by turns.
    fn nested(&self, polygon: &Polygon, joints: &Joints) -> Result<SmallVec<[bool; 6]>, Special> {
        let curves = joints.loops(&self.segments);
        let view = View::of(polygon);
        let first = match self.ends.first() {
            Some(end) => !end.enters,
            None => view.border_is_inside(&curves)?,
        };
        let corners = corners_inside(polygon.corners().len(), first, &self.ends);
        if curves.len() > usize::from(self.ends.is_empty()) {
            let border = [false, true].map(|inside| {
                let mut edges = Vec::new();
                self.border(polygon, &corners, inside, &mut edges);
                edges
            });
            view.check(&self.segments, &border, &curves)?;
        }
        Ok(corners)
    }

    /// Return whether a corner lies inside the operand.
    pub(super) fn holds_corner(&self, corner: usize) -> bool {
        self.corners[corner]
    }

    /// The outline of the part inside the operand, or of that outside.
    pub(super) fn outline(&self, polygon: &Polygon, inside: bool) -> Vec<BareEdge> {
        let mut edges = Vec::with_capacity(self.segments.len() + self.ends.len() + 3);
        edges.extend(self.segments.iter().map(|s| s.bordering(inside)));
        self.border(polygon, &self.corners, inside, &mut edges);
        edges
    }

    /// The arcs of the border that lie inside the operand, or outside.
    pub(super) fn border(
        &self,
        polygon: &Polygon,
        labels: &[bool],
        inside: bool,
        edges: &mut Vec<BareEdge>,
    ) {
        let corners = polygon.corners();
        let mut ends = self.ends.iter().peekable();
        for (i, corner) in corners.iter().enumerate() {
            let (mut from, mut within) = (&corner.at, labels[i]);
            let mut arc = |from: &Arc<Vertex>, to: &Arc<Vertex>, within: bool| {
                if within == inside {
                    edges.push(BareEdge {
                        from: Arc::clone(from),
                        to: Arc::clone(to),
                        carrier: corner.edge.clone(),
                    });
                }
            };
            while let Some(end) = ends.next_if(|end| end.edge == i) {
                arc(from, &end.at, within);
                (from, within) = (&end.at, end.enters);
            }
            arc(from, &corners[(i + 1) % corners.len()].at, within);
        }
    }
}

impl Segment {
    /// As an edge of the part inside the operand, or of that outside.
    fn bordering(&self, inside: bool) -> BareEdge {
        let (from, to) = if inside {
            (&self.from.at, &self.to.at)
        } else {
            (&self.to.at, &self.from.at)
        };
        BareEdge {
            from: Arc::clone(from),
            to: Arc::clone(to),
            carrier: Carrier::Cut(Arc::clone(&self.plane), self.plus == inside),
        }
    }
}

fn divided(crossed: &Crossed, crossers: &[Crosser], points: &mut Points) -> Result<Trace, Special> {
    if crossers.iter().any(|c| c.operand != crossers[0].operand) {
        return Err(Special);
    }
    let mut segments = Vec::with_capacity(crossers.len());
    for crosser in crossers {
        poll();
        segments.extend(crossed.segment(crosser, points)?);
    }
    if segments.is_empty() {
        return Err(Special);
    }
    let ends = border_ends(crossed.polygon, &segments)?;
    let joints = Joints::of(&segments)?;
    if may_cross(&segments) {
        return Err(Special);
    }
    let mut trace = Trace {
        operand: crossers[0].operand,
        corners: SmallVec::new(),
        segments,
        ends,
    };
    trace.corners = trace.nested(crossed.polygon, &joints)?;
    trace.segments = joints.joined(trace.segments)?;
    Ok(trace)
}

/// The ends on the border, counterclockwise; they must enter and leave by turns.
fn border_ends(polygon: &Polygon, segments: &[Segment]) -> Result<Vec<BorderEnd>, Special> {
    let mut ends = Vec::new();
    for segment in segments {
        for (end, enters) in [(&segment.from, false), (&segment.to, true)] {
            if let Some(edge) = end.edge {
                let at = Arc::clone(&end.at);
                ends.push(BorderEnd { edge, at, enters });
            }
        }
    }
    ends.sort_by_key(|end| end.edge);
    for on_edge in ends.chunk_by_mut(|a, b| a.edge == b.edge) {
        if on_edge.len() > 1 {
            sort_along(polygon, on_edge);
        }
    }
    let n = ends.len();
    let by_turns = (0..n).all(|i| ends[i].enters != ends[(i + 1) % n].enters);
    let apart = |i: usize| ends[i].edge != ends[i + 1].edge || !ends[i].at.same(&ends[i + 1].at);
    if by_turns && (1..n).all(|i| apart(i - 1)) {
        Ok(ends)
    } else {
        Err(Special)
    }
}

/// Sorts points of one edge in its direction.
fn sort_along(polygon: &Polygon, ends: &mut [BorderEnd]) {
    let corners = polygon.corners();
    let edge = ends[0].edge;
    let (a, b) = (&corners[edge].at, &corners[(edge + 1) % corners.len()].at);
    let (p, q) = (a.approx(), b.approx());
    let extent = |i: usize| (q[i] - p[i]).abs();
    let axis = (0..3)
        .max_by(|i, j| extent(*i).total_cmp(&extent(*j)))
        .unwrap_or(0);
    let forward = order_along(a, b, axis);
    ends.sort_by(|x, y| {
        let order = order_along(&x.at, &y.at, axis);
        if forward.is_lt() {
            order
        } else {
            order.reverse()
        }
    });
}

fn corners_inside(count: usize, first: bool, ends: &[BorderEnd]) -> SmallVec<[bool; 6]> {
    let mut inside = SmallVec::with_capacity(count);
    let mut within = first;
    let mut ends = ends.iter().peekable();
    for i in 0..count {
        inside.push(within);
        while let Some(end) = ends.next_if(|end| end.edge == i) {
            within = end.enters;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use super::super::cutting::{contact, Contact, Face};
    use super::*;
    use crate::geometry::plane::{Lattice, Plane};

    fn polygon(corners: &[Lattice; 3]) -> Polygon {
        let [a, b, c] = corners;
        let plane = Plane::through(a, b, c).expect("a triangle with an area");
        Polygon::triangle(corners, Arc::new(plane))
    }

    fn crosser<'a>(polygon: &Polygon, face: &'a Face<'a>, number: u32) -> Crosser<'a> {
        let Contact::Crossing(ours, theirs) = contact(polygon, face) else {
            panic!("the face crosses the polygon's plane");
        };
        Crosser {
            face,
            number,
            operand: 1,
            weight: 1,
            ours,
            theirs,
        }
    }

    /// The trace that two faces of one operand leave on a polygon.
    fn trace(crossed: &Polygon, faces: [[Lattice; 3]; 2]) -> Option<Trace> {
        let faces = faces.map(|corners| Face::new(Cow::Owned(polygon(&corners))));
        let crossers: Vec<Crosser> = (1..)
            .zip(&faces)
            .map(|(number, face)| crosser(crossed, face, number))
            .collect();
        let element = Crossed {
            polygon: crossed,
            number: 0,
        };
        Trace::new(&element, &crossers, &mut Points::default())
    }

    /// The edge of a wall goes through the border of a polygon: (4, 4, 0) lies on both.
    #[test]
    fn a_curve_may_end_where_two_edges_meet() {
        let crossed = polygon(&[[0, 0, 0], [8, 0, 0], [8, 8, 0]]);
        let wall = [
            [[4, 4, -8], [4, 4, 8], [7, -3, 1]],
            [[4, 4, 8], [4, 4, -8], [1, 9, 1]],
        ];
        let trace = trace(&crossed, wall).expect("one curve from border to border");
        let corner = Vertex::lattice([4, 4, 0]);
        assert_eq!(trace.segments.len(), 1);
        assert_eq!(trace.ends.len(), 2);
        assert!(trace
            .ends
            .iter()
            .any(|end| end.edge == 2 && end.at.same(&corner)));
        assert_ne!(trace.holds_corner(0), trace.holds_corner(1));
        assert_eq!(trace.holds_corner(1), trace.holds_corner(2));
    }

    /// Both faces at the edge lie over the polygon: their curve only touches its border.
    #[test]
    fn a_curve_that_touches_the_border_is_in_doubt() {
        let crossed = polygon(&[[0, 0, 0], [8, 0, 0], [8, 8, 0]]);
        let wedge = [
            [[4, 4, -8], [4, 4, 8], [7, -3, 1]],
            [[4, 4, 8], [4, 4, -8], [9, 3, 1]],
        ];
        assert!(trace(&crossed, wedge).is_none());
    }
}
