//! The classes of rays: facets that rays are cast at, and trees that rays cause to grow.

pub mod scene;
pub mod store;
pub mod tree;
