//! Exact set operations on solids by merging binary space partition trees.
//!
//! The data's way: mesh → source → deferred tree → evaluation of an expression by one descent →
//! tree → boundary → mesh. Layers point one way:
//! `arith < geometry < mesh < tree < merge < extract < query < python`.

pub mod arith;
pub mod error;
pub mod extract;
pub mod geometry;
pub mod interrupt;
pub mod merge;
pub mod mesh;
pub mod query;
pub mod store;
pub mod tree;

#[cfg(feature = "python")]
mod python;

// Lets tests name the crate as others do.
#[cfg(test)]
extern crate self as bspcsg;

#[cfg(test)]
#[path = "../tests/mod.rs"]
mod tests;
