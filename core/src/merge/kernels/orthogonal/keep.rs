//! Decides which parts of the facets (faces perpendicular to axes) of a cell bound the result.

use std::ops::Range;

use smallvec::SmallVec;

use super::facet::{Facet, Facets, OTHER_AXES};
use super::grid::{mask, Grid};
use super::pieces::pieces;
use super::position::FacetPosition;
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::merge::expression::Expression;
use crate::merge::kernels::kept::KeptPart;
use crate::merge::kernels::stays::{kept, StayingElement, StayingRegion};

/// A cell with its grid, facets and values.
pub(super) struct Scene<'a> {
    pub(super) cell: &'a Cell,
    pub(super) grid: &'a Grid,
    pub(super) facets: &'a Facets<'a>,
    /// For each facet, its position and its rectangles in the grid.
    pub(super) positions: &'a [FacetPosition],
    /// For each operand, the boxes of the grid inside it, as a word of bits for each column.
    pub(super) fields: &'a [Vec<u64>],
    /// The boxes of the grid in which the expression is true, as a word of bits for each column.
    pub(super) value: &'a [u64],
    pub(super) expression: &'a Expression,
    /// The index of each operand by its number in the expression.
    pub(super) operand_indices: &'a [usize],
}

/// A plane of the grid: the axis it is perpendicular to, and its number on this axis.
type Plane = (usize, usize);

impl Scene<'_> {
    /// Returns the parts of all facets that bound the result; `None` if two facets of one operand overlap.
    pub(super) fn keep(&self) -> Option<Vec<KeptPart>> {
        let all = &self.facets.all;
        let mut order: Vec<usize> = (0..all.len()).collect();
        let sheet = |i: &usize| (all[*i].axis, all[*i].at);
        order.sort_by_key(sheet);
        let mut settled: Vec<StayingElement> = Vec::with_capacity(all.len());
        for sheet in order.chunk_by(|a, b| sheet(a) == sheet(b)) {
            poll();
            self.keep_sheet(sheet, &mut settled)?;
        }
        settled.sort_unstable_by_key(|s| s.0);
        let polygon = |i: usize| all[i].polygon_in(self.cell);
        Some(kept(settled.into_iter(), &self.facets.parts, polygon))
    }

    /// Decides which parts of the facets in one plane of the grid bound the result; `None` if two facets of
    /// one operand overlap.
    fn keep_sheet(&self, sheet: &[usize], settled: &mut Vec<StayingElement>) -> Option<()> {
        let all = &self.facets.all;
        let facet = &all[sheet[0]];
        let plane = (facet.axis, self.positions[sheet[0]].line);
        let runs = sheet.chunk_by(|a, b| all[*a].operand == all[*b].operand);
        let runs: SmallVec<[&[usize]; 2]> = runs.collect();
        if runs.iter().any(|own| self.any_overlap(own)) {
            return None;
        }
        let operands: SmallVec<[usize; 2]> = runs.iter().map(|own| all[own[0]].operand).collect();
        for (own, staying) in runs.iter().zip(self.staying_rectangles(plane, &operands)) {
            poll();
            settled.extend(
                own.iter()
                    .filter_map(|i| self.staying_element(*i, &staying)),
            );
        }
        Some(())
    }

    /// Returns for each operand with facets in a plane the rectangles in which its faces stay, row by row, as
    /// two words: rectangles with the inside of the result below the plane, and with the inside above it.
    fn staying_rectangles(&self, plane: Plane, operands: &[usize]) -> SmallVec<[Vec<[u64; 2]>; 2]> {
        let (row, _) = OTHER_AXES[plane.0];
        let rows = self.grid.count(row);
        let none = |_| Vec::with_capacity(rows);
        let mut staying: SmallVec<[Vec<[u64; 2]>; 2]> = operands.iter().map(none).collect();
        for row in 0..rows {
            poll();
            let [below, above] = self.sides(self.value, plane, row);
            let changed = below ^ above;
            if changed == 0 {
                staying.iter_mut().for_each(|staying| staying.push([0; 2]));
                continue;
            }
            let bounds = |k: &usize| self.changes_across(*k, plane, row) & changed;
            let bounds: SmallVec<[u64; 4]> = operands.iter().map(bounds).collect();
            let contested = contested(&bounds);
            let owners = self.owners_of_contested(contested, plane, row);
            for ((staying, k), bounds) in staying.iter_mut().zip(operands).zip(bounds) {
                let won = owners.iter().filter(|(owner, _)| owner == k);
                let won = won.fold(0, |all, (_, won)| all | won);
                let own = bounds & !contested | won & contested;
                staying.push([below & own, above & own]);
            }
        }
        staying
    }

    /// Returns whose face stays in rectangles of a row in which faces of several operands bound the
    /// expression, as pairs of an operand's index and a word of rectangles; `contested` marks these
    /// rectangles.
    fn owners_of_contested(&self, contested: u64, plane: Plane, row: usize) -> Vec<(usize, u64)> {
        if contested == 0 {
            return Vec::new();
        }
        let index = |number: u32| self.operand_indices[number as usize];
        let side = |side: usize| move |k: u32| self.sides(&self.fields[index(k)], plane, row)[side];
        let owners = self.expression.owners(side(0), side(1)).into_iter();
        owners.map(|(k, won)| (index(k), won)).collect()
    }

    /// Returns the rectangles in a row of a plane across which an operand changes between inside and outside.
    fn changes_across(&self, operand: usize, plane: Plane, row: usize) -> u64 {
        let [below, above] = self.sides(&self.fields[operand], plane, row);
        below ^ above
    }

    fn sides(&self, field: &[u64], (axis, line): Plane, row: usize) -> [u64; 2] {
        self.grid.sides(field, axis, line, row)
    }

    /// Returns true if facets of one operand and plane with opposite orientations overlap. Facets with the
    /// same orientation cannot overlap if all winding numbers are 0 or 1.
    fn any_overlap(&self, own: &[usize]) -> bool {
        let rises = |i: &&usize| self.facets.all[**i].change() > 0;
        let (up, down): (Vec<&usize>, Vec<&usize>) = own.iter().partition(rises);
        up.iter()
            .any(|a| down.iter().any(|b| self.two_overlap(**a, **b)))
    }

    fn two_overlap(&self, a: usize, b: usize) -> bool {
        let (p, q) = (&self.positions[a], &self.positions[b]);
        let apart = |p: &Range<usize>, q: &Range<usize>| p.end <= q.start || q.end <= p.start;
        if apart(&p.rows.touched, &q.rows.touched) || apart(&p.bits.touched, &q.bits.touched) {
            return false;
        }
        let polygon = |i: usize| self.facets.all[i].polygon_in(self.cell);
        match (polygon(a), polygon(b)) {
            (Some(a), Some(b)) => !a.is_separated_from(&b),
            _ => false,
        }
    }

    /// Returns the parts of a facet that bound the result in each orientation, given the rectangles of its
    /// plane in which the operand's faces stay; `None` if the facet does not meet the cell.
    fn staying_element(&self, i: usize, staying: &[[u64; 2]]) -> Option<StayingElement> {
        let (facet, position) = (&self.facets.all[i], &self.positions[i]);
        let staying = &staying[position.rows.touched.clone()];
        let below = usize::from(!facet.upward);
        let sides = [below, 1 - below];
        let alike = sides.map(|side| all_alike(staying, side, mask(&position.bits.touched)));
        let stays = if let [Some(same), Some(turned)] = alike {
            let present = self
                .touched_rectangles(facet, position)
                .any(|held| held != 0);
            present.then(|| {
                [same, turned].map(|all| {
                    if all {
                        StayingRegion::All
                    } else {
                        StayingRegion::Nothing
                    }
                })
            })
        } else {
            let held: Vec<u64> = self.touched_rectangles(facet, position).collect();
            let side =
                |side: usize| self.side(facet, position.rows.touched.start, &held, staying, side);
            let present = held.iter().any(|h| *h != 0);
            present.then(|| sides.map(side))
        };
        Some((i, facet.owner(), stays?))
    }

    /// Returns the part of a facet that bounds the result in one orientation; `held` has the rectangles that
    /// the facet touches, row by row from row `first` on, and `staying` the rectangles that stay.
    fn side(
        &self,
        facet: &Facet,
        first: usize,
        held: &[u64],
        staying: &[[u64; 2]],
        side: usize,
    ) -> StayingRegion {
        let kept: Vec<u64> = staying.iter().zip(held).map(|(o, h)| o[side] & h).collect();
        if kept == held {
            return StayingRegion::All;
        }
        if kept.iter().all(|k| *k == 0) {
            return StayingRegion::Nothing;
        }
        StayingRegion::of(pieces(self.cell, self.grid, facet, first, held, &kept))
    }

    /// Returns the rectangles of the grid that a facet touches, as a word of bits for each row.
    fn touched_rectangles<'b>(
        &'b self,
        facet: &'b Facet,
        position: &'b FacetPosition,
    ) -> impl Iterator<Item = u64> + 'b {
        let (row, bit) = OTHER_AXES[facet.axis];
        let line = move |i: usize, j: usize| [self.grid.line(row, i), self.grid.line(bit, j)];
        position.rows.touched.clone().map(move |r| {
            if facet.is_rectangle() {
                return mask(&position.bits.touched);
            }
            let touched = |b: &usize| facet.touches(line(r, *b), line(r + 1, b + 1));
            let touched = position.bits.touched.clone().filter(touched);
            touched.fold(0, |all, b| all | 1 << b)
        })
    }
}

/// Returns the bits that are set in more than one word.
fn contested(words: &[u64]) -> u64 {
    let (mut once, mut more) = (0, 0);
    for word in words {
        more |= once & word;
        once |= word;
    }
    more
}

/// Returns true if all bits of `mask` are set in all rows, and false if no bit is set in any row; `None` if
/// they are mixed. `side` selects one of the two words of a row.
fn all_alike(staying: &[[u64; 2]], side: usize, mask: u64) -> Option<bool> {
    let mut bits = staying.iter().map(|o| o[side] & mask);
    let first = bits.next()?;
    let alike = (first == 0 || first == mask) && bits.all(|b| b == first);
    alike.then_some(first != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_is_alike_if_all_rows_hold_all_of_the_mask_or_nothing() {
        assert_eq!(all_alike(&[[0b110, 0b001]; 2], 0, 0b110), Some(true));
        assert_eq!(all_alike(&[[0b110, 0b001]; 2], 1, 0b110), Some(false));
        assert_eq!(all_alike(&[[0b110, 0], [0, 0]], 0, 0b110), None);
        assert_eq!(all_alike(&[[0b010, 0]; 2], 0, 0b110), None);
    }
}
