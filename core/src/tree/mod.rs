//! Partition trees: the nodes of solids, and generic trees on the line, in the plane and in space.

pub mod flux;
pub mod fragments;
pub mod node;
pub mod partition;
pub mod pieces;
pub mod plane;
mod renaming;
pub mod share;
pub mod solid;
pub mod stats;
pub mod table;
pub mod trace;
pub mod work;
