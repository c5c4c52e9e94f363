//! The classes for rays: facets that rays are cast at, and trees that grow where rays pass.

pub mod scene;
pub mod store;
pub mod tree;
