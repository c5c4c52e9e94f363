//! Finds the source face that each new triangle of a joined polygon lies in.

use crate::arith::convert::as_number;
use crate::extract::joining::group::PlaneGroup;
use crate::extract::triangulate::Planar;
use crate::extract::vertices::Projection;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::OrientedFace;
use crate::mesh::source::Shape;

/// At most this many points are compared with all faces near them; longer lists are halved first.
const MAX_POINTS_UNHALVED: usize = 8;

/// A list of points is not halved if both halves together would list more than this many sixteenths of the
/// faces, that is, seven eighths each.
const MAX_SIXTEENTHS_LEFT: usize = 28;

/// A bound on how far rounding may move a corner or a side, relative to the largest coordinate.
const ROUNDING: f64 = 1e-12;

/// Finds the face of a plane group at a point, in a projection of the plane.
///
/// A triangle of a joined polygon may lie in several faces; its origin is the face at its centre. Doubles
/// decide, because nothing else depends on the origin. The first face that contains the centre up to
/// rounding is taken: so a centre on a common edge always gets the same face.
pub struct Owners<'a> {
    group: &'a PlaneGroup,
    /// The corners of each face; `None` for the face of a half-space, which covers the plane.
    corners: Vec<Option<[[f64; 2]; 3]>>,
}

/// The corner of a rectangle with the least coordinates, and the corner with the largest.
type Bounds = [[f64; 2]; 2];

/// Points to locate, and the faces that may contain some of them, ascending.
struct Search<'p> {
    points: &'p mut [(usize, [f64; 2])],
    faces: Vec<u32>,
}

impl<'a> Owners<'a> {
    /// Projects the faces of a plane group.
    pub fn new(group: &'a PlaneGroup, view: &Projection, sources: &Sources) -> Self {
        let corners = |face: &OrientedFace| match sources.get(face.slot()).shape() {
            Shape::Mesh(mesh) => Some(mesh.corners(face.id()).map(|p| view.flat(&p))),
            Shape::HalfSpace(_) => None,
        };
        let corners = group.faces.iter().map(corners).collect();
        Self { group, corners }
    }

    /// Returns for each triangle the source face that contains its centre, or the first face of the group if
    /// rounding errors leave no such face.
    ///
    /// # Cost
    /// Points are halved, each half with the faces that meet its box. A long face meets about the square
    /// root of the number of parts.
    pub fn at_centres(&self, triangles: &[[u32; 3]], view: &Projection) -> Vec<OrientedFace> {
        let centre = |triangle: &[u32; 3]| {
            let corners = triangle.map(|p| view.approx(p));
            [0, 1].map(|i| corners.iter().map(|c| c[i]).sum::<f64>() / 3.0)
        };
        let first = self.group.faces.first().copied().unwrap_or_default();
        let mut found = vec![first; triangles.len()];
        let mut points: Vec<(usize, [f64; 2])> = triangles.iter().map(centre).enumerate().collect();
        let mut waiting = vec![Search {
            points: &mut points,
            faces: (0..as_number(self.corners.len())).collect(),
        }];
        while let Some(search) = waiting.pop() {
            poll();
            match self.halved(search) {
                Ok(halves) => waiting.extend(halves),
                Err(few) => self.compare(few, &mut found),
            }
        }
        found
    }

    fn compare(&self, search: Search, found: &mut [OrientedFace]) {
        for (number, point) in search.points {
            poll();
            let mut near = search.faces.iter();
            if let Some(face) = near.find(|face| self.reaches(**face, &[*point; 2])) {
                found[*number] = self.group.faces[*face as usize];
            }
        }
    }

    /// Halves the points of a search, each half with the faces near it; returns the search itself as `Err` if
    /// halving would rule out too few faces.
    fn halved<'p>(&self, search: Search<'p>) -> Result<[Search<'p>; 2], Search<'p>> {
        let Search { points, faces } = search;
        if points.len() <= MAX_POINTS_UNHALVED || faces.len() <= MAX_POINTS_UNHALVED {
            return Err(Search { points, faces });
        }
        let [low, high] = bounds(points);
        let longer = usize::from(high[1] - low[1] > high[0] - low[0]);
        for axis in [longer, 1 - longer] {
            let middle = points.len() / 2;
            points.select_nth_unstable_by(middle, |a, b| a.1[axis].total_cmp(&b.1[axis]));
            let near = [&points[..middle], &points[middle..]]
                .map(|half| self.reaching(&faces, &bounds(half)));
            if 16 * (near[0].len() + near[1].len()) <= MAX_SIXTEENTHS_LEFT * faces.len() {
                let (lower, upper) = points.split_at_mut(middle);
                let [some, others] = near;
                return Ok([(lower, some), (upper, others)]
                    .map(|(points, faces)| Search { points, faces }));
            }
        }
        Err(Search { points, faces })
    }

    /// Returns the faces among `faces` that may contain a point of a box.
    fn reaching(&self, faces: &[u32], bounds: &Bounds) -> Vec<u32> {
        let faces = faces.iter().copied();
        faces.filter(|face| self.reaches(*face, bounds)).collect()
    }

    /// Returns false only if a face misses a box by more than rounding.
    fn reaches(&self, face: u32, bounds: &Bounds) -> bool {
        let corners = self.corners[face as usize];
        corners.is_none_or(|corners| may_meet(&corners, bounds))
    }
}

fn bounds(points: &[(usize, [f64; 2])]) -> Bounds {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for (_, point) in points {
        for i in 0..2 {
            bounds[0][i] = bounds[0][i].min(point[i]);
            bounds[1][i] = bounds[1][i].max(point[i]);
        }
    }
    bounds
}

fn sides([a, b, c]: &[[f64; 2]; 3]) -> [[[f64; 2]; 2]; 3] {
    [[*a, *b], [*b, *c], [*c, *a]]
}

fn turn([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Returns false only if a side of the box, or of the triangle, separates the two by more than rounding.
fn may_meet(corners: &[[f64; 2]; 3], [low, high]: &Bounds) -> bool {
    let largest = corners
        .iter()
        .chain([low, high])
        .flatten()
        .fold(0.0, |most: f64, x| most.max(x.abs()));
    let slack = ROUNDING * largest;
    let is_past = |i: usize| {
        corners.iter().all(|c| c[i] > high[i] + slack)
            || corners.iter().all(|c| c[i] < low[i] - slack)
    };
    if is_past(0) || is_past(1) {
        return false;
    }
    let ends = [*low, [high[0], low[1]], *high, [low[0], high[1]]];
    let [ab, bc, ca] = sides(corners);
    [(ab, corners[2]), (bc, corners[0]), (ca, corners[1])]
        .iter()
        .all(|(side, third)| {
            let inner = turn(*side, *third);
            let length = (0..2).map(|i| (side[1][i] - side[0][i]).abs()).sum::<f64>();
            let doubt = slack * length;
            let turns = ends.map(|end| turn(*side, end) * inner.signum());
            inner.abs() <= doubt || turns.iter().any(|t| *t >= -doubt)
        })
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
            let x = triangle.map(|v| match mesh.vertices[v.index()] {
                Corner::Source(slot, id) => {
                    let source = boxes[slot.index()].sources().get(Slot(0));
                    source.mesh().expect("a mesh").vertices[id.index()][0]
                }
                Corner::Point(id) => mesh.table.point(id).as_lattice().expect("a corner")[0],
            });
            let [low, high] = reach[face.slot().index()];
            let sum: i64 = x.iter().sum();
            assert!((3 * low..=3 * high).contains(&sum));
        }
    }
}
