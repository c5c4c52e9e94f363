//! Questions to a solid: where a point lies, how large the solid is, what a ray meets.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

pub mod classify;
pub mod measure;
pub mod ray;
pub mod region;
pub mod stab;
