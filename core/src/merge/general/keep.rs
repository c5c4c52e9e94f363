//! What an expression leaves of the elements.

use std::sync::Arc;

use smallvec::SmallVec;

use super::super::kept::Kept;
use super::fates::Fate;
use super::scene::{Element, Place, Scene};
use super::Labels;
use crate::geometry::polygon::Polygon;

/// What stays of an element on one side.
enum Stays {
    Nothing,
    All,
    Pieces(Vec<Polygon>),
}

impl Stays {
    fn of(pieces: Vec<Polygon>) -> Self {
        if pieces.is_empty() {
            Self::Nothing
        } else {
            Self::Pieces(pieces)
        }
    }

    fn kept(self, face: (u32, u32), flip: bool) -> Option<Kept> {
        match self {
            Self::Nothing => None,
            Self::All => Some(Kept::whole(face, flip)),
            Self::Pieces(polygons) => Some(Kept::pieces(face, flip, polygons)),
        }
    }
}

impl Scene<'_> {
    /// What stays of all elements, given their labels and the expression's value for labels.
    pub(super) fn keep(
        &self,
        fates: Vec<Fate>,
        labels: &[Vec<Labels>],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> Vec<Kept> {
        let mut kept = Vec::new();
        let mut parts: Vec<Vec<(usize, [Stays; 2])>> = Vec::new();
        parts.resize_with(self.parts.len(), Vec::new);
        for (i, fate) in fates.into_iter().enumerate() {
            if matches!(fate, Fate::Absent) {
                continue;
            }
            let element = &self.elements[i];
            let stays = element.stays(fate, &labels[i], value);
            let face = match &element.place {
                Place::Face(t) => (t.slot, t.face),
                Place::Plane(slot, _) => (*slot, 0),
                Place::Piece(part, _) => {
                    parts[*part].push((i, stays));
                    continue;
                }
            };
            let sides = stays.into_iter().zip([false, true]);
            kept.extend(sides.filter_map(|(stays, flip)| stays.kept(face, flip)));
        }
        for (part, pieces) in parts.into_iter().enumerate() {
            self.keep_part(part, pieces, &mut kept);
        }
        kept
    }

    /// Keeps a part as it is if all its pieces stay alike, else what stays of its pieces.
    fn keep_part(&self, part: usize, pieces: Vec<(usize, [Stays; 2])>, kept: &mut Vec<Kept>) {
        let (part, slot) = self.parts[part];
        let face = (slot, part.face);
        let mut sides = [Vec::new(), Vec::new()];
        for (i, [same, turned]) in pieces {
            sides[0].push((i, same));
            sides[1].push((i, turned));
        }
        for (pieces, flip) in sides.into_iter().zip([false, true]) {
            if !pieces.is_empty() && pieces.iter().all(|p| matches!(p.1, Stays::All)) {
                kept.push(Kept::part(face, flip, Arc::clone(part)));
                continue;
            }
            let polygons = pieces.into_iter().flat_map(|(i, s)| self.polygons(i, s));
            kept.extend(Stays::of(polygons.collect()).kept(face, flip));
        }
    }

    /// What stays of an element as polygons.
    fn polygons(&self, element: usize, stays: Stays) -> Vec<Polygon> {
        match stays {
            Stays::Nothing => Vec::new(),
            Stays::All => {
                let polygon = self.elements[element].polygon_in(self.cell);
                polygon.into_iter().collect()
            }
            Stays::Pieces(polygons) => polygons,
        }
    }
}

impl Element<'_> {
    /// What stays as the source has the face, and what stays turned.
    fn stays(
        &self,
        fate: Fate,
        labels: &[Labels],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> [Stays; 2] {
        let side = |others: &Labels| self.side(*others, value);
        let sides: SmallVec<[Option<usize>; 4]> = labels.iter().map(side).collect();
        let mut stays = [Stays::Nothing, Stays::Nothing];
        match sides[0] {
            Some(first) if sides.iter().all(|s| *s == Some(first)) => {
                stays[first] = Stays::All;
                stays
            }
            _ => stays_of_pieces(fate, &sides),
        }
    }

    /// Whether a piece where the others have these labels stays, and as what: 1 is turned.
    fn side(&self, others: Labels, value: &mut impl FnMut(Labels) -> bool) -> Option<usize> {
        let own: Labels = 1 << self.operand;
        let (inside, outside) = (value(others | own), value(others & !own));
        let turned = outside != (self.weight < 0);
        (inside != outside).then_some(usize::from(turned))
    }
}

/// The pieces by the sides on which they stay.
fn stays_of_pieces(fate: Fate, sides: &[Option<usize>]) -> [Stays; 2] {
    let mut found = [Vec::new(), Vec::new()];
    if let Fate::Cut(cutting, ..) = fate {
        for (piece, side) in cutting.pieces.into_iter().zip(sides) {
            if let Some(side) = side {
                found[*side].push(piece);
            }
        }
    }
    found.map(Stays::of)
}
