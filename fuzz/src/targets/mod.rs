//! The targets. Each takes any bytes; it returns if the core did what it should, and panics if not.

mod checks;
mod evaluate;
mod extract;
mod import;
mod program;
mod section;
mod snapshot;

pub use evaluate::evaluate;
pub use extract::extract;
pub use import::import;
pub use program::program;
pub use section::section;
pub use snapshot::snapshot;
