//! A constrained triangulation of a convex polygon: given points are its vertices, and given segments are
//! chains of its edges.
//!
//! Points are inserted one by one, border points first; the module `segments` inserts segments. Orientation
//! tests are exact. Circle tests only improve the shape of triangles, so doubles are precise enough.
//!
//! # Source
//! Lawson 1977 (insertion and flips).

mod segments;

use std::sync::Arc;

use smallvec::SmallVec;

use crate::arith::convert::{as_number, as_whole};
use crate::arith::{Filtered, Int, Sign};
use crate::geometry::doubles::turn;
use crate::geometry::plane::Plane;
use crate::geometry::vertex::{Homogeneous, Vertex};
use crate::interrupt::poll;

/// The error that a point or a segment leaves the polygon, that crossing segments have no common point, or
/// that a polygon is not convex: a defect of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Defect;

/// The number that stands for no triangle (outside the border), and for no side (inside the polygon).
pub const NONE: u32 = u32::MAX;

/// A triangle of the triangulation, counterclockwise. Edge i runs from corner i to the next one.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The numbers of the points at the corners.
    pub corners: [u32; 3],
    /// For each edge the number of the triangle across it, or `NONE`.
    pub neighbours: [u32; 3],
    /// For each edge one more than the index of the last segment recorded along it, or 0 without a segment. A
    /// negative sign says that the directions of segments are given as seen from the triangle across the
    /// edge.
    marks: [i32; 3],
}

/// A segment that runs along an edge of the triangulation.
#[derive(Clone, Copy, Debug)]
struct EdgeSegment {
    segment: u32,
    /// True if the segment has the direction of the edge as seen from the triangle with the positive mark.
    is_forward: bool,
    /// The mark of the edge before this segment was recorded: one more than the index of the previous
    /// segment, or 0.
    before: i32,
}

/// A point of the triangulation, with its projection along an axis in doubles.
#[derive(Clone, Debug)]
struct ProjectedPoint {
    at: [f64; 2],
    /// A bound on the error of each projected coordinate.
    error: f64,
    /// The numbers of the polygon's sides on which the point lies, or `NONE`.
    sides: [u32; 2],
    vertex: Arc<Vertex>,
    exact: Option<Box<Homogeneous>>,
}

/// A triangulated convex polygon.
#[derive(Debug)]
pub struct Triangulation {
    axes: [usize; 2],
    points: Vec<ProjectedPoint>,
    /// For each point the number of a triangle that has it as a corner.
    incident: Vec<u32>,
    cells: Vec<Cell>,
    edge_segments: Vec<EdgeSegment>,
    last: u32,
    random: u32,
}

impl Triangulation {
    /// Triangulates a polygon as a fan; its corners are strictly convex, and counterclockwise in the
    /// projection on the two axes.
    pub fn new(corners: impl ExactSizeIterator<Item = Arc<Vertex>>, axes: [usize; 2]) -> Self {
        let count = as_number(corners.len());
        let mut made = Self {
            axes,
            points: Vec::with_capacity(corners.len() + 5),
            incident: Vec::with_capacity(corners.len() + 5),
            cells: Vec::with_capacity(corners.len() + 5),
            edge_segments: Vec::new(),
            last: 0,
            random: 1,
        };
        for (side, vertex) in (0..).zip(corners) {
            let before = if side == 0 { count - 1 } else { side - 1 };
            made.add(vertex, [side, before]);
        }
        for k in 2..count {
            let before = if k == 2 { NONE } else { k - 3 };
            let after = if k + 1 == count { NONE } else { k - 1 };
            let cell = Cell {
                corners: [0, k - 1, k],
                neighbours: [before, NONE, after],
                marks: [0; 3],
            };
            made.put(k - 2, cell);
        }
        made
    }

    /// Returns the triangles.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Returns the exact position of the point with this number.
    pub fn vertex(&self, point: u32) -> &Arc<Vertex> {
        &self.points[point as usize].vertex
    }

    /// Returns the number of a side of the polygon on which two border points lie.
    pub fn side(&self, ends: [u32; 2]) -> u32 {
        let [a, b] = ends.map(|p| self.points[p as usize].sides);
        if b.contains(&a[0]) {
            a[0]
        } else {
            a[1]
        }
    }

    /// Returns the numbers of the points at the ends of an edge of a triangle.
    pub fn ends(&self, (cell, edge): (u32, usize)) -> (u32, u32) {
        let corners = self.cells[cell as usize].corners;
        (corners[edge], corners[(edge + 1) % 3])
    }

    /// Returns the triangle across an edge, or `NONE`, and the index of the same edge in it.
    pub fn across(&self, (cell, edge): (u32, usize)) -> (u32, usize) {
        let neighbour = self.cells[cell as usize].neighbours[edge];
        let back = if neighbour == NONE {
            0
        } else {
            self.edge_to(neighbour, cell)
        };
        (neighbour, back)
    }

    /// Returns about twice the area of the projection of a triangle.
    pub fn size(&self, cell: u32) -> f64 {
        let [a, b, c] = self.cells[cell as usize]
            .corners
            .map(|i| &self.points[i as usize]);
        let ([ux, uy], [vx, vy]) = (a.to(b), a.to(c));
        ux * vy - uy * vx
    }

    /// Returns the weighted mean of a triangle's projected corners, in half lattice steps rounded to
    /// integers, in the cyclic order of the axes.
    pub fn mean(&self, cell: u32, weights: [f64; 3]) -> [i64; 2] {
        let corners = self.cells[cell as usize].corners;
        let at = |i: usize| {
            let terms = (0..3).map(|k| weights[k] * self.points[corners[k] as usize].at[i]);
            terms.sum::<f64>() / weights.iter().sum::<f64>()
        };
        let [u, v] = [0, 1].map(|i| as_whole((2.0 * at(i)).round()));
        if (self.axes[0] + 1) % 3 == self.axes[1] {
            [u, v]
        } else {
            [v, u]
        }
    }

    /// Returns true if a point lies strictly inside a triangle.
    pub fn contains(&mut self, cell: u32, vertex: Arc<Vertex>) -> bool {
        let [a, b, c] = self.cells[cell as usize].corners;
        let point = self.add(vertex, [NONE; 2]);
        let is_left = |(p, q)| self.turn([p, q, point]) == Sign::Positive;
        let is_inside = [(a, b), (b, c), (c, a)].into_iter().all(is_left);
        self.points.pop();
        self.incident.pop();
        is_inside
    }

    /// Returns the number of a triangle that has the point with this number as a corner.
    pub fn cell_at(&self, point: u32) -> u32 {
        self.incident[point as usize]
    }

    fn add(&mut self, vertex: Arc<Vertex>, sides: [u32; 2]) -> u32 {
        self.points
            .push(ProjectedPoint::of(vertex, sides, self.axes));
        self.incident.push(NONE);
        as_number(self.points.len() - 1)
    }

    fn put(&mut self, number: u32, cell: Cell) {
        for corner in cell.corners {
            self.incident[corner as usize] = number;
        }
        if number as usize == self.cells.len() {
            self.cells.push(cell);
        } else {
            self.cells[number as usize] = cell;
        }
    }

    /// Replaces the neighbour `from` of a triangle by `to`.
    fn relink(&mut self, neighbour: u32, from: u32, to: u32) {
        if neighbour != NONE {
            let neighbours = &mut self.cells[neighbour as usize].neighbours;
            if let Some(neighbour) = neighbours.iter_mut().find(|m| **m == from) {
                *neighbour = to;
            }
        }
    }

    /// Returns the index of the edge of a triangle across which the triangle `neighbour` lies.
    fn edge_to(&self, cell: u32, neighbour: u32) -> usize {
        let neighbours = &self.cells[cell as usize].neighbours;
        neighbours.iter().position(|m| *m == neighbour).unwrap_or(0)
    }

    /// Returns the exact sign of the turn along three projected points, positive to the left.
    pub fn turn(&mut self, points: [u32; 3]) -> Sign {
        match self.near_turn(points) {
            Filtered::Certain(sign) => sign,
            Filtered::Doubtful => self.exact_turn(points),
        }
    }

    /// Returns the exact sign of the turn along three points, positive to the left, if the first two lie in
    /// the plane `cut` whose minus side is on the left; cheaper than `Self::turn` for constructed points.
    fn turn_beside(&self, cut: &Plane, points: [u32; 3]) -> Sign {
        match self.near_turn(points) {
            Filtered::Certain(sign) => sign,
            Filtered::Doubtful => -self.vertex(points[2]).side_of(cut).sign(),
        }
    }

    /// Returns the sign of the turn along three points, positive to the left, if doubles or a common side of
    /// the polygon decide it.
    fn near_turn(&self, points: [u32; 3]) -> Filtered<Sign> {
        let [p, q, r] = points.map(|i| &self.points[i as usize]);
        let ([ux, uy], [vx, vy]) = (p.to(q), p.to(r));
        let (left, right) = (ux * vy, uy * vx);
        let (value, off) = (left - right, p.error + q.error + r.error);
        let span = ux.abs() + uy.abs() + vx.abs() + vy.abs();
        let rounding = 4.0 * f64::EPSILON * (left.abs() + right.abs());
        if value.abs() > rounding + 2.0 * off * (span + 4.0 * off) {
            return Filtered::Certain(Sign::of(value));
        }
        let is_common = |side: &u32| q.sides.contains(side) && r.sides.contains(side);
        if p.sides[0] != NONE && p.sides.iter().any(is_common) {
            return Filtered::Certain(Sign::Zero);
        }
        if off == 0.0 {
            return Filtered::Certain(turn([p.at, q.at, r.at]));
        }
        Filtered::Doubtful
    }

    #[cold]
    fn exact_turn(&mut self, points: [u32; 3]) -> Sign {
        for point in points {
            let projected = &mut self.points[point as usize];
            let vertex = &projected.vertex;
            projected
                .exact
                .get_or_insert_with(|| Box::new(vertex.coordinates()));
        }
        let at = |i: usize| self.points[points[i] as usize].exact.as_deref();
        match (at(0), at(1), at(2)) {
            (Some(p), Some(q), Some(r)) => turn_of([p, q, r], self.axes),
            _ => Sign::Zero,
        }
    }

    /// Returns the triangles at a point, each with the index of the point among its corners.
    fn fan(&self, point: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let corner_of =
            move |cell: &Cell| cell.corners.iter().position(|c| *c == point).unwrap_or(0);
        let first = self.incident[point as usize];
        let (mut at, mut is_back) = (first, false);
        std::iter::from_fn(move || {
            if at == NONE && !is_back {
                is_back = true;
                let cell = self.cells.get(first as usize)?;
                at = cell.neighbours[corner_of(cell)];
            }
            let here = at;
            let cell = self.cells.get(here as usize)?;
            let k = corner_of(cell);
            at = cell.neighbours[if is_back { k } else { (k + 2) % 3 }];
            if at == first {
                (at, is_back) = (NONE, true);
            }
            Some((here, k))
        })
    }

    /// Returns the triangle that has an edge from one point to another, and the index of this edge; `None` if
    /// there is none.
    fn edge_between(&self, from: u32, to: u32) -> Option<(u32, usize)> {
        let leads =
            |(cell, k): &(u32, usize)| self.cells[*cell as usize].corners[(k + 1) % 3] == to;
        self.fan(from).find(leads)
    }

    /// Returns the edge between two points, as seen from the triangles on its left and on its right, or on
    /// one side at the border; `None` if no edge connects the points.
    fn edges_between(&self, from: u32, to: u32) -> Option<[Option<(u32, usize)>; 2]> {
        let across = |at| Some(self.across(at)).filter(|(neighbour, _)| *neighbour != NONE);
        if let Some(at) = self.edge_between(from, to) {
            return Some([Some(at), across(at)]);
        }
        let back = self.edge_between(to, from)?;
        Some([None, Some(back)])
    }

    /// Adds a border point between two consecutive border points, and returns its number.
    pub fn divide_border(&mut self, ends: [u32; 2], vertex: Arc<Vertex>) -> u32 {
        let side = self.side(ends);
        let point = self.add(vertex, [side; 2]);
        if let Some((cell, edge)) = self.edge_between(ends[0], ends[1]) {
            let changed = self.split_edge(cell, edge, point);
            self.legalize(point, changed);
        }
        point
    }

    /// Adds a point of the polygon, and returns its number, or the number of an equal point that is already a
    /// vertex.
    ///
    /// # Errors
    /// If the point lies outside the polygon.
    pub fn insert(&mut self, vertex: Arc<Vertex>) -> Result<u32, Defect> {
        let point = self.add(vertex, [NONE; 2]);
        let (cell, on) = self.locate(point)?;
        self.last = cell;
        let Cell {
            corners,
            neighbours,
            ..
        } = self.cells[cell as usize];
        let changed = match on[..] {
            [] => self.split_cell(cell, point),
            [edge] => {
                if neighbours[edge] == NONE {
                    let side = self.side([corners[edge], corners[(edge + 1) % 3]]);
                    self.points[point as usize].sides = [side; 2];
                }
                self.split_edge(cell, edge, point)
            }
            _ => {
                self.points.pop();
                self.incident.pop();
                let is_end = |i: &usize| on.contains(i) && on.contains(&((i + 2) % 3));
                return Ok(corners[(0..3).find(is_end).unwrap_or(0)]);
            }
        };
        self.legalize(point, changed);
        Ok(point)
    }

    /// Returns a triangle that contains a point, and the indices of its edges on which the point lies.
    ///
    /// The walk from triangle to triangle tests edges in pseudo-random order: with a fixed order it might not
    /// end.
    fn locate(&mut self, point: u32) -> Result<(u32, SmallVec<[usize; 3]>), Defect> {
        let mut at = self.last;
        'walk: loop {
            poll();
            self.random = self
                .random
                .wrapping_mul(1_664_525)
                .wrapping_add(1_013_904_223);
            let first = (self.random >> 16) as usize % 3;
            let cell = self.cells[at as usize];
            let mut on: SmallVec<[usize; 3]> = SmallVec::new();
            for i in [first, (first + 1) % 3, (first + 2) % 3] {
                let [a, b] = [cell.corners[i], cell.corners[(i + 1) % 3]];
                match self.turn([a, b, point]) {
                    Sign::Positive => {}
                    Sign::Negative if cell.neighbours[i] == NONE => return Err(Defect),
                    Sign::Negative => {
                        at = cell.neighbours[i];
                        continue 'walk;
                    }
                    Sign::Zero => on.push(i),
                }
            }
            return Ok((at, on));
        }
    }

    /// Divides a triangle at an inner point, and returns the triangles at this point.
    fn split_cell(&mut self, number: u32, m: u32) -> SmallVec<[u32; 4]> {
        let Cell {
            corners: [a, b, c],
            neighbours,
            marks,
        } = self.cells[number as usize];
        let (second, third) = (as_number(self.cells.len()), as_number(self.cells.len() + 1));
        let cell = |corners, neighbours, mark| Cell {
            corners,
            neighbours,
            marks: [mark, 0, 0],
        };
        self.put(
            number,
            cell([a, b, m], [neighbours[0], second, third], marks[0]),
        );
        self.put(
            second,
            cell([b, c, m], [neighbours[1], third, number], marks[1]),
        );
        self.put(
            third,
            cell([c, a, m], [neighbours[2], number, second], marks[2]),
        );
        self.relink(neighbours[1], number, second);
        self.relink(neighbours[2], number, third);
        SmallVec::from_slice(&[number, second, third])
    }

    /// Divides an edge, and the triangles on both sides, at a point; returns the triangles at this point.
    fn split_edge(&mut self, number: u32, edge: usize, m: u32) -> SmallVec<[u32; 4]> {
        let across = self.cells[number as usize].neighbours[edge];
        let second = as_number(self.cells.len());
        let fourth = if across == NONE { NONE } else { second + 1 };
        let back = if across == NONE {
            0
        } else {
            self.edge_to(across, number)
        };
        self.split_side(number, edge, m, [second, fourth, across]);
        let mut changed = SmallVec::from_slice(&[number, second]);
        if across != NONE {
            // Seen from the triangle across, the halves of the edge come in the opposite order.
            self.split_side(across, back, m, [fourth, second, number]);
            changed.extend([across, fourth]);
        }
        changed
    }

    /// Divides the triangle on one side of an edge at a point m of the edge: `second` is the number of the
    /// new triangle, and `first_mate` and `second_mate` are the triangles across the two halves of the edge.
    fn split_side(
        &mut self,
        number: u32,
        edge: usize,
        m: u32,
        [second, first_mate, second_mate]: [u32; 3],
    ) {
        let old = self.cells[number as usize];
        let (next, last) = ((edge + 1) % 3, (edge + 2) % 3);
        let [a, b, apex] = [edge, next, last].map(|i| old.corners[i]);
        self.put(
            number,
            Cell {
                corners: [a, m, apex],
                neighbours: [first_mate, second, old.neighbours[last]],
                marks: [old.marks[edge], 0, old.marks[last]],
            },
        );
        self.put(
            second,
            Cell {
                corners: [m, b, apex],
                neighbours: [second_mate, old.neighbours[next], number],
                marks: [old.marks[edge], old.marks[next], 0],
            },
        );
        self.relink(old.neighbours[next], number, second);
    }

    /// Replaces an edge by the other diagonal of the quadrilateral of its two triangles.
    fn flip(&mut self, number: u32, edge: usize) {
        let t = self.cells[number as usize];
        let across = t.neighbours[edge];
        let u = self.cells[across as usize];
        let back = self.edge_to(across, number);
        let [[t1, t2], [u1, u2]] = [edge, back].map(|i| [(i + 1) % 3, (i + 2) % 3]);
        let (a, b, apex, other) = (t.corners[edge], t.corners[t1], t.corners[t2], u.corners[u2]);
        self.put(
            number,
            Cell {
                corners: [apex, a, other],
                neighbours: [t.neighbours[t2], u.neighbours[u1], across],
                marks: [t.marks[t2], u.marks[u1], 0],
            },
        );
        self.put(
            across,
            Cell {
                corners: [other, b, apex],
                neighbours: [u.neighbours[u2], t.neighbours[t1], number],
                marks: [u.marks[u2], t.marks[t1], 0],
            },
        );
        self.relink(u.neighbours[u1], across, number);
        self.relink(t.neighbours[t1], number, across);
    }

    /// Flips edges opposite to a new point until the triangles at the point are locally Delaunay.
    fn legalize(&mut self, point: u32, mut open: SmallVec<[u32; 4]>) {
        while let Some(number) = open.pop() {
            poll();
            let cell = self.cells[number as usize];
            let Some(k) = cell.corners.iter().position(|c| *c == point) else {
                continue;
            };
            let edge = (k + 1) % 3;
            let across = cell.neighbours[edge];
            let is_free = across != NONE && cell.marks[edge] == 0;
            if is_free && self.should_flip(number, edge) {
                self.flip(number, edge);
                open.extend([number, across]);
            }
        }
    }

    fn should_flip(&mut self, number: u32, edge: usize) -> bool {
        let [a, b, apex, other] = self.around(number, edge);
        self.is_in_circle([a, b, apex], other) && self.is_convex([a, b, apex, other])
    }

    /// Returns the points at the ends of an edge, and the corners opposite to it in the triangles on both
    /// sides.
    fn around(&self, number: u32, edge: usize) -> [u32; 4] {
        let t = &self.cells[number as usize];
        let across = t.neighbours[edge];
        let back = self.edge_to(across, number);
        let other = self.cells[across as usize].corners[(back + 2) % 3];
        let corner = |i: usize| t.corners[(edge + i) % 3];
        [corner(0), corner(1), corner(2), other]
    }

    /// Returns true if the two triangles at an edge form a strictly convex quadrilateral.
    fn is_convex(&mut self, [a, b, apex, other]: [u32; 4]) -> bool {
        self.turn([apex, a, other]) == Sign::Positive
            && self.turn([other, b, apex]) == Sign::Positive
    }

    /// Returns true if a point lies clearly inside the circle through three other points; computed in
    /// doubles.
    fn is_in_circle(&self, corners: [u32; 3], point: u32) -> bool {
        /// The relative margin from which a point is clearly inside: four points of a grid often lie on one
        /// circle, and rounding must not decide.
        const CLEAR: f64 = 1e-9;
        let at = |i: u32| self.points[i as usize].at;
        let origin = at(point);
        let [p, q, r] = corners.map(|i| {
            let (x, y) = (at(i)[0] - origin[0], at(i)[1] - origin[1]);
            [x, y, x * x + y * y]
        });
        let minor = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let terms = [p[2] * minor(q, r), q[2] * minor(r, p), r[2] * minor(p, q)];
        let size: f64 = terms.iter().map(|t| t.abs()).sum();
        terms.iter().sum::<f64>() > CLEAR * size
    }
}

impl ProjectedPoint {
    fn of(vertex: Arc<Vertex>, sides: [u32; 2], axes: [usize; 2]) -> Self {
        let near = vertex.approx();
        let at = axes.map(|i| near[i]);
        let error = match vertex.as_lattice() {
            Some(_) => 0.0,
            None => 4.0 * f64::EPSILON * at[0].abs().max(at[1].abs()),
        };
        Self {
            at,
            error,
            sides,
            vertex,
            exact: None,
        }
    }

    fn to(&self, other: &Self) -> [f64; 2] {
        [other.at[0] - self.at[0], other.at[1] - self.at[1]]
    }
}

/// Returns the exact sign of the turn along three points, projected on two axes.
///
/// # Bits
/// At most 604 for three points on edges, 1086 for any points (`arith::bounds`).
fn turn_of([a, b, c]: [&Homogeneous; 3], [u, v]: [usize; 2]) -> Sign {
    let minor = |p: &Homogeneous, q: &Homogeneous| -> Int<12> {
        let product = |i: usize, j: usize| -> Int<12> { p.x[i].mul(&q.x[j]) };
        product(u, v) - product(v, u)
    };
    let term = |p, q, r: &Homogeneous| -> Int<18> { minor(p, q).mul(&r.w) };
    (term(a, b, c) + term(b, c, a) + term(c, a, b)).sign()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn vertex([x, y]: [i64; 2]) -> Arc<Vertex> {
        Arc::new(Vertex::lattice([x, y, 0]))
    }

    pub(super) fn face() -> Triangulation {
        Triangulation::new([[0, 0], [64, 0], [0, 64]].map(vertex).into_iter(), [0, 1])
    }

    pub(super) fn at(cells: &Triangulation, point: u32) -> [f64; 2] {
        cells.points[point as usize].at
    }

    /// Returns twice the area of all triangles; asserts that each is counterclockwise and agrees with its
    /// neighbours.
    pub(super) fn area(cells: &Triangulation) -> f64 {
        let mut sum = 0.0;
        for (number, cell) in (0..).zip(cells.cells()) {
            assert!(cells.size(number) > 0.0);
            sum += cells.size(number);
            for i in (0..3).filter(|i| cell.neighbours[*i] != NONE) {
                let (neighbour, back) = cells.across((number, i));
                let (from, to) = cells.ends((number, i));
                assert_eq!(cells.ends((neighbour, back)), (to, from));
                assert_eq!(
                    cells.cells()[neighbour as usize].marks[back],
                    -cell.marks[i]
                );
            }
        }
        sum
    }

    #[test]
    fn points_are_in_the_triangulation_once() {
        let mut cells = face();
        let rim = cells.divide_border([0, 1], vertex([20, 0]));
        cells.divide_border([rim, 1], vertex([30, 0]));
        let inner = |k: i64| vertex([1 + k * 13 % 31, 1 + k * 7 % 29]);
        let points: Vec<u32> = (0..40)
            .map(|k| cells.insert(inner(k)).expect("inside"))
            .collect();
        let again: Vec<u32> = (0..40)
            .map(|k| cells.insert(inner(k)).expect("inside"))
            .collect();
        assert_eq!(points, again);
        assert_eq!(cells.insert(vertex([20, 0])), Ok(rim));
        assert_eq!(cells.insert(vertex([64, 0])), Ok(1));
        let on_border = cells.insert(vertex([32, 32])).expect("on the border");
        assert_eq!(cells.side([on_border, 2]), 1);
        assert_eq!(cells.insert(vertex([40, 40])), Err(Defect));
        assert!((area(&cells) - 4096.0).abs() < 1e-9);
    }
}
