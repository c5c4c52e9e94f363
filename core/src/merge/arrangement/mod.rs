//! Arrangements: each face is cut once, by all that meets it.
//!
//! The stages, each in a file of its own: faces that may meet (`pair` with `probe`, `occupancy` and
//! `candidates`; `alone`), pairs of them whose boxes meet (`boxes`), what they have in common (`contact`,
//! `segments`), the cells into which that divides a face (`faces`), winding numbers
//! (`labels`), and the leaf that lists what stays (`kept`, `scene`).

mod alone;
mod boxes;
mod candidates;
mod contact;
mod faces;
mod kept;
mod labels;
mod looked;
mod near;
mod occupancy;
mod pair;
mod probe;
mod scene;
mod segments;
mod shells;
pub(super) mod star;
mod surfaces;
mod windings;

pub use alone::{is_simple_mesh, united, United};
pub use pair::{arranged, Arranged};

/// Faces in one box that are worth waking a pool: they take some milliseconds.
pub const POOL: usize = 4096;

/// Pairs for each face beyond which faces are crowded: boxes do not tell them apart, and the descent
/// divides space instead.
const PAIRS_FOR_EACH: usize = 24;
