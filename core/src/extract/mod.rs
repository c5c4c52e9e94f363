//! Turns a solid's tree into a mesh: collects its boundary faces, joins coplanar ones, pairs edges,
//! triangulates, splits contacts, and rounds.

mod angles;
pub mod assemble;
pub mod boundary;
pub mod contacts;
pub mod emission;
mod failure;
pub mod joining;
pub mod mesh;
mod order;
pub mod outlines;
pub mod rounding;
pub mod simplify;
pub mod surface;
pub mod triangulate;
pub mod vertices;
