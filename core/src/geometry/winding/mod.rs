//! Winding numbers: changes along segments and paths, and numbers of outlines.

pub mod covering;
pub mod crossing;
pub mod path;
