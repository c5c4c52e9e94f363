//! The grid of a cell along all facets' planes.

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

/// The most intervals on each axis: the regions above a rectangle are the bits of one word.
const MAX_INTERVALS: usize = 64;

/// The grid: on each axis intervals between lines; the first and last lines are the cell's walls.
pub(super) struct Grid {
    /// Doubled coordinates by axis, ascending.
    lines: [Vec<i64>; 3],
    /// The planes of the lines, the smaller coordinates on their minus sides.
    planes: [Vec<Arc<Plane>>; 3],
}

impl Grid {
    /// The grid of facets; `None` if it is too fine.
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

    /// The number of intervals on an axis.
    pub(super) fn count(&self, axis: usize) -> usize {
        self.lines[axis].len() - 1
    }

    /// The doubled coordinate of a line; interval `i` lies between lines `i` and `i + 1`.
    pub(super) fn line(&self, axis: usize, line: usize) -> i64 {
        self.lines[axis][line]
    }

    /// The plane of a line.
    pub(super) fn plane(&self, axis: usize, line: usize) -> &Arc<Plane> {
        &self.planes[axis][line]
    }

    /// The number of a line with a lattice coordinate.
    pub(super) fn find(&self, axis: usize, at: i64) -> usize {
        self.lines[axis].partition_point(|l| *l < 2 * at)
    }

    /// Return the intervals between two doubled coordinates.
    pub(super) fn between(&self, axis: usize, low: i64, high: i64) -> Reach {
        let lines = &self.lines[axis];
        let below = |at: i64| lines.partition_point(|l| *l < at);
        let low = below(low)..lines.partition_point(|l| *l <= low);
        Reach::new(&low, below(high), self.count(axis))
    }

    /// Return the intervals of a polygon's bounds.
    pub(super) fn under(&self, axis: usize, polygon: &Polygon) -> Reach {
        let (mut low, mut below) = (usize::MAX..usize::MAX, 0);
        for corner in polygon.corners() {
            let place = self.place(axis, &corner.at);
            low = low.start.min(place.start)..low.end.min(place.end);
            below = below.max(place.start);
        }
        Reach::new(&low, below, self.count(axis))
    }

    /// The range from the number of lines below a point to the number of lines not above it.
    fn place(&self, axis: usize, point: &Vertex) -> Range<usize> {
        let lines = &self.lines[axis];
        if let Some(at) = point.doubled(axis) {
            return lines.partition_point(|l| *l < at)..lines.partition_point(|l| *l <= at);
        }
        let least = 2.0 * point.bounds().0[axis];
        let below = lines.partition_point(|l| as_double(*l) < least);
        let side = |line: &Arc<Plane>| point.side_of(line);
        let start = below + count(&self.planes[axis][below..], |line| side(line) == Side::Plus);
        start..start + count(&self.planes[axis][start..], |line| side(line) == Side::On)
    }

    /// The number of columns along z.
    pub(super) fn columns(&self) -> usize {
        self.count(0) * self.count(1)
    }

    /// The index of a column.
    pub(super) fn column(&self, x: usize, y: usize) -> usize {
        x * self.count(1) + y
    }

    /// The rectangles in one row below and above a line, as bits, in a field of columns.
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

/// The intervals of an axis that overlap bounds.
pub(super) struct Reach {
    /// The intervals that share more than a point with the bounds.
    pub(super) touched: Range<usize>,
    /// The first interval that begins inside the bounds.
    first: usize,
}

impl Reach {
    /// Bounds from a place, given by the numbers of lines below it and not above it, to a place with
    /// `below` lines below it, among `count` intervals.
    fn new(low: &Range<usize>, below: usize, count: usize) -> Self {
        let end = below.min(count);
        Self {
            touched: (low.end.max(1) - 1).min(end)..end,
            first: low.start,
        }
    }

    /// All of `count` intervals.
    pub(super) fn all(count: usize) -> Self {
        Self {
            touched: 0..count,
            first: 0,
        }
    }

    /// The intervals that begin inside the bounds.
    pub(super) fn begun(&self) -> Range<usize> {
        self.first.min(self.touched.end)..self.touched.end
    }
}

/// Count the leading lines for which a condition holds.
fn count(planes: &[Arc<Plane>], holds: impl Fn(&Arc<Plane>) -> bool) -> usize {
    planes.iter().take_while(|line| holds(line)).count()
}

/// The bits of a range.
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
        assert_eq!((grid.count(0), grid.columns(), grid.find(0, 3)), (3, 9, 2));
        assert_eq!(grid.between(0, 2, 6).touched, 1..2);
    }

    #[test]
    fn masks_have_the_bits_of_a_range() {
        assert_eq!(
            (mask(&(2..5)), mask(&(3..3)), mask(&(0..64))),
            (0b11100, 0, u64::MAX)
        );
    }
}
