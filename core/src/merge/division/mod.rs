//! Divides a convex polygon along segments into triangular cells.
//!
//! The arrangement divides whole faces, and the kernel for general position divides the elements of a cell of
//! the descent. Since all cells are triangles, no caller needs to know how segments are connected: values
//! that change across segments spread from cell to cell, and the outline of a set of cells is its border.

mod probe;
mod triangulation;

use std::sync::Arc;

use smallvec::SmallVec;

use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::geometry::outline::BareEdge;
use crate::geometry::plane::Plane;
use crate::geometry::polygon::Carrier;
use crate::geometry::vertex::Vertex;

pub use probe::{cell_with_probe, Probe};
pub use triangulation::{Defect, Triangulation, NONE};

/// What is known in advance about the position of a point in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PositionInPolygon {
    /// The point is the corner with this index.
    Corner(usize),
    /// The point lies between the ends of the side with this index.
    Side(usize),
    /// The point lies inside the polygon or on its border.
    Inside,
}

/// A convex polygon divided along segments.
#[derive(Debug)]
pub struct Division {
    support: Arc<Plane>,
    /// For each side of the polygon, the edge or plane that it lies on.
    sides: SmallVec<[Carrier; 3]>,
    triangulation: Triangulation,
    /// For each segment a plane that contains it; the left of the segment is on the minus side.
    cuts: Vec<Arc<Plane>>,
}

impl Division {
    /// Makes an undivided polygon of its plane and its counterclockwise corners, each with the carrier (the
    /// edge or plane that contains it) of the side that begins there.
    ///
    /// # Errors
    /// If the polygon has more than three corners and is not strictly convex.
    pub fn of(
        support: &Arc<Plane>,
        corners: impl ExactSizeIterator<Item = (Arc<Vertex>, Carrier)>,
    ) -> Result<Self, Defect> {
        let mut sides = SmallVec::with_capacity(corners.len());
        let corners = corners.map(|(at, side)| {
            sides.push(side);
            at
        });
        let mut triangulation = Triangulation::new(corners, axes(support));
        let count = as_number(sides.len());
        let mut turns = |i: u32| triangulation.turn([i, (i + 1) % count, (i + 2) % count]);
        if count > 3 && (0..count).any(|i| turns(i) != Sign::Positive) {
            return Err(Defect);
        }
        Ok(Self {
            support: Arc::clone(support),
            sides,
            triangulation,
            cuts: Vec::new(),
        })
    }

    /// Inserts points as vertices of the triangulation, and returns their numbers there.
    ///
    /// # Errors
    /// If a point lies outside the polygon.
    pub fn insert(
        &mut self,
        points: &[(&Arc<Vertex>, PositionInPolygon)],
    ) -> Result<Vec<u32>, Defect> {
        let mut numbers = vec![NONE; points.len()];
        let mut on_border: SmallVec<[(usize, usize); 16]> = SmallVec::new();
        for (i, (_, position)) in points.iter().enumerate() {
            match position {
                PositionInPolygon::Corner(corner) => numbers[i] = as_number(*corner),
                PositionInPolygon::Side(side) => on_border.push((*side, i)),
                PositionInPolygon::Inside => {}
            }
        }
        on_border.sort_unstable();
        for on_side in on_border.chunk_by_mut(|p, q| p.0 == q.0) {
            self.insert_on_side(on_side, points, &mut numbers);
        }
        for (number, (point, _)) in numbers.iter_mut().zip(points) {
            if *number == NONE {
                *number = self.triangulation.insert(Arc::clone(point))?;
            }
        }
        Ok(numbers)
    }

    /// Inserts the points of one side of the polygon, in their order along it.
    fn insert_on_side(
        &mut self,
        on_side: &mut [(usize, usize)],
        points: &[(&Arc<Vertex>, PositionInPolygon)],
        numbers: &mut [u32],
    ) {
        let side = on_side[0].0;
        let (mut last, end) = (as_number(side), as_number((side + 1) % self.sides.len()));
        let ends = [last, end].map(|p| self.triangulation.vertex(p));
        let axis = ends[0].axis_to(ends[1]);
        let order = ends[0].compare_along(ends[1], axis);
        let vertex = |i: usize| points[i].0;
        on_side.sort_by(|(_, p), (_, q)| {
            let along = vertex(*p).compare_along(vertex(*q), axis);
            if order.is_gt() {
                along.reverse()
            } else {
                along
            }
        });
        let mut before: Option<&Arc<Vertex>> = None;
        for (_, point) in on_side {
            let vertex = vertex(*point);
            if !before.is_some_and(|b| b.equals(vertex)) {
                last = self
                    .triangulation
                    .divide_border([last, end], Arc::clone(vertex));
            }
            before = Some(vertex);
            numbers[*point] = last;
        }
    }

    /// Divides the polygon along the segment between two inserted points. It lies in the plane `cut`, and its
    /// left is on the minus side.
    ///
    /// # Errors
    /// If the segment leaves the polygon.
    pub fn cut_along(&mut self, ends: [u32; 2], cut: Arc<Plane>) -> Result<(), Defect> {
        let number = as_number(self.cuts.len());
        self.cuts.push(cut);
        let (support, cuts) = (&self.support, &self.cuts);
        let meet = |other: u32| {
            let [p, q] = [number, other].map(|i| &cuts[i as usize]);
            Vertex::meet(support, p, q).map(Arc::new)
        };
        let cut = &cuts[number as usize];
        self.triangulation.constrain(ends, (number, cut), meet)
    }

    /// Returns the triangulation of the polygon.
    pub fn triangulation(&mut self) -> &mut Triangulation {
        &mut self.triangulation
    }

    /// Returns the number of triangles.
    #[allow(clippy::len_without_is_empty, reason = "a polygon has at least one")]
    pub fn len(&self) -> usize {
        self.triangulation.cells().len()
    }

    /// Returns for each neighbour of a triangle of the division the index of the triangle's edge between
    /// them, and the neighbour's number.
    pub fn neighbours(&self, cell: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let neighbours = self.triangulation.cells()[cell]
            .neighbours
            .iter()
            .enumerate();
        let neighbours = neighbours.filter(|(_, neighbour)| **neighbour != NONE);
        neighbours.map(|(edge, neighbour)| (edge, *neighbour as usize))
    }

    /// Returns the corners of a triangle of the division, counterclockwise.
    pub fn corners_of(&self, cell: usize) -> [&Vertex; 3] {
        let corners = self.triangulation.cells()[cell].corners;
        corners.map(|c| &**self.triangulation.vertex(c))
    }

    /// Returns the number of a triangle of the division at a corner of the polygon.
    pub fn cell_at_corner(&self, corner: usize) -> usize {
        self.triangulation.cell_at(as_number(corner)) as usize
    }

    /// Returns the segments that run along an edge of a triangle of the division, each with whether it has
    /// the direction of the edge.
    pub fn along_edge(&self, cell: usize, edge: usize) -> impl Iterator<Item = (usize, bool)> + '_ {
        let along = self.triangulation.along_edge(as_number(cell), edge);
        along.map(|(segment, is_along)| (segment as usize, is_along))
    }

    /// Computes a value for each triangle of the division: the first has `first`, and `across` returns the
    /// value of a neighbour from the value of a triangle, the triangle and the edge.
    pub fn spread<T: Copy>(&self, first: T, across: impl Fn(T, usize, usize) -> T) -> Vec<T> {
        let cells = self.triangulation.cells();
        let mut values = vec![first; cells.len()];
        let mut is_known = vec![false; cells.len()];
        is_known[0] = true;
        let mut open = vec![0];
        while let Some(at) = open.pop() {
            for (edge, neighbour) in cells[at].neighbours.into_iter().enumerate() {
                if neighbour != NONE && !std::mem::replace(&mut is_known[neighbour as usize], true)
                {
                    values[neighbour as usize] = across(values[at], at, edge);
                    open.push(neighbour as usize);
                }
            }
        }
        values
    }

    /// Returns the border of the triangles of the division for which `is_kept` is true, as closed loops;
    /// collinear edges are merged.
    pub fn outline(&mut self, is_kept: &[bool]) -> Vec<BareEdge> {
        let is_border = |this: &Self, (cell, edge): (u32, usize)| {
            let neighbour = this.triangulation.cells()[cell as usize].neighbours[edge];
            neighbour == NONE || !is_kept[neighbour as usize]
        };
        let mut is_done = vec![[false; 3]; is_kept.len()];
        let mut edges = Vec::new();
        for start in (0..as_number(is_kept.len())).flat_map(|c| [(c, 0), (c, 1), (c, 2)]) {
            if !is_kept[start.0 as usize]
                || is_done[start.0 as usize][start.1]
                || !is_border(self, start)
            {
                continue;
            }
            let mut ring: SmallVec<[(u32, usize); 8]> = SmallVec::new();
            let mut at = start;
            while !std::mem::replace(&mut is_done[at.0 as usize][at.1], true) {
                ring.push(at);
                at = (at.0, (at.1 + 1) % 3);
                while !is_border(self, at) {
                    at = self.triangulation.across(at);
                    at.1 = (at.1 + 1) % 3;
                }
            }
            self.add_ring(&ring, &mut edges);
        }
        edges
    }

    /// Adds a closed loop of border edges to `edges`; merges collinear ones.
    fn add_ring(&mut self, ring: &[(u32, usize)], edges: &mut Vec<BareEdge>) {
        let turns = |this: &mut Self, i: usize| {
            let before = ring[(i + ring.len() - 1) % ring.len()];
            if this.have_one_cut(before, ring[i]) {
                return false;
            }
            let ((from, at), (_, to)) = (
                this.triangulation.ends(before),
                this.triangulation.ends(ring[i]),
            );
            this.triangulation.turn([from, at, to]) != Sign::Zero
        };
        let corners: SmallVec<[usize; 8]> = (0..ring.len()).filter(|i| turns(self, *i)).collect();
        for (k, first) in corners.iter().enumerate() {
            let (from, _) = self.triangulation.ends(ring[*first]);
            let (to, _) = self
                .triangulation
                .ends(ring[corners[(k + 1) % corners.len()]]);
            edges.push(BareEdge {
                from: Arc::clone(self.triangulation.vertex(from)),
                to: Arc::clone(self.triangulation.vertex(to)),
                carrier: self.carrier(ring[*first]),
            });
        }
    }

    /// Returns true if two edges of triangles certainly lie in the plane of one dividing segment.
    fn have_one_cut(&self, first: (u32, usize), second: (u32, usize)) -> bool {
        let cut = |(cell, edge)| self.triangulation.along_edge(cell, edge).next();
        let cuts = cut(first).zip(cut(second));
        cuts.is_some_and(|((p, _), (q, _))| {
            let [p, q] = [p, q].map(|segment| &self.cuts[segment as usize]);
            Arc::ptr_eq(p, q) || p.coincides(q).is_some()
        })
    }

    fn carrier(&self, (cell, edge): (u32, usize)) -> Carrier {
        let ends = self.triangulation.ends((cell, edge));
        if self.triangulation.cells()[cell as usize].neighbours[edge] == NONE {
            return self.sides[self.triangulation.side(ends.into()) as usize].clone();
        }
        let mut along = self.triangulation.along_edge(cell, edge);
        let (segment, is_along) = along
            .next()
            .expect("cells that differ are parted by a segment");
        Carrier::Cut(Arc::clone(&self.cuts[segment as usize]), !is_along)
    }
}

/// Returns two axes such that the projection on them of a polygon of this plane is counterclockwise.
pub fn axes(support: &Plane) -> [usize; 2] {
    let axis = support.main_axis();
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    if support.normal()[axis] > 0 {
        [u, v]
    } else {
        [v, u]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Lattice;
    use crate::geometry::polygon::Polygon;

    fn support() -> Arc<Plane> {
        Arc::new(Plane::axis_cut(2, 0))
    }

    fn division(corners: &[Lattice]) -> Result<Division, Defect> {
        let polygon = Polygon::convex(corners, support());
        let corners = polygon.corners().iter();
        let corners = corners.map(|c| (Arc::clone(&c.at), c.edge.clone()));
        Division::of(polygon.support(), corners)
    }

    const SQUARE: [Lattice; 4] = [[0, 0, 0], [8, 0, 0], [8, 8, 0], [0, 8, 0]];

    /// Returns the square divided along a line from its lower to its upper side, and along a line across
    /// this.
    fn quarters() -> Division {
        let mut made = division(&SQUARE).expect("a convex polygon");
        let at = |x, y| Arc::new(Vertex::lattice([x, y, 0]));
        let points = [at(3, 0), at(3, 8), at(0, 2), at(8, 2)];
        let spots = [0, 2, 3, 1].map(PositionInPolygon::Side);
        let points: Vec<_> = points.iter().zip(spots).collect();
        let ends = made.insert(&points).expect("inside");
        let cuts = [Plane::axis_cut(0, 6), Plane::axis_cut(1, 4).flipped()].map(Arc::new);
        for (ends, cut) in ends.chunks_exact(2).zip(cuts) {
            made.cut_along([ends[0], ends[1]], cut).expect("inside");
        }
        made
    }

    #[test]
    fn values_spread_across_segments() {
        let made = quarters();
        let bits = |cell, edge| {
            let along = made.along_edge(cell, edge);
            along.fold(0, |all, (segment, _)| all ^ 1 << segment)
        };
        let values = made.spread(0u8, |here, cell, edge| here ^ bits(cell, edge));
        let at_corners = [0, 1, 2, 3].map(|corner| values[made.cell_at_corner(corner)]);
        assert_eq!(at_corners[0] ^ at_corners[2], 0b11);
        assert_eq!(at_corners[1] ^ at_corners[3], 0b11);
        assert_eq!(at_corners[0] ^ at_corners[1], 0b01);
        for cell in 0..values.len() {
            for (edge, neighbour) in made.neighbours(cell) {
                assert_eq!(values[neighbour], values[cell] ^ bits(cell, edge));
            }
        }
    }

    #[test]
    fn an_outline_goes_around_cells_and_keeps_their_side_of_cuts() {
        let mut made = quarters();
        let is_first = |cell, edge| made.along_edge(cell, edge).any(|(segment, _)| segment == 0);
        let left = made.spread(true, |here, cell, edge| here ^ is_first(cell, edge));
        let start = left[made.cell_at_corner(0)];
        let left: Vec<bool> = left.into_iter().map(|l| l == start).collect();
        let all = vec![true; left.len()];
        assert_eq!(made.outline(&all).len(), 4);
        let edges = made.outline(&left);
        let cuts: Vec<bool> = edges
            .iter()
            .filter_map(|e| match &e.carrier {
                Carrier::Cut(_, is_plus) => Some(*is_plus),
                Carrier::Edge(_) => None,
            })
            .collect();
        // The cut y = 2 is no edge of the outline, and x < 3 is the minus side of x = 3.
        assert_eq!((edges.len(), cuts), (4, vec![false]));
    }

    #[test]
    fn corners_on_one_line_are_refused() {
        assert!(division(&SQUARE).is_ok());
        let flat = [[0, 0, 0], [4, 0, 0], [8, 0, 0], [0, 8, 0]];
        assert_eq!(division(&flat).err(), Some(Defect));
    }
}
