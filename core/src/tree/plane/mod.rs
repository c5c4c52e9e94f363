//! Sets of the plane: by their boundaries, by trees, or by both.
//!
//! A [`Boundary`] is the reduced outline of a set: maximal edges between numbered corners, and which
//! connected parts they separate. It depends on the set alone. A [`PlaneSet`] has a boundary or a
//! tree, and makes the other when it is asked for.

mod boundary;
mod moving;
mod planeset;

pub use boundary::{Boundary, Corner, Edge};
pub use planeset::{tree_of, PlaneSet, Spent, TREE};
