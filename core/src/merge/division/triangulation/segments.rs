//! Inserts segments into a triangulation by flipping the edges that cross them.
//!
//! # Source
//! Sloan 1993.

use std::collections::VecDeque;
use std::sync::Arc;

use super::{Defect, EdgeSegment, ProjectedPoint, Triangulation, NONE};
use crate::arith::Sign;
use crate::geometry::plane::Plane;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// The first section of the path of a segment through the triangulation.
enum PathSection {
    /// The path reaches this point and crosses only these edges, given by their end points, none of which is
    /// part of a segment.
    Free(u32, Vec<[u32; 2]>),
    /// The path meets an edge that is part of another segment: a triangle, and the index of its edge.
    Blocked(u32, usize),
}

/// How the path of a segment leaves a point.
enum PathStart {
    /// It crosses an edge of a triangle at the point: the triangle, and the index of the edge.
    Edge(u32, usize),
    /// It runs along the edge to this point.
    Along(u32),
}

impl Triangulation {
    /// Inserts a segment between two points as a chain of edges. It lies in the plane `cut`, whose minus side
    /// is on its left; `meet` returns the point in which it crosses the segment with a given number.
    ///
    /// # Errors
    /// If the segment leaves the polygon, or `meet` finds no point.
    pub fn constrain(
        &mut self,
        [from, to]: [u32; 2],
        (segment, cut): (u32, &Plane),
        meet: impl Fn(u32) -> Option<Arc<Vertex>>,
    ) -> Result<(), Defect> {
        let (mut at, mut goals) = (from, vec![to]);
        while let Some(goal) = goals.last().copied() {
            poll();
            if at == goal {
                goals.pop();
                continue;
            }
            if let Some(edges) = self.edges_between(at, goal) {
                self.mark(edges, segment)?;
                at = goal;
                continue;
            }
            match self.path_section(at, goal, cut)? {
                PathSection::Free(end, crossed) => {
                    self.remove(crossed, [at, end], cut);
                    let edges = self.edges_between(at, end).ok_or(Defect)?;
                    self.mark(edges, segment)?;
                    at = end;
                }
                PathSection::Blocked(cell, edge) => {
                    let mark = self.cells[cell as usize].marks[edge];
                    let (other, _) = self.along(mark).next().ok_or(Defect)?;
                    let point = self.add(meet(other).ok_or(Defect)?, [NONE; 2]);
                    self.split_edge(cell, edge, point);
                    goals.push(point);
                }
            }
        }
        Ok(())
    }

    /// Returns the segments that a mark of an edge stands for, each with whether it has the direction of the
    /// edge.
    fn along(&self, mark: i32) -> impl Iterator<Item = (u32, bool)> + '_ {
        let is_turned = mark < 0;
        let mut next = mark.unsigned_abs();
        std::iter::from_fn(move || {
            let run = self.edge_segments[next.checked_sub(1)? as usize];
            next = run.before.unsigned_abs();
            Some((run.segment, run.is_forward != is_turned))
        })
    }

    /// Returns the segments that run along an edge of a triangle, each with whether it has the direction of
    /// the edge.
    pub fn along_edge(&self, cell: u32, edge: usize) -> impl Iterator<Item = (u32, bool)> + '_ {
        self.along(self.cells[cell as usize].marks[edge])
    }

    /// Marks an edge as part of a segment; the edge is given as seen from the triangles on both sides.
    fn mark(&mut self, edges: [Option<(u32, usize)>; 2], segment: u32) -> Result<(), Defect> {
        let known = |at: &Option<(u32, usize)>| at.map(|(c, e)| self.cells[c as usize].marks[e]);
        let before = known(&edges[0])
            .or_else(|| known(&edges[1]).map(|m| -m))
            .unwrap_or(0);
        self.edge_segments.push(EdgeSegment {
            segment,
            is_forward: before >= 0,
            before,
        });
        let sign = if before < 0 { -1 } else { 1 };
        let mark = i32::try_from(self.edge_segments.len()).map_err(|_| Defect)? * sign;
        for (at, mark) in edges.into_iter().zip([mark, -mark]) {
            if let Some((cell, edge)) = at {
                self.cells[cell as usize].marks[edge] = mark;
            }
        }
        Ok(())
    }

    /// Returns the first section of the path from one point to another that no edge connects.
    fn path_section(&self, from: u32, to: u32, cut: &Plane) -> Result<PathSection, Defect> {
        let (mut at, mut edge) = match self.first_crossed(from, to, cut)? {
            PathStart::Edge(cell, edge) => (cell, edge),
            PathStart::Along(point) => return Ok(PathSection::Free(point, Vec::new())),
        };
        let mut crossed = Vec::new();
        loop {
            poll();
            let cell = self.cells[at as usize];
            if cell.marks[edge] != 0 {
                return Ok(PathSection::Blocked(at, edge));
            }
            let across = cell.neighbours[edge];
            if across == NONE {
                return Err(Defect);
            }
            crossed.push([cell.corners[edge], cell.corners[(edge + 1) % 3]]);
            let back = self.edge_to(across, at);
            let next = self.cells[across as usize].corners[(back + 2) % 3];
            if next == to {
                return Ok(PathSection::Free(to, crossed));
            }
            at = across;
            edge = match self.turn_beside(cut, [from, to, next]) {
                Sign::Zero => return Ok(PathSection::Free(next, crossed)),
                Sign::Positive => (back + 1) % 3,
                Sign::Negative => (back + 2) % 3,
            };
        }
    }

    /// Returns the first edge that the path from one point to another crosses or runs along.
    fn first_crossed(&self, from: u32, to: u32, cut: &Plane) -> Result<PathStart, Defect> {
        for (number, k) in self.fan(from) {
            let corners = self.cells[number as usize].corners;
            let [right, left] = [1, 2].map(|i| corners[(k + i) % 3]);
            let sides = [right, left].map(|corner| self.turn_beside(cut, [from, to, corner]));
            for (corner, side) in [right, left].into_iter().zip(sides) {
                if side == Sign::Zero && self.is_ahead(from, to, corner) {
                    return Ok(PathStart::Along(corner));
                }
            }
            if sides == [Sign::Negative, Sign::Positive] {
                return Ok(PathStart::Edge(number, (k + 1) % 3));
            }
        }
        Err(Defect)
    }

    /// Returns true if a point of the line through `from` and `to` lies on the same side of `from` as `to`.
    fn is_ahead(&self, from: u32, to: u32, point: u32) -> bool {
        let [from, to, point] = [from, to, point].map(|p| &self.points[p as usize]);
        let axis = from.vertex.axis_to(&to.vertex);
        let order = |p: &ProjectedPoint| from.vertex.compare_along(&p.vertex, axis);
        order(point) == order(to)
    }

    /// Flips the crossed edges until none crosses the segment between two points of the plane `cut`.
    fn remove(&mut self, crossed: Vec<[u32; 2]>, [from, to]: [u32; 2], cut: &Plane) {
        let mut open = VecDeque::from(crossed);
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
            let sides = [apex, other].map(|p| self.turn_beside(cut, [from, to, p]));
            if sides[0] != sides[1] {
                open.push_back([apex, other]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{area, at, face, vertex};
    use super::*;
    use crate::arith::convert::as_number;

    /// Adds these segments, one after the other.
    fn constrain_all(cells: &mut Triangulation, segments: &[[u32; 2]]) {
        let plane = |[a, b]: [u32; 2]| {
            let [a, b] = [a, b].map(|p| *cells.vertex(p).as_lattice().expect("a lattice point"));
            Arc::new(Plane::beside_edge(&a, &b, 2))
        };
        let floor = Arc::new(Plane::axis_cut(2, 0));
        let planes: Vec<Arc<Plane>> = segments.iter().map(|s| plane(*s)).collect();
        for (number, ends) in (0..).zip(segments) {
            let meet = |other: u32| {
                let [p, q] = [number, other].map(|i| &planes[i as usize]);
                Vertex::meet(&floor, p, q).map(Arc::new)
            };
            cells
                .constrain(*ends, (number, &planes[number as usize]), meet)
                .expect("inside the face");
        }
    }

    /// Returns the total length of the edges along which a segment runs.
    fn length(cells: &Triangulation, segment: u32) -> f64 {
        let mut sum = 0.0;
        for (cell, edge) in
            (0..as_number(cells.cells().len())).flat_map(|c| [0, 1, 2].map(|e| (c, e)))
        {
            let (from, to) = cells.ends((cell, edge));
            if cells
                .along_edge(cell, edge)
                .any(|run| run == (segment, true))
            {
                let [[a, b], [c, d]] = [from, to].map(|p| at(cells, p));
                sum += (c - a).hypot(d - b);
            }
        }
        sum
    }

    #[test]
    fn all_segments_between_points_become_edges() {
        for k in 0..200i64 {
            let mut cells = face();
            let positions = (0..12).map(|i| [1 + (k * 5 + i * 17) % 31, 1 + (k * 3 + i * 11) % 29]);
            let points: Vec<u32> = positions
                .map(|p| cells.insert(vertex(p)).expect("inside"))
                .collect();
            let pairs = points
                .windows(2)
                .chain(points.chunks_exact(3).map(|c| &c[1..]));
            let segments: Vec<[u32; 2]> = pairs
                .map(|p| [p[0], p[1]])
                .filter(|[a, b]| a != b)
                .collect();
            constrain_all(&mut cells, &segments);
            assert!((area(&cells) - 4096.0).abs() < 1e-9);
            for (number, ends) in (0..).zip(segments) {
                let [[a, b], [c, d]] = ends.map(|p| at(&cells, p));
                assert!(
                    (length(&cells, number) - (c - a).hypot(d - b)).abs() < 1e-9,
                    "{k}"
                );
            }
        }
    }
}
