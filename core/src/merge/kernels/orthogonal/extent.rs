//! The positions of facets (faces perpendicular to axes) in the grid of a cell.

use super::facet::{Facet, Place, ACROSS};
use super::grid::{Grid, Reach};

/// The position of a facet in the grid of a cell.
pub(super) struct Extent {
    /// The number of the facet's plane among the grid's planes on its axis.
    pub(super) line: usize,
    /// The rows of rectangles that the facet's bounds overlap.
    pub(super) rows: Reach,
    /// The bits in each row that the facet's bounds overlap.
    pub(super) bits: Reach,
}

impl Facet<'_> {
    /// Returns the intervals of the grid on an axis that the facet's bounds overlap.
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

    /// Returns the position of the facet in a grid.
    pub(super) fn extent(&self, grid: &Grid) -> Extent {
        let (row, bit) = ACROSS[self.axis];
        Extent {
            line: grid.find(self.axis, self.at),
            rows: self.reach(grid, row),
            bits: self.reach(grid, bit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::facet::Facets;
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn facets_of_a_box_lie_in_the_middle_of_its_grid() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let operands = scene.operands();
        let facets = Facets::new(&scene.cell, &operands, &scene.sources).expect("upright");
        let grid = Grid::new(&scene.cell, &facets).expect("a coarse grid");
        for facet in &facets.all {
            let extent = facet.extent(&grid);
            assert_eq!(extent.line, if facet.at == 1 { 1 } else { 2 });
            assert_eq!((extent.rows.touched, extent.bits.touched), (1..2, 1..2));
        }
    }
}
