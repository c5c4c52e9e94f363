//! Decides which parts of the elements of a cell bound the result.

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::cut_status::CutStatus;
use super::scene::{Element, ElementKind, Scene};
use super::{Labels, PieceLabels};
use crate::merge::kernels::kept::KeptPart;
use crate::merge::kernels::stays::{kept, Owner, StayingRegion};
use crate::mesh::handle::{FaceId, SourceFace};

impl Scene<'_> {
    /// Returns the parts of all faces in the cell that bound the result, given how each face is cut and in
    /// which operands its parts lie (`labels`); `value` returns the expression's value for a label.
    pub(super) fn keep(
        &self,
        statuses: Vec<CutStatus>,
        labels: &[PieceLabels],
        value: &mut impl FnMut(Labels) -> bool,
    ) -> Vec<KeptPart> {
        let present = statuses.into_iter().enumerate();
        let present = present.filter(|(_, status)| !matches!(status, CutStatus::Absent));
        let mut values = Values::of(value);
        let settled = present.map(|(i, status)| {
            let element = &self.elements[i];
            let owner = match &element.kind {
                ElementKind::Face(t) => Owner::Face(t.face),
                ElementKind::Plane(slot, _) => Owner::Face(SourceFace::new(*slot, FaceId::ONLY)),
                ElementKind::Piece(part, _) | ElementKind::Part(part, _) => Owner::Part(*part),
            };
            (
                i,
                owner,
                element.staying_regions(status, &labels[i], &mut values),
            )
        });
        kept(settled, &self.parts, |i| {
            self.elements[i].polygon_in(self.cell)
        })
    }
}

impl Element<'_> {
    /// Returns the parts of the face that bound the result in its source's orientation and in the opposite
    /// one; `labels` says for each part of the face in which operands it lies.
    fn staying_regions(
        &self,
        status: CutStatus,
        labels: &[Labels],
        values: &mut Values<impl FnMut(Labels) -> bool>,
    ) -> [StayingRegion; 2] {
        let mut side = |others: &Labels| self.side(*others, values);
        if let [only] = labels {
            return side(only).map_or([StayingRegion::Nothing, StayingRegion::Nothing], all_on);
        }
        let sides: SmallVec<[Option<usize>; 4]> = labels.iter().map(side).collect();
        match sides[0] {
            Some(first) if sides.iter().all(|s| *s == Some(first)) => all_on(first),
            _ => staying_regions_of_parts(status, &sides),
        }
    }

    /// Returns the orientation in which a part of the face stays, given the bits of the other operands: 0 for
    /// the source's orientation, 1 for the opposite one; `None` if it does not stay.
    fn side(
        &self,
        others: Labels,
        values: &mut Values<impl FnMut(Labels) -> bool>,
    ) -> Option<usize> {
        let own: Labels = 1 << self.operand;
        let [inside, outside] = values.values_on_sides(own, others & !own);
        let turned = outside != (self.weight < 0);
        (inside != outside).then_some(usize::from(turned))
    }
}

/// A cache of an expression's values for labels. A label has a bit for each operand: whether a point is
/// inside the operand.
struct Values<F> {
    value: F,
    known: HashMap<Labels, bool>,
    /// The last pair of arguments of `values_on_sides` and its result: consecutive faces mostly need the
    /// same.
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
    fn values_on_sides(&mut self, own: Labels, others: Labels) -> [bool; 2] {
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

/// Returns the regions of a face that stays whole: all of it in the orientation `side`, nothing in the other
/// orientation.
fn all_on(side: usize) -> [StayingRegion; 2] {
    let mut stays = [StayingRegion::Nothing, StayingRegion::Nothing];
    stays[side] = StayingRegion::All;
    stays
}

/// Returns the parts of a divided face that bound the result in each orientation; `sides` has for each part
/// the orientation in which it bounds the result, or `None`.
fn staying_regions_of_parts(status: CutStatus, sides: &[Option<usize>]) -> [StayingRegion; 2] {
    let CutStatus::Cut(mut cut) = status else {
        return [StayingRegion::Nothing, StayingRegion::Nothing];
    };
    [0, 1].map(|side| {
        let stays: SmallVec<[bool; 4]> = sides.iter().map(|s| *s == Some(side)).collect();
        if stays.contains(&true) {
            StayingRegion::Outline(cut.trace.outline(&stays))
        } else {
            StayingRegion::Nothing
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
        assert_eq!(values.values_on_sides(0b01, 0b00), [false, false]);
        assert_eq!(values.values_on_sides(0b01, 0b10), [true, false]);
        assert_eq!(values.values_on_sides(0b10, 0b01), [true, false]);
        assert_eq!(asked, [0b01, 0b00, 0b11, 0b10]);
    }
}
