//! Contributions of boundary to the volume.

use crate::geometry::flux::fixed::Flux;
use crate::geometry::side::Orientation;

/// The contribution of a node's boundary to the volume.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// Six times the flux through the boundary in the node's cell.
    pub flux: Flux,
    /// Whether the boundary may be unbounded, so that the flux means nothing.
    pub open: bool,
}

impl Share {
    /// No contribution.
    pub const NONE: Self = Self {
        flux: Flux::ZERO,
        open: false,
    };

    /// Adds another contribution, turned inside out if `complement` is set.
    pub fn add(&mut self, other: &Self, complement: bool) {
        self.flux
            .add(&other.flux, Orientation::turned_around(complement));
        self.open |= other.open;
    }
}
