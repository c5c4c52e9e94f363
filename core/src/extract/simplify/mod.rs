//! Removal of short edges and slivers from a mesh, within a tolerance.
//!
//! An edge is short if it is no longer than the tolerance, a triangle is a sliver if its least height is not
//! above the tolerance. Rounds of independent changes collapse short edges and flip the long edges of
//! slivers. After each round changed triangles are compared exactly with all triangles near them, and
//! changes that made surfaces cross are undone.
//!
//! Vertices are never moved. `Drift` bounds how far the surface moved.
//!
//! # Cost
//! A round is linear in the mesh and makes a maximal set of changes: each waiting one is next to
//! one that was made. So each round decides a share of the waiting ones, and the number of rounds
//! grows with the logarithm of the mesh.
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
