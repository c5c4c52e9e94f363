//! Determines for each piece of an element which other operands contain it (its label).
//!
//! Labels spread from piece to piece across the segments that divide an element, and from element to element
//! at common points (anchors). If no label is known, winding numbers are counted along a path from the cell's
//! corner.

use std::sync::Arc;

use super::anchors::AnchorPosition;
use super::cut_status::{CutElement, CutStatus};
use super::known_labels::KnownLabels;
use super::scene::{Element, ElementKind, Scene};
use super::trace::Trace;
use super::{Labels, PieceLabels};
use crate::arith::convert::as_double;
use crate::arith::Filtered;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Corner;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::{triangle_change_on_path, PaddedPath};
use crate::interrupt::poll;

impl Scene<'_> {
    /// Returns for each face in the cell the labels of its parts, which say in which other operands a part
    /// lies; `None` if labels contradict each other, or if they cannot be counted.
    pub(super) fn labels(&self, statuses: &[CutStatus]) -> Option<Vec<PieceLabels>> {
        let mut known = KnownLabels::new(self, statuses);
        let mut labels = vec![PieceLabels::new(); statuses.len()];
        for (i, status) in statuses.iter().enumerate() {
            poll();
            if let (CutStatus::Cut(cut), true) = (status, labels[i].is_empty()) {
                let (part, start) = self.start_label(self.elements[i].operand, cut, &mut known)?;
                self.spread_from(statuses, (i, part, start), &mut known, &mut labels)?;
            }
        }
        for (i, status) in statuses.iter().enumerate() {
            poll();
            if let CutStatus::Untouched | CutStatus::Uncut(_) = status {
                labels[i].push(known.label_of(self, i, status)?);
            }
        }
        Some(labels)
    }

    /// Returns a part of a divided face and its label (in which other operands it lies), from which the
    /// labels of all other parts follow; `None` if no label can be counted.
    fn start_label(
        &self,
        operand: usize,
        cut: &CutElement,
        known: &mut KnownLabels,
    ) -> Option<(usize, Labels)> {
        // Several corners are tried, because a path to a corner may run through an edge, as all paths to a
        // wall at the cell's corner do.
        if !cut.anchors.is_empty() {
            let label = |anchor| Some((cut.part_at(anchor)?, known.label(self, operand, anchor)?));
            return cut.anchors.iter().find_map(label);
        }
        let label = |corner: &Corner| {
            let part = cut.part_with(|at| Arc::ptr_eq(at, &corner.at))?;
            Some((part, self.count_label_at_vertex(operand, &corner.at)?))
        };
        cut.polygon.corners().iter().find_map(label)
    }

    /// Labels the parts of a divided face from one of them, and then the parts of all divided faces that are
    /// connected to it by common points; `None` if labels contradict each other.
    fn spread_from(
        &self,
        statuses: &[CutStatus],
        start: (usize, usize, Labels),
        known: &mut KnownLabels,
        labels: &mut [PieceLabels],
    ) -> Option<()> {
        let mut open = vec![start];
        while let Some((i, part, start)) = open.pop() {
            poll();
            let (CutStatus::Cut(cut), true) = (&statuses[i], labels[i].is_empty()) else {
                continue;
            };
            labels[i] = labels_of_parts(&cut.trace, part, start)?;
            for anchor in &cut.anchors {
                let label = labels[i][cut.part_at(anchor)?];
                let root = known.root_of(self.elements[i].operand, anchor.name) as usize;
                match known.labels[root].replace(label) {
                    Some(other) if other != label => return None,
                    Some(_) => {}
                    None => open.extend(known.cut_elements_at(root, statuses, label)?),
                }
            }
        }
        Some(())
    }

    /// Returns the label at a point on the boundary of operand `own`: in which other operands the point lies;
    /// `None` if winding numbers cannot be counted.
    pub(super) fn count_label_at(&self, own: usize, position: &AnchorPosition) -> Option<Labels> {
        match position {
            AnchorPosition::Lattice(point) => self.count_label_at_lattice(own, point),
            AnchorPosition::Exact(point) => self.count_label_at_vertex(own, point),
        }
    }

    /// Returns the label at an exact point on the boundary of operand `own`: in which other operands the
    /// point lies; `None` if winding numbers cannot be counted.
    fn count_label_at_vertex(&self, own: usize, point: &Vertex) -> Option<Labels> {
        let across = |e: &Element| e.change_on_path(&self.corner, point);
        self.count_label(own, point.approx(), across)
    }

    /// Returns the label at a lattice vertex of operand `own`: in which other operands the vertex lies;
    /// `None` if winding numbers cannot be counted.
    pub(super) fn count_label_at_lattice(&self, own: usize, point: &Lattice) -> Option<Labels> {
        let exact = Vertex::lattice(*point);
        let across = |e: &Element| match &e.kind {
            ElementKind::Face(t) => triangle_change_on_path(&t.corners, &self.corner, point),
            _ => e.change_on_path(&self.corner, &exact),
        };
        self.count_label(own, point.map(as_double), across)
    }

    /// Counts winding numbers along a path from the cell's corner to near a point, and returns in which
    /// operands except `own` the point lies; `across` returns the change at a face. `None` if a change is
    /// doubtful, or a number is neither 0 nor 1.
    fn count_label(
        &self,
        own: usize,
        point: [f64; 3],
        across: impl Fn(&Element) -> Filtered<i32>,
    ) -> Option<Labels> {
        let path = PaddedPath::new(self.corner.map(|x| 0.5 * as_double(x)), point);
        let near = |e: &&Element| path.may_meet(&e.low, &e.high);
        let mut labels = 0;
        for operand in (0..self.corners.len()).filter(|k| *k != own) {
            let mut w = self.corners[operand];
            let [low, high] = &self.boxes[operand];
            let elements = if path.may_meet(low, high) {
                self.of_operand(operand)
            } else {
                &[]
            };
            for element in elements.iter().filter(near) {
                poll();
                let Filtered::Certain(change) = across(element) else {
                    return None;
                };
                w += element.weight * change;
            }
            if !(0..=1).contains(&w) {
                self.overlapping.get_or_init(|| operand);
                return None;
            }
            labels |= Labels::from(w == 1) << operand;
        }
        Some(labels)
    }
}

/// Returns the labels of all parts of a divided face (in which operands each lies), given the label of one;
/// `None` if this contradicts the segments that divide the face.
fn labels_of_parts(trace: &Trace, first: usize, start: Labels) -> Option<PieceLabels> {
    let agrees = start & trace.operands == trace.parts[first];
    let others = start & !trace.operands;
    agrees.then(|| trace.parts.iter().map(|part| others | part).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::crossing;

    #[test]
    fn a_cut_face_lies_outside_and_inside_the_solid_that_cuts_it() {
        let shared = crossing();
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        let statuses = scene.cut_statuses().expect("general position");
        let labels = scene.labels(&statuses).expect("labels agree");
        let labels: Vec<&[Labels]> = labels.iter().map(|l| &l[..]).collect();
        let (of_first, of_second): (&[Labels], &[Labels]) = (&[0, 0b10], &[0, 0b01]);
        assert_eq!(labels[..4], [&[0][..], &[0], &[0], of_first]);
        assert_eq!(labels[4..], [of_second, of_second, of_second, &[0]]);
    }
}
