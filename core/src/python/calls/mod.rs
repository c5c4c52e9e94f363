//! Calls from Python: threads, signals, forks and failures.

pub mod ending;
pub mod errors;
pub mod forking;
pub mod in_use;
mod places;
pub mod pool;
pub mod run;
