//! The trace of other operands on an element: where their surfaces cross it.
//!
//! The trace divides the element into parts inside and outside of these operands. Its walls and the
//! arcs of the border between them are the outlines of the parts: nothing has to be cut. What is not
//! certain is left to the autopartition of `cutting`: curves of one operand that may cross, ends that
//! find no continuation, curves that do not agree about what lies between them.

use std::sync::Arc;

use smallvec::SmallVec;

use super::border::Border;
use super::curves::Joints;
use super::cutting::Special;
use super::nesting::View;
use super::points::Points;
use super::segment::{Crossed, Crosser, Segment};
use super::stops::Stops;
use super::walls::{Wall, Walls};
use super::Labels;
use crate::geometry::outline::BareEdge;
use crate::geometry::polygon::{Carrier, Polygon};
use crate::interrupt::poll;

/// An element divided by the surfaces of other operands.
pub(super) struct Trace {
    /// The bits of these operands.
    pub(super) operands: Labels,
    /// Inside which of them the parts lie, ascending.
    pub(super) parts: SmallVec<[Labels; 2]>,
    walls: Walls,
    border: Border,
}

impl Trace {
    /// The trace of what may cross an element; `None` if it is not certain.
    pub(super) fn new(
        crossed: &Crossed,
        crossers: &[Crosser],
        points: &mut Points,
    ) -> Option<Self> {
        divided(crossed, crossers, points).ok()
    }

    /// The part that has a corner of the element.
    pub(super) fn part_at_corner(&self, corner: usize) -> Option<usize> {
        self.part(self.border.corners[corner])
    }

    fn part(&self, labels: Labels) -> Option<usize> {
        self.parts.binary_search(&labels).ok()
    }

    /// The outline of some of the parts together.
    pub(super) fn outline(&self, polygon: &Polygon, stays: &[bool]) -> Vec<BareEdge> {
        let holds = |labels: Labels| self.part(labels).is_some_and(|i| stays[i]);
        let mut edges = Vec::with_capacity(self.walls.segments.len() + 3);
        self.add_walls(holds, &mut edges);
        self.add_border(polygon, holds, &mut edges);
        edges
    }

    /// Adds the walls that have some parts on one side, those that continue each other as one edge.
    fn add_walls(&self, holds: impl Fn(Labels) -> bool, edges: &mut Vec<BareEdge>) {
        let mut last = None;
        for wall in self.walls.walls() {
            let [left, right] = wall.sides.unwrap_or_default().map(&holds);
            if left == right {
                last = None;
                continue;
            }
            let edge = self.walls.segments[wall.segment].bordering(&wall, left);
            let current = Some((wall.segment, left));
            add(edges, edge, last == current, left);
            last = current;
        }
    }

    /// Adds the arcs of the border at some parts, those that continue each other as one edge.
    fn add_border(
        &self,
        polygon: &Polygon,
        holds: impl Fn(Labels) -> bool,
        edges: &mut Vec<BareEdge>,
    ) {
        let mut last = None;
        for arc in self.border.arcs(polygon) {
            if !holds(arc.labels) {
                last = None;
                continue;
            }
            let edge = BareEdge {
                from: Arc::clone(arc.from),
                to: Arc::clone(arc.to),
                carrier: polygon.corners()[arc.edge].edge.clone(),
            };
            add(edges, edge, last == Some(arc.edge), true);
            last = Some(arc.edge);
        }
    }
}

/// Adds an edge, or makes the last one longer by it, onward or backward.
fn add(edges: &mut Vec<BareEdge>, edge: BareEdge, continues: bool, onward: bool) {
    match edges.last_mut() {
        Some(last) if continues && onward => last.to = edge.to,
        Some(last) if continues => last.from = edge.from,
        _ => edges.push(edge),
    }
}

impl Segment {
    /// A wall of it as an edge of a part on its left, or on its right.
    fn bordering(&self, wall: &Wall, left: bool) -> BareEdge {
        let (from, to) = if left {
            (wall.from, wall.to)
        } else {
            (wall.to, wall.from)
        };
        BareEdge {
            from: Arc::clone(from),
            to: Arc::clone(to),
            carrier: Carrier::Cut(Arc::clone(&self.plane), self.plus == left),
        }
    }
}

fn divided(crossed: &Crossed, crossers: &[Crosser], points: &mut Points) -> Result<Trace, Special> {
    let mut segments = Vec::with_capacity(crossers.len());
    for crosser in crossers {
        poll();
        segments.extend(crossed.segment(crosser, points)?);
    }
    let (segments, joints) = Joints::of(&segments)?.joined(segments)?;
    let mut border = Border::new(crossed.polygon, &segments)?;
    let stops = Stops::of(crossed, &segments, points)?;
    let operands = segments.iter().fold(0, |all, s| all | s.bit());
    let mut walls = Walls::new(segments, joints, stops);
    View::of(crossed.polygon).label(&mut walls, &mut border)?;
    let parts = parts(&walls, &border);
    Ok(Trace {
        operands,
        parts,
        walls,
        border,
    })
}

/// The labels beside all walls and along the border, ascending.
fn parts(walls: &Walls, border: &Border) -> SmallVec<[Labels; 2]> {
    let sides = walls.walls().filter_map(|wall| wall.sides).flatten();
    let mut parts: SmallVec<[Labels; 2]> = sides.chain(border.corners.iter().copied()).collect();
    parts.sort_unstable();
    parts.dedup();
    parts
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use super::super::cutting::{contact, Contact, Face};
    use super::*;
    use crate::geometry::plane::{Lattice, Plane};
    use crate::geometry::vertex::Vertex;

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
        assert_eq!(trace.walls.segments.len(), 1);
        let arcs = trace.border.arcs(&crossed);
        assert_eq!(arcs.len(), 5);
        assert!(arcs
            .iter()
            .any(|arc| arc.edge == 2 && arc.from.same(&corner)));
        assert_ne!(trace.part_at_corner(0), trace.part_at_corner(1));
        assert_eq!(trace.part_at_corner(1), trace.part_at_corner(2));
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
