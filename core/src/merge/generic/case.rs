//! The cases in which a hyperplane splits a partition tree at its root.
//!
//! # Source
//! Naylor, Amanatides, Thibault 1990, section 4: the cases of their table.

use serde::{Deserialize, Serialize};

use crate::geometry::side::Half;

/// The position of a splitting hyperplane relative to the cut at the root of a partition tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SplitCase {
    /// The tree is a leaf, so both halves are leaves.
    Leaf,
    /// The hyperplane is the root's cut.
    Same,
    /// The hyperplane is the root's cut with its sides exchanged.
    Opposite,
    /// Within the tree's region, the hyperplane lies on the side `deep` of the root's cut, and the root's cut
    /// on the side `home` of the hyperplane.
    OneSided {
        /// The side of the root's cut whose subtree the hyperplane splits.
        deep: Half,
        /// The side of the hyperplane whose half of the tree keeps the root's cut.
        home: Half,
    },
    /// The hyperplane and the root's cut cross within the tree's region.
    Crossing,
}

impl SplitCase {
    /// Returns the name of the case in lower case; a one-sided case is named by its sides `deep` and `home`,
    /// as in "minus-plus".
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
