//! The grid that all facets' planes make of a cell.

use std::ops::Range;
use std::sync::Arc;

use super::facet::Facets;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Plane;
use crate::geometry::vertex::Vertex;

/// Intervals on each axis, at most: the regions above a rectangle are the bits of one word.
const MOST: usize = 64;

/// The grid: on each axis intervals between lines, of which the first and last are the cell's walls.
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
        let fits = lines.iter().all(|l| l.len() <= MOST + 1);
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

    /// The intervals that share more than a point with the one between two doubled coordinates.
    pub(super) fn between(&self, axis: usize, low: i64, high: i64) -> Range<usize> {
        let lines = &self.lines[axis];
        let up_to = lines.partition_point(|l| *l <= low);
        let below = lines.partition_point(|l| *l < high);
        up_to.max(1) - 1..below.min(lines.len() - 1)
    }

    /// The intervals between the lowest and the highest of some points.
    pub(super) fn between_vertices(&self, axis: usize, points: &[&Vertex]) -> Range<usize> {
        let planes = &self.planes[axis];
        let at_most = |p: &Vertex, line: &Arc<Plane>| p.side_of(line) >= 0;
        let below = |p: &Vertex, line: &Arc<Plane>| p.side_of(line) > 0;
        let low = planes.partition_point(|l| points.iter().all(|p| at_most(p, l)));
        let high = planes.partition_point(|l| points.iter().any(|p| below(p, l)));
        low.max(1) - 1..high.min(planes.len() - 1)
    }

    /// The number of columns along z.
    pub(super) fn columns(&self) -> usize {
        self.count(0) * self.count(1)
    }

    /// The place of a column.
    pub(super) fn column(&self, x: usize, y: usize) -> usize {
        x * self.count(1) + y
    }

    /// Of a field of columns the rectangles of one row below and above a line, as bits.
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

/// The bits of a range.
pub(super) fn mask(range: &Range<usize>) -> u64 {
    if range.is_empty() {
        return 0;
    }
    (u64::MAX >> (64 - range.len())) << range.start
}
