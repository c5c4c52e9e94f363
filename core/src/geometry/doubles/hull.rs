//! Exact convex hulls of points in space.
//!
//! Points are added one by one to a polytope. A point sees the faces on whose outer side it strictly lies;
//! they form a disk, and new faces join the border of the disk to the point. No new face is flat, because a
//! point outside a face's plane is not on a line with an edge of that face. A point that sees no face already
//! lies in the polytope.
//!
//! # Source
//! Barber, Dobkin, Huhdanpaa 1996, "The quickhull algorithm for convex hulls".

use rustc_hash::FxHashMap as HashMap;

use crate::arith::Sign;
use crate::geometry::doubles::reach::is_beyond;
use crate::geometry::doubles::vector::{cross, difference, dot, normal};
use crate::geometry::doubles::{side, turn, Facing, Point, Triangle};
use crate::geometry::side::Side;
use crate::interrupt::poll;

/// Stands for the number of a face where there is none.
const NONE: usize = usize::MAX;

/// A triangle of the polytope, counterclockwise as seen from outside.
struct Face {
    corners: [usize; 3],
    /// For each corner, the number of the face across the edge from this corner to the next.
    beside: [usize; 3],
    /// Points strictly on the outer side of this face; each point is listed at one face only.
    before: Vec<usize>,
    is_gone: bool,
}

/// The triangles of the convex hull of finite points, each as three indices of points, counterclockwise from
/// outside.
///
/// All corners are true corners of the hull: none lies inside an edge or a flat side of it. Empty if all
/// points lie in one plane.
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
    hull_of_inexact(points, 0.0)
}

/// The triangles of a convex hull of finite points that may each be off by a radius.
///
/// A point within twice the radius of the hull of the other points is no corner, and no point lies farther
/// than twice the radius outside the result. Empty if all points may lie in one plane.
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::hull::hull_of_inexact;
///
/// let mut points = vec![[0.0; 3], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]];
/// points.push([2.0, 2.0, -0.1]);
/// assert_eq!(hull_of_inexact(&points, 0.0).len(), 6);
/// assert_eq!(hull_of_inexact(&points, 0.1).len(), 4);
/// ```
#[must_use]
pub fn hull_of_inexact(points: &[Point], radius: f64) -> Vec<[usize; 3]> {
    let all: Vec<usize> = (0..points.len()).collect();
    let mut faces = Polytope::around(points, &[&all], 0.0);
    let corners = corners_of(&faces);
    let corner_points: Vec<Point> = corners.iter().map(|p| points[*p]).collect();
    if radius > 0.0 && is_flat_within(&corner_points, FLAT_RADII * radius) {
        return Vec::new();
    }
    for _ in 0..MAX_PASSES {
        let sharp = sharp_corners(points, &faces, 2.0 * radius);
        if sharp.len() == corners_of(&faces).len() {
            break;
        }
        let is_left = |p: &usize| sharp.binary_search(p).is_err();
        let others: Vec<usize> = corners.iter().copied().filter(is_left).collect();
        faces = Polytope::around(points, &[&sharp, &others], 2.0 * radius);
    }
    faces
}

/// The largest number of passes that drop corners which are not sharp. Of several corners that differ only by
/// rounding, none is sharp; the first pass leaves one of them.
const MAX_PASSES: usize = 3;

/// Points of one plane, each off by a radius, lie within this many radii of the plane through three of them
/// that are far apart. The errors of the three points contribute at most three, two and one radii, and the
/// error of the point itself one.
const FLAT_RADII: f64 = 7.0;

/// The indices of the points that are corners of faces, ascending and without repetition.
#[must_use]
pub fn corners_of(faces: &[[usize; 3]]) -> Vec<usize> {
    let mut used: Vec<usize> = faces.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    used
}

/// Return whether all points lie within a distance from the plane through three of them that are far apart.
fn is_flat_within(points: &[Point], max_distance: f64) -> bool {
    let width = |axis: usize| {
        let along = || points.iter().map(|p| p[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let widest = (0..3).max_by(|i, j| width(*i).total_cmp(&width(*j)));
    let farthest = |height: &dyn Fn(&Point) -> f64| {
        let far = points.iter().max_by(|p, q| height(p).total_cmp(&height(q)));
        far.copied().unwrap_or_default()
    };
    let axis = widest.unwrap_or_default();
    let (low, high) = (farthest(&|p| -p[axis]), farthest(&|p| p[axis]));
    let along = difference(&high, &low);
    let length = dot(&along, &along);
    // Computed relative to the line, so that a plane through points near it keeps its digits.
    let off = |p: &Point| {
        let offset = difference(p, &low);
        let share = dot(&offset, &along) / length;
        [0, 1, 2].map(|i| offset[i] - share * along[i])
    };
    let widest = off(&farthest(&|p| dot(&off(p), &off(p))));
    let normal = cross(&along, &widest);
    let height = |p: &Point| dot(&normal, &off(p)).abs();
    height(&farthest(&height)) <= max_distance * dot(&normal, &normal).sqrt()
}

/// The corners of faces that lie farther than a distance from the hull of their neighbours, ascending.
fn sharp_corners(points: &[Point], faces: &[[usize; 3]], max_distance: f64) -> Vec<usize> {
    let mut around: Vec<(usize, usize)> = Vec::with_capacity(3 * faces.len());
    for (number, face) in faces.iter().enumerate() {
        around.extend(face.map(|corner| (corner, number)));
    }
    around.sort_unstable();
    let clearly = (CLEAR_DISTANCE * size_of(points, faces)).max(max_distance);
    let mut sharp = Vec::new();
    for star in around.chunk_by(|p, q| p.0 == q.0) {
        poll();
        let corner = star[0].0;
        let beside = || star.iter().flat_map(|(_, face)| faces[*face]);
        let others: Vec<Point> = beside()
            .filter(|p| *p != corner)
            .map(|p| points[p])
            .collect();
        let is_beyond = |max_distance: f64| is_beyond(&points[corner], &others, max_distance);
        let planes = || star.iter().map(|(_, face)| faces[*face].map(|p| points[p]));
        let is_sharp = is_beyond(clearly)
            || has_three_planes(&planes().collect::<Vec<Triangle>>())
                && (max_distance == 0.0 || is_beyond(max_distance));
        if is_sharp {
            sharp.push(corner);
        }
    }
    sharp
}

/// A distance as a fraction of the hull's size: doubles decide all larger ones.
const CLEAR_DISTANCE: f64 = 1e-12;

/// The largest difference, in any coordinate, between a corner of the faces and the first corner.
fn size_of(points: &[Point], faces: &[[usize; 3]]) -> f64 {
    let Some([first, ..]) = faces.first() else {
        return 0.0;
    };
    let offsets = faces
        .as_flattened()
        .iter()
        .map(|p| difference(&points[*p], &points[*first]));
    let largest = |offset: Point| {
        offset
            .iter()
            .fold(0.0, |largest: f64, x| largest.max(x.abs()))
    };
    offsets.map(largest).fold(0.0, f64::max)
}

/// Return whether the triangles around a corner lie in at least three planes: the corner is then inside no
/// edge and no flat side.
fn has_three_planes(planes: &[Triangle]) -> bool {
    let others: Vec<&Triangle> = planes.iter().filter(|p| are_apart(&planes[0], p)).collect();
    others.iter().any(|third| are_apart(others[0], third))
}

/// Return whether two triangles that share a corner lie in different planes.
fn are_apart(a: &Triangle, b: &Triangle) -> bool {
    b.iter().any(|p| side(a, p) != Side::On)
}

struct Polytope<'a> {
    points: &'a [Point],
    faces: Vec<Face>,
    /// Faces whose outer side may contain points that are not yet added.
    waiting: Vec<usize>,
    /// For each point, the number of the round that adds it; empty if there is one round only.
    rounds: Vec<usize>,
}

impl<'a> Polytope<'a> {
    /// The hull of groups of points: it contains all points of the first group, and of each other group the
    /// points that lie farther outside than the distance `max_distance`.
    fn around(points: &'a [Point], groups: &[&[usize]], max_distance: f64) -> Vec<[usize; 3]> {
        let all = groups.concat();
        let Some(first) = simplex(points, groups[0]).or_else(|| simplex(points, &all)) else {
            return Vec::new();
        };
        let mut polytope = Self {
            points,
            faces: Vec::new(),
            waiting: Vec::new(),
            rounds: Vec::new(),
        };
        if groups.len() > 1 {
            polytope.rounds = vec![0; points.len()];
        }
        for (round, group) in groups.iter().enumerate().skip(1) {
            for point in *group {
                polytope.rounds[*point] = round;
            }
        }
        polytope.start(first, all);
        for round in 0..groups.len() {
            polytope.add_all(round, if round == 0 { 0.0 } else { max_distance });
        }
        let left = polytope.faces.iter().filter(|face| !face.is_gone);
        left.map(|face| face.corners).collect()
    }

    /// Adds the points of all rounds up to `round` that lie farther outside the polytope than the distance
    /// `max_distance`.
    fn add_all(&mut self, round: usize, max_distance: f64) {
        let is_left = |f: &usize| !self.faces[*f].is_gone;
        self.waiting = (0..self.faces.len()).filter(is_left).collect();
        while let Some(face) = self.waiting.pop() {
            poll();
            if max_distance > 0.0 {
                self.drop_points_near(face, max_distance);
            }
            let Some(point) = self.farthest(face, round) else {
                continue;
            };
            let (seen, rim) = self.seen(point, face);
            if max_distance > 0.0 && self.is_within(point, &seen, max_distance) {
                for face in seen {
                    self.faces[face].is_gone = false;
                }
                self.faces[face].before.retain(|p| *p != point);
                self.waiting.push(face);
            } else {
                self.add(point, seen, &rim);
            }
        }
    }

    /// Drops the points listed at a face that lie within the distance `max_distance` of it.
    fn drop_points_near(&mut self, face: usize, max_distance: f64) {
        let (triangle, points) = (self.triangle(face), self.points);
        let before = &mut self.faces[face].before;
        before.retain(|p| is_beyond(&points[*p], &triangle, max_distance));
    }

    /// Return whether a point lies within the distance `max_distance` of the faces that it sees.
    fn is_within(&self, point: usize, seen: &[usize], max_distance: f64) -> bool {
        let corners: Vec<Point> = seen.iter().flat_map(|f| self.triangle(*f)).collect();
        !is_beyond(&self.points[point], &corners, max_distance)
    }

    /// Starts with the tetrahedron of four points in general position, and lists all points at its faces.
    fn start(&mut self, [a, b, c, d]: [usize; 4], all: Vec<usize>) {
        let corners = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
        let beside = [[2, 3, 1], [0, 3, 2], [1, 3, 0], [2, 1, 0]];
        for (corners, beside) in corners.into_iter().zip(beside) {
            self.push(corners, beside);
        }
        self.distribute(all, 0);
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

    /// Lists each point at one face on whose outer side it lies: the first such face from number `from` on. A
    /// point on no outer side already lies in the polytope and is dropped.
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

    /// The point listed at a face, of the rounds up to `round`, that is farthest from the face in doubles;
    /// `None` if there is none. Rounding errors do no harm, because any listed point could be added next.
    fn farthest(&self, face: usize, round: usize) -> Option<usize> {
        if self.faces[face].is_gone {
            return None;
        }
        let [a, b, c] = self.triangle(face);
        let normal = normal(&[a, b, c]);
        let height = |p: usize| dot(&normal, &difference(&self.points[p], &a));
        let listed = self.faces[face].before.iter().copied();
        let due = listed.filter(|p| self.rounds.get(*p).is_none_or(|of| *of <= round));
        due.max_by(|p, q| {
            let lower = height(*p).total_cmp(&height(*q));
            lower.then_with(|| order(&self.points[*q], &self.points[*p]))
        })
    }

    /// Adds a point to the polytope: the faces that the point sees are replaced by new faces between the
    /// point and the border edges `rim` of the seen faces.
    fn add(&mut self, point: usize, seen: Vec<usize>, rim: &[Rim]) {
        let first = self.faces.len();
        // The rim is a cycle: each new face adjoins the one whose rim edge starts where its own ends, and the
        // one whose rim edge ends where its own starts.
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
        for (number, edge) in (first..).zip(rim) {
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

    /// Marks the faces that a point sees as removed, starting from one of them; returns these faces and the
    /// edges around them.
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

/// An edge on the border between the faces of a polytope that a point sees and the faces that it does not
/// see.
struct Rim {
    start: usize,
    end: usize,
    /// The face across the edge, which the point does not see; `slot` is the index of the edge in that face.
    behind: usize,
    slot: usize,
}

/// Four of the points in general position, the last on the inner side of the first three; `None` if all lie
/// in one plane.
fn simplex(points: &[Point], candidates: &[usize]) -> Option<[usize; 4]> {
    let all = || candidates.iter().copied();
    let a = all().min_by(|p, q| order(&points[*p], &points[*q]))?;
    let b = all().max_by(|p, q| order(&points[*p], &points[*q]))?;
    let (pa, pb) = (points[a], points[b]);
    let across = |p: &usize| {
        let normal = normal(&[pa, pb, points[*p]]);
        dot(&normal, &normal)
    };
    let wide = all().max_by(|p, q| across(p).total_cmp(&across(q)))?;
    let is_off = |p: &usize| !are_in_line(&[pa, pb, points[*p]]);
    let c = Some(wide).filter(is_off).or_else(|| all().find(is_off))?;
    let base = [pa, pb, points[c]];
    let normal = normal(&[pa, pb, points[c]]);
    let height = |p: &usize| dot(&normal, &difference(&points[*p], &pa)).abs();
    let high = all().max_by(|p, q| height(p).total_cmp(&height(q)))?;
    let is_out = |p: &usize| side(&base, &points[*p]) != Side::On;
    let d = Some(high).filter(is_out).or_else(|| all().find(is_out))?;
    Some(if side(&base, &points[d]) == Side::Minus {
        [a, b, c, d]
    } else {
        [a, c, b, d]
    })
}

/// Return whether three points lie on one line: in each projection along an axis they make no turn.
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
    use super::{hull, hull_of_inexact, side, Point, Side};
    use proptest::prelude::*;

    /// Points of a small grid, of which many share lines and planes.
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

        /// Points of a grid, each moved by no more than a radius; many points occur twice.
        #[test]
        fn what_rounding_moves_keeps_its_faces(
            points in grid_points(),
            moves in prop::collection::vec(prop::array::uniform3(-1i32..2), 40),
        ) {
            let moved: Vec<Point> = points.iter().zip(&moves).map(|(p, by)| {
                [0, 1, 2].map(|i| 1e6 * p[i] + f64::from(by[i]))
            }).collect();
            let faces = hull_of_inexact(&moved, 2.0);
            prop_assert_eq!(faces.len(), hull(&points).len());
            for face in &faces {
                let triangle = face.map(|p| moved[p]);
                let corners = faces.as_flattened().iter();
                prop_assert!(corners.clone().all(|p| side(&triangle, &moved[*p]) != Side::Plus));
            }
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
