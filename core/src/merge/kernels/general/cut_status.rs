//! Finds the elements that faces of other operands cross, and divides them.

use std::sync::Arc;

use smallvec::SmallVec;

use super::anchors::{Anchor, PointNames};
use super::contact::{contact, Contact};
use super::points::Points;
use super::scene::{Element, Scene};
use super::segment::{CrossedElement, CrossingFace};
use super::trace::Trace;
use crate::arith::convert::as_number;
use crate::geometry::apart::{are_apart, NearTriangle};
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::pairs::{pairs, shift_of, BoxedElement, ElementsInBox};

/// The numbers of the faces of other operands, or pieces of cut faces, that may meet a face: rarely more than
/// six.
type Neighbours = SmallVec<[u32; 6]>;

/// The number of the first pair of faces of different operands that is examined as soon as it is found; the
/// pairs 32, 64 and so on follow. If many pairs touch without crossing, the search so ends early.
const FIRST_PAIR_EXAMINED: usize = 16;

/// How the faces of other operands affect one face, or convex piece of a cut face, in the cell.
pub(super) enum CutStatus {
    /// The face does not meet the cell.
    Absent,
    /// All of an original face that no other operand is near; a vertex of it lies in the cell.
    Untouched,
    /// No other operand crosses the face, which has at least one anchor (a point that other faces of its
    /// operand may share).
    Uncut(Vec<Anchor>),
    /// Faces of other operands divided the face.
    Cut(Box<CutElement>),
}

/// The points in which edges cross faces, and the names of corners, which all faces in the cell share.
struct SharedNames<'a> {
    points: Points,
    names: PointNames<'a>,
}

/// The faces of other operands that a face, or convex piece of a cut face, meets in the cell.
enum NearElements<'a> {
    /// The face meets no face of another operand; it may not even meet the cell.
    Apart,
    /// The face does not meet the cell.
    Absent,
    /// The part of the face inside the cell, and the faces of other operands that may cross it, perhaps none.
    Near(Box<Polygon>, Vec<CrossingFace<'a>>),
}

/// A face, or convex piece of a cut face, that faces of other operands divided.
pub(super) struct CutElement {
    /// The part of the face inside the cell.
    pub(super) polygon: Polygon,
    pub(super) trace: Trace,
    pub(super) anchors: Vec<Anchor>,
}

impl Scene<'_> {
    /// Returns how other operands affect each face, or convex piece of a cut face, in the cell; `None` if
    /// faces of different operands touch without crossing.
    pub(super) fn cut_statuses(&self) -> Option<Vec<CutStatus>> {
        let near = self.neighbours()?.into_iter().enumerate();
        // A cell with a degenerate position is refused before any element is divided.
        let all_near: Option<Vec<NearElements>> =
            near.map(|(i, near)| self.near_elements(i, &near)).collect();
        let mut shared = SharedNames {
            points: Points::default(),
            names: PointNames::of(self),
        };
        let all_near = all_near?.into_iter().enumerate();
        let status = |(i, near)| match near {
            NearElements::Apart => self.status_apart(i, &mut shared),
            NearElements::Absent => Some(CutStatus::Absent),
            NearElements::Near(polygon, crossing_faces) => {
                self.status_of(i, *polygon, &crossing_faces, &mut shared)
            }
        };
        all_near.map(status).collect()
    }

    /// Returns the faces of other operands that face (or piece of a cut face) number `i` meets; `None` if it
    /// touches one without crossing it.
    fn near_elements(&self, i: usize, neighbours: &[u32]) -> Option<NearElements<'_>> {
        if neighbours.is_empty() {
            return Some(NearElements::Apart);
        }
        let Some(polygon) = self.elements[i].polygon_in(self.cell) else {
            return Some(NearElements::Absent);
        };
        let crossing_faces = self.crossing_faces(&polygon, neighbours)?;
        Some(NearElements::Near(Box::new(polygon), crossing_faces))
    }

    /// Returns the cut status of a face, or piece of a cut face, that no other operand is near.
    fn status_apart(&self, i: usize, shared: &mut SharedNames) -> Option<CutStatus> {
        let element = &self.elements[i];
        if element.vertices_in(self.cell).next().is_some() {
            return Some(CutStatus::Untouched);
        }
        let anchors = element.anchors(self.cell, &mut shared.names);
        if !anchors.is_empty() {
            return Some(CutStatus::Uncut(anchors));
        }
        match element.polygon_in(self.cell) {
            Some(polygon) => self.status_of(i, polygon, &[], shared),
            None => Some(CutStatus::Absent),
        }
    }

    /// Returns for each face, or piece of a cut face, the numbers of the faces and pieces of other operands
    /// that may meet it inside the cell; `None` if a sampled pair touches without crossing.
    fn neighbours(&self) -> Option<Vec<Neighbours>> {
        let size = self.cell.size().into_iter().max().unwrap_or(0);
        let shift = shift_of(1 << size);
        let boxed = |(number, element): (u32, &Element)| {
            let [low, high] = element.extent(self.cell);
            BoxedElement::new(element.operand, number, [&low, &high], shift)
        };
        let elements = (0..).zip(&self.elements);
        let boxes = elements.filter(|(_, e)| !e.is_apart()).map(boxed).collect();
        let bounded = |number: u32| self.elements[number as usize].bounded(self.cell);
        let mut found = vec![Neighbours::new(); self.elements.len()];
        let near: Vec<NearTriangle> = self
            .elements
            .iter()
            .map(|e| self.near_triangle(e))
            .collect();
        let mut count = 0usize;
        pairs(ElementsInBox::of(boxes, shift), bounded, |a, b| {
            poll();
            let (i, j) = (a as usize, b as usize);
            if are_apart(&near[i], &near[j]) {
                return Some(());
            }
            found[i].push(b);
            found[j].push(a);
            count += 1;
            if count >= FIRST_PAIR_EXAMINED && count.is_power_of_two() {
                self.near_elements(i, &[b])?;
            }
            Some(())
        })?;
        // Pairs are not found in the order of the elements, and some repeatedly.
        for list in found.iter_mut().filter(|list| list.len() > 1) {
            poll();
            list.sort_unstable();
            list.dedup();
        }
        Some(found)
    }

    fn status_of(
        &self,
        i: usize,
        polygon: Polygon,
        crossing_faces: &[CrossingFace],
        shared: &mut SharedNames,
    ) -> Option<CutStatus> {
        let element = &self.elements[i];
        let mut anchors = element.anchors(self.cell, &mut shared.names);
        if anchors.is_empty() {
            anchors = element.anchors_at_walls(&polygon, &mut shared.names);
        }
        if !anchors.is_empty() && crossing_faces.is_empty() {
            return Some(CutStatus::Uncut(anchors));
        }
        let crossed = CrossedElement {
            polygon: &polygon,
            number: as_number(i),
        };
        let trace = Trace::new(&crossed, crossing_faces, &mut shared.points).ok()?;
        Some(CutStatus::Cut(Box::new(CutElement {
            polygon,
            trace,
            anchors,
        })))
    }

    /// Returns the faces among `neighbours` that may cross a polygon; `None` if one touches it without
    /// crossing it.
    fn crossing_faces(
        &self,
        polygon: &Polygon,
        neighbours: &[u32],
    ) -> Option<Vec<CrossingFace<'_>>> {
        let mut crossing_faces = Vec::with_capacity(neighbours.len());
        for j in neighbours {
            poll();
            let other = &self.elements[*j as usize];
            let Some(face) = other.shape() else { continue };
            match contact(polygon, face) {
                Contact::Degenerate => return None,
                Contact::None => {}
                Contact::Crossing(ours, theirs) => crossing_faces.push(CrossingFace {
                    face,
                    number: *j,
                    operand: other.operand,
                    weight: other.weight,
                    ours,
                    theirs,
                }),
            }
        }
        Some(crossing_faces)
    }
}

impl CutElement {
    /// Returns the index of a part of the divided face that has an anchor (a point shared with other faces)
    /// as a corner; `None` if there is none.
    pub(super) fn part_at(&self, anchor: &Anchor) -> Option<usize> {
        self.part_with(|corner| anchor.is_at(corner))
    }

    /// Returns the index of the part of the divided face at the first corner for which `is_it` is true;
    /// `None` if there is none.
    pub(super) fn part_with(&self, is_it: impl Fn(&Arc<Vertex>) -> bool) -> Option<usize> {
        let corner = self.polygon.corners().iter().position(|c| is_it(&c.at))?;
        self.trace.part_at_corner(corner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{crossing, cuboids, tetrahedron, Shared};

    #[test]
    fn faces_that_nothing_crosses_stay_whole() {
        let shared = crossing();
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        let statuses = scene.cut_statuses().expect("general position");
        let cut = |status: &CutStatus| matches!(status, CutStatus::Cut(_));
        let cut: Vec<bool> = statuses.iter().map(cut).collect();
        // The divided faces are the face opposite the origin, and the three faces at the corner inside.
        assert_eq!(cut, [false, false, false, true, true, true, true, false]);
        let alone = Scene::new(&shared.cell, &operands[..1], &shared.sources);
        let statuses = alone.cut_statuses().expect("nothing meets");
        assert!(statuses
            .iter()
            .all(|status| matches!(status, CutStatus::Untouched)));
    }

    /// Returns for each face of a tetrahedron the number of edges of the part that is inside all operands
    /// that cross it.
    fn traced(operands: &[&[[[i64; 3]; 2]]]) -> Vec<usize> {
        let floor = tetrahedron([[-90, -95, 0], [290, -85, 0], [-80, 310, 0], [-70, -70, 300]]);
        let others = operands.iter().map(|o| cuboids(o.iter().copied()));
        let shared = Shared::of(&std::iter::once(floor).chain(others).collect::<Vec<_>>());
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        let statuses = scene.cut_statuses().unwrap_or_default();
        let edges = |status: CutStatus| match status {
            CutStatus::Cut(mut cut) => {
                let Trace {
                    parts, operands, ..
                } = &cut.trace;
                let inside = parts.iter().map(|p| p == operands && *p != 0);
                let inside: Vec<bool> = inside.collect();
                let some = inside.contains(&true);
                some.then(|| cut.trace.outline(&inside).len())
            }
            _ => None,
        };
        let faces = statuses.into_iter().take(4);
        faces.map(|status| edges(status).unwrap_or(0)).collect()
    }

    #[test]
    fn several_curves_on_a_face_are_one_trace() {
        let side_by_side = [[[1, 2, -5], [9, 11, 5]], [[20, 3, -5], [31, 14, 5]]];
        assert_eq!(traced(&[&side_by_side]), [8, 0, 0, 0]);
        let in_a_row = [[[1, 2, -5], [9, 11, 5]], [[20, 2, -5], [31, 11, 5]]];
        assert_eq!(traced(&[&in_a_row]), [8, 0, 0, 0]);
    }

    #[test]
    fn curves_of_several_operands_may_cross() {
        let first = [[[1, 2, -5], [9, 11, 5]]];
        let second = [[[4, 5, -6], [31, 14, 7]]];
        assert_eq!(traced(&[&first, &second]), [4, 0, 0, 0]);
        // Two parts are inside both operands.
        let third = [[[4, 5, -6], [6, 14, 7]], [[7, 5, -6], [8, 14, 7]]];
        assert_eq!(traced(&[&first, &third]), [8, 0, 0, 0]);
    }

    #[test]
    fn a_curve_inside_one_of_another_operand_has_labels_of_both() {
        let outer = [[[1, 2, -9], [19, 21, 9]]];
        let inner = [[[5, 6, -5], [9, 11, 5]]];
        assert_eq!(traced(&[&outer, &inner]), [4, 0, 0, 0]);
    }

    #[test]
    fn an_operand_that_winds_twice_around_a_place_of_a_face_is_no_trace() {
        let nested = [[[1, 2, -9], [19, 21, 9]], [[5, 6, -5], [9, 11, 5]]];
        assert!(traced(&[&nested]).is_empty());
    }
}
