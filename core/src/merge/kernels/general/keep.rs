//! Decides which parts of the elements of a cell bound the result.

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::fates::Fate;
use super::scene::{Element, Place, Scene};
use super::{Labels, OnPieces};
use crate::merge::kernels::kept::Kept;
use crate::merge::kernels::stays::{kept, Owner, Stays};
use crate::mesh::handle::{FaceId, SourceFace};

impl Scene<'_> {
    /// Returns the parts of all elements that bound the result, given the labels of their pieces; `value`
    /// returns the expression's value for a label.
    pub(super) fn keep(
        &self,
        fates: Vec<Fate>,
        labels: &[OnPieces],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> Vec<Kept> {
        let present = fates.into_iter().enumerate();
        let present = present.filter(|(_, fate)| !matches!(fate, Fate::Absent));
        let mut values = Values::of(value);
        let settled = present.map(|(i, fate)| {
            let element = &self.elements[i];
            let owner = match &element.place {
                Place::Face(t) => Owner::Face(t.face),
                Place::Plane(slot, _) => Owner::Face(SourceFace::new(*slot, FaceId::ONLY)),
                Place::Piece(part, _) | Place::Part(part, _) => Owner::Part(*part),
            };
            (i, owner, element.stays(fate, &labels[i], &mut values))
        });
        kept(settled, &self.parts, |i| {
            self.elements[i].polygon_in(self.cell)
        })
    }
}

impl Element<'_> {
    /// Returns the parts of the element that bound the result in its source's orientation and in the opposite
    /// one, given the labels of its pieces.
    fn stays(
        &self,
        fate: Fate,
        labels: &[Labels],
        values: &mut Values<impl FnMut(Labels) -> bool>,
    ) -> [Stays; 2] {
        let mut side = |others: &Labels| self.side(*others, values);
        if let [only] = labels {
            return side(only).map_or([Stays::Nothing, Stays::Nothing], all_on);
        }
        let sides: SmallVec<[Option<usize>; 4]> = labels.iter().map(side).collect();
        match sides[0] {
            Some(first) if sides.iter().all(|s| *s == Some(first)) => all_on(first),
            _ => stays_of_parts(fate, &sides),
        }
    }

    /// Returns the orientation in which a piece of the element stays, given the bits of the other operands: 0
    /// for the source's orientation, 1 for the opposite one; `None` if the piece goes.
    fn side(
        &self,
        others: Labels,
        values: &mut Values<impl FnMut(Labels) -> bool>,
    ) -> Option<usize> {
        let own: Labels = 1 << self.operand;
        let [inside, outside] = values.on_sides(own, others & !own);
        let turned = outside != (self.weight < 0);
        (inside != outside).then_some(usize::from(turned))
    }
}

/// A cache of an expression's values for labels.
struct Values<F> {
    value: F,
    known: HashMap<Labels, bool>,
    /// The last request and its result: consecutive elements mostly ask for the same.
    last: Option<((Labels, Labels), [bool; 2])>,
}

impl<F: FnMut(Labels) -> bool> Values<F> {
    fn of(value: F) -> Self {
        Self {
            value,
            known: HashMap::default(),
            last: None,
        }
    }

    /// Returns the expression's values inside and outside the operand with the bit `own`, given the bits of
    /// the other operands.
    fn on_sides(&mut self, own: Labels, others: Labels) -> [bool; 2] {
        if let Some((_, found)) = self.last.filter(|(asked, _)| *asked == (own, others)) {
            return found;
        }
        let found = [others | own, others].map(|labels| {
            let value = &mut self.value;
            *self.known.entry(labels).or_insert_with(|| value(labels))
        });
        self.last = Some(((own, others), found));
        found
    }
}

/// Returns that all of an element stays in the orientation `side`, and nothing in the other one.
fn all_on(side: usize) -> [Stays; 2] {
    let mut stays = [Stays::Nothing, Stays::Nothing];
    stays[side] = Stays::All;
    stays
}

/// Returns the parts of a divided element that bound the result in each orientation; `sides` has for each
/// part the orientation in which it bounds the result, or `None`.
fn stays_of_parts(fate: Fate, sides: &[Option<usize>]) -> [Stays; 2] {
    let Fate::Cut(mut cut) = fate else {
        return [Stays::Nothing, Stays::Nothing];
    };
    [0, 1].map(|side| {
        let stays: SmallVec<[bool; 4]> = sides.iter().map(|s| *s == Some(side)).collect();
        if stays.contains(&true) {
            Stays::Outline(cut.trace.outline(&stays))
        } else {
            Stays::Nothing
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expression_is_asked_once_for_the_same_labels() {
        let mut asked = Vec::new();
        let mut values = Values::of(|labels: Labels| {
            asked.push(labels);
            labels == 0b11
        });
        assert_eq!(values.on_sides(0b01, 0b00), [false, false]);
        assert_eq!(values.on_sides(0b01, 0b10), [true, false]);
        assert_eq!(values.on_sides(0b10, 0b01), [true, false]);
        assert_eq!(asked, [0b01, 0b00, 0b11, 0b10]);
    }
}
