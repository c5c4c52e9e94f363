//! On which pieces of an element which other operands are inside.
//!
//! Labels spread from piece to piece along ties and, at anchors, from element to element; only where
//! nothing is known yet they are counted, along a path from the cell's corner.

use std::sync::Arc;

use super::super::cutting::{Cutting, Tie};
use super::anchors::{piece_with, Anchors};
use super::fates::Fate;
use super::known::Known;
use super::scene::{Element, Place, Scene};
use super::{Labels, OnPieces};
use crate::geometry::path::triangle_on_path;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Vertex;

impl Scene<'_> {
    /// For each element the labels of the other operands on its pieces.
    pub(super) fn labels(&self, fates: &[Fate]) -> Option<Vec<OnPieces>> {
        let mut known = Known::new(self, fates);
        let mut labels = vec![OnPieces::new(); fates.len()];
        for (i, fate) in fates.iter().enumerate() {
            if let (Fate::Cut(cutting, base, anchors), true) = (fate, labels[i].is_empty()) {
                let operand = self.elements[i].operand;
                let (piece, start) = self.start(operand, cutting, base, anchors, &mut known)?;
                self.flood(fates, (i, piece, start), &mut known, &mut labels)?;
            }
        }
        for ((element, fate), labels) in self.elements.iter().zip(fates).zip(&mut labels) {
            if let Fate::Uncut(anchors) = fate {
                labels.push(known.label(self, element.operand, &anchors[0])?);
            }
        }
        Some(labels)
    }

    /// A piece of a cut element, and its labels.
    fn start(
        &self,
        operand: usize,
        cutting: &Cutting,
        base: &Arc<Vertex>,
        anchors: &Anchors,
        known: &mut Known,
    ) -> Option<(usize, Labels)> {
        if let Some(anchor) = anchors.first() {
            return Some((anchor.piece(cutting)?, known.label(self, operand, anchor)?));
        }
        let piece = piece_with(cutting, |at| Arc::ptr_eq(at, base))?;
        Some((piece, self.count(operand, base)?))
    }

    /// Labels the pieces of a cut element from one of them, and of all cut elements that share
    /// anchors with it.
    fn flood(
        &self,
        fates: &[Fate],
        start: (usize, usize, Labels),
        known: &mut Known,
        labels: &mut [OnPieces],
    ) -> Option<()> {
        let mut open = vec![start];
        while let Some((i, piece, start)) = open.pop() {
            let (Fate::Cut(cutting, _, anchors), true) = (&fates[i], labels[i].is_empty()) else {
                continue;
            };
            labels[i] = spread(cutting, piece, start)?;
            for anchor in anchors {
                let label = labels[i][anchor.piece(cutting)?];
                let root = known.root(self.elements[i].operand, anchor) as usize;
                match known.labels[root].replace(label) {
                    Some(other) if other != label => return None,
                    Some(_) => {}
                    None => open.extend(known.cut_at(root, fates, label)?),
                }
            }
        }
        Some(())
    }

    /// The labels of all operands but one at an exact point of that one's boundary.
    pub(super) fn count(&self, own: usize, point: &Vertex) -> Option<Labels> {
        let across = |e: &Element| e.shape().on_path(&self.corner, point);
        let near = point.approx();
        let (low, high) = (
            near.map(|x| x.floor() as i64),
            near.map(|x| x.ceil() as i64),
        );
        self.count_by(own, &low, &high, across)
    }

    /// The labels of all operands but one at a lattice vertex of that one.
    pub(super) fn count_at_lattice(&self, own: usize, point: &Lattice) -> Option<Labels> {
        let exact = Vertex::lattice(*point);
        let across = |e: &Element| match &e.place {
            Place::Face(t) => triangle_on_path(&t.corners, &self.corner, point),
            _ => e.shape().on_path(&self.corner, &exact),
        };
        self.count_by(own, point, point, across)
    }

    /// The labels at a point in a box, given the change across an element on the way there.
    fn count_by(
        &self,
        own: usize,
        low: &Lattice,
        high: &Lattice,
        across: impl Fn(&Element) -> Option<i32>,
    ) -> Option<Labels> {
        let start = self.cell.low();
        let from = [0, 1, 2].map(|i| low[i].min(start[i]) - 1);
        let to = [0, 1, 2].map(|i| high[i].max(start[i]) + 1);
        let near = |e: &&Element| (0..3).all(|i| e.low[i] <= to[i] && e.high[i] >= from[i]);
        let mut labels = 0;
        for operand in (0..self.corners.len()).filter(|k| *k != own) {
            let mut w = self.corners[operand];
            for element in self.of_operand(operand).iter().filter(near) {
                w += element.weight * across(element)?;
            }
            if !(0..=1).contains(&w) {
                return None;
            }
            labels |= Labels::from(w == 1) << operand;
        }
        Some(labels)
    }
}

/// The labels of all pieces from those of one; `None` if the ties contradict each other, or a
/// number is neither 0 nor 1.
fn spread(cutting: &Cutting, first: usize, start: Labels) -> Option<OnPieces> {
    let mut labels: Vec<Option<Labels>> = vec![None; cutting.pieces.len()];
    labels[first] = Some(start);
    let mut changed = true;
    while changed {
        changed = false;
        for tie in &cutting.ties {
            let (minus, plus) = (tie.minus as usize, tie.plus as usize);
            match (labels[minus], labels[plus]) {
                (Some(w), None) => labels[plus] = Some(across(tie, w, true)?),
                (None, Some(w)) => labels[minus] = Some(across(tie, w, false)?),
                (Some(v), Some(w)) if across(tie, v, true) != Some(w) => return None,
                _ => continue,
            }
            changed = true;
        }
    }
    labels.into_iter().collect()
}

/// The labels on the other side of a tie, from its minus to its plus piece or back.
fn across(tie: &Tie, labels: Labels, onward: bool) -> Option<Labels> {
    let bit: Labels = 1 << tie.operand;
    let rises = (tie.change > 0) == onward;
    ((labels & bit == 0) == rises).then_some(labels ^ bit)
}
