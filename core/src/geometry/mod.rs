//! Exact predicates, planes, points and convex pieces.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation
)]

pub mod cell;
pub mod crossing;
pub mod line;
pub mod outline;
pub mod plane;
pub mod polygon;
mod residue;
pub mod vertex;
