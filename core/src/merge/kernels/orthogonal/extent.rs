//! The places of facets in a grid.

use super::facet::{Facet, Place, ACROSS};
use super::grid::{Grid, Reach};

/// The place of a facet in a grid.
pub(super) struct Extent {
    /// The number of the line that is its plane.
    pub(super) line: usize,
    /// Its rows.
    pub(super) rows: Reach,
    /// Its bits.
    pub(super) bits: Reach,
}

impl Facet<'_> {
    /// Return the stretch of the facet's bounds on an axis.
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

    /// Return the place of the facet in a grid.
    pub(super) fn extent(&self, grid: &Grid) -> Extent {
        let (row, bit) = ACROSS[self.axis];
        Extent {
            line: grid.find(self.axis, self.at),
            rows: self.reach(grid, row),
            bits: self.reach(grid, bit),
        }
    }
}
