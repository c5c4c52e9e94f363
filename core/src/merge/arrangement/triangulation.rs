//! A triangulation of one face in which given segments are edges.
//!
//! Points are inserted one by one, those of the face's border first; then each segment becomes an edge by
//! flips of the edges that it crosses. Decisions about orientation are exact; circles only choose among
//! triangulations and are looked at in doubles.
//!
//! # Source
//! Lawson 1977 (insertion and flips); Sloan 1993 (segments).

use std::sync::Arc;

use smallvec::SmallVec;

use crate::arith::convert::as_number;
use crate::arith::{Int, Sign};
use crate::geometry::doubles::turn;
use crate::geometry::vertex::{Homogeneous, Vertex};
use crate::interrupt::poll;

/// No triangle: the border of the face.
pub(super) const NONE: u32 = u32::MAX;

/// Something that general position excludes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Special;

/// A triangle by the places of its corners, counterclockwise. Edge `i` runs from corner `i` to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// The corners.
    pub(super) corners: [u32; 3],
    /// The triangles across the edges.
    pub(super) mates: [u32; 3],
    /// For each edge the segment that it is part of, by its number and one more; negative if the
    /// segment runs the other way, 0 if there is none.
    pub(super) marks: [i32; 3],
}

/// A point of the face as seen along an axis.
#[derive(Clone, Debug)]
struct Place {
    at: [f64; 2],
    /// By how much each coordinate may be off.
    error: f64,
    /// The bits of the face's edges on which the point lies.
    rims: u8,
    vertex: Arc<Vertex>,
    exact: Option<Box<Homogeneous>>,
}

/// A triangulated face.
#[derive(Debug)]
pub(super) struct Triangulation {
    axes: [usize; 2],
    places: Vec<Place>,
    /// A triangle at each point.
    incident: Vec<u32>,
    cells: Vec<Cell>,
    last: u32,
    random: u32,
}

impl Triangulation {
    /// The face alone; seen along two axes it must turn left.
    pub(super) fn new(corners: [Arc<Vertex>; 3], axes: [usize; 2]) -> Self {
        let mut made = Self {
            axes,
            places: Vec::with_capacity(8),
            incident: vec![0; 3],
            cells: Vec::with_capacity(8),
            last: 0,
            random: 1,
        };
        for (vertex, rims) in corners.into_iter().zip([0b101, 0b011, 0b110]) {
            made.places.push(Place::of(vertex, rims, axes));
        }
        made.cells.push(Cell {
            corners: [0, 1, 2],
            mates: [NONE; 3],
            marks: [0; 3],
        });
        made
    }

    /// The triangles.
    pub(super) fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// A point.
    pub(super) fn vertex(&self, place: u32) -> &Arc<Vertex> {
        &self.places[place as usize].vertex
    }

    /// The number of points.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// The edge of the face on which two points of its border lie.
    pub(super) fn rim(&self, ends: [u32; 2]) -> usize {
        let [a, b] = ends.map(|p| self.places[p as usize].rims);
        (a & b).trailing_zeros() as usize
    }

    /// A triangle at a point.
    pub(super) fn cell_at(&self, place: u32) -> u32 {
        self.incident[place as usize]
    }

    fn add(&mut self, vertex: Arc<Vertex>, rims: u8) -> u32 {
        self.places.push(Place::of(vertex, rims, self.axes));
        self.incident.push(NONE);
        as_number(self.places.len() - 1)
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

    /// Makes a triangle's neighbour point to another triangle.
    fn relink(&mut self, neighbour: u32, from: u32, to: u32) {
        if neighbour != NONE {
            let mates = &mut self.cells[neighbour as usize].mates;
            if let Some(mate) = mates.iter_mut().find(|m| **m == from) {
                *mate = to;
            }
        }
    }

    /// The edge of a triangle across which another one lies.
    fn edge_to(&self, cell: u32, mate: u32) -> usize {
        let mates = &self.cells[cell as usize].mates;
        mates.iter().position(|m| *m == mate).unwrap_or(0)
    }

    /// Sign of the turn at three points, positive to the left; exact.
    fn turn(&mut self, [a, b, c]: [u32; 3]) -> Sign {
        let [p, q, r] = [a, b, c].map(|i| &self.places[i as usize]);
        if p.rims & q.rims & r.rims != 0 {
            return Sign::Zero;
        }
        let ([ux, uy], [vx, vy]) = (p.to(q), p.to(r));
        let (left, right) = (ux * vy, uy * vx);
        let (value, off) = (left - right, p.error + q.error + r.error);
        let span = ux.abs() + uy.abs() + vx.abs() + vy.abs();
        let rounding = 4.0 * f64::EPSILON * (left.abs() + right.abs());
        if value.abs() > rounding + 2.0 * off * (span + 4.0 * off) {
            return Sign::of(value);
        }
        if off == 0.0 {
            return turn([p.at, q.at, r.at]);
        }
        self.exact_turn([a, b, c])
    }

    #[cold]
    fn exact_turn(&mut self, points: [u32; 3]) -> Sign {
        for point in points {
            let place = &mut self.places[point as usize];
            let vertex = &place.vertex;
            place
                .exact
                .get_or_insert_with(|| Box::new(vertex.coordinates()));
        }
        let at = |i: usize| self.places[points[i] as usize].exact.as_deref();
        match (at(0), at(1), at(2)) {
            (Some(p), Some(q), Some(r)) => turn_of([p, q, r], self.axes),
            _ => Sign::Zero,
        }
    }

    /// The triangles at a point, each with the place of the point among its corners.
    fn fan(&self, point: u32) -> SmallVec<[(u32, usize); 8]> {
        let first = self.incident[point as usize];
        let mut fan = SmallVec::new();
        for back in [false, true] {
            let mut at = first;
            while at != NONE {
                let cell = &self.cells[at as usize];
                let k = cell.corners.iter().position(|c| *c == point).unwrap_or(0);
                if !(back && at == first) {
                    fan.push((at, k));
                }
                at = cell.mates[if back { k } else { (k + 2) % 3 }];
                if at == first {
                    return fan;
                }
            }
        }
        fan
    }

    /// The edge from one point to another, as a triangle's.
    fn edge_between(&self, from: u32, to: u32) -> Option<(u32, usize)> {
        let leads =
            |(cell, k): &(u32, usize)| self.cells[*cell as usize].corners[(k + 1) % 3] == to;
        self.fan(from).into_iter().find(leads)
    }

    /// Divides the border between two points of it that follow each other; returns the new point.
    pub(super) fn divide_border(&mut self, ends: [u32; 2], vertex: Arc<Vertex>) -> u32 {
        let rims = 1 << self.rim(ends);
        let point = self.add(vertex, rims);
        if let Some((cell, edge)) = self.edge_between(ends[0], ends[1]) {
            let changed = self.split_edge(cell, edge, point);
            self.legalize(point, changed);
        }
        point
    }

    /// Adds a point inside the face.
    ///
    /// # Errors
    /// `Special` if it is one of the points that are there, or lies on the border.
    pub(super) fn insert(&mut self, vertex: Arc<Vertex>) -> Result<u32, Special> {
        let point = self.add(vertex, 0);
        let (cell, on) = self.locate(point)?;
        let changed = match on {
            None => self.split_cell(cell, point),
            Some(edge) => self.split_edge(cell, edge, point),
        };
        self.legalize(point, changed);
        self.last = cell;
        Ok(point)
    }

    /// The triangle that holds a point, and the edge on which it lies.
    ///
    /// A walk may go in circles if it tries edges in the same order each time.
    fn locate(&mut self, point: u32) -> Result<(u32, Option<usize>), Special> {
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
                    Sign::Negative if cell.mates[i] == NONE => return Err(Special),
                    Sign::Negative => {
                        at = cell.mates[i];
                        continue 'walk;
                    }
                    Sign::Zero => on.push(i),
                }
            }
            return match on[..] {
                [] => Ok((at, None)),
                [edge] if cell.mates[edge] != NONE => Ok((at, Some(edge))),
                _ => Err(Special),
            };
        }
    }

    /// Divides a triangle at a point inside it; returns the triangles there.
    fn split_cell(&mut self, number: u32, m: u32) -> SmallVec<[u32; 4]> {
        let Cell {
            corners: [a, b, c],
            mates,
            ..
        } = self.cells[number as usize];
        let (second, third) = (as_number(self.cells.len()), as_number(self.cells.len() + 1));
        let cell = |corners, mates| Cell {
            corners,
            mates,
            marks: [0; 3],
        };
        self.put(number, cell([a, b, m], [mates[0], second, third]));
        self.put(second, cell([b, c, m], [mates[1], third, number]));
        self.put(third, cell([c, a, m], [mates[2], number, second]));
        self.relink(mates[1], number, second);
        self.relink(mates[2], number, third);
        SmallVec::from_slice(&[number, second, third])
    }

    /// Divides an edge that no segment runs along; returns the triangles there.
    fn split_edge(&mut self, number: u32, edge: usize, m: u32) -> SmallVec<[u32; 4]> {
        let across = self.cells[number as usize].mates[edge];
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
            // Seen from across, the halves of the edge come in the other order.
            self.split_side(across, back, m, [fourth, second, number]);
            changed.extend([across, fourth]);
        }
        changed
    }

    /// Divides one side of an edge at a point: `second` is the new triangle, `first_mate` and
    /// `second_mate` those across the halves of the edge.
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
                mates: [first_mate, second, old.mates[last]],
                marks: [0, 0, old.marks[last]],
            },
        );
        self.put(
            second,
            Cell {
                corners: [m, b, apex],
                mates: [second_mate, old.mates[next], number],
                marks: [0, old.marks[next], 0],
            },
        );
        self.relink(old.mates[next], number, second);
    }

    /// Replaces an edge by the other diagonal of the two triangles at it.
    fn flip(&mut self, number: u32, edge: usize) {
        let t = self.cells[number as usize];
        let across = t.mates[edge];
        let u = self.cells[across as usize];
        let back = self.edge_to(across, number);
        let [[t1, t2], [u1, u2]] = [edge, back].map(|i| [(i + 1) % 3, (i + 2) % 3]);
        let (a, b, apex, other) = (t.corners[edge], t.corners[t1], t.corners[t2], u.corners[u2]);
        self.put(
            number,
            Cell {
                corners: [apex, a, other],
                mates: [t.mates[t2], u.mates[u1], across],
                marks: [t.marks[t2], u.marks[u1], 0],
            },
        );
        self.put(
            across,
            Cell {
                corners: [other, b, apex],
                mates: [u.mates[u2], t.mates[t1], number],
                marks: [u.marks[u2], t.marks[t1], 0],
            },
        );
        self.relink(u.mates[u1], across, number);
        self.relink(t.mates[t1], number, across);
    }

    /// Flips edges opposite to a new point until no circle around a triangle there holds another point.
    fn legalize(&mut self, point: u32, mut open: SmallVec<[u32; 4]>) {
        while let Some(number) = open.pop() {
            poll();
            let cell = self.cells[number as usize];
            let Some(k) = cell.corners.iter().position(|c| *c == point) else {
                continue;
            };
            let edge = (k + 1) % 3;
            let across = cell.mates[edge];
            if across != NONE && self.should_flip(number, edge) {
                self.flip(number, edge);
                open.extend([number, across]);
            }
        }
    }

    fn should_flip(&mut self, number: u32, edge: usize) -> bool {
        let [a, b, apex, other] = self.around(number, edge);
        self.is_in_circle([a, b, apex], other) && self.is_convex([a, b, apex, other])
    }

    /// The ends of an edge, the corner opposite to it, and the one across.
    fn around(&self, number: u32, edge: usize) -> [u32; 4] {
        let t = &self.cells[number as usize];
        let across = t.mates[edge];
        let back = self.edge_to(across, number);
        let other = self.cells[across as usize].corners[(back + 2) % 3];
        let corner = |i: usize| t.corners[(edge + i) % 3];
        [corner(0), corner(1), corner(2), other]
    }

    /// Return whether the two triangles at an edge make a strictly convex quadrilateral.
    fn is_convex(&mut self, [a, b, apex, other]: [u32; 4]) -> bool {
        self.turn([apex, a, other]) == Sign::Positive
            && self.turn([other, b, apex]) == Sign::Positive
    }

    /// Return whether a point lies clearly inside the circle through three others; in doubles.
    fn is_in_circle(&self, corners: [u32; 3], point: u32) -> bool {
        /// Rounding must not choose: rows of a grid have four points on a circle.
        const CLEAR: f64 = 1e-9;
        let at = |i: u32| self.places[i as usize].at;
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

    /// Makes a segment an edge.
    ///
    /// # Errors
    /// `Special` if it meets another segment, or a point other than its ends.
    pub(super) fn constrain(&mut self, ends: [u32; 2], segment: u32) -> Result<(), Special> {
        let [from, to] = ends;
        if self.edge_between(from, to).is_none() && self.edge_between(to, from).is_none() {
            let crossed = self.crossed(from, to)?;
            self.remove(crossed, from, to);
        }
        self.mark(from, to, segment)
    }

    /// Marks an edge as a part of a segment.
    fn mark(&mut self, from: u32, to: u32, segment: u32) -> Result<(), Special> {
        let sign = i32::try_from(segment + 1).map_err(|_| Special)?;
        for ([from, to], mark) in [([from, to], sign), ([to, from], -sign)] {
            if let Some((cell, edge)) = self.edge_between(from, to) {
                let known = &mut self.cells[cell as usize].marks[edge];
                if *known != 0 {
                    return Err(Special);
                }
                *known = mark;
            }
        }
        Ok(())
    }

    /// The edges that a segment crosses, in their order along it.
    fn crossed(&mut self, from: u32, to: u32) -> Result<Vec<[u32; 2]>, Special> {
        let (mut at, mut edge) = self.first_crossed(from, to)?;
        let mut crossed = Vec::new();
        loop {
            poll();
            let cell = self.cells[at as usize];
            let across = cell.mates[edge];
            if cell.marks[edge] != 0 || across == NONE {
                return Err(Special);
            }
            crossed.push([cell.corners[edge], cell.corners[(edge + 1) % 3]]);
            let back = self.edge_to(across, at);
            let next = self.cells[across as usize].corners[(back + 2) % 3];
            if next == to {
                return Ok(crossed);
            }
            at = across;
            edge = match self.turn([from, to, next]) {
                Sign::Positive => (back + 1) % 3,
                Sign::Negative => (back + 2) % 3,
                Sign::Zero => return Err(Special),
            };
        }
    }

    /// The first edge that the way from a point to another one crosses.
    fn first_crossed(&mut self, from: u32, to: u32) -> Result<(u32, usize), Special> {
        for (number, k) in self.fan(from) {
            let corners = self.cells[number as usize].corners;
            let [right, left] = [1, 2].map(|i| corners[(k + i) % 3]);
            let sides = [right, left].map(|corner| self.turn([from, to, corner]));
            if sides == [Sign::Negative, Sign::Positive] {
                return Ok((number, (k + 1) % 3));
            }
        }
        Err(Special)
    }

    /// Flips edges until none crosses a segment.
    fn remove(&mut self, crossed: Vec<[u32; 2]>, from: u32, to: u32) {
        let mut open = std::collections::VecDeque::from(crossed);
        while let Some([a, b]) = open.pop_front() {
            poll();
            let Some((number, edge)) = self.edge_between(a, b) else {
                continue;
            };
            let quad = self.around(number, edge);
            if !self.is_convex(quad) {
                open.push_back([a, b]);
                continue;
            }
            self.flip(number, edge);
            let [.., apex, other] = quad;
            let is_end = |p: u32| p == from || p == to;
            if is_end(apex) || is_end(other) {
                continue;
            }
            let sides = [apex, other].map(|p| self.turn([from, to, p]));
            if sides[0] != sides[1] {
                open.push_back([apex, other]);
            }
        }
    }
}

impl Place {
    fn of(vertex: Arc<Vertex>, rims: u8, axes: [usize; 2]) -> Self {
        let near = vertex.approx();
        let at = axes.map(|i| near[i]);
        let error = match vertex.as_lattice() {
            Some(_) => 0.0,
            None => 4.0 * f64::EPSILON * at[0].abs().max(at[1].abs()),
        };
        Self {
            at,
            error,
            rims,
            vertex,
            exact: None,
        }
    }

    fn to(&self, other: &Self) -> [f64; 2] {
        [other.at[0] - self.at[0], other.at[1] - self.at[1]]
    }
}

/// Sign of the turn at three points as seen along two axes.
///
/// # Bits
/// Of three points on edges at most 604, of any 1086 (`arith::bounds`).
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
    use crate::geometry::plane::Lattice;

    fn vertex([x, y]: [i64; 2]) -> Arc<Vertex> {
        Arc::new(Vertex::lattice([x, y, 0]))
    }

    fn face() -> Triangulation {
        Triangulation::new([[0, 0], [64, 0], [0, 64]].map(vertex), [0, 1])
    }

    fn at(cells: &Triangulation, place: u32) -> Lattice {
        *cells.vertex(place).as_lattice().expect("a lattice point")
    }

    /// Twice the area of all triangles, each of which must turn left and know its neighbours.
    fn area(cells: &Triangulation) -> i64 {
        let mut sum = 0;
        for (number, cell) in (0..).zip(cells.cells()) {
            let [a, b, c] = cell.corners.map(|p| at(cells, p));
            let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            assert!(turn > 0);
            sum += turn;
            for i in (0..3).filter(|i| cell.mates[*i] != NONE) {
                let mate = &cells.cells()[cell.mates[i] as usize];
                let back = mate
                    .mates
                    .iter()
                    .position(|m| *m == number)
                    .expect("a mate");
                assert_eq!(mate.corners[back], cell.corners[(i + 1) % 3]);
                assert_eq!(mate.marks[back], -cell.marks[i]);
            }
        }
        sum
    }

    #[test]
    fn points_and_segments_are_in_the_triangulation() {
        let mut cells = face();
        let rim = cells.divide_border([0, 1], vertex([20, 0]));
        cells.divide_border([rim, 1], vertex([30, 0]));
        let inner: Vec<u32> = (0..40)
            .map(|k| {
                cells
                    .insert(vertex([1 + k * 13 % 31, 1 + k * 7 % 29]))
                    .expect("a new point")
            })
            .collect();
        assert_eq!(area(&cells), 64 * 64);
        for (number, ends) in (0..).zip([[rim, inner[3]], [inner[9], inner[30]], [2, inner[17]]]) {
            if cells.constrain(ends, number) == Ok(()) {
                let (cell, edge) = cells.edge_between(ends[0], ends[1]).expect("an edge");
                assert_eq!(
                    cells.cells()[cell as usize].marks[edge],
                    i32::try_from(number).unwrap() + 1
                );
            }
        }
        assert_eq!(area(&cells), 64 * 64);
    }

    #[test]
    fn all_segments_between_points_become_edges_unless_they_meet_others() {
        for k in 0..200i64 {
            let mut cells = face();
            let places = (0..12).map(|i| [1 + (k * 5 + i * 17) % 31, 1 + (k * 3 + i * 11) % 29]);
            let points: Vec<u32> = places
                .filter_map(|p| cells.insert(vertex(p)).ok())
                .collect();
            let mut made: Vec<[Lattice; 2]> = Vec::new();
            for (number, pair) in (0..).zip(points.chunks_exact(2)) {
                let ends = [pair[0], pair[1]];
                let places = ends.map(|p| at(&cells, p));
                let is_clear = made.iter().all(|other| !meet(places, *other))
                    && points
                        .iter()
                        .filter(|p| !ends.contains(p))
                        .all(|p| !holds(places, at(&cells, *p)));
                assert_eq!(cells.constrain(ends, number).is_ok(), is_clear, "{k}");
                assert_eq!(area(&cells), 64 * 64);
                if is_clear {
                    made.push(places);
                }
            }
        }
    }

    fn side([a, b]: [Lattice; 2], p: Lattice) -> i64 {
        ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
    }

    fn holds(segment: [Lattice; 2], p: Lattice) -> bool {
        let [a, b] = segment;
        let along = (p[0] - a[0]) * (p[0] - b[0]) + (p[1] - a[1]) * (p[1] - b[1]);
        side(segment, p) == 0 && along <= 0
    }

    fn meet(s: [Lattice; 2], t: [Lattice; 2]) -> bool {
        let crosses = side(s, t[0]) * side(s, t[1]) < 0 && side(t, s[0]) * side(t, s[1]) < 0;
        crosses || t.iter().any(|p| holds(s, *p)) || s.iter().any(|p| holds(t, *p))
    }

    #[test]
    fn points_that_coincide_are_special() {
        let mut cells = face();
        cells.insert(vertex([9, 9])).expect("a new point");
        assert_eq!(cells.insert(vertex([9, 9])), Err(Special));
        assert_eq!(cells.insert(vertex([32, 32])), Err(Special));
        assert_eq!(cells.insert(vertex([40, 40])), Err(Special));
    }
}
