//! Determines the boxes of a cell's grid that are inside an operand.

use std::ops::Range;

use super::facet::{Facet, OTHER_AXES};
use super::grid::{mask, Grid, IntervalRange};
use super::position::FacetPosition;
use crate::interrupt::poll;

/// The coarser grid of one operand's own planes, with the operand's winding number in each box.
struct OperandGrid<'a> {
    grid: &'a Grid,
    /// For each axis, the numbers of the planes of the finer grid at which the operand's intervals begin; at
    /// the end, the finer grid's number of intervals.
    starts: [Vec<usize>; 3],
    numbers: Vec<i32>,
}

/// Returns a word for each column of the grid, with a bit for each box inside the operand; `None` if a
/// winding number is neither 0 nor 1. `corner` is the winding number at the cell's corner.
pub(super) fn field<'b>(
    grid: &Grid,
    facets: impl Iterator<Item = (&'b Facet<'b>, &'b FacetPosition)> + Clone,
    corner: i32,
) -> Option<Vec<u64>> {
    let mut own = OperandGrid::new(grid, facets.clone());
    own.numbers[0] = corner;
    for (facet, position) in facets {
        poll();
        own.enter(facet, position);
    }
    own.add_up();
    let simple = own.numbers.iter().all(|w| (0..=1).contains(w));
    simple.then(|| own.field())
}

impl<'a> OperandGrid<'a> {
    fn new<'b>(
        grid: &'a Grid,
        facets: impl Iterator<Item = (&'b Facet<'b>, &'b FacetPosition)>,
    ) -> Self {
        let mut starts = [0, 1, 2].map(|axis| vec![0, grid.count(axis)]);
        for (facet, position) in facets {
            poll();
            starts[facet.axis].push(position.line);
        }
        for starts in &mut starts {
            starts.sort_unstable();
            starts.dedup();
        }
        let numbers = vec![0; starts.iter().map(|s| s.len() - 1).product()];
        Self {
            grid,
            starts,
            numbers,
        }
    }

    fn count(&self, axis: usize) -> usize {
        self.starts[axis].len() - 1
    }

    fn box_index(&self, [x, y, z]: [usize; 3]) -> usize {
        (x * self.count(1) + y) * self.count(2) + z
    }

    /// Returns the operand's intervals on an axis that begin in a range of intervals of the finer grid.
    fn within(&self, axis: usize, range: &Range<usize>) -> Range<usize> {
        let starts = &self.starts[axis][..self.count(axis)];
        let first = starts.partition_point(|s| *s < range.start);
        first..starts.partition_point(|s| *s < range.end)
    }

    /// Records the change of the winding number across a facet in boxes just above it, from where
    /// [`Self::add_up`] spreads it: if the facet is perpendicular to z, in all boxes that it bounds; if to y,
    /// only in boxes at the lowest z; if to x, only in the box at the lowest y and z.
    fn enter(&mut self, facet: &Facet, position: &FacetPosition) {
        let axis = facet.axis;
        let at = self.starts[axis].partition_point(|s| *s < position.line);
        let (row, bit) = OTHER_AXES[axis];
        let cross = |along: usize, range: &IntervalRange| {
            let all = self.within(along, &range.begun_inside());
            if along > axis {
                all.start..all.end.min(1)
            } else {
                all
            }
        };
        let (rows, bits) = (cross(row, &position.rows), cross(bit, &position.bits));
        for r in rows {
            for b in bits.clone() {
                let corner = [(row, r), (bit, b)]
                    .map(|(axis, i)| self.grid.line(axis, self.starts[axis][i]));
                if facet.contains(corner) {
                    let mut index = [at; 3];
                    (index[row], index[bit]) = (r, b);
                    let index = self.box_index(index);
                    self.numbers[index] += facet.change();
                }
            }
        }
    }

    /// Adds up the changes of the winding number along x, then from there along y, then from there along z.
    fn add_up(&mut self) {
        let [nx, ny, nz] = [0, 1, 2].map(|i| self.count(i));
        for x in 1..nx {
            self.numbers[x * ny * nz] += self.numbers[(x - 1) * ny * nz];
        }
        for x in 0..nx {
            poll();
            for y in 1..ny {
                self.numbers[(x * ny + y) * nz] += self.numbers[(x * ny + y - 1) * nz];
            }
        }
        for column in self.numbers.chunks_mut(nz) {
            for z in 1..nz {
                column[z] += column[z - 1];
            }
        }
    }

    fn interval(&self, axis: usize, i: usize) -> Range<usize> {
        self.starts[axis][i]..self.starts[axis][i + 1]
    }

    /// Returns for each column of the finer grid a word with the bits of the boxes whose winding number is 1.
    fn field(&self) -> Vec<u64> {
        let mut field = vec![0; self.grid.columns()];
        for x in 0..self.count(0) {
            for y in 0..self.count(1) {
                poll();
                let inside = |z: &usize| self.numbers[self.box_index([x, y, *z])] == 1;
                let bits = (0..self.count(2)).filter(inside);
                let word = bits.fold(0, |all, z| all | mask(&self.interval(2, z)));
                for i in self.interval(0, x) {
                    let columns = self.interval(1, y);
                    let row = self.grid.column(i, 0);
                    field[row + columns.start..row + columns.end].fill(word);
                }
            }
        }
        field
    }
}

#[cfg(test)]
mod tests {
    use super::super::facet::Facets;
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn a_box_is_inside_in_the_middle_of_its_grid() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let operands = scene.operands();
        let facets = Facets::new(&scene.cell, &operands, &scene.sources).expect("upright");
        let grid = Grid::new(&scene.cell, &facets).expect("a coarse grid");
        let positions: Vec<FacetPosition> = facets.all.iter().map(|f| f.position(&grid)).collect();
        let field = |corner: i32| field(&grid, facets.all.iter().zip(&positions), corner);
        assert_eq!(field(0), Some(vec![0, 0, 0, 0, 0b010, 0, 0, 0, 0]));
        // With 1 at the corner the box has the number 2, which is refused.
        assert_eq!(field(1), None);
    }
}
