//! The descent: one walk through space for a whole expression, which divides cells until a kernel takes
//! them, and joins the results.

pub mod choice;
pub mod counters;
pub mod descend;
mod groups;
pub(super) mod join;
pub(super) mod state;
pub(super) mod twins;
