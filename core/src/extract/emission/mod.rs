//! Triangles and vertices on their way out: whole faces, and polygons triangulated.

pub(super) mod assembly;
pub(super) mod origin;
pub(super) mod polygons;
pub(super) mod untouched;
