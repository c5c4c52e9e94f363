//! Cells of the one dyadic hierarchy that all solids share.

use super::plane::{Lattice, Plane};

/// Coordinates are below 2^REACH lattice steps in magnitude.
///
/// A double holds every integer up to 2^53, so that a lattice coordinate is one.
pub const REACH: u32 = 53;

/// A box of the dyadic hierarchy: the lattice points `low[i] .. low[i] + 2^size[i]`.
///
/// Its faces lie half a step outside these points, so that no lattice point, edge or face ever
/// lies in one (design review, F2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    low: Lattice,
    size: [u8; 3],
}

/// An axis-parallel cut of a cell: lattice points below `at` on the minus side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cut {
    /// The axis the cut is perpendicular to.
    pub axis: usize,
    /// The first lattice coordinate on the plus side.
    pub at: i64,
}

impl Cell {
    /// The cell of all lattice points.
    pub const UNIVERSE: Self = Self {
        low: [-(1 << REACH); 3],
        size: [REACH as u8 + 1; 3],
    };

    /// The smallest lattice point.
    pub fn low(&self) -> &Lattice {
        &self.low
    }

    /// The largest lattice point.
    #[inline]
    pub fn high(&self) -> Lattice {
        let high = |i: usize| self.low[i] + (1i64 << self.size[i]) - 1;
        [high(0), high(1), high(2)]
    }

    /// The binary logarithms of the extents.
    pub fn size(&self) -> [u8; 3] {
        self.size
    }

    /// The low corner in half steps.
    pub fn corner(&self) -> Lattice {
        let [x, y, z] = self.low;
        [2 * x - 1, 2 * y - 1, 2 * z - 1]
    }

    /// The cut through the middle, across the longest axis; `None` for a single lattice point.
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

    /// The minus (0) or plus (1) half of the cell.
    #[must_use]
    pub fn half(&self, cut: Cut, plus: bool) -> Self {
        let mut half = *self;
        half.size[cut.axis] -= 1;
        if plus {
            half.low[cut.axis] = cut.at;
        }
        half
    }

    /// Whether every lattice point of `other` is one of this cell.
    pub fn holds(&self, other: &Self) -> bool {
        self.holds_box(other.low(), &other.high())
    }

    /// Whether a lattice box lies inside.
    pub fn holds_box(&self, low: &Lattice, high: &Lattice) -> bool {
        let top = self.high();
        (0..3).all(|i| self.low[i] <= low[i] && high[i] <= top[i])
    }

    /// Whether the cells share lattice points.
    pub fn meets(&self, other: &Self) -> bool {
        self.meets_box(other.low(), &other.high())
    }

    /// Whether the cell shares lattice points with a box.
    pub fn meets_box(&self, low: &Lattice, high: &Lattice) -> bool {
        let top = self.high();
        (0..3).all(|i| self.low[i] <= high[i] && low[i] <= top[i])
    }

    /// The smallest cell of the hierarchy that holds both.
    #[must_use]
    pub fn join(&self, other: &Self) -> Self {
        let (a, b) = (self.high(), other.high());
        let low = [0, 1, 2].map(|i| self.low[i].min(other.low[i]));
        Self::around(&low, &[0, 1, 2].map(|i| a[i].max(b[i])))
    }

    /// The smallest cell of the hierarchy that holds a lattice box.
    pub fn around(low: &Lattice, high: &Lattice) -> Self {
        let mut cell = Self::UNIVERSE;
        while let Some(cut) = cell.cut() {
            let minus = high[cut.axis] < cut.at;
            let plus = low[cut.axis] >= cut.at;
            if minus == plus {
                break;
            }
            cell = cell.half(cut, plus);
        }
        cell
    }

    /// The six planes that bound the cell, the cell on their minus sides.
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
