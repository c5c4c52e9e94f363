//! The emission of triangles and vertices: whole faces, and triangulated polygons.

pub(super) mod assembly;
pub(super) mod origin;
pub(super) mod polygons;
pub(super) mod untouched;
