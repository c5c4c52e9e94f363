//! The work that the fuzz targets do with their bytes, and how they know what is right.
//!
//! The bytes make a scene of small solids on the lattice ([`scene`]); where points lie relative to
//! it is known from winding numbers that share nothing with the core ([`winding`]).

pub mod scene;
pub mod seeds;
pub mod targets;
pub mod winding;

#[path = "../../core/tests/support/mod.rs"]
mod support;
