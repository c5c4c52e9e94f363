//! Winding numbers: how they change along segments and paths, and those of outlines.

pub mod covering;
pub mod crossing;
pub mod path;
