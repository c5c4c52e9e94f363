//! Boundaries as bytes: stored, checked, moved, and made into trees again.

pub mod sealed;
pub mod snapshot;
mod sound;
mod wholes;
