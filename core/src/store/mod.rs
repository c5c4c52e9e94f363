//! Stores boundaries as bytes, checks them, moves them, and makes trees of them again.

pub mod sealed;
pub mod snapshot;
mod sound;
mod wholes;
