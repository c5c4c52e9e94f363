//! Boxes in lattice steps, and boxes of single precision in a frame around the scene.

use super::facet::Facet;

/// A box in lattice steps.
#[derive(Clone, Copy, Debug)]
pub struct Cell<const D: usize> {
    /// The least coordinates.
    pub low: [f64; D],
    /// The largest coordinates.
    pub high: [f64; D],
}

impl<const D: usize> Cell<D> {
    const NOTHING: Self = Self {
        low: [f64::INFINITY; D],
        high: [f64::NEG_INFINITY; D],
    };

    /// The smallest box around facets; `low` is above `high` if there is none.
    pub fn around<'a>(facets: impl IntoIterator<Item = &'a Facet<D>>) -> Self {
        let mut cell = Self::NOTHING;
        for corner in facets.into_iter().flatten() {
            for (k, c) in corner.iter().enumerate() {
                cell.low[k] = cell.low[k].min(*c);
                cell.high[k] = cell.high[k].max(*c);
            }
        }
        cell
    }
}

/// The map x → (x − centre) · scale, which takes a scene into [−1, 1] on each axis.
///
/// The scale is a power of two, so that a coordinate carries only the rounding of the difference.
#[derive(Clone, Copy, Debug)]
pub struct Frame<const D: usize> {
    pub(super) centre: [f64; D],
    pub(super) scale: f64,
}

impl<const D: usize> Frame<D> {
    /// Makes the frame of a box.
    pub fn of(cell: &Cell<D>) -> Self {
        if (0..D).any(|k| cell.low[k] > cell.high[k]) {
            let (centre, scale) = ([0.0; D], 1.0);
            return Self { centre, scale };
        }
        let centre = std::array::from_fn(|k| f64::midpoint(cell.low[k], cell.high[k]));
        let reach = |k: usize| (cell.high[k] - centre[k]).max(centre[k] - cell.low[k]);
        let radius = (0..D).map(reach).fold(1.0, f64::max);
        let mut scale = 1.0;
        while radius * scale > 1.0 {
            scale *= 0.5;
        }
        Self { centre, scale }
    }

    /// Maps a coordinate into the frame.
    #[inline]
    pub fn inward(&self, axis: usize, x: f64) -> f64 {
        (x - self.centre[axis]) * self.scale
    }

    /// The smallest box of single precision around the corners of a facet, in the frame.
    #[inline]
    pub fn span(&self, corners: &Facet<D>) -> Span {
        let mut span = Span::NOTHING;
        for k in 0..D {
            let along = corners.map(|corner| corner[k]);
            let low = along.into_iter().fold(f64::INFINITY, f64::min);
            let high = along.into_iter().fold(f64::NEG_INFINITY, f64::max);
            span.low[k] = below(self.inward(k, low));
            span.high[k] = above(self.inward(k, high));
        }
        span
    }

    /// Converts a box of the frame to lattice steps.
    pub fn outward(&self, span: &Span) -> Cell<D> {
        let back = |axis: usize, x: f32| f64::from(x) / self.scale + self.centre[axis];
        Cell {
            low: std::array::from_fn(|k| back(k, span.low[k])),
            high: std::array::from_fn(|k| back(k, span.high[k])),
        }
    }
}

/// A box of single precision in a frame; axes that the space does not have are empty.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// The least coordinates.
    pub low: [f32; 4],
    /// The largest coordinates.
    pub high: [f32; 4],
}

impl Span {
    /// The empty box: farther out than any coordinate of a frame, with `low` above `high`.
    pub const NOTHING: Self = Self {
        low: [4.0; 4],
        high: [-4.0; 4],
    };

    /// The smallest box around this box and another.
    #[inline]
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        let least = |a: f32, b: f32| if b < a { b } else { a };
        let most = |a: f32, b: f32| if b > a { b } else { a };
        Self {
            low: std::array::from_fn(|k| least(self.low[k], other.low[k])),
            high: std::array::from_fn(|k| most(self.high[k], other.high[k])),
        }
    }

    /// The smallest box around boxes.
    pub fn around<'a>(spans: impl IntoIterator<Item = &'a Self>) -> Self {
        spans
            .into_iter()
            .fold(Self::NOTHING, |all, span| all.with(span))
    }

    /// The measure of the box: half the surface area in 3D, half the perimeter in 2D, the length in 1D.
    #[inline]
    pub fn surface<const D: usize>(&self) -> f32 {
        let size = |k: usize| (self.high[k] - self.low[k]).max(0.0);
        match D {
            1 => size(0),
            2 => size(0) + size(1),
            _ => size(0) * size(1) + size(1) * size(2) + size(2) * size(0),
        }
    }
}

/// The largest single-precision number not above `x`.
#[inline]
pub fn below(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x {
        near.next_down()
    } else {
        near
    }
}

/// The least single-precision number not below `x`.
#[inline]
pub fn above(x: f64) -> f32 {
    -below(-x)
}
