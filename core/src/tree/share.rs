//! Shares of a solid's volume, as contributions of parts of its boundary.

use crate::geometry::flux::fixed::Flux;
use crate::geometry::side::Orientation;

/// The contribution (share) of a node of a solid's tree to the solid's volume.
#[derive(Clone, Copy, Debug)]
pub struct VolumeShare {
    /// Six times the flux of (0, 0, z) through the boundary in the node's cell.
    pub flux: Flux,
    /// True if the boundary may be unbounded, so that the flux has no meaning.
    pub open: bool,
}

impl VolumeShare {
    /// The volume share of a node without boundary.
    pub const NONE: Self = Self {
        flux: Flux::ZERO,
        open: false,
    };

    /// Adds another share of the volume, with its flux subtracted if `complement` is set.
    pub fn add(&mut self, other: &Self, complement: bool) {
        self.flux
            .add(&other.flux, Orientation::turned_around(complement));
        self.open |= other.open;
    }
}
