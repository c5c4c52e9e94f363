//! Finds pairs of elements with exact points whose boxes overlap.

use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Vertex;
use crate::merge::pairs::{pairs, shift_of, BoundedElement, BoxedElement, ElementsInBox};

/// A box with lattice corners, which belong to it.
#[derive(Clone, Copy)]
pub struct LatticeBox {
    low: Lattice,
    high: Lattice,
}

impl LatticeBox {
    /// The empty box.
    pub const NOTHING: Self = Self {
        low: [i64::MAX; 3],
        high: [i64::MIN; 3],
    };

    /// The smallest lattice box that contains all points.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Vertex>) -> Self {
        let spaces = points.into_iter().map(Self::around_point);
        spaces.fold(Self::NOTHING, |all, one| all.with(&one))
    }

    fn around_point(vertex: &Vertex) -> Self {
        if let Some(place) = vertex.as_lattice() {
            return Self {
                low: *place,
                high: *place,
            };
        }
        let (low, high) = vertex.bounds();
        Self {
            low: low.map(|x| as_whole(x.floor())),
            high: high.map(|x| as_whole(x.ceil())),
        }
    }

    /// The smallest box around this box and another.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    /// The intersection of this box and another; empty if they have no common point.
    #[must_use]
    pub fn within(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].max(other.low[i])),
            high: each_axis(|i| self.high[i].min(other.high[i])),
        }
    }

    /// Returns true if two boxes have a common point.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// The two corners of the box relative to a point.
    fn from(&self, origin: &Lattice) -> [Lattice; 2] {
        [&self.low, &self.high].map(|end| each_axis(|i| end[i] - origin[i]))
    }

    /// The length of the longest side, in lattice steps.
    fn size(&self) -> u64 {
        let side = |i: usize| self.high[i].checked_sub(self.low[i]).unwrap_or(0);
        each_axis(side)
            .iter()
            .map(|x| x.unsigned_abs())
            .max()
            .unwrap_or(0)
    }
}

/// A triangle or another part of one of two operands, with a box around it.
pub struct Element {
    /// The index of the operand; the parts of one operand follow each other in the list.
    pub operand: usize,
    /// A box that contains the part of the operand.
    pub space: LatticeBox,
}

/// Calls `meet` for all pairs of elements of different operands whose boxes overlap; stops with `None` if it
/// returns `None`. A pair may come more than once, in either order.
///
/// `corners` gives three points whose convex hull contains an element, or `None`.
pub fn near_pairs(
    elements: &[Element],
    corners: impl Fn(u32) -> Option<[Vertex; 3]>,
    meet: impl FnMut(u32, u32) -> Option<()>,
) -> Option<()> {
    let spaces = elements.iter().map(|element| element.space);
    let around = spaces.fold(LatticeBox::NOTHING, |all, one| all.with(&one));
    let (origin, shift) = (around.low, shift_of(around.size()));
    let boxed = |(number, element): (usize, &Element)| {
        let [low, high] = element.space.from(&origin);
        BoxedElement::new(element.operand, as_number(number), [&low, &high], shift)
    };
    let bounded = |number: u32| {
        let element = &elements[number as usize];
        let [low, high] = element.space.from(&origin);
        BoundedElement {
            operand: element.operand,
            low,
            high,
            corners: corners(number).and_then(|corners| relative(&corners, &origin)),
        }
    };
    let boxes = elements.iter().enumerate().map(boxed).collect();
    pairs(ElementsInBox::of(boxes, shift), bounded, meet)
}

/// The corners of a triangle relative to a point, in lattice steps; `None` if a corner is not a lattice
/// point.
fn relative(corners: &[Vertex; 3], origin: &Lattice) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = corners.each_ref().map(Vertex::as_lattice);
    let from = |p: &Lattice| each_axis(|i| as_double(p[i] - origin[i]));
    Some([from(a?), from(b?), from(c?)])
}
