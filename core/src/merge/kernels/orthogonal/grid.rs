//! The grid into which the planes of all facets (faces perpendicular to axes) divide a cell.

use std::ops::Range;
use std::sync::Arc;

use super::facet::Facets;
use crate::arith::convert::as_double;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Plane;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// The most intervals on each axis: the boxes of a column along z are the bits of one 64-bit word.
const MAX_INTERVALS: usize = 64;

/// The grid of a cell: on each axis, coordinates of planes (lines) with intervals between them; the first and
/// the last are the cell's walls.
pub(super) struct Grid {
    /// For each axis the coordinates of its planes in half lattice steps, ascending.
    lines: [Vec<i64>; 3],
    /// The planes at these coordinates, with smaller coordinates on their minus sides.
    planes: [Vec<Arc<Plane>>; 3],
}

impl Grid {
    /// Makes the grid of all facets' planes in a cell; `None` if an axis has more than `MAX_INTERVALS`
    /// intervals.
    pub(super) fn new(cell: &Cell, facets: &Facets) -> Option<Self> {
        let mut lines = [0, 1, 2].map(|i| vec![2 * cell.low()[i] - 1, 2 * cell.high()[i] + 1]);
        for facet in &facets.all {
            poll();
            lines[facet.axis].push(2 * facet.at);
        }
        for line in &mut lines {
            line.sort_unstable();
            line.dedup();
        }
        let planes = [0, 1, 2].map(|i| {
            let plane = |at: &i64| Arc::new(Plane::axis_cut(i, *at));
            lines[i].iter().map(plane).collect()
        });
        let fits = lines.iter().all(|l| l.len() <= MAX_INTERVALS + 1);
        fits.then_some(Self { lines, planes })
    }

    /// Returns the number of intervals on an axis.
    pub(super) fn count(&self, axis: usize) -> usize {
        self.lines[axis].len() - 1
    }

    /// Returns the coordinate of plane number `line` on an axis, in half lattice steps; interval `i` lies
    /// between planes `i` and `i + 1`.
    pub(super) fn line(&self, axis: usize, line: usize) -> i64 {
        self.lines[axis][line]
    }

    /// Returns plane number `line` on an axis.
    pub(super) fn plane(&self, axis: usize, line: usize) -> &Arc<Plane> {
        &self.planes[axis][line]
    }

    /// Returns the number of the plane at a lattice coordinate on an axis.
    pub(super) fn number_of_plane(&self, axis: usize, at: i64) -> usize {
        self.lines[axis].partition_point(|l| *l < 2 * at)
    }

    /// Returns the intervals that overlap the range between two coordinates, given in half lattice steps.
    pub(super) fn intervals_between(&self, axis: usize, low: i64, high: i64) -> IntervalRange {
        let lines = &self.lines[axis];
        let below = |at: i64| lines.partition_point(|l| *l < at);
        let low = below(low)..lines.partition_point(|l| *l <= low);
        IntervalRange::new(&low, below(high), self.count(axis))
    }

    /// Returns the intervals on an axis that a polygon's bounds overlap.
    pub(super) fn intervals_under(&self, axis: usize, polygon: &Polygon) -> IntervalRange {
        let (mut low, mut below) = (usize::MAX..usize::MAX, 0);
        for corner in polygon.corners() {
            let planes = self.planes_up_to(axis, &corner.at);
            low = low.start.min(planes.start)..low.end.min(planes.end);
            below = below.max(planes.start);
        }
        IntervalRange::new(&low, below, self.count(axis))
    }

    /// Returns the number of planes on an axis below a point, and the number of planes below it or through
    /// it.
    fn planes_up_to(&self, axis: usize, point: &Vertex) -> Range<usize> {
        let lines = &self.lines[axis];
        if let Some(at) = point.doubled_coordinate(axis) {
            return lines.partition_point(|l| *l < at)..lines.partition_point(|l| *l <= at);
        }
        let least = 2.0 * point.bounds().0[axis];
        let below = lines.partition_point(|l| as_double(*l) < least);
        let side = |line: &Arc<Plane>| point.side_of(line);
        let start = below + count(&self.planes[axis][below..], |line| side(line) == Side::Plus);
        start..start + count(&self.planes[axis][start..], |line| side(line) == Side::On)
    }

    /// Returns the number of columns of boxes along z.
    pub(super) fn columns(&self) -> usize {
        self.count(0) * self.count(1)
    }

    /// Returns the index of the column of boxes in interval `x` on the first and interval `y` on the second
    /// axis.
    pub(super) fn column(&self, x: usize, y: usize) -> usize {
        x * self.count(1) + y
    }

    /// Returns two words of bits for a row of rectangles in plane number `line` on an axis: the values of the
    /// boxes below and above them. `field` has a word of values for each column along z.
    pub(super) fn sides(&self, field: &[u64], axis: usize, line: usize, row: usize) -> [u64; 2] {
        match axis {
            0 => [line - 1, line].map(|x| field[self.column(x, row)]),
            1 => [line - 1, line].map(|y| field[self.column(row, y)]),
            _ => {
                let columns = &field[self.column(row, 0)..self.column(row + 1, 0)];
                let bit = |z: usize| {
                    let bits = columns.iter().rev();
                    bits.fold(0, |all, column| all << 1 | (column >> z & 1))
                };
                [bit(line - 1), bit(line)]
            }
        }
    }
}

/// The intervals on an axis of the grid that overlap the bounds of a facet.
pub(super) struct IntervalRange {
    /// The intervals that share more than a point with the facet's bounds.
    pub(super) touched: Range<usize>,
    /// The first interval that begins inside the facet's bounds.
    first: usize,
}

impl IntervalRange {
    /// Makes the intervals for bounds whose low end has `low.start` planes below it and `low.end` below or
    /// through it, and whose high end has `below` planes below it; `count` is the number of intervals.
    fn new(low: &Range<usize>, below: usize, count: usize) -> Self {
        let end = below.min(count);
        Self {
            touched: (low.end.max(1) - 1).min(end)..end,
            first: low.start,
        }
    }

    /// Makes a range of all `count` intervals.
    pub(super) fn all(count: usize) -> Self {
        Self {
            touched: 0..count,
            first: 0,
        }
    }

    /// Returns the intervals that begin inside the facet's bounds.
    pub(super) fn begun_inside(&self) -> Range<usize> {
        self.first.min(self.touched.end)..self.touched.end
    }
}

/// Returns the number of leading planes for which `holds` is true.
fn count(planes: &[Arc<Plane>], is_counted: impl Fn(&Arc<Plane>) -> bool) -> usize {
    planes.iter().take_while(|line| is_counted(line)).count()
}

/// Returns a word with the bits of a range set.
pub(super) fn mask(range: &Range<usize>) -> u64 {
    if range.is_empty() {
        return 0;
    }
    (u64::MAX >> (64 - range.len())) << range.start
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn planes_of_facets_and_walls_of_the_cell_are_lines() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let operands = scene.operands();
        let facets = Facets::new(&scene.cell, &operands, &scene.sources).expect("upright");
        let grid = Grid::new(&scene.cell, &facets).expect("a coarse grid");
        let lines: Vec<i64> = (0..4).map(|line| grid.line(0, line)).collect();
        assert_eq!(lines, [-1, 2, 6, 7]);
        assert_eq!(
            (grid.count(0), grid.columns(), grid.number_of_plane(0, 3)),
            (3, 9, 2)
        );
        assert_eq!(grid.intervals_between(0, 2, 6).touched, 1..2);
    }

    #[test]
    fn masks_have_the_bits_of_a_range() {
        assert_eq!(
            (mask(&(2..5)), mask(&(3..3)), mask(&(0..64))),
            (0b11100, 0, u64::MAX)
        );
    }
}
