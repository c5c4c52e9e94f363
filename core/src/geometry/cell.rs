//! Cells: boxes of lattice points that repeated halving of the whole lattice makes, the same for all solids.

use super::axes::each_axis;
use super::plane::{Lattice, Plane};
use super::side::Half;
use crate::arith::bounds::COORDINATE_BITS;

/// A box of the hierarchy that halving makes: the lattice points `low[i] .. low[i] + 2^size[i]` on each axis
/// i.
///
/// The faces of the box lie half a step outside these points, so that no lattice point, lattice edge or
/// lattice triangle ever lies in a face.
///
/// # Example
/// ```
/// use bspcsg::geometry::cell::Cell;
/// use bspcsg::geometry::side::Half;
///
/// let cell = Cell::around(&[0; 3], &[5, 3, 3]);
/// assert_eq!((*cell.low(), cell.high()), ([0; 3], [7; 3]));
/// // The longest axis is halved, between two lattice points.
/// let cut = cell.cut().expect("more than one point");
/// assert_eq!((cut.axis, cut.at), (0, 4));
/// assert_eq!(cell.half(cut, Half::Plus).low(), &[4, 0, 0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    low: Lattice,
    size: [u8; 3],
}

/// An axis-parallel cut of a cell, half a step below the lattice coordinate `at`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// The axis to which the cut is perpendicular.
    pub axis: usize,
    /// The least lattice coordinate on the plus side.
    pub at: i64,
}

impl Cell {
    /// The cell of all lattice points.
    #[allow(clippy::cast_possible_truncation, reason = "a small constant")]
    pub const UNIVERSE: Self = Self {
        low: [-(1 << COORDINATE_BITS); 3],
        size: [COORDINATE_BITS as u8 + 1; 3],
    };

    /// The lattice point of the cell with the smallest coordinates.
    pub fn low(&self) -> &Lattice {
        &self.low
    }

    /// The lattice point of the cell with the largest coordinates.
    #[inline]
    pub fn high(&self) -> Lattice {
        let high = |i: usize| self.low[i] + (1i64 << self.size[i]) - 1;
        [high(0), high(1), high(2)]
    }

    /// The binary logarithms of the numbers of lattice points along the axes.
    pub fn size(&self) -> [u8; 3] {
        self.size
    }

    /// The corner of the cell with the smallest coordinates, in half lattice steps.
    pub fn corner(&self) -> Lattice {
        let [x, y, z] = self.low;
        [2 * x - 1, 2 * y - 1, 2 * z - 1]
    }

    /// The cut through the middle of the cell, across its longest axis; `None` if it has a single lattice
    /// point.
    pub fn cut(&self) -> Option<Cut> {
        let s = self.size;
        let axis = if s[0] >= s[1] && s[0] >= s[2] {
            0
        } else if s[1] >= s[2] {
            1
        } else {
            2
        };
        (s[axis] > 0).then(|| Cut {
            axis,
            at: self.low[axis] + (1i64 << (s[axis] - 1)),
        })
    }

    /// The half of the cell on one side of its middle cut.
    #[must_use]
    pub fn half(&self, cut: Cut, half: Half) -> Self {
        let mut cell = *self;
        cell.size[cut.axis] -= 1;
        if half == Half::Plus {
            cell.low[cut.axis] = cut.at;
        }
        cell
    }

    /// Return whether every lattice point of `other` is also in this cell.
    pub fn contains(&self, other: &Self) -> bool {
        self.contains_box(other.low(), &other.high())
    }

    /// Return whether this cell contains all lattice points of a box, given by its lowest and highest point.
    pub fn contains_box(&self, low: &Lattice, high: &Lattice) -> bool {
        let top = self.high();
        (0..3).all(|i| self.low[i] <= low[i] && high[i] <= top[i])
    }

    /// Return whether the two cells have a lattice point in common.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        self.meets_box(other.low(), &other.high())
    }

    /// Return whether the cell and a box, given by its lowest and highest lattice point, have a lattice point
    /// in common.
    #[inline]
    pub fn meets_box(&self, low: &Lattice, high: &Lattice) -> bool {
        let top = self.high();
        (0..3).all(|i| self.low[i] <= high[i] && low[i] <= top[i])
    }

    /// The smallest cell of the hierarchy that contains both cells.
    #[must_use]
    pub fn join(&self, other: &Self) -> Self {
        let (a, b) = (self.high(), other.high());
        let low = each_axis(|i| self.low[i].min(other.low[i]));
        Self::around(&low, &each_axis(|i| a[i].max(b[i])))
    }

    /// The smallest cell of the hierarchy that contains a lattice box, given by its lowest and highest point.
    ///
    /// On each axis, the two coordinates of the box differ only in a number of low binary digits; the cell
    /// can be halved that many times. The next cut is across the first axis with the largest such number.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "an exponent of coordinates"
    )]
    pub fn around(low: &Lattice, high: &Lattice) -> Self {
        let origin = Self::UNIVERSE.low;
        let place = |p: &Lattice, i: usize| (p[i] - origin[i]).cast_unsigned();
        let differing = |i: usize| u64::BITS - (place(low, i) ^ place(high, i)).leading_zeros();
        let differing = [differing(0), differing(1), differing(2)];
        let most = differing.into_iter().max().unwrap_or(0);
        let next = differing.iter().position(|d| *d == most).unwrap_or(0);
        let size = each_axis(|i| most - u32::from(i < next));
        let low = each_axis(|i| origin[i] + (place(low, i) >> size[i] << size[i]).cast_signed());
        let size = size.map(|s| s as u8);
        Self { low, size }
    }

    /// The six planes that bound the cell, with the cell on their minus sides: for each axis the low one,
    /// then the high one.
    pub fn walls(&self) -> [Plane; 6] {
        let high = self.high();
        let wall = |i: usize| {
            let axis = i / 2;
            if i.is_multiple_of(2) {
                Plane::axis_cut(axis, 2 * self.low[axis] - 1).flipped()
            } else {
                Plane::axis_cut(axis, 2 * high[axis] + 1)
            }
        };
        [wall(0), wall(1), wall(2), wall(3), wall(4), wall(5)]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Cell, Half, Lattice, COORDINATE_BITS};
    use crate::geometry::axes::each_axis;

    /// Coordinates near each other, near zero, and anywhere.
    fn point() -> impl Strategy<Value = Lattice> {
        let most = (1i64 << COORDINATE_BITS) - 1;
        let coordinate = prop_oneof![-3i64..=3, 1i64 << 40..(1i64 << 40) + 9, -most..=most];
        prop::array::uniform3(coordinate)
    }

    proptest! {
        /// Halving the universe until a cut has points on both sides ends in the same cell.
        #[test]
        fn around_is_where_halving_ends(a in point(), b in point()) {
            let low = each_axis(|i| a[i].min(b[i]));
            let high = each_axis(|i| a[i].max(b[i]));
            let mut cell = Cell::UNIVERSE;
            while let Some(cut) = cell.cut() {
                let halves = Half::BOTH.map(|half| cell.half(cut, half));
                match halves.into_iter().find(|half| half.contains_box(&low, &high)) {
                    Some(half) => cell = half,
                    None => break,
                }
            }
            prop_assert_eq!(Cell::around(&low, &high), cell);
        }
    }
}
