//! Axis-parallel boxes around triangles in doubles.

use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{Point, Triangle};

/// An axis-parallel box in doubles; points on its border belong to it.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// The corner with the smallest coordinates.
    pub low: Point,
    /// The corner with the largest coordinates.
    pub high: Point,
}

impl Extent {
    /// The smallest box around a triangle.
    pub fn of(triangle: &Triangle) -> Self {
        let [a, b, c] = triangle;
        Self {
            low: each_axis(|i| a[i].min(b[i]).min(c[i])),
            high: each_axis(|i| a[i].max(b[i]).max(c[i])),
        }
    }

    /// The smallest box that contains both boxes.
    #[must_use]
    pub fn joined(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Return whether the two boxes have no point in common.
    pub fn misses(&self, other: &Self) -> bool {
        (0..3).any(|i| self.high[i] < other.low[i] || other.high[i] < self.low[i])
    }
}
