//! Triangle meshes on the lattice: import, topology and findings.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss
)]

pub mod cached;
mod chain;
mod ears;
pub mod facets;
pub mod finding;
pub mod grid;
pub mod half_space;
pub mod handle;
pub mod import;
pub mod joints;
mod links;
pub mod measures;
pub mod snap;
pub mod source;
pub mod surfaces;
pub mod tasks;
pub mod topology;
pub mod triangles;
pub mod weld;
