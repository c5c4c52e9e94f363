//! Rounds exact vertices to doubles or singles, without making surfaces cross.

pub mod broad_phase;
pub mod crossings;
mod image;
pub mod mend;
pub mod places;
pub mod round;
pub mod settle;
pub mod snapping;
mod star;
mod touching;
pub mod unfold;
mod upright;
