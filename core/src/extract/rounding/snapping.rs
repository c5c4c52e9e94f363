//! Meshes that cross themselves once their doubles give way to those of the lattice.
//!
//! A motion of the lattice keeps the doubles on axes along which it shifts nothing. On the others it
//! snaps each vertex by itself, so that surfaces that touched may cross.

use super::company::Faces;
use super::crossings::{all_faults, faults, Faults};
use crate::geometry::doubles::Point;
use crate::geometry::plane::Lattice;
use crate::mesh::source::Source;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::solid::Solid;

/// Return whether a mesh of a solid crosses itself once its doubles along some axes are those of the
/// lattice, where it did not before.
pub fn crosses_once_snapped(solid: &Solid, axes: [bool; 3]) -> bool {
    // What is reduced does not cross itself on the lattice.
    let is_known = axes == [true; 3] && solid.is_reduced();
    !is_known && solid.sources().iter().any(|s| source_crosses(s, axes))
}

/// Looks once for each source and choice of axes.
fn source_crosses(source: &Source, axes: [bool; 3]) -> bool {
    let crosses = |mesh| {
        let known = source.crosses_once_snapped(axes);
        *known.get_or_make(|| mesh_crosses(mesh, source, axes))
    };
    source.mesh().is_some_and(crosses)
}

fn mesh_crosses(mesh: &TriangleMesh, source: &Source, axes: [bool; 3]) -> bool {
    let snapped = |(double, place): (&Point, &Lattice)| -> Point {
        let coordinate = |i: usize| {
            if axes[i] {
                source.pitch().coordinate(place[i])
            } else {
                double[i]
            }
        };
        [0, 1, 2].map(coordinate)
    };
    let vertices = || mesh.doubles.iter().zip(&mesh.vertices).map(snapped);
    let blurred = source.blurred_vertices();
    if blurred.is_empty() && vertices().eq(mesh.doubles.iter().copied()) {
        return false;
    }
    let faces = Faces {
        vertices: &vertices().collect::<Vec<Point>>(),
        triangles: &mesh.faces,
    };
    let mut found = all_faults(&faces);
    let any = !found.crossings.is_empty();
    // Around welded vertices the faces are not those that were given.
    let is_blurred = |t: &u32| {
        let corners = mesh.faces[*t as usize];
        corners.iter().any(|v| blurred.binary_search(v).is_ok())
    };
    found.crossings.retain(|pair| !pair.iter().any(is_blurred));
    let before = Faces {
        vertices: &mesh.doubles,
        ..faces
    };
    any && !crossed(&before, &found)
}

/// Return whether triangles that cross others elsewhere cross some in these places, too.
pub fn crossed(before: &Faces, found: &Faults) -> bool {
    let mut some: Vec<u32> = found.crossings.iter().flatten().copied().collect();
    some.sort_unstable();
    some.dedup();
    !faults(before, &some, |_| 0).crossings.is_empty()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::crosses_once_snapped;
    use crate::geometry::doubles::Point;
    use crate::mesh::grid::Pitch;
    use crate::mesh::import::import;
    use crate::tree::solid::Solid;

    /// A floor that slants by rounding, and a tip above it, on a lattice of whole steps.
    fn above(tip: Point, trusted: bool) -> Solid {
        let floor = [[0.0, 0.0, 1.4], [8.0, 0.0, 1.4], [0.0, 8.0, 1.6], [0.0; 3]];
        let spike = [tip, [3.0, 1.0, 9.0], [1.0, 3.0, 9.0], [-1.0, -1.0, 9.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let faces = [faces, faces.map(|t| t.map(|v| v + 4))].concat();
        let source = import(&[floor, spike].concat(), &faces, Pitch::new(0).ok());
        Solid::of_source(Arc::new(source.expect("it is closed")), trusted)
    }

    const ALL: [bool; 3] = [true; 3];

    #[test]
    fn only_what_snapping_makes_cross_is_told() {
        let crosses = |height: f64, axes| {
            let solid = above([1.0, 1.0, height], false);
            crosses_once_snapped(&solid, axes)
        };
        assert!(crosses(1.49, ALL) && crosses(1.49, [false, false, true]));
        assert!(!crosses(1.49, [true, true, false]));
        assert!(!crosses(1.51, ALL));
        // It crossed before.
        assert!(!crosses(0.4, ALL));
    }

    #[test]
    fn what_is_reduced_is_looked_at_only_if_some_doubles_stay() {
        let solid = above([1.0, 1.0, 1.49], true);
        assert!(!crosses_once_snapped(&solid, ALL));
        assert!(crosses_once_snapped(&solid, [false, false, true]));
    }
}
