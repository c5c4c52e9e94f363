//! Answers to "where does it lie?": sides, orientations and splits.

use serde::{Deserialize, Serialize};

/// Where a point lies relative to an oriented hyperplane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Side {
    /// Strictly inside: the hyperplane's value is negative.
    Minus,
    /// In the hyperplane: its value is zero.
    On,
    /// Strictly outside: its value is positive.
    Plus,
}

impl Side {
    /// The side named by the sign of a hyperplane's value.
    ///
    /// Negative: `Minus`; zero: `On`; positive: `Plus`.
    pub fn from_sign(sign: i32) -> Self {
        match sign {
            ..=-1 => Self::Minus,
            0 => Self::On,
            1.. => Self::Plus,
        }
    }

    /// The same place seen from the hyperplane with its sides exchanged.
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
    /// The other half-space.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Minus => Self::Plus,
            Self::Plus => Self::Minus,
        }
    }
}

/// How two hyperplanes that are the same set of points are oriented to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Orientation {
    /// Their minus sides agree.
    Same,
    /// The minus side of one is the plus side of the other.
    Opposite,
}

/// Where a convex piece lies relative to a hyperplane; touching it does not count as crossing.
///
/// The one-sided answers carry nothing: the piece that was asked about is the answer.
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
