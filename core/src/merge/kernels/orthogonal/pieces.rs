//! Cuts a facet (a face perpendicular to an axis) into the pieces that bound the result.

use super::facet::{Facet, OTHER_AXES};
use super::grid::Grid;
use crate::geometry::cell::Cell;
use crate::geometry::polygon::{Polygon, PolygonSplit};
use crate::interrupt::poll;

/// Returns polygons that cover those rectangles of a facet that stay in the result.
///
/// Rectangles of the grid are bits in rows, from row `first` on; `touched` marks the ones that the facet
/// touches, and `stay` the ones that stay. Compatible rows form one slab, and each sequence of adjacent set
/// bits in a slab one polygon.
pub(super) fn pieces(
    cell: &Cell,
    grid: &Grid,
    facet: &Facet,
    first: usize,
    touched: &[u64],
    stay: &[u64],
) -> Vec<Polygon> {
    let (row, bit) = OTHER_AXES[facet.axis];
    let mut found = Vec::new();
    let mut rest = facet.polygon_in(cell);
    let mut start = 0;
    while start < stay.len() {
        poll();
        let slab = Slab::new(&touched[start..], &stay[start..]);
        let end = start + slab.rows;
        let below = if end < stay.len() {
            take_below(&mut rest, grid, row, first + end)
        } else {
            rest.take()
        };
        if slab.stay != 0 {
            cut_slab(below, grid, bit, &slab, &mut found);
        }
        start = end;
    }
    found
}

/// Consecutive rows of rectangles that agree on which rectangles of the facet stay and which go.
struct Slab {
    rows: usize,
    stay: u64,
    go: u64,
}

impl Slab {
    /// Returns the longest sequence of first rows that agree.
    fn new(touched: &[u64], kept: &[u64]) -> Self {
        let (mut stay, mut go) = (kept[0], touched[0] & !kept[0]);
        let more = touched[1..].iter().zip(&kept[1..]);
        let alike = more.take_while(|(touched, kept)| {
            let both = (stay | **kept, go | **touched & !**kept);
            let alike = both.0 & both.1 == 0;
            if alike {
                (stay, go) = both;
            }
            alike
        });
        let rows = 1 + alike.count();
        Self { rows, stay, go }
    }

    /// Returns the next sequence of adjacent rectangles that stay, from bit `from` on: its first bit, and the
    /// first later bit that goes; `None` if there is none.
    fn run(&self, from: u32) -> Option<(u32, u32)> {
        let rest = self.stay & u64::MAX.checked_shl(from)?;
        if rest == 0 {
            return None;
        }
        let start = rest.trailing_zeros();
        let end = (self.go & (u64::MAX << start)).trailing_zeros();
        Some((start, end))
    }
}

/// Adds the polygons for the sequences of adjacent rectangles that stay in one slab of a facet; `polygon` is
/// the part of the facet in the slab.
fn cut_slab(
    polygon: Option<Polygon>,
    grid: &Grid,
    bit: usize,
    slab: &Slab,
    found: &mut Vec<Polygon>,
) {
    let mut rest = polygon;
    let mut from = 0;
    while let Some((start, end)) = slab.run(from) {
        // Before the run lies a bit that goes, unless this is the first run.
        if slab.go & ((1 << start) - 1) != 0 {
            take_below(&mut rest, grid, bit, start as usize);
        }
        found.extend(if slab.go.checked_shr(end).unwrap_or(0) != 0 {
            take_below(&mut rest, grid, bit, end as usize)
        } else {
            rest.take()
        });
        from = end;
    }
}

/// Cuts off and returns the part of the polygon `rest` below a plane of the grid; `None` if there is none.
fn take_below(
    rest: &mut Option<Polygon>,
    grid: &Grid,
    axis: usize,
    line: usize,
) -> Option<Polygon> {
    let polygon = rest.take()?;
    match polygon.split(grid.plane(axis, line)) {
        PolygonSplit::Minus | PolygonSplit::Coplanar => Some(polygon),
        PolygonSplit::Plus => {
            *rest = Some(polygon);
            None
        }
        PolygonSplit::Both(minus, plus) => {
            *rest = Some(plus);
            Some(minus)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_alike_make_one_slab() {
        let slab = Slab::new(&[0b111; 3], &[0b011, 0b011, 0b110]);
        assert_eq!((slab.rows, slab.stay, slab.go), (2, 0b011, 0b100));
        assert_eq!((slab.run(0), slab.run(2)), (Some((0, 2)), None));
    }

    #[test]
    fn rectangles_that_the_facet_does_not_touch_may_be_on_either_side() {
        let slab = Slab::new(&[0b101, 0b010], &[0b001, 0b010]);
        assert_eq!((slab.rows, slab.stay, slab.go), (2, 0b011, 0b100));
    }
}
