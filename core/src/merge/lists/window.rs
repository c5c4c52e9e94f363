//! A window on one level of the hierarchy of cells: a box of equal cells, and places in it.
// Counts and the places of cells are never negative, and places beyond the window exceed -2.

use std::ops::Range;

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;

/// The most cells along one axis: places in the window and just outside it fit into ten bits.
const MAX_CELLS_PER_AXIS: i64 = 1022;

/// Equal cells of the hierarchy, numbered from the lowest one.
///
/// A coordinate's *place* on an axis is the number of its cell there, −1 below the window and the count
/// above it. The *lines* are the planes between the cells, numbered from 0 to the count.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// The binary logarithm of the cells' extent, the same on all axes.
    size: u32,
    first: Lattice,
    count: [i32; 3],
}

/// The range of places of a face's bounds, including those outside the window.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The element.
    pub element: u32,
    /// The lowest places.
    pub low: [i16; 3],
    /// The highest places.
    pub high: [i16; 3],
}

impl Span {
    /// The places of a face's corners, packed as by `Window::code`.
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

    /// The lines on an axis that it crosses.
    pub fn lines(&self, axis: usize) -> Range<i32> {
        i32::from(self.low[axis]) + 1..i32::from(self.high[axis]) + 1
    }
}

impl Window {
    /// The cells of extent 2^size that a lattice box meets; `None` if there are too many on an axis.
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

    /// The binary logarithm of the cells' extent.
    pub fn size(&self) -> u32 {
        self.size
    }

    /// The numbers of cells along the axes.
    pub fn count(&self) -> [i32; 3] {
        self.count
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.count
            .iter()
            .map(|c| c.cast_unsigned() as usize)
            .product()
    }

    #[inline]
    #[allow(clippy::cast_possible_truncation, reason = "clamped before")]
    fn place(&self, axis: usize, k: i64) -> i32 {
        ((k >> self.size) - self.first[axis]).clamp(-1, i64::from(self.count[axis])) as i32
    }

    /// The places of a lattice point in one word, equal for all points of a cell.
    #[inline]
    pub fn code(&self, p: &Lattice) -> u32 {
        let field = |i: usize| (self.place(i, p[i]) + 1).cast_unsigned();
        field(0) << 20 | field(1) << 10 | field(2)
    }

    /// The number of a cell in the window; the last axis varies fastest.
    #[inline]
    pub fn index(&self, at: [i32; 3]) -> usize {
        let count = self.count;
        ((at[0] * count[1] + at[1]) * count[2] + at[2]).cast_unsigned() as usize
    }

    /// The number of the cell with this code; `None` outside the window.
    #[inline]
    pub fn index_of(&self, code: u32) -> Option<u32> {
        let at = each_axis(|i| ((code >> (20 - 10 * i)) & 0x3ff).cast_signed() - 1);
        let inside = (0..3).all(|i| (0..self.count[i]).contains(&at[i]));
        inside.then(|| as_number(self.index(at)))
    }

    /// The coordinate of a line in half steps.
    pub fn line(&self, axis: usize, line: i32) -> i64 {
        2 * ((self.first[axis] + i64::from(line)) << self.size) - 1
    }

    /// The lattice box of a box of cells, both ends included.
    pub fn extent(&self, low: &[i32; 3], high: &[i32; 3]) -> (Lattice, Lattice) {
        let start = |i: usize, place: i32| (self.first[i] + i64::from(place)) << self.size;
        (
            each_axis(|i| start(i, low[i])),
            each_axis(|i| start(i, high[i] + 1) - 1),
        )
    }

    /// The places that a larger cell covers.
    #[inline]
    pub fn covered(&self, cell: &Cell) -> [Range<i32>; 3] {
        let high = cell.high();
        each_axis(|i| {
            let low = self.place(i, cell.low()[i]).max(0);
            low..(self.place(i, high[i]) + 1).clamp(low, self.count[i])
        })
    }

    /// The lines through the low corner of a larger cell.
    pub fn corner(&self, cell: &Cell) -> [i32; 3] {
        each_axis(|i| self.place(i, cell.low()[i]).max(0))
    }

    /// Return whether a cell's cut lies between cells of the window.
    pub fn is_divided_in(&self, cell: &Cell) -> bool {
        cell.size().iter().any(|s| u32::from(*s) > self.size)
    }

    /// The cells of the window in a span, as lowest and highest places; `None` if there are none.
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
