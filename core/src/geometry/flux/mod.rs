//! The flux of (0, 0, z), from which volumes are summed.

pub mod fixed;
pub mod trim;
