//! From a tree back to a mesh: collecting, joining, pairing, triangulating, splitting, rounding.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub mod assemble;
pub mod boundary;
pub mod contacts;
pub mod emission;
mod failure;
pub mod joining;
pub mod mesh;
pub mod rounding;
pub mod simplify;
pub mod triangulate;
pub mod vertices;
