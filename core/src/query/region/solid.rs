//! Faces of closed meshes as facets of sets in space.

use crate::error::Result;
use crate::geometry::polygon::Polygon;
use crate::geometry::spaces::dim3::Dim3;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;
use crate::tree::partition::Facet;

/// Returns the faces of a closed mesh as facets, with their numbers in the input.
///
/// # Errors
/// None; reserved for half-spaces, which have no mesh.
pub fn facets(source: &Source) -> Result<Vec<Facet<Dim3>>> {
    let Some(mesh) = source.mesh() else {
        return Ok(Vec::new());
    };
    let facet = |face: FaceId| Facet {
        fragment: Polygon::triangle(&mesh.corners(face), source.plane(face)),
        source: u64::from(source.number(face)),
    };
    Ok(mesh.face_ids().map(facet).collect())
}
