//! The cases of splitting a tree.
//!
//! # Source
//! Naylor, Amanatides, Thibault 1990, section 4: the cases of their table.

use serde::{Deserialize, Serialize};

use crate::geometry::side::Half;

/// How the root of a tree and a splitting hyperplane lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SplitCase {
    /// The tree is a leaf: so are both halves.
    Leaf,
    /// The hyperplane is the root's own.
    Same,
    /// The hyperplane is the root's own with its sides exchanged.
    Opposite,
    /// One-sided: the hyperplane's part lies on the side `deep` of the root's cut, and the root's
    /// sub-hyperplane on the side `home` of the hyperplane.
    OneSided {
        /// The subtree that is split.
        deep: Half,
        /// The half that keeps the root.
        home: Half,
    },
    /// The two cross.
    Crossing,
}

impl SplitCase {
    /// A name: the coplanar cases, "crossing", or the sides `deep` and `home`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Leaf => "leaf",
            Self::Same => "same",
            Self::Opposite => "opposite",
            Self::Crossing => "crossing",
            Self::OneSided { deep, home } => match (deep, home) {
                (Half::Minus, Half::Minus) => "minus-minus",
                (Half::Minus, Half::Plus) => "minus-plus",
                (Half::Plus, Half::Minus) => "plus-minus",
                (Half::Plus, Half::Plus) => "plus-plus",
            },
        }
    }
}
