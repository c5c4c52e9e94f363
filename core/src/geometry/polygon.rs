//! Convex polygons in supporting planes, split exactly by planes.
//!
//! Each edge knows a plane that carries it, so that a new corner is always the meet of three input planes
//! and widths do not grow with the number of cuts.

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

/// What an edge lies on, besides the plane of the polygon.
#[derive(Clone, Debug)]
pub enum Carrier {
    /// A lattice edge of a face, in the face's own direction.
    Edge(LatticeEdge),
    /// A plane; the polygon lies on its minus side, or on its plus side if the flag is set.
    Cut(Arc<Plane>, bool),
}

impl Carrier {
    /// The plane through the edge that has the polygon on its minus side.
    pub fn plane(&self, support: &Plane) -> Plane {
        match self {
            Self::Edge(edge) => edge_plane(edge, support),
            Self::Cut(plane, true) => plane.flipped(),
            Self::Cut(plane, false) => (**plane).clone(),
        }
    }

    /// The same plane for side tests only.
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

    /// Return whether no corner of a polygon in a support lies on the inner side of this edge.
    fn has_beyond(&self, support: &Plane, corners: &[Corner]) -> bool {
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

    /// Return whether this is the border of the universe, which cuts off only half-spaces.
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

    /// The common line of this carrier and the support.
    pub fn line(&self, support: &PlaneResidues) -> Line {
        match self {
            Self::Edge(edge) => {
                let (a, b) = edge.ends();
                Line::of_edge(a, b)
            }
            Self::Cut(plane, _) => Line::of_planes(support, &PlaneResidues::of(plane)),
        }
    }

    /// The meet of this edge's line with a plane that crosses it.
    pub fn meet(&self, support: &Arc<Plane>, cut: &Arc<Plane>) -> Option<Vertex> {
        match self {
            Self::Edge(edge) => Vertex::on_edge(edge, cut),
            Self::Cut(plane, _) => Vertex::meet(support, plane, cut),
        }
    }
}

/// The plane through a face's edge parallel to an axis, with the face on its minus side.
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

/// A corner and the carrier of the edge that leaves it.
#[derive(Clone, Debug)]
pub struct Corner {
    /// The place of the corner.
    pub at: Arc<Vertex>,
    /// The carrier of the edge to the next corner.
    pub edge: Carrier,
}

type Corners = SmallVec<[Corner; 5]>;

/// The sides of a plane on which the corners of a polygon lie.
pub type Sides = SmallVec<[Side; 8]>;

/// The ends of a segment inside a polygon.
type Chord = SmallVec<[Arc<Vertex>; 2]>;

/// Return whether any corners are on the minus side, and whether any are on the plus side.
pub fn straddle(sides: &[Side]) -> (bool, bool) {
    (sides.contains(&Side::Minus), sides.contains(&Side::Plus))
}

/// A convex polygon of positive area, counterclockwise as seen from its support's plus side.
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

/// The sides of a plane on which a polygon lies, and its parts there.
///
/// Pieces are consumed at once, never stored, so that boxing the large variant would only cost.
#[derive(Debug)]
#[allow(clippy::large_enum_variant)]
pub enum PolygonSplit {
    /// Entirely on the minus side, perhaps touching.
    Minus,
    /// Entirely on the plus side, perhaps touching.
    Plus,
    /// In the plane.
    Coplanar,
    /// Strictly on both sides: the two pieces.
    Both(Polygon, Polygon),
}

impl Polygon {
    /// The triangle of three lattice points with this supporting plane.
    pub fn triangle(points: &[Lattice; 3], support: Arc<Plane>) -> Self {
        Self::convex(points, support)
    }

    /// The convex polygon with these corners in this supporting plane, counterclockwise.
    pub fn of_corners(corners: Vec<Corner>, support: Arc<Plane>) -> Self {
        let corners = corners.into_iter().collect();
        Self { support, corners }
    }

    /// The convex polygon of lattice points in this supporting plane, counterclockwise.
    pub fn convex(points: &[Lattice], support: Arc<Plane>) -> Self {
        let ring = Arc::new(Ring::from_slice(points));
        let corner = |(i, point): (u32, &Lattice)| Corner {
            at: Arc::new(Vertex::lattice(*point)),
            edge: Carrier::Edge(LatticeEdge::of_ring(&ring, i)),
        };
        let corners = (0..).zip(points).map(corner).collect();
        Self { support, corners }
    }

    /// The part of a plane inside a cell, if it has an area.
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
            .inside(&walls[2 * axis])?
            .inside(&walls[2 * axis + 1])
    }

    /// The supporting plane.
    pub fn support(&self) -> &Arc<Plane> {
        &self.support
    }

    /// The corners, counterclockwise.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The directed edges: start, end, carrier.
    pub fn edges(&self) -> impl Iterator<Item = (&Arc<Vertex>, &Arc<Vertex>, &Carrier)> {
        let n = self.corners.len();
        (0..n).map(move |i| {
            let (from, to) = (&self.corners[i], &self.corners[(i + 1) % n]);
            (&from.at, &to.at, &from.edge)
        })
    }

    /// Splits by a plane.
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

    /// The sides of a plane on which the corners lie.
    pub fn sides(&self, cut: &Plane) -> Sides {
        self.corners.iter().map(|c| c.at.side_of(cut)).collect()
    }

    /// The ends of the segment in which a plane with corners strictly on both sides cuts the polygon, in
    /// order along its border.
    fn chord(&self, cut: &Arc<Plane>, sides: &[Side]) -> Chord {
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

    /// Return the point in which the edge from a corner crosses a plane between its ends.
    fn crossing(&self, corner: usize, cut: &Arc<Plane>) -> Arc<Vertex> {
        let meet = self.corners[corner].edge.meet(&self.support, cut);
        Arc::new(meet.expect("an edge with ends on both sides meets the plane"))
    }

    /// The pieces on the minus and plus side of a plane that cuts the polygon in a chord.
    fn divided(&self, cut: &Arc<Plane>, sides: &[Side], chord: &Chord) -> (Self, Self) {
        let half = |own| self.half(cut, sides, chord, own);
        (half(Side::Minus), half(Side::Plus))
    }

    /// The piece on a side, not `On`.
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

    /// The part on the minus side of a plane, if it has an area.
    #[must_use]
    pub fn inside(self, cut: &Arc<Plane>) -> Option<Self> {
        let sides = self.sides(cut);
        match straddle(&sides) {
            (true, true) => Some(self.half(cut, &sides, &self.chord(cut, &sides), Side::Minus)),
            (true, false) => Some(self),
            (false, _) => None,
        }
    }

    /// The part inside a cell, if it has an area.
    #[must_use]
    pub fn clipped(self, cell: &Cell) -> Option<Self> {
        let (low, high) = (cell.low(), cell.high());
        let mut polygon = self;
        for axis in 0..3 {
            let (below, above) = polygon.reach(axis, low[axis], high[axis]);
            if below {
                let wall = Arc::new(Plane::axis_cut(axis, 2 * low[axis] - 1).flipped());
                polygon = polygon.inside(&wall)?;
            }
            if above {
                polygon = polygon.inside(&Arc::new(Plane::axis_cut(axis, 2 * high[axis] + 1)))?;
            }
        }
        Some(polygon)
    }

    /// Return whether the polygon may reach half a step below `low` or above `high`; may return false
    /// positives.
    fn reach(&self, axis: usize, low: i64, high: i64) -> (bool, bool) {
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

    /// The same polygon seen from the other side.
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

    /// Return whether an edge of one polygon has the other entirely beyond it; both lie in one plane.
    pub fn lies_beside(&self, other: &Self) -> bool {
        poll();
        self.has_beyond_an_edge(other) || other.has_beyond_an_edge(self)
    }

    fn has_beyond_an_edge(&self, other: &Self) -> bool {
        let mut edges = self.corners.iter().map(|corner| &corner.edge);
        edges.any(|edge| edge.has_beyond(&self.support, &other.corners))
    }

    /// A box of doubles around the polygon, widened by the rounding of its corners.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        bounds(self.corners.iter().map(|corner| &*corner.at))
    }
}

/// A box of doubles around points, widened by their rounding.
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
