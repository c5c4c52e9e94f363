//! Queries of solids and sets: the location of a point, volumes and areas, hits of rays, sections by planes.
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
