//! The classes of rays: facets that rays meet, and trees that rays grow.

pub mod scene;
pub mod store;
pub mod tree;
