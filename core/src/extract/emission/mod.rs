//! Adds the triangles and vertices of whole faces and of triangulated polygons to the mesh.

pub(super) mod assembly;
pub(super) mod origin;
pub(super) mod polygons;
pub(super) mod untouched;
