//! The trace of one other operand on an element: where that one's surface crosses it.
//!
//! The trace divides the element into a part inside the operand and one outside. The segments of
//! the trace and the arcs of the border between them are the outlines of both: nothing has to be
//! cut. What is not certain to be simple — loops beside other curves, curves that may cross, ends
//! that find no continuation — is left to the autopartition of `cutting`.

use std::sync::Arc;

use smallvec::SmallVec;

use super::points::Points;
use super::segment::{Crossed, Crosser, Doubt, End, Segment};
use crate::geometry::outline::{order_along, BareEdge};
use crate::geometry::polygon::{bounds, Carrier, Polygon};
use crate::geometry::vertex::Vertex;

/// An element divided by the surface of one other operand.
pub(super) struct Trace {
    pub(super) operand: usize,
    /// Which corners lie inside that operand.
    corners: SmallVec<[bool; 6]>,
    /// With the inside on their left.
    segments: Vec<Segment>,
    /// Where they leave the border and come back to it, counterclockwise.
    ends: Vec<BorderEnd>,
}

/// The end of a segment on the element's border.
struct BorderEnd {
    edge: usize,
    at: Arc<Vertex>,
    /// Whether the border beyond lies inside the operand.
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
        let (segments, ends, corners) = divided(crossed, crossers, points).ok()?;
        Some(Self {
            operand: crossers[0].operand,
            corners,
            segments,
            ends,
        })
    }

    /// Whether a corner lies inside the operand.
    pub(super) fn holds_corner(&self, corner: usize) -> bool {
        self.corners[corner]
    }

    /// The outline of the part inside the operand, or of that outside.
    pub(super) fn outline(&self, polygon: &Polygon, inside: bool) -> Vec<BareEdge> {
        let mut edges = Vec::with_capacity(self.segments.len() + self.ends.len() + 3);
        edges.extend(self.segments.iter().map(|s| s.bordering(inside)));
        self.border(polygon, inside, &mut edges);
        edges
    }

    /// The arcs of the border that lie inside the operand, or outside.
    fn border(&self, polygon: &Polygon, inside: bool, edges: &mut Vec<BareEdge>) {
        let corners = polygon.corners();
        let mut ends = self.ends.iter().peekable();
        for (i, corner) in corners.iter().enumerate() {
            let (mut from, mut within) = (&corner.at, self.corners[i]);
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

type Divided = (Vec<Segment>, Vec<BorderEnd>, SmallVec<[bool; 6]>);

fn divided(crossed: &Crossed, crossers: &[Crosser], points: &mut Points) -> Result<Divided, Doubt> {
    if crossers.iter().any(|c| c.operand != crossers[0].operand) {
        return Err(Doubt);
    }
    let mut segments = Vec::with_capacity(crossers.len());
    for crosser in crossers {
        segments.extend(crossed.segment(crosser, points)?);
    }
    if segments.is_empty() {
        return Err(Doubt);
    }
    let ends = border_ends(crossed.polygon, &segments)?;
    let joints = Joints::of(&segments)?;
    let loops = joints.loops(&segments);
    if loops > usize::from(ends.is_empty()) || may_cross(&segments) {
        return Err(Doubt);
    }
    let first = match ends.first() {
        Some(end) => !end.enters,
        None => !turns_left(crossed.polygon, &segments)?,
    };
    let corners = corners_inside(crossed.polygon.corners().len(), first, &ends);
    Ok((joints.joined(segments)?, ends, corners))
}

/// The ends on the border, counterclockwise; they must enter and leave by turns.
fn border_ends(polygon: &Polygon, segments: &[Segment]) -> Result<Vec<BorderEnd>, Doubt> {
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
        Err(Doubt)
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

/// Which segment continues each.
struct Joints(Vec<Option<usize>>);

impl Joints {
    /// Each end inside the element must be where exactly one other segment begins.
    fn of(segments: &[Segment]) -> Result<Self, Doubt> {
        let address = |end: &End| Arc::as_ptr(&end.at) as usize;
        let inner = |end: &&End| end.edge.is_none();
        let mut begins: Vec<(usize, usize)> = Vec::with_capacity(segments.len());
        let numbered = segments.iter().enumerate();
        begins.extend(
            numbered
                .filter(|(_, s)| inner(&&s.from))
                .map(|(i, s)| (address(&s.from), i)),
        );
        begins.sort_unstable();
        let ending = segments.iter().filter(|s| inner(&&s.to)).count();
        if ending != begins.len() || begins.windows(2).any(|w| w[0].0 == w[1].0) {
            return Err(Doubt);
        }
        let next = |segment: &Segment| {
            if segment.to.edge.is_some() {
                return Ok(None);
            }
            let found = begins.binary_search_by_key(&address(&segment.to), |b| b.0);
            found.map(|at| Some(begins[at].1)).map_err(|_| Doubt)
        };
        let next: Vec<Option<usize>> = segments.iter().map(next).collect::<Result<_, _>>()?;
        let mut taken = vec![false; segments.len()];
        let twice = |i: &usize| std::mem::replace(&mut taken[*i], true);
        if next.iter().flatten().any(twice) {
            return Err(Doubt);
        }
        Ok(Self(next))
    }

    /// The number of closed curves.
    fn loops(&self, segments: &[Segment]) -> usize {
        let mut seen = vec![false; segments.len()];
        let mut follow = |start: usize| {
            let mut at = Some(start);
            let mut found = false;
            while let Some(i) = at.filter(|i| !seen[*i]) {
                seen[i] = true;
                found = true;
                at = self.0[i];
            }
            found
        };
        for (i, segment) in segments.iter().enumerate() {
            if segment.from.edge.is_some() {
                follow(i);
            }
        }
        (0..segments.len()).filter(|i| follow(*i)).count()
    }

    /// The segments with those joined that continue each other on one line.
    fn joined(self, segments: Vec<Segment>) -> Result<Vec<Segment>, Doubt> {
        let mut continued = vec![false; segments.len()];
        let mut any = false;
        for (i, next) in self.0.iter().enumerate() {
            let Some(next) = *next else { continue };
            let (a, b) = (&segments[i], &segments[next]);
            match a.plane.coincides(&b.plane) {
                None => {}
                Some(same) if same == (a.plus == b.plus) => {
                    continued[next] = true;
                    any = true;
                }
                Some(_) => return Err(Doubt),
            }
        }
        if !any {
            return Ok(segments);
        }
        let last = |mut i: usize| {
            while let Some(next) = self.0[i].filter(|next| continued[*next]) {
                i = next;
            }
            segments[i].to.clone()
        };
        let firsts = (0..segments.len()).filter(|i| !continued[*i]);
        Ok(firsts
            .map(|i| Segment {
                from: segments[i].from.clone(),
                to: last(i),
                plane: Arc::clone(&segments[i].plane),
                plus: segments[i].plus,
            })
            .collect())
    }
}

/// Whether two segments that do not follow each other may meet.
fn may_cross(segments: &[Segment]) -> bool {
    let (count, inner) = (
        segments.len(),
        segments.iter().any(|s| s.from.edge.is_none()),
    );
    if count == 1 || count == 2 && inner {
        return false;
    }
    let boxes: Vec<([f64; 3], [f64; 3])> = segments
        .iter()
        .map(|s| bounds([&*s.from.at, &*s.to.at].into_iter()))
        .collect();
    let mut order: Vec<usize> = (0..segments.len()).collect();
    let axis = widest(&boxes);
    order.sort_by(|a, b| boxes[*a].0[axis].total_cmp(&boxes[*b].0[axis]));
    let beyond = |a: usize, b: usize| boxes[b].0[axis] > boxes[a].1[axis];
    let apart = |a: usize, b: usize| {
        let ((low, high), (least, most)) = (&boxes[a], &boxes[b]);
        (0..3).any(|i| low[i] > most[i] || least[i] > high[i])
    };
    order.iter().enumerate().any(|(k, a)| {
        let others = order[k + 1..].iter().take_while(|b| !beyond(*a, **b));
        others
            .filter(|b| !apart(*a, **b))
            .any(|b| !segments[*a].is_clear_of(&segments[*b]))
    })
}

/// The axis along which boxes reach farthest.
fn widest(boxes: &[([f64; 3], [f64; 3])]) -> usize {
    let extent = |i: usize| {
        let low = boxes.iter().fold(f64::INFINITY, |m, b| m.min(b.0[i]));
        let high = boxes.iter().fold(f64::NEG_INFINITY, |m, b| m.max(b.1[i]));
        high - low
    };
    (0..3)
        .max_by(|i, j| extent(*i).total_cmp(&extent(*j)))
        .unwrap_or(0)
}

impl Segment {
    /// Whether two segments follow each other, or one lies on one side of the other's line.
    fn is_clear_of(&self, other: &Self) -> bool {
        let follows = |a: &Self, b: &Self| Arc::ptr_eq(&a.to.at, &b.from.at);
        follows(self, other)
            || follows(other, self)
            || self.is_beside(other)
            || other.is_beside(self)
    }

    fn is_beside(&self, other: &Self) -> bool {
        let side = |end: &End| end.at.side_of(&other.plane);
        side(&self.from) * side(&self.to) > 0
    }
}

/// Whether a closed curve of segments turns left around what it encloses, as seen from the plus
/// side of the polygon's plane.
fn turns_left(polygon: &Polygon, segments: &[Segment]) -> Result<bool, Doubt> {
    let axis = polygon.support().main_axis();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let origin = segments[0].from.at.approx();
    let place = |end: &End| {
        let p = end.at.approx();
        [p[u] - origin[u], p[v] - origin[v]]
    };
    let (mut area, mut reach, mut size) = (0.0f64, 0.0f64, 0.0f64);
    for segment in segments {
        let (p, q) = (place(&segment.from), place(&segment.to));
        area += p[0] * q[1] - p[1] * q[0];
        reach = reach.max(p[0].abs()).max(p[1].abs());
        let c = segment.from.at.approx();
        size = size.max(c[u].abs()).max(c[v].abs());
    }
    // Coordinates are off by less than 4 units in the last place of `size`, each of two products
    // by twice that times `reach`; sums of n terms are rounded n times, and `reach` is at most
    // twice `size`.
    let n = segments.len() as f64;
    let doubt = n * (n + 32.0) * 4.0 * f64::EPSILON * reach * size;
    if area.abs() <= doubt {
        return Err(Doubt);
    }
    Ok((area > 0.0) == (polygon.support().normal()[axis] > 0))
}
