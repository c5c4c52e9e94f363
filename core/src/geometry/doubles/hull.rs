//! Convex hulls of points in space, exactly.
//!
//! Points are added one by one to a polytope, each where it lies outside of faces, which it then
//! sees. A face is seen only by points strictly before it. So the faces that a point sees are a
//! disk, whose rim it joins to new faces; none of these is flat, because a point before a face is
//! not on a line with an edge of it. Points in the plane of a face that are not before another one
//! lie in the polytope already.
//!
//! # Source
//! Barber, Dobkin, Huhdanpaa 1996, "The quickhull algorithm for convex hulls".

use rustc_hash::FxHashMap as HashMap;

use crate::arith::Sign;
use crate::geometry::doubles::vector::{dot, less, normal};
use crate::geometry::doubles::{side, turn, Facing, Point, Triangle};
use crate::geometry::side::Side;
use crate::interrupt::poll;

/// The number of no face.
const NONE: usize = usize::MAX;

/// A triangle of the polytope, counterclockwise as seen from outside.
struct Face {
    corners: [usize; 3],
    /// The face behind the edge from each corner to the next.
    beside: [usize; 3],
    /// Points before this face, each listed at one face only.
    before: Vec<usize>,
    is_gone: bool,
}

/// The triangles of the convex hull of finite points, as their numbers.
///
/// All corners are corners of the hull as a set: none lies within an edge or a side of it. Empty if
/// all points lie in one plane.
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::hull::hull;
///
/// let mut points = vec![[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]];
/// points.push([1.0; 3]);
/// // The last point lies inside: the hull is a tetrahedron.
/// assert_eq!(hull(&points).len(), 4);
/// ```
#[must_use]
pub fn hull(points: &[Point]) -> Vec<[usize; 3]> {
    let faces = Polytope::around(points);
    let extreme = extreme_corners(points, &faces);
    if extreme.len() == corner_count(&faces) {
        return faces;
    }
    let chosen: Vec<Point> = extreme.iter().map(|p| points[*p]).collect();
    let renamed = |face: [usize; 3]| face.map(|corner| extreme[corner]);
    Polytope::around(&chosen).into_iter().map(renamed).collect()
}

fn corner_count(faces: &[[usize; 3]]) -> usize {
    // Of a triangulated sphere.
    if faces.is_empty() {
        0
    } else {
        faces.len() / 2 + 2
    }
}

/// The corners around which faces of three planes or more meet, ascending.
fn extreme_corners(points: &[Point], faces: &[[usize; 3]]) -> Vec<usize> {
    let mut around: HashMap<usize, Vec<Triangle>> = HashMap::default();
    for face in faces {
        for corner in face {
            around
                .entry(*corner)
                .or_default()
                .push(face.map(|p| points[p]));
        }
    }
    let has_three = |planes: &[Triangle]| {
        let others: Vec<&Triangle> = planes.iter().filter(|p| are_apart(&planes[0], p)).collect();
        others.iter().any(|third| are_apart(others[0], third))
    };
    let extreme = around.iter().filter(|(_, planes)| has_three(planes));
    let mut corners: Vec<usize> = extreme.map(|(corner, _)| *corner).collect();
    corners.sort_unstable();
    corners
}

/// Return whether triangles that share a corner lie in different planes.
fn are_apart(a: &Triangle, b: &Triangle) -> bool {
    b.iter().any(|p| side(a, p) != Side::On)
}

struct Polytope<'a> {
    points: &'a [Point],
    faces: Vec<Face>,
    /// Faces that may have points before them.
    waiting: Vec<usize>,
}

impl<'a> Polytope<'a> {
    fn around(points: &'a [Point]) -> Vec<[usize; 3]> {
        let Some(first) = simplex(points) else {
            return Vec::new();
        };
        let mut polytope = Self {
            points,
            faces: Vec::new(),
            waiting: Vec::new(),
        };
        polytope.start(first);
        while let Some(face) = polytope.waiting.pop() {
            poll();
            if let Some(point) = polytope.farthest(face) {
                polytope.add(point, face);
            }
        }
        let left = polytope.faces.iter().filter(|face| !face.is_gone);
        left.map(|face| face.corners).collect()
    }

    /// Makes the tetrahedron of four points in general position, and sorts all others before it.
    fn start(&mut self, [a, b, c, d]: [usize; 4]) {
        let corners = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
        let beside = [[2, 3, 1], [0, 3, 2], [1, 3, 0], [2, 1, 0]];
        for (corners, beside) in corners.into_iter().zip(beside) {
            self.push(corners, beside);
        }
        self.distribute((0..self.points.len()).collect(), 0);
    }

    fn push(&mut self, corners: [usize; 3], beside: [usize; 3]) {
        self.waiting.push(self.faces.len());
        self.faces.push(Face {
            corners,
            beside,
            before: Vec::new(),
            is_gone: false,
        });
    }

    fn triangle(&self, face: usize) -> Triangle {
        self.faces[face].corners.map(|corner| self.points[corner])
    }

    /// Lists points at the first face they lie before, of those from a number on; those before none
    /// lie in the polytope for good.
    fn distribute(&mut self, mut points: Vec<usize>, from: usize) {
        for face in from..self.faces.len() {
            let triangle = self.triangle(face);
            let facing = Facing::of(&triangle);
            let is_before = |p: &usize| {
                poll();
                facing.side(&self.points[*p]) == Side::Plus
            };
            let (before, others) = points.into_iter().partition(is_before);
            self.faces[face].before = before;
            points = others;
        }
    }

    /// The point that seems farthest before a face; any would do.
    fn farthest(&self, face: usize) -> Option<usize> {
        if self.faces[face].is_gone {
            return None;
        }
        let [a, b, c] = self.triangle(face);
        let normal = normal(&[a, b, c]);
        let height = |p: usize| dot(&normal, &less(&self.points[p], &a));
        let listed = self.faces[face].before.iter().copied();
        listed.max_by(|p, q| {
            let lower = height(*p).total_cmp(&height(*q));
            lower.then_with(|| order(&self.points[*q], &self.points[*p]))
        })
    }

    /// Adds a point before a face: all faces that it sees give way to new ones around it.
    fn add(&mut self, point: usize, face: usize) {
        let (seen, rim) = self.seen(point, face);
        let first = self.faces.len();
        // The rim is a cycle: each new face is beside those that start where it ends, and end where
        // it starts.
        let starts: HashMap<usize, usize> = rim
            .iter()
            .enumerate()
            .map(|(k, r)| (r.start, first + k))
            .collect();
        let ends: HashMap<usize, usize> = rim
            .iter()
            .enumerate()
            .map(|(k, r)| (r.end, first + k))
            .collect();
        for (number, edge) in (first..).zip(&rim) {
            let beside = [edge.behind, starts[&edge.end], ends[&edge.start]];
            self.push([edge.start, edge.end, point], beside);
            self.faces[edge.behind].beside[edge.slot] = number;
        }
        let mut orphans = Vec::new();
        for gone in seen {
            orphans.append(&mut self.faces[gone].before);
        }
        orphans.retain(|p| *p != point);
        self.distribute(orphans, first);
    }

    /// The faces that a point sees, taken away, and the edges around them.
    fn seen(&mut self, point: usize, face: usize) -> (Vec<usize>, Vec<Rim>) {
        let (mut seen, mut rim) = (vec![face], Vec::new());
        self.faces[face].is_gone = true;
        let mut next = 0;
        while next < seen.len() {
            let at = seen[next];
            next += 1;
            for edge in 0..3 {
                let behind = self.faces[at].beside[edge];
                if self.faces[behind].is_gone {
                    continue;
                }
                if side(&self.triangle(behind), &self.points[point]) == Side::Plus {
                    self.faces[behind].is_gone = true;
                    seen.push(behind);
                } else {
                    let corners = &self.faces[at].corners;
                    let slot = self.faces[behind].beside.iter().position(|f| *f == at);
                    rim.push(Rim {
                        start: corners[edge],
                        end: corners[(edge + 1) % 3],
                        behind,
                        slot: slot.unwrap_or(NONE),
                    });
                }
            }
        }
        (seen, rim)
    }
}

/// An edge around the faces that a point sees.
struct Rim {
    start: usize,
    end: usize,
    /// The face on its other side, and which edge of it this is.
    behind: usize,
    slot: usize,
}

/// Four points of which none lies in the plane of the others, the last behind the first three.
fn simplex(points: &[Point]) -> Option<[usize; 4]> {
    let a = (0..points.len()).min_by(|p, q| order(&points[*p], &points[*q]))?;
    let b = (0..points.len()).max_by(|p, q| order(&points[*p], &points[*q]))?;
    let (pa, pb) = (points[a], points[b]);
    let across = |p: &usize| {
        let normal = normal(&[pa, pb, points[*p]]);
        dot(&normal, &normal)
    };
    let wide = (0..points.len()).max_by(|p, q| across(p).total_cmp(&across(q)))?;
    let is_off = |p: &usize| !are_in_line(&[pa, pb, points[*p]]);
    let c = Some(wide)
        .filter(is_off)
        .or_else(|| (0..points.len()).find(is_off))?;
    let base = [pa, pb, points[c]];
    let normal = normal(&[pa, pb, points[c]]);
    let height = |p: &usize| dot(&normal, &less(&points[*p], &pa)).abs();
    let high = (0..points.len()).max_by(|p, q| height(p).total_cmp(&height(q)))?;
    let is_out = |p: &usize| side(&base, &points[*p]) != Side::On;
    let d = Some(high)
        .filter(is_out)
        .or_else(|| (0..points.len()).find(is_out))?;
    Some(if side(&base, &points[d]) == Side::Minus {
        [a, b, c, d]
    } else {
        [a, c, b, d]
    })
}

/// Return whether three points lie on one line: then they do along each axis.
fn are_in_line(points: &Triangle) -> bool {
    (0..3).all(|axis| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        turn(points.map(|p| [p[u], p[v]])) == Sign::Zero
    })
}

fn order(p: &Point, q: &Point) -> std::cmp::Ordering {
    p.partial_cmp(q).unwrap_or(std::cmp::Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::{hull, side, Point, Side};
    use proptest::prelude::*;

    /// Points of a small grid, most of them in common lines and planes.
    fn grid_points() -> impl Strategy<Value = Vec<Point>> {
        let coordinate = (-2i32..3).prop_map(f64::from);
        prop::collection::vec(prop::array::uniform3(coordinate), 0..40)
    }

    fn scattered_points() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 4..60)
    }

    fn assert_hull(points: &[Point]) {
        let faces = hull(points);
        let corner = |p: usize| points[p];
        for face in &faces {
            let triangle = face.map(corner);
            assert!(points.iter().all(|p| side(&triangle, p) != Side::Plus));
            assert!(points.iter().any(|p| side(&triangle, p) == Side::Minus));
            for edge in 0..3 {
                let back = [face[(edge + 1) % 3], face[edge]];
                let has = |f: &&[usize; 3]| (0..3).any(|k| [f[k], f[(k + 1) % 3]] == back);
                assert_eq!(faces.iter().filter(has).count(), 1);
            }
        }
        if faces.is_empty() {
            let flat = |a: &Point, b: &Point, c: &Point| {
                points.iter().all(|p| side(&[*a, *b, *c], p) == Side::On)
            };
            let few = points.len().min(12);
            let (a, b) = (&points[..few], &points[..few]);
            assert!(a
                .iter()
                .all(|a| b.iter().all(|b| points.iter().all(|c| flat(a, b, c)))));
        }
    }

    proptest! {
        #[test]
        fn all_points_are_behind_all_faces(points in grid_points()) {
            assert_hull(&points);
        }

        #[test]
        fn scattered_points_are_enclosed(points in scattered_points()) {
            assert_hull(&points);
        }
    }

    #[test]
    fn a_grid_has_eight_corners() {
        let numbers = || (0..4).map(f64::from);
        let grid: Vec<Point> = numbers()
            .flat_map(|x| numbers().flat_map(move |y| numbers().map(move |z| [x, y, z])))
            .collect();
        let faces = hull(&grid);
        assert_eq!(faces.len(), 12);
        let outer = |p: &f64| [0.0, 3.0].contains(p);
        assert!(faces
            .as_flattened()
            .iter()
            .all(|p| grid[*p].iter().all(outer)));
    }
}
