//! Terrains in a mesh in doubles: smooth connected parts of the surface (pieces) that each line along an axis
//! meets in at most one triangle, such as the triangles between a hole and the border of a face, or the
//! needles (long thin triangles) of a cone.
//!
//! A piece is found by a heuristic and proved exactly: in the projection along the axis, all its triangles
//! turn the same way, and its outline winds at most once around each point. So its triangles can cross only
//! triangles of other pieces.
//!
//! # Source
//! De Berg, Cheong, van Kreveld, Overmars, *Computational Geometry*, third edition, section 9: a
//! polyhedral terrain is the graph of a function that is linear on triangles.

use rustc_hash::FxHashMap as HashMap;

use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::geometry::doubles::meeting::has_no_area;
use crate::geometry::doubles::vector::{cross, dot, normal};
use crate::geometry::doubles::{seen_along, turn, Facing, Point, Triangle};
use crate::geometry::winding::covering::{winds_at_most_once, PlanarPoint};
use crate::interrupt::poll;
use crate::mesh::faces::{edges, Faces};
use crate::mesh::handle::VertexId;
use crate::mesh::topology::NONE;

/// The least ratio of length to height of a needle (a long thin triangle). The boxes of other triangles
/// overlap only a small number of boxes, and comparing these triangles is faster than finding terrains.
const MIN_NEEDLE_RATIO: f64 = 16.0;

/// The largest number of needles (long thin triangles) that are compared pairwise, without a search for
/// terrains (sets of triangles proved not to overlap).
const MAX_NEEDLES_COMPARED: usize = 256;

/// The least number of triangles in a piece (a smooth connected part of the surface) for which a sweep pays.
const MIN_TRIANGLES_SWEPT: usize = 4;

/// The tangent of the largest angle between normals of adjoining triangles in one piece (smooth connected
/// part of the surface): more than on any round body, less than at an intended corner.
const MAX_FOLD_TANGENT: f64 = 0.5;

/// For each triangle in `subset`, the number of its terrain (a set of triangles proved not to overlap each
/// other), or `NONE`. Only needles (long thin triangles) belong to terrains.
///
/// # Cost
/// One test of each triangle, a sort of the needles, and a sweep over the outline of each piece.
pub fn terrains(faces: &Faces, subset: &[u32]) -> Vec<u32> {
    let is_thin = |t: &u32| is_needle(&faces.corners(*t));
    let needles: Vec<u32> = subset.iter().copied().filter(is_thin).collect();
    let mut terrains = vec![NONE; subset.len()];
    if needles.len() <= MAX_NEEDLES_COMPARED {
        return terrains;
    }
    let mut found = needles_terrains(faces, &needles)
        .into_iter()
        .zip(&needles)
        .peekable();
    for (terrain, t) in terrains.iter_mut().zip(subset) {
        if let Some((number, _)) = found.next_if(|(_, needle)| *needle == t) {
            *terrain = number;
        }
    }
    terrains
}

fn needles_terrains(faces: &Faces, needles: &[u32]) -> Vec<u32> {
    let mut search = Search::new(faces, needles);
    let mut numbers = Vec::new();
    for first in search.largest_first() {
        if search.pieces[first as usize] == NONE {
            let number = as_number(numbers.len());
            let projection = Projection::of(&search.corners(first));
            let piece = search.piece_around(first, projection, number);
            let is_terrain = piece.len() >= MIN_TRIANGLES_SWEPT && {
                let outline = search.outline(&piece, projection);
                winds_at_most_once(&outline)
            };
            numbers.push(if is_terrain { number } else { NONE });
        }
    }
    let proved = |piece: u32| numbers[piece as usize];
    search.pieces.into_iter().map(proved).collect()
}

/// Return whether a triangle is at least `MIN_NEEDLE_RATIO` times as long as high.
fn is_needle(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle;
    let square = |p: &Point, q: &Point| (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum();
    let longest = f64::max(f64::max(square(a, b), square(b, c)), square(c, a));
    let n = normal(triangle);
    longest * longest > MIN_NEEDLE_RATIO * MIN_NEEDLE_RATIO * dot(&n, &n)
}

/// The search for pieces (smooth connected parts of the surface) among needles (long thin triangles); each
/// needle is numbered by its index in `needles`.
struct Search<'a> {
    faces: &'a Faces<'a>,
    needles: &'a [u32],
    /// The needle (long thin triangle) of each directed edge.
    owners: HashMap<[VertexId; 2], u32>,
    /// The number of the piece (smooth connected part of the surface) to which each needle (long thin
    /// triangle) belongs, or
    /// `NONE`.
    pieces: Vec<u32>,
}

/// The axis along which a piece (smooth connected part of the surface) is projected, and the direction in
/// which its triangles turn in the projection.
#[derive(Clone, Copy)]
struct Projection {
    axis: usize,
    turn_sign: Sign,
}

impl Projection {
    /// The axis along which a triangle's projection is largest.
    fn of(triangle: &Triangle) -> Self {
        let axis = Facing::of(triangle).main_axis();
        let turn_sign = turn(seen_along(triangle, axis));
        Self { axis, turn_sign }
    }

    fn faces_viewer(self, triangle: &Triangle) -> bool {
        turn(seen_along(triangle, self.axis)) == self.turn_sign
    }
}

impl<'a> Search<'a> {
    fn new(faces: &'a Faces, needles: &'a [u32]) -> Self {
        let mut owners = HashMap::default();
        owners.reserve(3 * needles.len());
        for (at, t) in (0u32..).zip(needles) {
            let edges = edges(faces.triangles[*t as usize]);
            owners.extend(edges.map(|edge| (edge, at)));
        }
        Self {
            faces,
            needles,
            owners,
            pieces: vec![NONE; needles.len()],
        }
    }

    fn triangle(&self, at: u32) -> [VertexId; 3] {
        self.faces.triangles[self.needles[at as usize] as usize]
    }

    fn corners(&self, at: u32) -> Triangle {
        self.faces.corners(self.needles[at as usize])
    }

    /// The needles (long thin triangles) by area, largest first: rounding changes the normal of a large
    /// triangle least.
    fn largest_first(&self) -> Vec<u32> {
        let squares = (0..as_number(self.needles.len())).map(|at| {
            let n = normal(&self.corners(at));
            (dot(&n, &n), at)
        });
        let mut sorted: Vec<(f64, u32)> = squares.collect();
        sorted.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        sorted.into_iter().map(|(_, at)| at).collect()
    }

    /// Numbers and lists the needles in the piece (smooth connected part of the surface) around a first
    /// needle; needles without area may belong to any piece.
    fn piece_around(&mut self, first: u32, projection: Projection, number: u32) -> Vec<u32> {
        self.pieces[first as usize] = number;
        let mut piece = vec![first];
        let mut open = match projection.turn_sign {
            Sign::Zero => Vec::new(),
            _ => vec![(first, normal(&self.corners(first)))],
        };
        while let Some((at, bearing)) = open.pop() {
            poll();
            for neighbour in self.neighbours_of(at).into_iter().flatten() {
                if self.pieces[neighbour as usize] != NONE {
                    continue;
                }
                let corners = self.corners(neighbour);
                let own = normal(&corners);
                let next = if is_smooth(&bearing, &own) && projection.faces_viewer(&corners) {
                    own
                } else if has_no_area(&corners) {
                    bearing
                } else {
                    continue;
                };
                self.pieces[neighbour as usize] = number;
                piece.push(neighbour);
                open.push((neighbour, next));
            }
        }
        piece
    }

    fn neighbours_of(&self, at: u32) -> [Option<u32>; 3] {
        edges(self.triangle(at)).map(|[from, to]| self.owners.get(&[to, from]).copied())
    }

    /// The outline of a piece (smooth connected part of the surface) in the projection: the edges that only
    /// one needle (long thin triangle) has, directed so that all needles turn left.
    fn outline(&self, piece: &[u32], projection: Projection) -> Vec<[PlanarPoint; 2]> {
        let number = self.pieces[piece[0] as usize];
        let mut outline = Vec::new();
        for at in piece {
            let seen = seen_along(&self.corners(*at), projection.axis);
            for (i, neighbour) in self.neighbours_of(*at).into_iter().enumerate() {
                if neighbour.is_none_or(|m| self.pieces[m as usize] != number) {
                    let [from, to] = [seen[i], seen[(i + 1) % 3]];
                    let is_left = projection.turn_sign == Sign::Positive;
                    outline.push(if is_left { [from, to] } else { [to, from] });
                }
            }
        }
        outline
    }
}

/// Return whether the angle between two normals is small: its tangent is at most [`MAX_FOLD_TANGENT`].
fn is_smooth(a: &Point, b: &Point) -> bool {
    let (along, across) = (dot(a, b), cross(a, b));
    along > 0.0 && dot(&across, &across) <= MAX_FOLD_TANGENT * MAX_FOLD_TANGENT * along * along
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The top and bottom of a ring around a hole of `count` sides in a plate, lifted by a function of x and
    /// y.
    fn ring(count: u32, height: impl Fn(f64, f64) -> f64) -> (Vec<Point>, Vec<[VertexId; 3]>) {
        let mut vertices = Vec::new();
        for radius in [1.0, 3.0] {
            for k in 0..count {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                let (x, y) = (radius * angle.cos(), radius * angle.sin());
                vertices.push([x, y, height(x, y)]);
            }
        }
        let quads = (0..count).flat_map(|k| {
            let (p, q) = (k, (k + 1) % count);
            [[p, count + p, q], [q, count + p, count + q]]
        });
        (vertices, VertexId::rows(quads))
    }

    fn found(vertices: &[Point], triangles: &[[VertexId; 3]]) -> Vec<u32> {
        let all: Vec<u32> = (0..as_number(triangles.len())).collect();
        let faces = Faces {
            vertices,
            triangles,
        };
        terrains(&faces, &all)
    }

    #[test]
    fn a_ring_is_one_piece_and_its_back_another() {
        let (mut vertices, mut triangles) = ring(200, |x, y| 0.3 * x - 0.1 * y);
        assert!(found(&vertices, &triangles).iter().all(|piece| *piece == 0));
        vertices.extend_from_within(..);
        let back = triangles
            .iter()
            .map(|[a, b, c]| [*a, *c, *b].map(|v| VertexId(v.0 + 400)));
        triangles.extend(back.collect::<Vec<_>>());
        let pieces = found(&vertices, &triangles);
        assert!(pieces[..400].iter().all(|piece| *piece == pieces[0]));
        assert!(pieces[400..].iter().all(|piece| *piece == pieces[400]));
        assert!(pieces[0] != NONE && pieces[400] != NONE && pieces[0] != pieces[400]);
    }

    #[test]
    fn a_bent_ring_is_one_piece_and_a_broken_one_two() {
        let (vertices, triangles) = ring(400, |x, y| 0.1 * x * y);
        assert!(found(&vertices, &triangles).iter().all(|piece| *piece == 0));
        let (vertices, triangles) = ring(400, |x, _| x.abs());
        let pieces = found(&vertices, &triangles);
        let side = |t: usize| vertices[triangles[t][1].index()][0] > 0.0;
        let right = (0..800).find(|t| side(*t)).expect("a triangle");
        let left = (0..800).find(|t| !side(*t)).expect("a triangle");
        let of_side = |t: usize| pieces[if side(t) { right } else { left }];
        assert!(pieces[right] != pieces[left]);
        let others = (0..800).filter(|t| pieces[*t] != of_side(*t)).count();
        assert!(
            others <= 4,
            "{others} triangles are not on the side of their corner"
        );
    }

    #[test]
    fn what_overlaps_is_no_piece() {
        let (mut vertices, mut triangles) = ring(200, |_, _| 0.0);
        let shifted = vertices.iter().map(|[x, y, z]| [x + 4.0, *y, *z]);
        vertices.extend(shifted.collect::<Vec<_>>());
        let shifted = triangles.iter().map(|t| t.map(|v| VertexId(v.0 + 400)));
        triangles.extend(shifted.collect::<Vec<_>>());
        let apart = found(&vertices, &triangles);
        assert!(apart[0] != NONE && apart[400] != NONE && apart[0] != apart[400]);
        // A bridge from the outer border of one ring to the inner border of the other makes them one piece.
        triangles.extend(VertexId::rows([[201, 200, 400], [201, 400, 401]]));
        assert!(found(&vertices, &triangles)
            .iter()
            .all(|piece| *piece == NONE));
    }
}
