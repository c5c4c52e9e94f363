//! From a tree back to a mesh: collecting, joining, pairing, triangulating, splitting, rounding.
#![allow(clippy::cast_precision_loss, clippy::cast_possible_truncation)]

pub mod assemble;
mod assembly;
pub mod collect;
pub mod company;
mod contacts;
pub mod crossings;
mod failure;
pub mod fans;
mod leaves;
pub mod mend;
pub mod mesh;
mod origin;
pub mod planes;
mod polygons;
pub mod rim;
pub mod round;
pub mod sealed;
pub mod seams;
pub mod settle;
pub mod snapshot;
mod sound;
pub mod triangulate;
pub mod unfold;
mod untouched;
pub mod vertices;
