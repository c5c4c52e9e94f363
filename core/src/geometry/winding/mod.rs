//! Winding numbers: how they change along segments and paths, and tests of outlines by them.

pub mod covering;
pub mod crossing;
pub mod path;
