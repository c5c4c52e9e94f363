//! Sets of the plane, as boundaries, trees, or both.
//!
//! A [`Boundary`] is the reduced outline of a set: maximal edges between numbered corners, with the connected
//! parts that they separate. It depends on the set alone, not on how it was made. A [`PlaneSet`] has a
//! boundary or a tree, and computes the other one on demand.

mod boundary;
mod moving;
mod planeset;

pub use boundary::{Boundary, Corner, Edge};
pub use planeset::{tree_of, PlaneSet, WorkSinceRebuild, SWEEPS_PER_TREE};
