//! Trees of supporting hyperplanes that rays stab: grown by their use, or complete from the start.
//!
//! # Source
//! The augmented BSP tree: Ar, Montag, Tal 2002, "Deferred, self-organizing BSP trees"; lecture
//! notes on BSP trees, "Distribution optimized (self-organizing) BSP".

pub mod batch;
pub mod cast;
pub mod heap;
pub mod record;
pub mod tree;

mod cut;
pub mod node;
mod trace;
mod walk;

pub use cast::Cast;
pub use trace::{StabEvent, Trace};
pub use tree::StabTree;
