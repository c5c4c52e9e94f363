//! Where things lie: sides, orientations and splits.

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
    /// The side named by the sign of a hyperplane's value.
    ///
    /// Negative: `Minus`; zero: `On`; positive: `Plus`.
    #[inline]
    pub fn from_sign(sign: Sign) -> Self {
        match sign {
            Sign::Negative => Self::Minus,
            Sign::Zero => Self::On,
            Sign::Positive => Self::Plus,
        }
    }

    /// The sign of a hyperplane's value here.
    #[inline]
    pub fn sign(self) -> Sign {
        match self {
            Self::Minus => Sign::Negative,
            Self::On => Sign::Zero,
            Self::Plus => Sign::Positive,
        }
    }

    /// Return whether this side and another are strictly different.
    #[inline]
    pub fn is_across_from(self, other: Self) -> bool {
        self != Self::On && other == self.opposite()
    }

    /// The side named by how a hyperplane's value compares to zero.
    pub fn from_order(order: Ordering) -> Self {
        match order {
            Ordering::Less => Self::Minus,
            Ordering::Equal => Self::On,
            Ordering::Greater => Self::Plus,
        }
    }

    /// The same place after the hyperplane's sides are exchanged.
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
    /// The inside.
    Minus,
    /// The outside.
    Plus,
}

impl Half {
    /// The inside, then the outside.
    pub const BOTH: [Self; 2] = [Self::Minus, Self::Plus];

    /// The half-space named by the sign of a hyperplane's value, which is not zero.
    #[inline]
    pub fn from_sign(sign: Sign) -> Self {
        match sign {
            Sign::Negative => Self::Minus,
            Sign::Zero | Sign::Positive => Self::Plus,
        }
    }

    /// The sign of a hyperplane's value in it.
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

/// The orientation of two hyperplanes with the same points to each other, or of a face of a solid to the
/// face it came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Orientation {
    /// Their minus sides agree.
    #[default]
    Same,
    /// The minus side of one is the plus side of the other.
    Opposite,
}

impl Orientation {
    /// Both orientations.
    pub const BOTH: [Self; 2] = [Self::Same, Self::Opposite];

    /// Opposite if the flag is set.
    pub fn turned_around(turned: bool) -> Self {
        Self::Same.turned_if(turned)
    }

    /// This orientation, or the other one if the flag is set.
    #[must_use]
    pub fn turned_if(self, turned: bool) -> Self {
        match (self, turned) {
            (Self::Same, false) | (Self::Opposite, true) => Self::Same,
            (Self::Same, true) | (Self::Opposite, false) => Self::Opposite,
        }
    }

    /// Return whether the sides are exchanged.
    pub fn is_opposite(self) -> bool {
        self == Self::Opposite
    }

    /// Return a signed value, negated if the sides are exchanged.
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

/// The sides of a hyperplane on which a convex piece lies; touching it does not count as crossing.
///
/// One-sided answers carry nothing: the whole piece is the answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Split<T> {
    /// The piece's relative interior is on the minus side.
    Minus,
    /// The piece's relative interior is on the plus side.
    Plus,
    /// Points of the piece lie strictly on both sides.
    Both {
        /// The part on the minus side.
        minus: T,
        /// The part on the plus side.
        plus: T,
    },
    /// The piece lies in the hyperplane; the orientation of the piece relative to it.
    Coplanar(Orientation),
}
