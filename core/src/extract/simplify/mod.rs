//! Short edges and slivers taken out of a mesh, no farther than a tolerance.
//!
//! An edge is short if it is no longer than the tolerance, a triangle is a sliver if its height is
//! no more than that. Short edges are collapsed and the long edges of slivers flipped, in rounds of
//! changes that do not touch each other; after each round what changed is compared exactly with all
//! near it, and what made surfaces cross is taken back.
//!
//! Vertices stay where they are. [`Drift`] proves how far the surface moved.
//!
//! # Cost
//! A round is linear in the mesh and takes a maximal set of changes: each that waits is next to one
//! that was made. So a share of those that wait is decided in each round, and rounds grow with the
//! logarithm of the mesh.
//!
//! # Source
//! Half-edge collapses under the link condition as in Dey, Edelsbrunner, Guha and Nekhayev,
//! *Topology preserving edge contraction*, 1999; needles and caps as in Botsch and Kobbelt, *A robust
//! procedure to eliminate degenerate faces from triangle meshes*, 2001.

pub mod choice;
pub mod drift;
pub mod edit;
pub mod proof;
pub mod result;
pub mod rounds;
pub mod shells;
pub mod sizes;
pub mod surface;
