//! The share of a part of a boundary in the volume.

use crate::geometry::flux::fixed::Flux;
use crate::geometry::side::Orientation;

/// The share of a node's boundary in the volume.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// Six times the flux through the boundary in the node's cell.
    pub flux: Flux,
    /// True if the boundary may reach infinity, so that the flux means nothing.
    pub open: bool,
}

impl Share {
    /// Nothing.
    pub const NONE: Self = Self {
        flux: Flux::ZERO,
        open: false,
    };

    /// Adds what another part contributes, perhaps turned inside out.
    pub fn add(&mut self, other: &Self, complement: bool) {
        self.flux
            .add(&other.flux, Orientation::turned_around(complement));
        self.open |= other.open;
    }
}
