//! The origins of new triangles: the source face that each triangle of a joined polygon lies in.

use crate::extract::joining::planes::PlaneGroup;
use crate::extract::triangulate::Planar;
use crate::extract::vertices::Projection;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::OrientedFace;
use crate::mesh::source::Shape;

/// The faces of one plane in a projection, to be asked for the one at a point.
///
/// A triangle of a joined polygon may lie in several faces; the face at its centre stands for it.
/// Doubles decide, for nothing but the name depends on it; where faces overlap, the first counts.
pub struct Owners {
    faces: Vec<Owner>,
    widest: f64,
}

struct Owner {
    face: OrientedFace,
    rank: usize,
    corners: Option<[[f64; 2]; 3]>,
    low: f64,
}

impl Owners {
    /// The faces of a group.
    pub fn new(group: &PlaneGroup, view: &Projection, sources: &Sources) -> Self {
        let mut faces: Vec<Owner> = group
            .faces
            .iter()
            .enumerate()
            .map(|(rank, face)| Owner::new(*face, rank, view, sources))
            .collect();
        faces.sort_by(|a, b| a.low.total_cmp(&b.low));
        let widest = faces.iter().map(Owner::width).fold(0.0, f64::max);
        Self { faces, widest }
    }

    /// The face at the centre of a triangle, or the first face if rounding finds none.
    pub fn at_centre(&self, triangle: [u32; 3], view: &Projection) -> OrientedFace {
        let corners = triangle.map(|p| view.approx(p));
        let centre = [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / 3.0);
        let end = self.faces.partition_point(|f| f.low <= centre[0]);
        let start = self.faces[..end].partition_point(|f| f.low < centre[0] - self.widest);
        self.faces[start..end]
            .iter()
            .filter(|f| f.holds(centre))
            .min_by_key(|f| f.rank)
            .or_else(|| self.faces.iter().min_by_key(|f| f.rank))
            .map_or_else(OrientedFace::default, |f| f.face)
    }
}

impl Owner {
    fn new(face: OrientedFace, rank: usize, view: &Projection, sources: &Sources) -> Self {
        let corners = match sources.get(face.slot()).shape() {
            Shape::Mesh(mesh) => Some(mesh.corners(face.id()).map(|p| view.flat(&p))),
            Shape::HalfSpace(_) => None,
        };
        let low = corners.map_or(f64::NEG_INFINITY, |c| c[0][0].min(c[1][0]).min(c[2][0]));
        Self {
            face,
            rank,
            corners,
            low,
        }
    }

    fn width(&self) -> f64 {
        self.corners.map_or(f64::INFINITY, |c| {
            c[0][0].max(c[1][0]).max(c[2][0]) - self.low
        })
    }

    fn holds(&self, p: [f64; 2]) -> bool {
        let Some(c) = self.corners else {
            return true;
        };
        let turn = |a: [f64; 2], b: [f64; 2]| {
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
        };
        let turns = [turn(c[0], c[1]), turn(c[1], c[2]), turn(c[2], c[0])];
        turns.iter().all(|t| *t >= 0.0) || turns.iter().all(|t| *t <= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use crate::extract::assemble::assemble;
    use crate::extract::mesh::Corner;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of};
    use crate::mesh::handle::Slot;

    #[test]
    fn a_new_triangle_names_a_face_that_holds_its_centre() {
        let boxes = [cuboid([0; 3], [6, 4, 4]), cuboid([3, 0, 0], [30, 4, 4])];
        let mesh = assemble(&made_of(&boxes, Term::Or)).expect("bounded");
        let reach = [[0, 6], [3, 30]];
        for (triangle, face) in mesh.triangles.iter().zip(&mesh.faces) {
            let x = triangle.map(|v| match mesh.vertices[v.place()] {
                Corner::Source(slot, id) => {
                    let source = boxes[slot.place()].sources().get(Slot(0));
                    source.mesh().expect("a mesh").vertices[id.place()][0]
                }
                Corner::Point(id) => mesh.table.point(id).as_lattice().expect("a corner")[0],
            });
            let [low, high] = reach[face.slot().place()];
            let sum: i64 = x.iter().sum();
            assert!((3 * low..=3 * high).contains(&sum));
        }
    }
}
