//! Elements of exact points whose boxes overlap.

use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Vertex;
use crate::merge::pairs::{pairs_of_many, shift_of, BoxedElement, ElementsInBox, SweptElement};

/// A box of lattice points, its ends included.
#[derive(Clone, Copy)]
pub struct LatticeBox {
    low: Lattice,
    high: Lattice,
}

impl LatticeBox {
    /// A box that holds nothing.
    pub const NOTHING: Self = Self {
        low: [i64::MAX; 3],
        high: [i64::MIN; 3],
    };

    /// The smallest box around points.
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

    /// The smallest box around this and another.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    /// The intersection with another box.
    #[must_use]
    pub fn within(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].max(other.low[i])),
            high: each_axis(|i| self.high[i].min(other.high[i])),
        }
    }

    /// Return whether two boxes have a point in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// The ends relative to a point.
    fn from(&self, origin: &Lattice) -> [Lattice; 2] {
        [&self.low, &self.high].map(|end| each_axis(|i| end[i] - origin[i]))
    }

    /// The length of the longest side.
    fn size(&self) -> u64 {
        let side = |i: usize| self.high[i].checked_sub(self.low[i]).unwrap_or(0);
        each_axis(side)
            .iter()
            .map(|x| x.unsigned_abs())
            .max()
            .unwrap_or(0)
    }
}

/// An element of one of two operands, with a box around it.
pub struct Element {
    /// The operand; elements are grouped by it.
    pub operand: usize,
    /// The box.
    pub space: LatticeBox,
}

/// Calls `meet` for all pairs of elements of different operands whose boxes overlap; stops if it
/// returns `None`. A pair may be found more than once, in either order.
///
/// `corners` gives points whose convex hull contains an element, if known.
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
    let swept = |number: u32| {
        let element = &elements[number as usize];
        let [low, high] = element.space.from(&origin);
        SweptElement {
            operand: element.operand,
            low,
            high,
            corners: corners(number).and_then(|corners| relative(&corners, &origin)),
        }
    };
    let boxes = elements.iter().enumerate().map(boxed).collect();
    pairs_of_many(ElementsInBox::of(boxes, shift), swept, meet)
}

/// Corners relative to a point, if they are lattice points.
fn relative(corners: &[Vertex; 3], origin: &Lattice) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = corners.each_ref().map(Vertex::as_lattice);
    let from = |p: &Lattice| each_axis(|i| as_double(p[i] - origin[i]));
    Some([from(a?), from(b?), from(c?)])
}
