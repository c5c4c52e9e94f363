//! Triangle meshes on the lattice: import, topology, findings, hulls and measures.

pub mod cached;
pub mod chain;
pub mod crossing_edges;
pub mod disjoint;
mod ears;
pub mod faces;
pub mod facets;
pub mod finding;
pub mod grid;
pub mod half_space;
pub mod handle;
pub mod hulls;
pub mod images;
pub mod import;
mod links;
pub mod measures;
pub mod snap;
pub mod source;
pub mod surfaces;
pub mod tasks;
pub mod terrains;
pub mod topology;
pub mod triangles;
pub mod weld;
