//! Calls from Python: threads, signals, forks and failures.

pub mod errors;
pub mod forking;
pub mod in_use;
pub mod pool;
pub mod run;
