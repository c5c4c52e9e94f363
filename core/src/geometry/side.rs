//! Sides of hyperplanes, orientations of hyperplanes to each other, and splits of pieces by hyperplanes.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::arith::Sign;

/// The side of an oriented hyperplane on which a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[repr(i8)]
pub enum Side {
    /// Strictly inside: the hyperplane's value is negative.
    Minus = -1,
    /// In the hyperplane: its value is zero.
    On = 0,
    /// Strictly outside: its value is positive.
    Plus = 1,
}

impl Side {
    /// The side of a hyperplane whose value at a point has this sign: negative is `Minus`, zero is `On`,
    /// positive is `Plus`.
    #[inline]
    pub fn from_sign(sign: Sign) -> Self {
        match sign {
            Sign::Negative => Self::Minus,
            Sign::Zero => Self::On,
            Sign::Positive => Self::Plus,
        }
    }

    /// The sign of a hyperplane's value on this side.
    #[inline]
    pub fn sign(self) -> Sign {
        match self {
            Self::Minus => Sign::Negative,
            Self::On => Sign::Zero,
            Self::Plus => Sign::Positive,
        }
    }

    /// Return whether one of two sides is `Minus` and the other `Plus`.
    #[inline]
    pub fn is_across_from(self, other: Self) -> bool {
        self != Self::On && other == self.opposite()
    }

    /// The side of a hyperplane whose value at a point compares to zero like this.
    pub fn from_order(order: Ordering) -> Self {
        match order {
            Ordering::Less => Self::Minus,
            Ordering::Equal => Self::On,
            Ordering::Greater => Self::Plus,
        }
    }

    /// The opposite side, on which a point of this side lies after the hyperplane is reversed.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Minus => Self::Plus,
            Self::On => Self::On,
            Self::Plus => Self::Minus,
        }
    }
}

/// One of the two open half-spaces of a hyperplane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Half {
    /// The open half-space of negative values, the inside.
    Minus,
    /// The open half-space of positive values, the outside.
    Plus,
}

impl Half {
    /// Both half-spaces: minus, the inside, then plus, the outside.
    pub const BOTH: [Self; 2] = [Self::Minus, Self::Plus];

    /// The half-space in which a hyperplane's value has this sign, which must not be zero.
    #[inline]
    pub fn from_sign(sign: Sign) -> Self {
        match sign {
            Sign::Negative => Self::Minus,
            Sign::Zero | Sign::Positive => Self::Plus,
        }
    }

    /// The sign of a hyperplane's values in this half-space.
    #[inline]
    pub fn sign(self) -> Sign {
        match self {
            Self::Minus => Sign::Negative,
            Self::Plus => Sign::Positive,
        }
    }

    /// The other half-space.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Minus => Self::Plus,
            Self::Plus => Self::Minus,
        }
    }
}

/// Whether two oriented hyperplanes that are the same set of points have the same inside; also, whether a
/// face of a solid has the same direction as the source face that it lies in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Orientation {
    /// The two minus sides agree.
    #[default]
    Same,
    /// The minus side of each is the plus side of the other.
    Opposite,
}

impl Orientation {
    /// Both orientations, `Same` first.
    pub const BOTH: [Self; 2] = [Self::Same, Self::Opposite];

    /// `Opposite` if `turned`, else `Same`.
    pub fn turned_around(turned: bool) -> Self {
        Self::Same.turned_if(turned)
    }

    /// The other orientation if `turned`, else this one.
    #[must_use]
    pub fn turned_if(self, turned: bool) -> Self {
        match (self, turned) {
            (Self::Same, false) | (Self::Opposite, true) => Self::Same,
            (Self::Same, true) | (Self::Opposite, false) => Self::Opposite,
        }
    }

    /// Return whether this is `Opposite`: the two sides are exchanged.
    pub fn is_opposite(self) -> bool {
        self == Self::Opposite
    }

    /// Return a signed value, negated if the orientation is `Opposite`.
    ///
    /// ```
    /// use bspcsg::geometry::side::Orientation;
    ///
    /// assert_eq!(Orientation::Same.signed(2), 2);
    /// assert_eq!(Orientation::Opposite.signed(2), -2);
    /// ```
    #[must_use]
    pub fn signed<T: std::ops::Neg<Output = T>>(self, value: T) -> T {
        match self {
            Self::Same => value,
            Self::Opposite => -value,
        }
    }
}

/// The position of a convex set relative to a hyperplane; touching it does not count as crossing.
///
/// The set is divided only if the hyperplane crosses it; each other case applies to the whole set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Split<T> {
    /// The relative interior of the convex set is on the minus side.
    Minus,
    /// The relative interior of the convex set is on the plus side.
    Plus,
    /// Points of the convex set lie strictly on both sides.
    Both {
        /// The part on the minus side.
        minus: T,
        /// The part on the plus side.
        plus: T,
    },
    /// The convex set lies in the hyperplane, with this orientation relative to it.
    Coplanar(Orientation),
}
