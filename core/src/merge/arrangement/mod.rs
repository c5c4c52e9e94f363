//! Arrangements: each face is cut once, by everything that meets it.
//!
//! The stages, each in its own file: faces that may meet (`pair` with `sample`, `occupancy` and
//! `candidates`; `self_union`), pairs of faces whose boxes meet (`boxes`), their intersections (`contact`,
//! `segments`), the cells into which these divide a face (`faces`), winding numbers (`labels`), and the
//! leaf of the faces that stay (`keep_rule`, `scene`).

mod boxes;
mod candidates;
mod contact;
mod faces;
mod keep_rule;
mod labels;
mod near;
mod occupancy;
mod pair;
mod prepared;
mod sample;
mod scene;
mod segments;
mod self_union;
mod shells;
pub(super) mod star;
mod surfaces;
mod windings;

pub use pair::{arranged, Arranged};
pub use self_union::{is_simple_mesh, united, United};

/// The number of faces in one box that is worth waking a pool: they take some milliseconds.
pub const MIN_FACES_FOR_POOL: usize = 4096;

/// The number of pairs for each face beyond which faces are crowded: boxes do not separate them, and the
/// descent divides space instead.
const MAX_PAIRS_PER_FACE: usize = 24;
