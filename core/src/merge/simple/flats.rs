//! The flat pieces of a surface: connected faces of one plane that look the same way and do not
//! overlap each other, as the needles of a cap.
//!
//! Seen along an axis, all faces of such a piece turn the same way, so how many of them cover a
//! point is the winding number there of the edges that only one of them has. A sweep over these
//! edges says whether it is ever above one, at the cost of the outline instead of all pairs.

use crate::arith::convert::{as_double, as_number};
use crate::arith::Sign;
use crate::error::Result;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{seen_along, turn, Facing, Triangle};
use crate::geometry::side::Side;
use crate::interrupt::poll;
use crate::merge::plane::{bounded, Outlines};
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::source::Source;
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::partition::Label;

/// Pieces of fewer faces are not worth a sweep: pairs are looked at in no time.
const LEAST: usize = 4;

struct Flats<'a> {
    mesh: &'a TriangleMesh,
    mates: &'a [u32],
    /// By face, the number of its piece.
    pieces: Vec<u32>,
}

/// A plane as its first face shows it.
struct View {
    plane: Triangle,
    /// The axis along which the face is seen best.
    axis: usize,
    /// The way the face turns, seen so; `Zero` without area.
    way: Sign,
}

/// Return for each face the number of its flat piece; `NONE` where faces are few or overlap.
///
/// # Cost
/// Linear in the faces, and a sweep over the outline of each piece.
pub fn flat_pieces(source: &Source, mesh: &TriangleMesh) -> Vec<u32> {
    let Some(topology) = source.topology() else {
        return vec![NONE; mesh.faces.len()];
    };
    let mut flats = Flats {
        mesh,
        mates: topology.mates(),
        pieces: vec![NONE; mesh.faces.len()],
    };
    let mut numbers = Vec::new();
    for first in mesh.face_ids() {
        if flats.pieces[first.place()] == NONE {
            let number = as_number(numbers.len());
            let view = View::of(mesh, first);
            let piece = flats.piece_around(first, &view, number);
            let is_sound = piece.len() >= LEAST && flats.is_covered_once(&piece, &view);
            numbers.push(if is_sound { number } else { NONE });
        }
    }
    let sound = |piece: u32| numbers[piece as usize];
    flats.pieces.into_iter().map(sound).collect()
}

impl View {
    fn of(mesh: &TriangleMesh, face: FaceId) -> Self {
        let plane = doubles(mesh, face);
        let axis = Facing::of(&plane).main_axis();
        let way = turn(seen_along(&plane, axis));
        Self { plane, axis, way }
    }

    /// Return whether a face lies in the plane and looks the same way; its corners other than one are
    /// known to lie there.
    fn shows(&self, face: &Triangle, other: usize) -> bool {
        Facing::of(&self.plane).side(&face[other]) == Side::On
            && turn(seen_along(face, self.axis)) == self.way
    }
}

impl Flats<'_> {
    /// Numbers the faces of a piece, and lists them.
    fn piece_around(&mut self, first: FaceId, view: &View, number: u32) -> Vec<FaceId> {
        self.pieces[first.place()] = number;
        let mut piece = vec![first];
        let mut at = 0;
        while let Some(face) = piece.get(at).copied() {
            poll();
            at += 1;
            let known = self.mesh.vertices_of(face);
            for mate in self.mates_of(face).into_iter().flatten() {
                if self.pieces[mate.place()] == NONE
                    && view.way != Sign::Zero
                    && view.shows(&doubles(self.mesh, mate), self.apex(mate, &known))
                {
                    self.pieces[mate.place()] = number;
                    piece.push(mate);
                }
            }
        }
        piece
    }

    /// The corner of a face across the edge at which it meets one with these vertices.
    fn apex(&self, face: FaceId, known: &[VertexId; 3]) -> usize {
        let corners = self.mesh.vertices_of(face);
        let apex = corners.iter().position(|v| !known.contains(v));
        apex.unwrap_or(0)
    }

    fn mates_of(&self, face: FaceId) -> [Option<FaceId>; 3] {
        let mates = &self.mates[3 * face.place()..3 * face.place() + 3];
        [0, 1, 2].map(|i| Some(mates[i]).filter(|m| *m != NONE).map(FaceId::beside))
    }

    /// Return whether no two faces of a piece overlap; errs on no.
    fn is_covered_once(&self, piece: &[FaceId], view: &View) -> bool {
        let twice = self
            .outline(piece, view)
            .and_then(|outline| bounded(&outline, |number| number > 1));
        twice.is_ok_and(|twice| twice.edges.is_empty() && twice.outer == Label::Out)
    }

    /// The edges that only one face of a piece has, seen along the axis.
    fn outline(&self, piece: &[FaceId], view: &View) -> Result<Outlines> {
        let number = self.pieces[piece[0].place()];
        let [u, v] = [1, 2].map(|i| (view.axis + i) % 3);
        let mut outline = Outlines::default();
        for face in piece {
            let corners = self.mesh.corners(*face).map(|c| [c[u], c[v]]);
            for (i, mate) in self.mates_of(*face).into_iter().enumerate() {
                if mate.is_none_or(|m| self.pieces[m.place()] != number) {
                    outline.push(corners[i], corners[(i + 1) % 3], view.way.into())?;
                }
            }
        }
        Ok(outline)
    }
}

/// The corners of a face in doubles, which hold lattice coordinates exactly.
pub fn doubles(mesh: &TriangleMesh, face: FaceId) -> Triangle {
    mesh.corners(face).map(|c| each_axis(|i| as_double(c[i])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::grid::Pitch;
    use crate::mesh::handle::VertexId;
    use crate::mesh::source::Shape;

    /// A prism over a fan: the first corner of the outline sees all others.
    fn prism(outline: &[[i64; 2]]) -> TriangleMesh {
        let count = as_number(outline.len());
        let level = |z: i64| outline.iter().map(move |p| [p[0], p[1], z]);
        let caps = (1..count - 1).flat_map(|i| [[0, i + 1, i], [count, count + i, count + i + 1]]);
        let walls = (0..count).flat_map(|i| {
            let j = (i + 1) % count;
            [[i, j, count + j], [i, count + j, count + i]]
        });
        TriangleMesh {
            vertices: level(0).chain(level(100)).collect(),
            faces: caps.chain(walls).map(|f| f.map(VertexId)).collect(),
            ..TriangleMesh::default()
        }
    }

    fn pieces(mesh: TriangleMesh) -> Vec<u32> {
        let source = Source::new(Pitch::DEFAULT, Shape::Mesh(mesh), Vec::new());
        flat_pieces(&source, source.mesh().expect("a mesh"))
    }

    #[test]
    fn caps_are_pieces_and_walls_are_too_small() {
        let arc: Vec<[i64; 2]> = (-9..=9).map(|i| [1000 - i * i, 100 * i]).collect();
        let found = pieces(prism(&arc));
        let caps = 2 * (arc.len() - 2);
        let of_face = |i: usize| found[i % 2];
        assert!((0..caps).all(|i| found[i] == of_face(i)));
        assert!(found[0] != NONE && found[1] != NONE && found[0] != found[1]);
        assert!(found[caps..].iter().all(|piece| *piece == NONE));
    }

    /// Needles that go around their common corner more than once cover it twice.
    #[test]
    fn pieces_that_cover_a_point_twice_are_given_up() {
        let around = [
            [5, 0],
            [4, 4],
            [0, 5],
            [-4, 4],
            [-5, 0],
            [-4, -4],
            [0, -5],
            [4, -4],
        ];
        let spiral = (100..112)
            .zip(around.iter().cycle())
            .map(|(size, p)| p.map(|c| c * size));
        let outline: Vec<[i64; 2]> = std::iter::once([0, 0]).chain(spiral).collect();
        let caps = 2 * (outline.len() - 2);
        assert!(pieces(prism(&outline))[..caps]
            .iter()
            .all(|piece| *piece == NONE));
        let once = pieces(prism(&outline[..8]));
        assert!(once[..12].iter().all(|piece| *piece != NONE));
    }
}
