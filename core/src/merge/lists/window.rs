//! A box of equally large cells of the dyadic hierarchy (a window), and the indices of its cells.
// Counts and the indices of cells are never negative, and indices outside the window are at least -1.

use std::ops::Range;

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;

/// The most cells of a window along one axis: an index in the window or just outside it fits into ten bits.
const MAX_CELLS_PER_AXIS: i64 = 1022;

/// A box of equally large cells of the dyadic hierarchy, numbered along each axis from the lowest one.
///
/// A coordinate's *cell index* on an axis is the index of its cell along the axis, −1 below the window, and
/// the number of cells above it. The *lines* of an axis are the planes that bound the cells, numbered from 0
/// to the number of cells.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// The binary logarithm of the cells' extent in lattice steps, the same on all axes.
    size: u32,
    first: Lattice,
    count: [i32; 3],
}

/// The range of cell indices that a face's bounding box covers on each axis, −1 and the number of cells
/// standing for outside the window.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The number of the face among the faces of a deferred leaf.
    pub element: u32,
    /// The lowest cell index on each axis.
    pub low: [i16; 3],
    /// The highest cell index on each axis.
    pub high: [i16; 3],
}

impl Span {
    /// Makes the range of a face from its three corners' cell indices, packed as by `Window::code`.
    pub fn new(element: u32, codes: [u32; 3]) -> Self {
        let field = |code: u32, i: usize| ((code >> (20 - 10 * i)) & 0x3ff) as i16 - 1;
        let ends = |pick: fn(i16, i16) -> i16| {
            each_axis(|i| {
                codes
                    .map(|c| field(c, i))
                    .into_iter()
                    .reduce(pick)
                    .unwrap_or(0)
            })
        };
        Self {
            element,
            low: ends(i16::min),
            high: ends(i16::max),
        }
    }

    /// Returns the numbers of the planes across an axis, between cells of a window, that lie within the
    /// face's range.
    pub fn lines(&self, axis: usize) -> Range<i32> {
        i32::from(self.low[axis]) + 1..i32::from(self.high[axis]) + 1
    }
}

impl Window {
    /// Returns the window of the cells of extent 2^`size` that a lattice box meets; `None` if they are more
    /// than `MAX_CELLS_PER_AXIS` on an axis.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "not above MAX_CELLS_PER_AXIS"
    )]
    pub fn around(low: &Lattice, high: &Lattice, size: u32) -> Option<Self> {
        let first = low.map(|k| k >> size);
        let count = each_axis(|i| (high[i] >> size) - first[i] + 1);
        count
            .iter()
            .all(|c| (1..=MAX_CELLS_PER_AXIS).contains(c))
            .then(|| Self {
                size,
                first,
                count: count.map(|c| c as i32),
            })
    }

    /// The binary logarithm of the cells' extent in lattice steps, the same on all axes.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// Returns the number of cells along each axis.
    pub fn count(&self) -> [i32; 3] {
        self.count
    }

    /// Returns the number of cells in the window.
    pub fn len(&self) -> usize {
        self.count
            .iter()
            .map(|c| c.cast_unsigned() as usize)
            .product()
    }

    #[inline]
    #[allow(clippy::cast_possible_truncation, reason = "clamped before")]
    fn cell_index(&self, axis: usize, k: i64) -> i32 {
        ((k >> self.size) - self.first[axis]).clamp(-1, i64::from(self.count[axis])) as i32
    }

    /// Packs a lattice point's three cell indices into one 32-bit word, equal for all points of a cell.
    #[inline]
    pub fn code(&self, p: &Lattice) -> u32 {
        let field = |i: usize| (self.cell_index(i, p[i]) + 1).cast_unsigned();
        field(0) << 20 | field(1) << 10 | field(2)
    }

    /// Returns the number of a cell in the window from its index on each axis; the last axis varies fastest.
    #[inline]
    pub fn index(&self, at: [i32; 3]) -> usize {
        let count = self.count;
        ((at[0] * count[1] + at[1]) * count[2] + at[2]).cast_unsigned() as usize
    }

    /// Returns the number of the cell whose indices `Window::code` packed; `None` outside the window.
    #[inline]
    pub fn index_of(&self, code: u32) -> Option<u32> {
        let at = each_axis(|i| ((code >> (20 - 10 * i)) & 0x3ff).cast_signed() - 1);
        let inside = (0..3).all(|i| (0..self.count[i]).contains(&at[i]));
        inside.then(|| as_number(self.index(at)))
    }

    /// Returns the coordinate of plane number `line` between the cells across an axis, in half lattice steps.
    pub fn line(&self, axis: usize, line: i32) -> i64 {
        2 * ((self.first[axis] + i64::from(line)) << self.size) - 1
    }

    /// Returns the lowest and the highest lattice point of a box of cells, given by its lowest and highest
    /// cell.
    pub fn extent(&self, low: &[i32; 3], high: &[i32; 3]) -> (Lattice, Lattice) {
        let start = |i: usize, place: i32| (self.first[i] + i64::from(place)) << self.size;
        (
            each_axis(|i| start(i, low[i])),
            each_axis(|i| start(i, high[i] + 1) - 1),
        )
    }

    /// Returns for each axis the indices of the window's cells in a larger cell.
    #[inline]
    pub fn cells_in(&self, cell: &Cell) -> [Range<i32>; 3] {
        let high = cell.high();
        each_axis(|i| {
            let low = self.cell_index(i, cell.low()[i]).max(0);
            low..(self.cell_index(i, high[i]) + 1).clamp(low, self.count[i])
        })
    }

    /// Returns for each axis the number of the window's plane through the low corner of a larger cell.
    pub fn corner(&self, cell: &Cell) -> [i32; 3] {
        each_axis(|i| self.cell_index(i, cell.low()[i]).max(0))
    }

    /// Returns true if a cell is larger than the window's cells on an axis, so that halving it cuts none of
    /// them.
    pub fn is_divided_in(&self, cell: &Cell) -> bool {
        cell.size().iter().any(|s| u32::from(*s) > self.size)
    }

    /// Returns the lowest and the highest cell of the window in a face's range; `None` if the face lies
    /// outside the window.
    pub fn within(&self, span: &Span) -> Option<([i32; 3], [i32; 3])> {
        let low = span.low.map(|p| i32::from(p).max(0));
        let high = each_axis(|i| i32::from(span.high[i]).min(self.count[i] - 1));
        (0..3).all(|i| low[i] <= high[i]).then_some((low, high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_cell_have_its_code() {
        let window = Window::around(&[0; 3], &[31; 3], 3).expect("few cells");
        assert_eq!((window.count(), window.len()), ([4; 3], 64));
        let code = window.code(&[8, 0, 31]);
        assert_eq!(code, window.code(&[15, 7, 24]));
        assert_eq!(
            window.index_of(code),
            Some(as_number(window.index([1, 0, 3])))
        );
        assert_eq!(window.index_of(window.code(&[-1, 0, 0])), None);
        // Between the points 7 and 8, in half steps.
        assert_eq!(window.line(0, 1), 15);
    }

    #[test]
    fn a_span_lies_across_the_lines_between_its_corners() {
        let window = Window::around(&[0; 3], &[31; 3], 3).expect("few cells");
        let codes = [[1, 1, 1], [20, 2, 2], [2, 9, 3]].map(|p| window.code(&p));
        let span = Span::new(0, codes);
        assert_eq!([0, 1, 2].map(|axis| span.lines(axis)), [1..3, 1..2, 1..1]);
        assert_eq!(window.within(&span), Some(([0; 3], [2, 1, 0])));
    }
}
