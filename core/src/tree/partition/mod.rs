//! The partition tree itself, written once for all dimensions.
//!
//! A tree stands for a set inside the region of its root: leaves are In or Out, cuts divide a region
//! by a hyperplane. Nodes are immutable and shared; no function here recurses, since a convex body
//! of n faces is a chain of depth n. Invariants, verified by [`check`]: the span of a node is its
//! cut inside its region, the coplanar set lies in the span, and no cut has two equal leaves.
//!
//! # Source
//! Fuchs, Kedem, Naylor 1980; Thibault, Naylor 1987.

mod boundary;
mod build;
mod classify;
mod node;
mod random;
mod stats;
mod winding;

pub use boundary::{boundary, owned_boundary};
pub use build::{autopartition, Built, PivotPolicy};
pub use classify::{classify, Location};
pub use node::{Cut, Facet, Label, PartitionTree, Sheet};
pub use random::SplitMix;
pub use stats::{check, stats, TreeStats};
pub use winding::{winding_tree, Winding};
