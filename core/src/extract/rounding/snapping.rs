//! Finds meshes that cross themselves if their vertices get the doubles nearest to their lattice points.
//!
//! On axes along which it shifts nothing, a motion of the lattice keeps the doubles of vertices. On all
//! other axes it snaps each vertex separately, so that surfaces that touched may cross. Lattice points are
//! rounded to doubles, differently for each shift: so faces that touch on the lattice are compared whenever
//! a mesh is made of them.

use super::crossings::{all_faults, close_pairs, crossings_among, faults, Faults};
use crate::arith::convert::as_double;
use crate::geometry::doubles::Point;
use crate::geometry::plane::Lattice;
use crate::geometry::spaces::motion::Motion;
use crate::mesh::faces::Faces;
use crate::mesh::grid::Pitch;
use crate::mesh::source::Source;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::solid::Solid;

/// Finds the pairs of faces that touch on the lattice, in each mesh of a solid, before a motion moves them.
pub fn look_at_contacts(solid: &Solid, motion: &Motion) {
    if motion.shifted() != [false; 3] {
        for source in solid.sources().iter() {
            if let Some(mesh) = source.mesh() {
                look_at(source, mesh);
            }
        }
    }
}

/// Finds the pairs of faces of a source's mesh that touch on the lattice, unless they are known.
pub fn look_at(source: &Source, mesh: &TriangleMesh) {
    source.close_pairs().get_or_make(|| close_on_lattice(mesh));
}

/// Returns, in ascending order, the faces that cross others in the doubles of a mesh; `pairs` are the pairs
/// of faces to compare.
///
/// A motion of the lattice that rounded positions again may have made such faces cross.
pub fn crossing_faces(mesh: &TriangleMesh, pairs: &[[u32; 2]]) -> Vec<u32> {
    let faces = Faces {
        vertices: &mesh.doubles,
        triangles: &mesh.faces,
    };
    let mut found: Vec<u32> = crossings_among(&faces, pairs).into_flattened();
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the doubles of a vertex after a motion of the lattice: its old doubles, permuted or negated,
/// except on axes along which the motion shifts, which get the doubles of the lattice point `image`.
pub fn moved_doubles(motion: &Motion, pitch: Pitch, p: &Point, image: &Lattice) -> Point {
    [0, 1, 2].map(|i| {
        let (axis, sign) = motion.axes[i];
        if motion.shift[i] == 0 {
            p[axis] * as_double(sign)
        } else {
            pitch.coordinate(image[i])
        }
    })
}

/// Returns the pairs of faces that touch on the lattice, but cross neither there nor in their doubles.
fn close_on_lattice(mesh: &TriangleMesh) -> Vec<[u32; 2]> {
    let steps: Vec<Point> = mesh.vertices.iter().map(|p| p.map(as_double)).collect();
    let faces = |vertices| Faces {
        vertices,
        triangles: &mesh.faces,
    };
    let mut pairs = close_pairs(&faces(&steps));
    for vertices in [&steps, &mesh.doubles] {
        let crossing = crossings_among(&faces(vertices), &pairs);
        pairs.retain(|pair| crossing.binary_search(pair).is_err());
    }
    pairs
}

/// Returns true if a mesh of a solid would cross itself after its vertices get the doubles of their lattice
/// points along the given axes, but does not cross itself now.
pub fn crosses_once_snapped(solid: &Solid, axes: [bool; 3]) -> bool {
    // A reduced solid does not cross itself on the lattice.
    let is_known = axes == [true; 3] && solid.is_reduced();
    !is_known && solid.sources().iter().any(|s| source_crosses(s, axes))
}

/// Returns true if a source's mesh would cross itself after its vertices get the doubles of their lattice
/// points along the given axes; computes this only once.
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
    // Import changed the doubles of welded vertices, so crossings of faces there are not compared with the
    // input.
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

/// Returns true if triangles that cross others in `found` also cross others in the mesh `before`.
pub fn crossed(before: &Faces, found: &Faults) -> bool {
    let mut some: Vec<u32> = found.crossings.iter().flatten().copied().collect();
    some.sort_unstable();
    some.dedup();
    !faults(before, &some, |_| 0).crossings.is_empty()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::{crosses_once_snapped, crossing_faces, look_at_contacts, moved_doubles};
    use crate::geometry::doubles::Point;
    use crate::geometry::spaces::motion::Motion;
    use crate::mesh::grid::Pitch;
    use crate::mesh::import::import;
    use crate::tree::solid::Solid;

    /// A floor that slants by rounding, and a tip above it, on the lattice of integers.
    fn above(tip: Point, trusted: bool) -> Solid {
        spike_over([1.4, 1.6], tip, 0, trusted)
    }

    /// A floor that rises from height `low` to `high`, and a spike above it.
    fn spike_over([low, high]: [f64; 2], tip: Point, pitch: i64, trusted: bool) -> Solid {
        let floor = [[0.0, 0.0, low], [8.0, 0.0, low], [0.0, 8.0, high], [0.0; 3]];
        let spike = [tip, [3.0, 1.0, 9.0], [1.0, 3.0, 9.0], [-1.0, -1.0, 9.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let faces = [faces, faces.map(|t| t.map(|v| v + 4))].concat();
        let source = import(&[floor, spike].concat(), &faces, Pitch::new(pitch).ok());
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
        // The surfaces crossed before.
        assert!(!crosses(0.4, ALL));
    }

    #[test]
    fn what_touches_on_the_lattice_is_looked_at_in_each_place() {
        let crosses = |height: f64, shift: i64| {
            let solid = spike_over([1.0, 2.0], [1.0, 4.0, height], -1, false);
            let motion = Motion::of_axes(&[1, 2, 3], &[0, 0, shift]).expect("a motion");
            look_at_contacts(&solid, &motion);
            let source = solid.sources().iter().next().expect("a mesh");
            let pairs = source.close_pairs().get().cloned().unwrap_or_default();
            let mut image = source.mesh().expect("a mesh").clone();
            for (place, double) in image.vertices.iter_mut().zip(&mut image.doubles) {
                *place = motion.point(place).expect("near");
                *double = moved_doubles(&motion, solid.pitch(), double, place);
            }
            !crossing_faces(&image, &pairs).is_empty()
        };
        let places = |height: f64| (0..100).filter(|shift| crosses(height, *shift)).count();
        let touching = places(1.5);
        assert!((1..100).contains(&touching), "{touching}");
        assert_eq!([crosses(1.5, 0), crosses(1.5, 80)], [false; 2]);
        assert_eq!([places(1.6), places(1.4)], [0; 2]);
    }

    #[test]
    fn what_is_reduced_is_looked_at_only_if_some_doubles_stay() {
        let solid = above([1.0, 1.0, 1.49], true);
        assert!(!crosses_once_snapped(&solid, ALL));
        assert!(crosses_once_snapped(&solid, [false, false, true]));
    }
}
