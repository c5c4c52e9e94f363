//! Convex polygons in planes, split exactly by other planes.
//!
//! Each edge stores a plane or lattice edge that carries it, so a new corner is always the meet of input
//! planes, and its coordinates do not widen with the number of cuts.

use std::sync::Arc;

use smallvec::SmallVec;

use super::cell::Cell;
use super::edge::{LatticeEdge, Ring};
use super::line::{Line, PlaneResidues};
use super::plane::{Lattice, Plane};
use super::side::Side;
use super::vertex::Vertex;
use crate::arith::convert::as_double;
use crate::interrupt::poll;

/// The lattice edge or the plane that carries an edge of a polygon: the edge lies on it and in the polygon's
/// plane.
#[derive(Clone, Debug)]
pub enum Carrier {
    /// A lattice edge of a face, in the face's own direction.
    Edge(LatticeEdge),
    /// A plane; the polygon lies on its plus side if the flag is set, else on its minus side.
    Cut(Arc<Plane>, bool),
}

impl Carrier {
    /// The plane through the edge that crosses the polygon's plane `support` and has the polygon on its minus
    /// side.
    pub fn plane(&self, support: &Plane) -> Plane {
        match self {
            Self::Edge(edge) => edge_plane(edge, support),
            Self::Cut(plane, true) => plane.flipped(),
            Self::Cut(plane, false) => (**plane).clone(),
        }
    }

    /// The plane through the edge with the polygon on its minus side, for side tests only: its coefficients
    /// may have a common divisor.
    pub fn rim(&self, support: &Plane) -> Plane {
        match self {
            Self::Edge(edge) => {
                let (a, b) = edge.ends();
                let axis = support.main_axis();
                let plane = Plane::beside_edge(a, b, axis);
                if support.normal()[axis] < 0 {
                    plane.flipped()
                } else {
                    plane
                }
            }
            Self::Cut(plane, true) => plane.flipped(),
            Self::Cut(plane, false) => (**plane).clone(),
        }
    }

    /// Return whether no corner in `corners` lies strictly on the inner side of this edge of a polygon; all
    /// corners lie in the polygon's plane `support`.
    fn all_outside(&self, support: &Plane, corners: &[Corner]) -> bool {
        let axis = support.main_axis();
        let (turned, side): (bool, &dyn Fn(&Vertex) -> Side) = match self {
            Self::Edge(edge) => (support.normal()[axis] < 0, &|at| {
                at.side_of_edge(edge, axis)
            }),
            Self::Cut(plane, plus) => (*plus, &|at| at.side_of(plane)),
        };
        let inner = if turned { Side::Plus } else { Side::Minus };
        corners.iter().all(|corner| side(&corner.at) != inner)
    }

    /// Return whether the carrier of a polygon's edge is a wall of the cell of all lattice points, which cuts
    /// only surfaces of half-spaces.
    pub fn is_border(&self) -> bool {
        match self {
            Self::Edge(..) => false,
            Self::Cut(plane, _) => {
                plane.only_axis().is_some()
                    && Cell::UNIVERSE
                        .walls()
                        .iter()
                        .any(|w| w.coincides(plane).is_some())
            }
        }
    }

    /// The line in which the carrier of a polygon's edge and the polygon's plane `support` meet.
    pub fn line(&self, support: &PlaneResidues) -> Line {
        match self {
            Self::Edge(edge) => {
                let (a, b) = edge.ends();
                Line::of_edge(a, b)
            }
            Self::Cut(plane, _) => Line::of_planes(support, &PlaneResidues::of(plane)),
        }
    }

    /// The point where this edge's line meets a plane; `None` if the two are parallel.
    pub fn meet(&self, support: &Arc<Plane>, cut: &Arc<Plane>) -> Option<Vertex> {
        match self {
            Self::Edge(edge) => Vertex::on_edge(edge, cut),
            Self::Cut(plane, _) => Vertex::meet(support, plane, cut),
        }
    }
}

/// The plane that contains an edge of a face and is parallel to the main axis of the face's normal, with the
/// face on its minus side.
fn edge_plane(edge: &LatticeEdge, support: &Plane) -> Plane {
    let (a, b) = edge.ends();
    let axis = support.main_axis();
    let plane = Plane::through_edge(a, b, axis)
        .expect("an edge is not parallel to the main axis of its face's normal");
    if support.normal()[axis] < 0 {
        plane.flipped()
    } else {
        plane
    }
}

/// A corner of a polygon, and the lattice edge or plane that carries the edge which leaves it.
#[derive(Clone, Debug)]
pub struct Corner {
    /// The exact position of the corner.
    pub at: Arc<Vertex>,
    /// The lattice edge or plane that carries the edge to the next corner.
    pub edge: Carrier,
}

type Corners = SmallVec<[Corner; 5]>;

/// The sides of a plane on which the corners of a polygon lie.
pub type Sides = SmallVec<[Side; 8]>;

/// The ends of a segment of a polygon.
pub type Chord = SmallVec<[Arc<Vertex>; 2]>;

/// Return two flags: whether any of the sides is `Minus`, and whether any is `Plus`.
pub fn straddle(sides: &[Side]) -> (bool, bool) {
    (sides.contains(&Side::Minus), sides.contains(&Side::Plus))
}

/// A convex polygon of positive area, counterclockwise as seen from the plus side of its plane.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::geometry::plane::Plane;
/// use bspcsg::geometry::polygon::{Polygon, PolygonSplit};
///
/// let corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];
/// let support = Plane::through(&corners[0], &corners[1], &corners[2]).expect("a plane");
/// let triangle = Polygon::triangle(&corners, Arc::new(support));
/// // The plane x = 1; twice a coordinate, so that cuts between lattice points have numbers, too.
/// let cut = Arc::new(Plane::axis_cut(0, 2));
/// let PolygonSplit::Both(minus, plus) = triangle.split(&cut) else {
///     panic!("the cut crosses the triangle");
/// };
/// assert_eq!((minus.corners().len(), plus.corners().len()), (4, 3));
/// ```
#[derive(Clone, Debug)]
pub struct Polygon {
    support: Arc<Plane>,
    corners: Corners,
}

/// Where a polygon lies relative to a plane, with the two parts if the plane crosses it.
///
/// Parts are used at once and never stored, so boxing the large variant would only cost time.
#[derive(Debug)]
#[allow(clippy::large_enum_variant)]
pub enum PolygonSplit {
    /// The polygon lies on the minus side; it may touch the plane.
    Minus,
    /// The polygon lies on the plus side; it may touch the plane.
    Plus,
    /// The polygon lies in the plane.
    Coplanar,
    /// The polygon has points strictly on both sides: its part on the minus side, then its part on the plus
    /// side.
    Both(Polygon, Polygon),
}

impl Polygon {
    /// The triangle with these lattice corners, counterclockwise, in the plane `support` through them.
    pub fn triangle(points: &[Lattice; 3], support: Arc<Plane>) -> Self {
        Self::convex(points, support)
    }

    /// The convex polygon with these corners, counterclockwise, in the plane `support` through them.
    pub fn of_corners(corners: Vec<Corner>, support: Arc<Plane>) -> Self {
        let corners = corners.into_iter().collect();
        Self { support, corners }
    }

    /// The convex polygon with these lattice corners, counterclockwise, in the plane `support` through them.
    pub fn convex(points: &[Lattice], support: Arc<Plane>) -> Self {
        let ring = Arc::new(Ring::from_slice(points));
        let corner = |(i, point): (u32, &Lattice)| Corner {
            at: Arc::new(Vertex::lattice(*point)),
            edge: Carrier::Edge(LatticeEdge::of_ring(&ring, i)),
        };
        let corners = (0..).zip(points).map(corner).collect();
        Self { support, corners }
    }

    /// The part of a plane inside a cell as a polygon; `None` if it has no area.
    pub fn span(plane: &Arc<Plane>, cell: &Cell) -> Option<Self> {
        let walls = cell.walls().map(Arc::new);
        let axis = plane.main_axis();
        let (u, v) = (2 * ((axis + 1) % 3), 2 * ((axis + 2) % 3));
        let mut ring = [(u, v), (v, u + 1), (u + 1, v + 1), (v + 1, u)];
        if plane.normal()[axis] < 0 {
            ring = [(v, u), (u, v + 1), (v + 1, u + 1), (u + 1, v)];
        }
        let corners = ring
            .iter()
            .map(|&(before, after)| {
                let at = Vertex::meet(plane, &walls[before], &walls[after])?;
                let edge = Carrier::Cut(Arc::clone(&walls[after]), false);
                Some(Corner {
                    at: Arc::new(at),
                    edge,
                })
            })
            .collect::<Option<Corners>>()?;
        let support = Arc::clone(plane);
        Self { support, corners }
            .minus_part(&walls[2 * axis])?
            .minus_part(&walls[2 * axis + 1])
    }

    /// The plane in which the polygon lies.
    pub fn support(&self) -> &Arc<Plane> {
        &self.support
    }

    /// The corners of the polygon, counterclockwise as seen from the plus side of its plane.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The directed edges, counterclockwise: start, end, and the lattice edge or plane that carries each.
    pub fn edges(&self) -> impl Iterator<Item = (&Arc<Vertex>, &Arc<Vertex>, &Carrier)> {
        let n = self.corners.len();
        (0..n).map(move |i| {
            let (from, to) = (&self.corners[i], &self.corners[(i + 1) % n]);
            (&from.at, &to.at, &from.edge)
        })
    }

    /// Splits the polygon by a plane.
    pub fn split(&self, cut: &Arc<Plane>) -> PolygonSplit {
        let sides = self.sides(cut);
        match straddle(&sides) {
            (true, true) => {
                let (minus, plus) = self.divided(cut, &sides, &self.chord(cut, &sides));
                PolygonSplit::Both(minus, plus)
            }
            (true, false) => PolygonSplit::Minus,
            (false, true) => PolygonSplit::Plus,
            (false, false) => PolygonSplit::Coplanar,
        }
    }

    /// The sides of a plane on which the polygon's corners lie, in the order of the corners.
    pub fn sides(&self, cut: &Plane) -> Sides {
        self.corners.iter().map(|c| c.at.side_of(cut)).collect()
    }

    /// The points of the polygon's border in a plane that does not contain it, in order along the border: the
    /// ends of the segment in which the plane cuts or touches the polygon, or a corner. `sides` are the sides on
    /// which the corners lie.
    pub fn chord(&self, cut: &Arc<Plane>, sides: &[Side]) -> Chord {
        let n = self.corners.len();
        let mut ends = Chord::new();
        for i in 0..n {
            if sides[i] == Side::On {
                ends.push(Arc::clone(&self.corners[i].at));
            } else if sides[i].is_across_from(sides[(i + 1) % n]) {
                ends.push(self.crossing(i, cut));
            }
        }
        ends
    }

    /// Return the point where a plane crosses the edge that leaves a corner; the edge's ends lie strictly on
    /// both sides.
    fn crossing(&self, corner: usize, cut: &Arc<Plane>) -> Arc<Vertex> {
        let meet = self.corners[corner].edge.meet(&self.support, cut);
        Arc::new(meet.expect("an edge with ends on both sides meets the plane"))
    }

    /// The part on the minus side and the part on the plus side of a plane that cuts the polygon in a chord.
    fn divided(&self, cut: &Arc<Plane>, sides: &[Side], chord: &Chord) -> (Self, Self) {
        let half = |own| self.half(cut, sides, chord, own);
        (half(Side::Minus), half(Side::Plus))
    }

    /// The part of the polygon on the side `own`, which is `Minus` or `Plus`, of a plane that cuts the
    /// polygon in a chord.
    fn half(&self, cut: &Arc<Plane>, sides: &[Side], chord: &Chord, own: Side) -> Self {
        let n = self.corners.len();
        let along = |at: &Arc<Vertex>| Corner {
            at: Arc::clone(at),
            edge: Carrier::Cut(Arc::clone(cut), own == Side::Plus),
        };
        let mut corners = Corners::new();
        let mut ends = chord.iter();
        for (i, corner) in self.corners.iter().enumerate() {
            let next = sides[(i + 1) % n];
            if sides[i] == Side::On {
                ends.next();
            }
            if sides[i] == own || sides[i] == Side::On && next == own {
                corners.push(corner.clone());
            } else if sides[i] == Side::On {
                corners.push(along(&corner.at));
            }
            let crossing = if sides[i].is_across_from(next) {
                ends.next()
            } else {
                None
            };
            match crossing {
                Some(at) if next == own => corners.push(Corner {
                    at: Arc::clone(at),
                    edge: corner.edge.clone(),
                }),
                Some(at) => corners.push(along(at)),
                None => {}
            }
        }
        Self {
            support: Arc::clone(&self.support),
            corners,
        }
    }

    /// The part of the polygon on the minus side of a plane, or `None` if it has no area.
    #[must_use]
    pub fn minus_part(self, cut: &Arc<Plane>) -> Option<Self> {
        let sides = self.sides(cut);
        match straddle(&sides) {
            (true, true) => Some(self.half(cut, &sides, &self.chord(cut, &sides), Side::Minus)),
            (true, false) => Some(self),
            (false, _) => None,
        }
    }

    /// The part of the polygon inside a cell, or `None` if it has no area.
    #[must_use]
    pub fn clipped(self, cell: &Cell) -> Option<Self> {
        let (low, high) = (cell.low(), cell.high());
        let mut polygon = self;
        for axis in 0..3 {
            let (below, above) = polygon.may_extend_beyond(axis, low[axis], high[axis]);
            if below {
                let wall = Arc::new(Plane::axis_cut(axis, 2 * low[axis] - 1).flipped());
                polygon = polygon.minus_part(&wall)?;
            }
            if above {
                polygon =
                    polygon.minus_part(&Arc::new(Plane::axis_cut(axis, 2 * high[axis] + 1)))?;
            }
        }
        Some(polygon)
    }

    /// Return two flags: whether the polygon may reach half a step below `low` along an axis, and whether it
    /// may reach half a step above `high`; either may be a false positive.
    fn may_extend_beyond(&self, axis: usize, low: i64, high: i64) -> (bool, bool) {
        let (mut below, mut above) = (false, false);
        for corner in &self.corners {
            if let Some(p) = corner.at.as_lattice() {
                below |= p[axis] < low;
                above |= p[axis] > high;
            } else {
                let (least, most) = corner.at.bounds();
                below |= least[axis] < as_double(low);
                above |= most[axis] > as_double(high);
            }
        }
        (below, above)
    }

    /// The same polygon seen from the other side: its plane flipped, its corners in reverse order.
    #[must_use]
    pub fn flipped(&self) -> Self {
        let n = self.corners.len();
        let corners = (0..n)
            .map(|i| Corner {
                at: Arc::clone(&self.corners[n - 1 - i].at),
                edge: reversed(&self.corners[(2 * n - 2 - i) % n].edge),
            })
            .collect();
        Self {
            support: Arc::new(self.support.flipped()),
            corners,
        }
    }

    /// Return whether, of two polygons in one plane, one lies entirely on the outer side of an edge of the
    /// other.
    pub fn is_separated_from(&self, other: &Self) -> bool {
        poll();
        self.is_outside_an_edge_of(other) || other.is_outside_an_edge_of(self)
    }

    fn is_outside_an_edge_of(&self, other: &Self) -> bool {
        let mut edges = self.corners.iter().map(|corner| &corner.edge);
        edges.any(|edge| edge.all_outside(&self.support, &other.corners))
    }

    /// The low and high corner of a box of doubles around the polygon, widened by the rounding of its
    /// corners.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        bounds(self.corners.iter().map(|corner| &*corner.at))
    }
}

/// The low and high corner of a box of doubles around points, widened by their rounding.
pub fn bounds<'a>(points: impl Iterator<Item = &'a Vertex>) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for point in points {
        let (least, most) = point.bounds();
        for i in 0..3 {
            low[i] = low[i].min(least[i]);
            high[i] = high[i].max(most[i]);
        }
    }
    (low, high)
}

fn reversed(edge: &Carrier) -> Carrier {
    match edge {
        Carrier::Edge(edge) => Carrier::Edge(edge.reversed()),
        cut @ Carrier::Cut(..) => cut.clone(),
    }
}
