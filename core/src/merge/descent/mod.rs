//! The descent: one walk through space that evaluates a whole expression. It divides cells until a kernel
//! solves them, and joins the results.

pub mod choice;
pub mod counters;
pub mod descend;
mod groups;
pub(super) mod join;
pub(super) mod state;
pub(super) mod twins;
