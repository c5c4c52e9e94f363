//! Triangle meshes on the lattice: import, topology and findings.

pub mod finding;
pub mod grid;
pub mod import;
pub mod source;
pub mod topology;
