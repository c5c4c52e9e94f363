//! Determines for each piece of an element which other operands contain it (its label).
//!
//! Labels spread from piece to piece across the segments that divide an element, and from element to element
//! at common points (anchors). If no label is known, winding numbers are counted along a path from the cell's
//! corner.

use std::sync::Arc;

use super::anchors::Spot;
use super::fates::{Cut, Fate};
use super::known::Known;
use super::scene::{Element, Place, Scene};
use super::trace::Trace;
use super::{Labels, OnPieces};
use crate::arith::convert::as_double;
use crate::arith::Filtered;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Corner;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::{triangle_on_path, Way};
use crate::interrupt::poll;

impl Scene<'_> {
    /// Returns for each element the labels of its pieces; `None` if labels contradict each other, or if they
    /// cannot be counted.
    pub(super) fn labels(&self, fates: &[Fate]) -> Option<Vec<OnPieces>> {
        let mut known = Known::new(self, fates);
        let mut labels = vec![OnPieces::new(); fates.len()];
        for (i, fate) in fates.iter().enumerate() {
            poll();
            if let (Fate::Cut(cut), true) = (fate, labels[i].is_empty()) {
                let (part, start) = self.start(self.elements[i].operand, cut, &mut known)?;
                self.flood(fates, (i, part, start), &mut known, &mut labels)?;
            }
        }
        for (i, fate) in fates.iter().enumerate() {
            poll();
            if let Fate::Untouched | Fate::Uncut(_) = fate {
                labels[i].push(known.label_of(self, i, fate)?);
            }
        }
        Some(labels)
    }

    /// Returns a part of a divided element and its label, from which the labels of all other parts follow;
    /// `None` if no label can be counted.
    fn start(&self, operand: usize, cut: &Cut, known: &mut Known) -> Option<(usize, Labels)> {
        // Several corners are tried, because a path to a corner may run through an edge, as all paths to a
        // wall at the cell's corner do.
        if !cut.anchors.is_empty() {
            let label = |anchor| Some((cut.part_at(anchor)?, known.label(self, operand, anchor)?));
            return cut.anchors.iter().find_map(label);
        }
        let label = |corner: &Corner| {
            let part = cut.part_with(|at| Arc::ptr_eq(at, &corner.at))?;
            Some((part, self.count(operand, &corner.at)?))
        };
        cut.polygon.corners().iter().find_map(label)
    }

    /// Labels the parts of a divided element from one of them, and then the parts of all divided elements
    /// that are connected to it by common points; `None` if labels contradict each other.
    fn flood(
        &self,
        fates: &[Fate],
        start: (usize, usize, Labels),
        known: &mut Known,
        labels: &mut [OnPieces],
    ) -> Option<()> {
        let mut open = vec![start];
        while let Some((i, part, start)) = open.pop() {
            poll();
            let (Fate::Cut(cut), true) = (&fates[i], labels[i].is_empty()) else {
                continue;
            };
            labels[i] = spread(&cut.trace, part, start)?;
            for anchor in &cut.anchors {
                let label = labels[i][cut.part_at(anchor)?];
                let root = known.root_of(self.elements[i].operand, anchor.name) as usize;
                match known.labels[root].replace(label) {
                    Some(other) if other != label => return None,
                    Some(_) => {}
                    None => open.extend(known.cut_at(root, fates, label)?),
                }
            }
        }
        Some(())
    }

    /// Returns the label of all operands except `own` at a point on the boundary of `own`; `None` if it
    /// cannot be counted.
    pub(super) fn count_at(&self, own: usize, place: &Spot) -> Option<Labels> {
        match place {
            Spot::Lattice(point) => self.count_at_lattice(own, point),
            Spot::Exact(point) => self.count(own, point),
        }
    }

    /// Returns the label of all operands except `own` at an exact point on the boundary of `own`; `None` if
    /// it cannot be counted.
    fn count(&self, own: usize, point: &Vertex) -> Option<Labels> {
        let across = |e: &Element| e.on_path(&self.corner, point);
        self.count_by(own, point.approx(), across)
    }

    /// Returns the label of all operands except `own` at a lattice vertex of `own`; `None` if it cannot be
    /// counted.
    pub(super) fn count_at_lattice(&self, own: usize, point: &Lattice) -> Option<Labels> {
        let exact = Vertex::lattice(*point);
        let across = |e: &Element| match &e.place {
            Place::Face(t) => triangle_on_path(&t.corners, &self.corner, point),
            _ => e.on_path(&self.corner, &exact),
        };
        self.count_by(own, point.map(as_double), across)
    }

    /// Counts winding numbers along a path from the cell's corner to near a point, and returns the label
    /// there of all operands except `own`; `across` returns the change at an element. `None` if a change is
    /// doubtful, or a number is neither 0 nor 1.
    fn count_by(
        &self,
        own: usize,
        point: [f64; 3],
        across: impl Fn(&Element) -> Filtered<i32>,
    ) -> Option<Labels> {
        let way = Way::new(self.corner.map(|x| 0.5 * as_double(x)), point);
        let near = |e: &&Element| way.may_meet(&e.low, &e.high);
        let mut labels = 0;
        for operand in (0..self.corners.len()).filter(|k| *k != own) {
            let mut w = self.corners[operand];
            let [low, high] = &self.boxes[operand];
            let elements = if way.may_meet(low, high) {
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

/// Returns the labels of all parts of a divided element, given the label of one; `None` if this contradicts
/// the segments that divide the element.
fn spread(trace: &Trace, first: usize, start: Labels) -> Option<OnPieces> {
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
        let fates = scene.fates().expect("general position");
        let labels = scene.labels(&fates).expect("labels agree");
        let labels: Vec<&[Labels]> = labels.iter().map(|l| &l[..]).collect();
        let (of_first, of_second): (&[Labels], &[Labels]) = (&[0, 0b10], &[0, 0b01]);
        assert_eq!(labels[..4], [&[0][..], &[0], &[0], of_first]);
        assert_eq!(labels[4..], [of_second, of_second, of_second, &[0]]);
    }
}
