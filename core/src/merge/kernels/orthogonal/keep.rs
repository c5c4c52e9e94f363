//! The faces that an expression leaves of the facets of a grid.

use std::ops::Range;

use super::extent::Extent;
use super::facet::{Facet, Facets, ACROSS};
use super::grid::{mask, Grid};
use super::pieces::pieces;
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::merge::kernels::kept::Kept;
use crate::merge::kernels::stays::{kept, Settled, Stays};

/// A cell with all that is known of it.
pub(super) struct Scene<'a> {
    pub(super) cell: &'a Cell,
    pub(super) grid: &'a Grid,
    pub(super) facets: &'a Facets<'a>,
    /// The places of the facets in the grid.
    pub(super) extents: &'a [Extent],
    /// By operand the columns of the grid.
    pub(super) fields: &'a [Vec<u64>],
    /// The columns of the expression's value.
    pub(super) value: &'a [u64],
}

impl Scene<'_> {
    /// Return what stays of all facets; `None` if two of an operand overlap.
    pub(super) fn keep(&self) -> Option<Vec<Kept>> {
        let all = &self.facets.all;
        let mut order: Vec<usize> = (0..all.len()).collect();
        let sheet = |i: &usize| (all[*i].axis, all[*i].at);
        order.sort_by_key(sheet);
        let mut settled: Vec<Settled> = Vec::with_capacity(all.len());
        for sheet in order.chunk_by(|a, b| sheet(a) == sheet(b)) {
            poll();
            self.keep_sheet(sheet, &mut settled)?;
        }
        settled.sort_unstable_by_key(|s| s.0);
        let polygon = |i: usize| all[i].polygon_in(self.cell);
        Some(kept(settled.into_iter(), &self.facets.parts, polygon))
    }

    /// Settles the facets of one plane, operand by operand: the first of which the label differs
    /// on the two sides owns a place.
    fn keep_sheet(&self, sheet: &[usize], settled: &mut Vec<Settled>) -> Option<()> {
        let facet = &self.facets.all[sheet[0]];
        let (row, _) = ACROSS[facet.axis];
        let mut free = vec![u64::MAX; self.grid.count(row)];
        let all = &self.facets.all;
        for own in sheet.chunk_by(|a, b| all[*a].operand == all[*b].operand) {
            poll();
            if self.overlap(own) {
                return None;
            }
            let owned = self.owned(own[0], &mut free);
            settled.extend(own.iter().filter_map(|i| self.settled(*i, &owned)));
        }
        Some(())
    }

    /// The free rectangles of a facet's plane across which its operand's label and the expression
    /// change, row by row: those with the inside below, and above. They are free no more.
    fn owned(&self, i: usize, free: &mut [u64]) -> Vec<[u64; 2]> {
        let (facet, line) = (&self.facets.all[i], self.extents[i].line);
        let owned = free.iter_mut().enumerate().map(|(row, free)| {
            let sides = |field: &[u64]| self.grid.sides(field, facet.axis, line, row);
            let [below, above] = sides(&self.fields[facet.operand]);
            let differs = (below ^ above) & *free;
            if differs == 0 {
                return [0; 2];
            }
            *free &= !differs;
            let [below, above] = sides(self.value);
            [below & !above & differs, above & !below & differs]
        });
        owned.collect()
    }

    /// Return whether facets of one operand and plane that face different ways overlap. Those that
    /// face the same way do not where winding numbers are 0 and 1.
    fn overlap(&self, own: &[usize]) -> bool {
        let rises = |i: &&usize| self.facets.all[**i].change() > 0;
        let (up, down): (Vec<&usize>, Vec<&usize>) = own.iter().partition(rises);
        up.iter()
            .any(|a| down.iter().any(|b| self.two_overlap(**a, **b)))
    }

    fn two_overlap(&self, a: usize, b: usize) -> bool {
        let (p, q) = (&self.extents[a], &self.extents[b]);
        let apart = |p: &Range<usize>, q: &Range<usize>| p.end <= q.start || q.end <= p.start;
        if apart(&p.rows.touched, &q.rows.touched) || apart(&p.bits.touched, &q.bits.touched) {
            return false;
        }
        let polygon = |i: usize| self.facets.all[i].polygon_in(self.cell);
        match (polygon(a), polygon(b)) {
            (Some(a), Some(b)) => !a.lies_beside(&b),
            _ => false,
        }
    }

    /// Return what stays of a facet, given the rectangles of its plane that stay with the inside
    /// below and above; `None` if it does not meet the cell.
    fn settled(&self, i: usize, owned: &[[u64; 2]]) -> Option<Settled> {
        let (facet, extent) = (&self.facets.all[i], &self.extents[i]);
        let owned = &owned[extent.rows.touched.clone()];
        let below = usize::from(!facet.upward);
        let sides = [below, 1 - below];
        let alike = sides.map(|side| all_alike(owned, side, mask(&extent.bits.touched)));
        let stays = if let [Some(same), Some(turned)] = alike {
            let present = self.touched(facet, extent).any(|held| held != 0);
            present.then(|| [same, turned].map(|all| if all { Stays::All } else { Stays::Nothing }))
        } else {
            let held: Vec<u64> = self.touched(facet, extent).collect();
            let side =
                |side: usize| self.side(facet, extent.rows.touched.start, &held, owned, side);
            let present = held.iter().any(|h| *h != 0);
            present.then(|| sides.map(side))
        };
        Some((i, facet.owner(), stays?))
    }

    /// Return what stays of a facet on one side, of the rectangles that it touches from a row on.
    fn side(
        &self,
        facet: &Facet,
        first: usize,
        held: &[u64],
        owned: &[[u64; 2]],
        side: usize,
    ) -> Stays {
        let kept: Vec<u64> = owned.iter().zip(held).map(|(o, h)| o[side] & h).collect();
        if kept == held {
            return Stays::All;
        }
        if kept.iter().all(|k| *k == 0) {
            return Stays::Nothing;
        }
        Stays::of(pieces(self.cell, self.grid, facet, first, held, &kept))
    }

    /// The rectangles that a facet touches, row by row.
    fn touched<'b>(
        &'b self,
        facet: &'b Facet,
        extent: &'b Extent,
    ) -> impl Iterator<Item = u64> + 'b {
        let (row, bit) = ACROSS[facet.axis];
        let line = move |i: usize, j: usize| [self.grid.line(row, i), self.grid.line(bit, j)];
        extent.rows.touched.clone().map(move |r| {
            if facet.is_rectangle() {
                return mask(&extent.bits.touched);
            }
            let touched = |b: &usize| facet.touches(line(r, *b), line(r + 1, b + 1));
            let touched = extent.bits.touched.clone().filter(touched);
            touched.fold(0, |all, b| all | 1 << b)
        })
    }
}

/// Return whether all bits of a mask are set on one side of every row, or none; `None` if they
/// differ.
fn all_alike(owned: &[[u64; 2]], side: usize, mask: u64) -> Option<bool> {
    let mut bits = owned.iter().map(|o| o[side] & mask);
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
