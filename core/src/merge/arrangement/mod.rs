//! Combines a few meshes, or unites one mesh with itself, by cutting each face once along all segments in which
//! other faces meet it.
//!
//! The stages are in files of their own. `meshes` (with `sample`, `occupancy` and `candidates`) finds faces that
//! may meet faces of other meshes, `own_pairs` pairs of faces of one mesh, and `boxes` pairs of faces whose boxes
//! meet. `contact` and `contacts` intersect these, and `faces` divides each face into cells along the segments.
//! `labels` finds winding numbers, `keep_rule` and `scene` make the leaf of the faces that stay, and `arrange`
//! repeats this with the own pairs of operands that turn out to overlap themselves. `self_union` arranges one
//! mesh alone.

mod arrange;
mod boxes;
mod candidates;
mod contact;
mod contacts;
mod faces;
mod facets;
mod keep_rule;
mod labels;
mod meshes;
mod occupancy;
mod own_pairs;
mod sample;
mod scene;
mod self_union;
mod shells;
pub(super) mod star;
mod windings;

pub use meshes::{arranged, Arranged};
pub use self_union::{is_simple_mesh, united, United};

/// The number of faces from which it pays to wake the thread pool: they take several milliseconds.
pub const MIN_FACES_FOR_POOL: usize = 4096;

/// The most pairs of faces with meeting boxes, on average for each face; with more, boxes do not separate the
/// faces, and the descent divides space instead.
const MAX_PAIRS_PER_FACE: usize = 24;
