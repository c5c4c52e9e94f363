//! Questions to a solid: where a point lies, how large the solid is.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub mod classify;
pub mod measure;
pub mod region;
