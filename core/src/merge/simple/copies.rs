//! Shells of one mesh that are the same: their union needs one of them.

use rustc_hash::FxHashMap;

use crate::geometry::plane::Lattice;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
use crate::mesh::triangles::TriangleMesh;

/// Different shells with one sample to which others are compared. So all comparisons together are
/// at most so many passes over the faces.
const KINDS: usize = 4;

/// A length and some faces that tell a shell from most others.
type Sample = (usize, [Option<[Lattice; 3]>; 3]);

/// For each shell whether it is the first of those whose faces, in their order, have its corners.
///
/// Of coinciding faces of a union the first operand's stay. So the first of equal shells can stand
/// for all.
pub fn are_firsts(mesh: &TriangleMesh, shells: &[Vec<FaceId>]) -> Vec<bool> {
    let mut known: FxHashMap<Sample, Vec<&[FaceId]>> = FxHashMap::default();
    let is_first = |shell| {
        poll();
        let others = known.entry(sample(mesh, shell)).or_default();
        if others.iter().any(|other| are_equal(mesh, other, shell)) {
            return false;
        }
        if others.len() < KINDS {
            others.push(shell);
        }
        true
    };
    shells.iter().map(Vec::as_slice).map(is_first).collect()
}

/// Return whether two shells are the same.
pub fn are_some(mesh: &TriangleMesh, shells: &[Vec<FaceId>]) -> bool {
    are_firsts(mesh, shells).contains(&false)
}

fn sample(mesh: &TriangleMesh, shell: &[FaceId]) -> Sample {
    let places = [0, shell.len() / 2, shell.len().saturating_sub(1)];
    let at = |place: usize| shell.get(place).map(|face| mesh.corners(*face));
    (shell.len(), places.map(at))
}

fn are_equal(mesh: &TriangleMesh, some: &[FaceId], others: &[FaceId]) -> bool {
    let corners = |face: &FaceId| mesh.corners(*face);
    some.len() == others.len() && some.iter().map(corners).eq(others.iter().map(corners))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::import::import;

    const TETRAHEDRON: [[i64; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn firsts(places: &[f64], faces: &[[i64; 3]]) -> Vec<bool> {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let vertices: Vec<_> = places
            .iter()
            .flat_map(|at| corners.map(|[x, y, z]| [x + at, y, z]))
            .collect();
        let source = import(&vertices, faces, None).expect("a closed mesh");
        let mesh = source.mesh().expect("a mesh");
        let all: Vec<FaceId> = mesh.face_ids().collect();
        let shells: Vec<_> = all.chunks(4).map(<[FaceId]>::to_vec).collect();
        are_firsts(mesh, &shells)
    }

    fn moved(by: i64) -> [[i64; 3]; 4] {
        TETRAHEDRON.map(|face| face.map(|vertex| vertex + by))
    }

    #[test]
    fn a_copy_follows_its_first() {
        let faces = [0, 4, 8, 12].map(moved).concat();
        assert_eq!(
            firsts(&[0.0, 2.0, 0.0, 2.0], &faces),
            [true, true, false, false]
        );
    }

    #[test]
    fn a_shell_turned_inside_out_is_no_copy() {
        let turned = moved(4).map(|[a, b, c]| [a, c, b]);
        assert_eq!(
            firsts(&[0.0, 0.0], &[moved(0), turned].concat()),
            [true, true]
        );
    }
}
