//! Whole faces of a stored boundary, grouped by source and orientation.

use serde::{Deserialize, Serialize};

use crate::extract::boundary::collect::{Boundary, CutFace};
use crate::extract::boundary::leaves::Fate;
use crate::geometry::side::Orientation;
use crate::mesh::handle::{FaceId, Slot, SourceFace};

/// Whole faces of one source with the same orientation; either all of them may touch other faces, or none
/// may.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct WholeFaces {
    pub(super) slot: Slot,
    pub(super) manner: Manner,
    pub(super) faces: Vec<FaceId>,
}

/// The orientation of whole faces, and whether they may touch other faces. The first two variants are
/// encoded like version 2's `false` and `true`.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) enum Manner {
    Same,
    Opposite,
    TouchingSame,
    TouchingOpposite,
}

impl Manner {
    pub(super) fn of(orientation: Orientation, touching: bool) -> Self {
        match (orientation, touching) {
            (Orientation::Same, false) => Self::Same,
            (Orientation::Opposite, false) => Self::Opposite,
            (Orientation::Same, true) => Self::TouchingSame,
            (Orientation::Opposite, true) => Self::TouchingOpposite,
        }
    }

    pub(super) fn orientation(self) -> Orientation {
        Orientation::turned_around(matches!(self, Self::Opposite | Self::TouchingOpposite))
    }

    pub(super) fn is_touching(self) -> bool {
        matches!(self, Self::TouchingSame | Self::TouchingOpposite)
    }
}

impl WholeFaces {
    /// Groups the whole faces of a boundary by source, orientation and whether they may touch other faces.
    pub(super) fn of(boundary: &Boundary) -> Vec<Self> {
        let mut wholes = Vec::new();
        for (slot, fates) in boundary.fates.by_slot() {
            let touches = |face: &FaceId| {
                let face = SourceFace::new(slot, *face);
                boundary.near.binary_search(&face).is_ok()
            };
            for orientation in Orientation::BOTH {
                let like = |(_, f): &(FaceId, &Fate)| **f == Fate::Whole(orientation);
                let alike = FaceId::all().zip(fates).filter(like).map(|(face, _)| face);
                let (touching, apart): (Vec<_>, Vec<_>) = alike.partition(touches);
                let of = |(faces, touching)| Self {
                    slot,
                    manner: Manner::of(orientation, touching),
                    faces,
                };
                wholes.extend([(apart, false), (touching, true)].map(of));
            }
        }
        wholes.retain(|w: &Self| !w.faces.is_empty());
        wholes
    }

    pub(super) fn plane(cut: &CutFace) -> Self {
        Self {
            slot: cut.face.slot(),
            manner: Manner::of(cut.face.orientation, false),
            faces: vec![cut.face.id()],
        }
    }
}
