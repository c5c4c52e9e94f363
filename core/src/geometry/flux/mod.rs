//! The flux of the vector field (0, 0, z) through faces, from which volumes are summed.

pub mod fixed;
pub mod trim;
