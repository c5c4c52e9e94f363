//! Finds the planes that contain a solid's surface.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use crate::error::Result;
use crate::extract::assemble::assemble;
use crate::geometry::plane::Plane;
use crate::interrupt::poll;
use crate::mesh::handle::OrientedFace;
use crate::tree::solid::Solid;

/// Returns the planes that contain the faces of a solid's surface, each once, with the solid on the minus
/// side.
///
/// These are the planes of input faces: exact, however small the remaining parts of the faces are.
///
/// # Errors
/// `Unbounded`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::planes::supporting_planes;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// let planes = supporting_planes(&solid)?;
/// let normals: Vec<[i128; 3]> = planes.iter().map(|plane| *plane.normal()).collect();
/// assert_eq!(normals, [[0, 0, -1], [0, -1, 0], [-1, 0, 0], [1, 1, 1]]);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn supporting_planes(solid: &Solid) -> Result<Vec<Arc<Plane>>> {
    let mut faces = assemble(solid)?.faces;
    faces.sort_unstable();
    faces.dedup();
    let mut known = HashSet::default();
    let outward = |face: &OrientedFace| {
        poll();
        let plane = solid.sources().get(face.slot()).plane(face.id());
        let turned = face.orientation.is_opposite();
        let plane = if turned {
            Arc::new(plane.flipped())
        } else {
            plane
        };
        known.insert(Arc::clone(&plane)).then_some(plane)
    };
    Ok(faces.iter().filter_map(outward).collect())
}
