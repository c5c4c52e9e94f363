//! Where facets lie in a grid.

use super::facet::{Facet, Place, ACROSS};
use super::grid::{Grid, Reach};

/// Where a facet lies in a grid.
pub(super) struct Extent {
    /// The number of the line that is its plane.
    pub(super) line: usize,
    /// Its rows.
    pub(super) rows: Reach,
    /// Its bits.
    pub(super) bits: Reach,
}

impl Facet<'_> {
    /// Where the facet's bounds lie on an axis.
    fn reach(&self, grid: &Grid, axis: usize) -> Reach {
        match &self.place {
            Place::Face(_, _, corners) => {
                let along = corners.map(|p| 2 * p[axis]);
                let [a, b, c] = along;
                grid.between(axis, a.min(b).min(c), a.max(b).max(c))
            }
            Place::Plane(..) => Reach::all(grid.count(axis)),
            Place::Piece(_, polygon) => grid.under(axis, polygon),
        }
    }

    /// Where the facet lies in a grid.
    pub(super) fn extent(&self, grid: &Grid) -> Extent {
        let (row, bit) = ACROSS[self.axis];
        Extent {
            line: grid.find(self.axis, self.at),
            rows: self.reach(grid, row),
            bits: self.reach(grid, bit),
        }
    }
}
