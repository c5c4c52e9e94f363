//! Divides an element along the segments in which other operands' faces cross it.
//!
//! The segments divide the element into cells. Each segment has its operand's inside on one side and its
//! outside on the other, so labels (one bit for each operand: inside or not) spread from cell to cell. If
//! segments contradict each other, an operand overlaps itself, or the position of faces is degenerate.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::contact::Degenerate;
use super::points::Points;
use super::segment::{CrossedElement, CrossingFace, Segment, SegmentEnd};
use super::Labels;
use crate::geometry::outline::BareEdge;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::division::{Defect, Division, PositionInPolygon};

/// A face, or convex piece of a cut face, divided by the surfaces of other operands.
pub(super) struct Trace {
    /// The bits of the operands whose faces cross the divided face.
    pub(super) operands: Labels,
    /// The labels of the parts of the face, ascending: in which operands each part lies. A part is all
    /// triangles of the division with the same label.
    pub(super) parts: SmallVec<[Labels; 2]>,
    /// The division of the face; `None` if no face of another operand crosses it.
    divided: Option<Divided>,
}

/// A face divided into triangles.
struct Divided {
    division: Division,
    /// For each triangle of the division its label: in which operands it lies.
    labels: Vec<Labels>,
}

impl Trace {
    /// Divides a face by the faces of other operands that may cross it; an error if they contradict each
    /// other.
    pub(super) fn new(
        crossed: &CrossedElement,
        crossing_faces: &[CrossingFace],
        points: &mut Points,
    ) -> Result<Self, Degenerate> {
        let mut segments = Vec::with_capacity(crossing_faces.len());
        for crossing_face in crossing_faces {
            poll();
            segments.extend(crossed.segment(crossing_face, points)?);
        }
        if segments.is_empty() {
            let parts = SmallVec::from_slice(&[0]);
            return Ok(Self {
                operands: 0,
                parts,
                divided: None,
            });
        }
        let operands = segments.iter().fold(0, |all, s| all | s.bit());
        let division = divided(crossed.polygon, &segments)?;
        let labels = labels(&division, &segments)?;
        let mut parts: SmallVec<[Labels; 2]> = SmallVec::from_slice(&labels);
        parts.sort_unstable();
        parts.dedup();
        let divided = Some(Divided { division, labels });
        Ok(Self {
            operands,
            parts,
            divided,
        })
    }

    /// Returns the index of the part at a corner of the divided face.
    pub(super) fn part_at_corner(&self, corner: usize) -> Option<usize> {
        let Some(Divided { division, labels }) = &self.divided else {
            return Some(0);
        };
        self.part(labels[division.cell_at_corner(corner)])
    }

    fn part(&self, labels: Labels) -> Option<usize> {
        self.parts.binary_search(&labels).ok()
    }

    /// Returns the outline of the parts for which `stays` is true.
    pub(super) fn outline(&mut self, stays: &[bool]) -> Vec<BareEdge> {
        let Some(Divided { division, labels }) = &mut self.divided else {
            return Vec::new();
        };
        let parts = &self.parts;
        let is_kept = |labels: &Labels| parts.binary_search(labels).is_ok_and(|i| stays[i]);
        let is_kept: Vec<bool> = labels.iter().map(is_kept).collect();
        division.outline(&is_kept)
    }
}

impl From<Defect> for Degenerate {
    fn from(_: Defect) -> Self {
        Self
    }
}

/// Divides a polygon along segments.
fn divided<'s>(polygon: &Polygon, segments: &'s [Segment]) -> Result<Division, Degenerate> {
    let corners = polygon.corners().iter();
    let corners = corners.map(|c| (Arc::clone(&c.at), c.edge.clone()));
    let mut division = Division::of(polygon.support(), corners)?;
    let mut points: SmallVec<[(&Arc<Vertex>, PositionInPolygon); 16]> = SmallVec::new();
    let mut numbers: HashMap<*const Vertex, usize> = HashMap::default();
    let number = |end: &'s SegmentEnd| {
        let add = || {
            points.push((&end.at, end.position));
            points.len() - 1
        };
        *numbers.entry(Arc::as_ptr(&end.at)).or_insert_with(add)
    };
    let ends = segments.iter().flat_map(|s| &s.ends).map(number);
    let ends: SmallVec<[usize; 16]> = ends.collect();
    let numbers = division.insert(&points)?;
    for (segment, ends) in segments.iter().zip(ends.chunks_exact(2)) {
        poll();
        let plane = Arc::clone(&segment.plane);
        division.cut_along([0, 1].map(|i| numbers[ends[i]]), plane)?;
    }
    Ok(division)
}

/// Returns for each triangle of a divided face its label relative to the first one: in which operands it
/// lies; an error if segments contradict each other.
fn labels(division: &Division, segments: &[Segment]) -> Result<Vec<Labels>, Degenerate> {
    let change = |cell: usize, edge: usize| {
        let along = division.along_edge(cell, edge);
        along.fold(0, |all, (segment, _)| all ^ segments[segment].bit())
    };
    // Labels are first relative to the first cell, then absolute, as the segments' insides determine.
    let mut labels = division.spread(0, |here, cell, edge| here ^ change(cell, edge));
    let in_first = labels_of_first(division, segments, &labels);
    for all in &mut labels {
        *all ^= in_first;
    }
    let agree = |cell: usize| {
        let mut neighbours = division.neighbours(cell);
        neighbours.all(|(edge, neighbour)| {
            are_of_different_operands(division, segments, cell, edge)
                && labels[neighbour] == labels[cell] ^ change(cell, edge)
        }) && sides(division, segments, cell).all(|(bit, inside)| labels[cell] & bit == inside)
    };
    let is_certain = (0..labels.len()).all(agree);
    is_certain.then_some(labels).ok_or(Degenerate)
}

/// Returns true if all segments along an edge of a triangle of the division belong to different operands.
/// Three coincident faces of one operand would otherwise give the same bits as a single face.
fn are_of_different_operands(
    division: &Division,
    segments: &[Segment],
    cell: usize,
    edge: usize,
) -> bool {
    let mut seen: Labels = 0;
    division.along_edge(cell, edge).all(|(segment, _)| {
        let bit = segments[segment].bit();
        let is_new = seen & bit == 0;
        seen |= bit;
        is_new
    })
}

/// Returns the label of the first triangle of the division (in which operands it lies), given the labels of
/// all triangles relative to it.
fn labels_of_first(division: &Division, segments: &[Segment], relative: &[Labels]) -> Labels {
    let (mut known, mut labels): (Labels, Labels) = (0, 0);
    for (cell, relative) in relative.iter().enumerate() {
        for (bit, inside) in sides(division, segments, cell) {
            labels |= (relative & bit ^ inside) & !known;
            known |= bit;
        }
    }
    labels
}

/// Returns for each segment along an inner edge of a triangle of the division the bit of its operand, and
/// this bit again if the triangle lies inside the operand, otherwise 0.
fn sides<'a>(
    division: &'a Division,
    segments: &'a [Segment],
    cell: usize,
) -> impl Iterator<Item = (Labels, Labels)> + 'a {
    let edges = division.neighbours(cell).map(|(edge, _)| edge);
    let along = edges.flat_map(move |edge| division.along_edge(cell, edge));
    along.map(|(segment, is_along)| {
        let segment = &segments[segment];
        // The inside of the operand is on the left of the segment, or on the right if it is on the plus side
        // of the plane.
        let is_inside = is_along != segment.plus;
        (segment.bit(), if is_inside { segment.bit() } else { 0 })
    })
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use super::super::contact::{contact, Contact, Face};
    use super::*;
    use crate::geometry::plane::{Lattice, Plane};

    fn polygon(corners: &[Lattice; 3]) -> Polygon {
        let [a, b, c] = corners;
        let plane = Plane::through(a, b, c).expect("a triangle with an area");
        Polygon::triangle(corners, Arc::new(plane))
    }

    fn crossing_face<'a>(polygon: &Polygon, face: &'a Face<'a>, number: u32) -> CrossingFace<'a> {
        let Contact::Crossing(ours, theirs) = contact(polygon, face) else {
            panic!("the face crosses the polygon's plane");
        };
        CrossingFace {
            face,
            number,
            operand: 1,
            weight: 1,
            ours,
            theirs,
        }
    }

    /// Returns the division of a polygon by faces of one operand; `None` if they contradict each other.
    fn trace<const N: usize>(crossed: &Polygon, faces: [[Lattice; 3]; N]) -> Option<Trace> {
        let faces = faces.map(|corners| Face::new(Cow::Owned(polygon(&corners))));
        let crossing_faces: Vec<CrossingFace> = (1..)
            .zip(&faces)
            .map(|(number, face)| crossing_face(crossed, face, number))
            .collect();
        let element = CrossedElement {
            polygon: crossed,
            number: 0,
        };
        Trace::new(&element, &crossing_faces, &mut Points::default()).ok()
    }

    /// The common edge of two faces passes through the border of a polygon, at (4, 4, 0).
    #[test]
    fn a_curve_may_end_where_two_edges_meet() {
        let crossed = polygon(&[[0, 0, 0], [8, 0, 0], [8, 8, 0]]);
        let wall = [
            [[4, 4, -8], [4, 4, 8], [7, -3, 1]],
            [[4, 4, 8], [4, 4, -8], [1, 9, 1]],
        ];
        let trace = trace(&crossed, wall).expect("one curve from border to border");
        assert_ne!(trace.part_at_corner(0), trace.part_at_corner(1));
        assert_eq!(trace.part_at_corner(1), trace.part_at_corner(2));
    }

    /// Both faces at the edge cross the polygon on the same side of its border, so their curve only touches
    /// the border.
    #[test]
    fn a_curve_may_touch_the_border() {
        let crossed = polygon(&[[0, 0, 0], [8, 0, 0], [8, 8, 0]]);
        let wedge = [
            [[4, 4, -8], [4, 4, 8], [7, -3, 1]],
            [[4, 4, 8], [4, 4, -8], [9, 3, 1]],
        ];
        let trace = trace(&crossed, wedge).expect("one curve from border to border");
        assert_eq!(trace.parts.len(), 2);
        assert_eq!(trace.part_at_corner(0), trace.part_at_corner(2));
        assert_ne!(trace.part_at_corner(0), trace.part_at_corner(1));
    }

    #[test]
    fn coincident_faces_of_one_operand_are_no_trace() {
        let crossed = polygon(&[[0, 0, 0], [8, 0, 0], [8, 8, 0]]);
        let wall = [[5, -9, -30], [5, 60, 1], [5, -9, 30]];
        assert!(trace(&crossed, [wall]).is_some());
        assert!(trace(&crossed, [wall; 2]).is_none());
        assert!(trace(&crossed, [wall; 3]).is_none());
    }

    /// A corner of both faces lies in the polygon's plane.
    #[test]
    fn corners_in_the_plane_are_ends_of_segments() {
        let crossed = polygon(&[[0, 0, 0], [80, 0, 0], [80, 80, 0]]);
        let walls = [
            [[40, 20, 0], [10, -30, 60], [30, -50, -40]],
            [[40, 20, 0], [60, 90, -40], [10, -30, 60]],
        ];
        let trace = trace(&crossed, walls).expect("one curve from border to border");
        assert_eq!(trace.parts.len(), 2);
    }
}
