//! The positions of facets (faces perpendicular to axes) in the grid of a cell.

use super::facet::{Facet, FacetOrigin, OTHER_AXES};
use super::grid::{Grid, IntervalRange};

/// The position of a facet in the grid of a cell.
pub(super) struct FacetPosition {
    /// The number of the facet's plane among the grid's planes on its axis.
    pub(super) line: usize,
    /// The rows of rectangles that the facet's bounds overlap.
    pub(super) rows: IntervalRange,
    /// The bits in each row that the facet's bounds overlap.
    pub(super) bits: IntervalRange,
}

impl Facet<'_> {
    /// Returns the intervals of the grid on an axis that the facet's bounds overlap.
    fn interval_range(&self, grid: &Grid, axis: usize) -> IntervalRange {
        match &self.origin {
            FacetOrigin::Face(_, _, corners) => {
                let along = corners.map(|p| 2 * p[axis]);
                let [a, b, c] = along;
                grid.intervals_between(axis, a.min(b).min(c), a.max(b).max(c))
            }
            FacetOrigin::Plane(..) => IntervalRange::all(grid.count(axis)),
            FacetOrigin::Piece(_, polygon) => grid.intervals_under(axis, polygon),
        }
    }

    /// Returns the position of the facet in a grid.
    pub(super) fn position(&self, grid: &Grid) -> FacetPosition {
        let (row, bit) = OTHER_AXES[self.axis];
        FacetPosition {
            line: grid.number_of_plane(self.axis, self.at),
            rows: self.interval_range(grid, row),
            bits: self.interval_range(grid, bit),
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
            let position = facet.position(&grid);
            assert_eq!(position.line, if facet.at == 1 { 1 } else { 2 });
            assert_eq!((position.rows.touched, position.bits.touched), (1..2, 1..2));
        }
    }
}
