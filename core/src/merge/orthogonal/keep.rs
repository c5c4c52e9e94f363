//! What an expression leaves of the facets of a grid.

use std::ops::Range;

use super::super::kept::Kept;
use super::super::overlay::separated;
use super::super::stays::{kept, Settled, Stays};
use super::facet::{Facet, Facets, ACROSS};
use super::grid::{mask, Grid};
use super::pieces::pieces;
use crate::geometry::cell::Cell;

/// A cell with all that is known of it.
pub(super) struct Scene<'a> {
    pub(super) cell: &'a Cell,
    pub(super) grid: &'a Grid,
    pub(super) facets: &'a Facets<'a>,
    /// By operand the columns of the grid.
    pub(super) fields: &'a [Vec<u64>],
    /// The columns of the expression's value.
    pub(super) value: &'a [u64],
}

impl Scene<'_> {
    /// What stays of all facets; `None` if two of an operand overlap.
    pub(super) fn keep(&self) -> Option<Vec<Kept>> {
        let all = &self.facets.all;
        let mut order: Vec<usize> = (0..all.len()).collect();
        let sheet = |i: &usize| (all[*i].axis, all[*i].at);
        order.sort_by_key(sheet);
        let mut settled: Vec<Settled> = Vec::with_capacity(all.len());
        for sheet in order.chunk_by(|a, b| sheet(a) == sheet(b)) {
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
            if self.overlap(own) {
                return None;
            }
            let line = self.grid.find(facet.axis, facet.at);
            let mut owned = Vec::with_capacity(free.len());
            for (row, free) in free.iter_mut().enumerate() {
                let sides = |field: &[u64]| self.grid.sides(field, facet.axis, line, row);
                let [below, above] = sides(&self.fields[all[own[0]].operand]);
                let differs = (below ^ above) & *free;
                *free &= !differs;
                let [below, above] = if differs == 0 {
                    [0; 2]
                } else {
                    sides(self.value)
                };
                owned.push([below & !above & differs, above & !below & differs]);
            }
            settled.extend(own.iter().filter_map(|i| self.settled(*i, &owned)));
        }
        Some(())
    }

    /// Whether facets of one operand and plane that face different ways overlap. Those that face
    /// the same way do not where winding numbers are 0 and 1.
    fn overlap(&self, own: &[usize]) -> bool {
        let facets = own.iter().map(|i| &self.facets.all[*i]);
        let (up, down): (Vec<&Facet>, Vec<&Facet>) = facets.partition(|f| f.change() > 0);
        up.iter()
            .any(|a| down.iter().any(|b| self.two_overlap(a, b)))
    }

    fn two_overlap(&self, a: &Facet, b: &Facet) -> bool {
        let (row, bit) = ACROSS[a.axis];
        let apart = |axis: usize| {
            let (a, b) = (a.range(self.grid, axis), b.range(self.grid, axis));
            a.end <= b.start || b.end <= a.start
        };
        if apart(row) || apart(bit) {
            return false;
        }
        match (a.polygon_in(self.cell), b.polygon_in(self.cell)) {
            (Some(a), Some(b)) => !separated(&a, &b),
            _ => false,
        }
    }

    /// What stays of a facet, given the rectangles of its plane that stay with the inside below and
    /// above; `None` if it does not meet the cell.
    fn settled(&self, i: usize, owned: &[[u64; 2]]) -> Option<Settled> {
        let facet = &self.facets.all[i];
        let (row, bit) = ACROSS[facet.axis];
        let rows = facet.range(self.grid, row);
        let held = self.held(facet, &rows, &facet.range(self.grid, bit));
        let side = |turned: bool| {
            let side = usize::from(turned == facet.upward);
            let kept = rows.clone().map(|r| owned[r][side]);
            let kept: Vec<u64> = kept.zip(&held).map(|(kept, held)| kept & held).collect();
            if kept.iter().all(|k| *k == 0) {
                Stays::Nothing
            } else if kept == held {
                Stays::All
            } else {
                Stays::of(pieces(
                    self.cell, self.grid, facet, rows.start, &held, &kept,
                ))
            }
        };
        let present = held.iter().any(|h| *h != 0);
        present.then(|| (i, facet.owner(), [side(false), side(true)]))
    }

    /// The rectangles that a facet touches, row by row.
    fn held(&self, facet: &Facet, rows: &Range<usize>, bits: &Range<usize>) -> Vec<u64> {
        if facet.is_rectangle() {
            return vec![mask(bits); rows.len()];
        }
        let (row, bit) = ACROSS[facet.axis];
        let line = |i: usize, j: usize| [self.grid.line(row, i), self.grid.line(bit, j)];
        let touched = |r: usize| {
            let touched = |b: &usize| facet.touches(line(r, *b), line(r + 1, b + 1));
            bits.clone().filter(touched).fold(0, |all, b| all | 1 << b)
        };
        rows.clone().map(touched).collect()
    }
}
