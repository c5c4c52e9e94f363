//! Boundaries as bytes: stored, checked, moved, and made into trees again.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub mod sealed;
pub mod snapshot;
mod sound;
