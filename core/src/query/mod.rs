//! Questions: where a point lies, how large a set is, what a ray meets, what a plane cuts.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

pub mod classify;
pub mod contact;
pub mod exact;
pub mod measure;
pub mod path;
pub mod planes;
pub mod ray;
pub mod region;
mod shares;
pub mod stab;
