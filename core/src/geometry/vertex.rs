//! Exact points: lattice points, meets of a lattice edge and a plane, and meets of three planes.

use std::cmp::Ordering;
use std::sync::Arc;

use super::axes::each_axis;
use super::coordinates::Coordinates;
pub use super::coordinates::{cross, Homogeneous};
use super::edge::LatticeEdge;
use super::plane::{Lattice, Plane, FILTER};
use super::residue::residue;
use super::side::Side;
use crate::arith::convert::as_double;
use crate::arith::{Filtered, Int, P1};

/// The largest relative difference of two doubles that approximate one coordinate: twice three units of
/// 2^-52, and room for the rounding of the comparison.
pub const MAX_COORDINATE_ERROR: f64 = 8.0 * f64::EPSILON;

/// An exact point (x/w, y/w, z/w) with w > 0.
///
/// A constructed point stores its construction: a lattice edge and a plane, or three planes. Its coordinates
/// are wide and rarely needed, so they are computed again wherever doubles do not settle a question.
///
/// # Bits
/// x, y, z below 2^379, w below 2^326 (`arith::bounds`).
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::geometry::plane::Plane;
/// use bspcsg::geometry::side::Side;
/// use bspcsg::geometry::vertex::Vertex;
///
/// // Three planes meet in (1/2, 0, 0), which is no lattice point.
/// let [slanted, front, floor] = [
///     Plane::through(&[0, 0, 1], &[1, 0, -1], &[0, 1, 1]),
///     Plane::through(&[0, 0, 0], &[1, 0, 0], &[0, 0, 1]),
///     Plane::through(&[0, 0, 0], &[1, 0, 0], &[0, 1, 0]),
/// ]
/// .map(|plane| Arc::new(plane.expect("not on one line")));
/// let corner = Vertex::meet(&slanted, &front, &floor).expect("one point");
/// assert_eq!(corner.as_lattice(), None);
/// assert_eq!(corner.approx(), [0.5, 0.0, 0.0]);
/// assert_eq!(corner.side_of(&floor), Side::On);
/// ```
#[derive(Clone, Debug)]
pub struct Vertex {
    definition: Definition,
    approx: [f64; 4],
}

#[derive(Clone, Debug)]
enum Definition {
    Lattice(Lattice),
    OnEdge(LatticeEdge, Arc<Plane>),
    Meet([Arc<Plane>; 3]),
    Homogeneous(Box<Homogeneous>),
}

/// A fingerprint of a point: its coordinates modulo a prime. Equal points have equal fingerprints; two
/// different points have equal ones with probability 2^-183.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VertexKey([u64; 3]);

impl Vertex {
    /// The vertex at a lattice point.
    pub fn lattice(p: Lattice) -> Self {
        Self {
            approx: [as_double(p[0]), as_double(p[1]), as_double(p[2]), 1.0],
            definition: Definition::Lattice(p),
        }
    }

    /// The vertex where three planes meet; `None` if they have no single common point.
    pub fn meet(a: &Arc<Plane>, b: &Arc<Plane>, c: &Arc<Plane>) -> Option<Self> {
        if let Some(point) = meet_on_lattice([a, b, c]) {
            return Some(Self::lattice(point));
        }
        let approx = Coordinates::of_planes(a, b, c)?.approx();
        let definition = Definition::Meet([a, b, c].map(Arc::clone));
        Some(Self { definition, approx })
    }

    /// The vertex where the line through a lattice edge meets a plane; `None` if the two are parallel.
    pub fn on_edge(edge: &LatticeEdge, cut: &Arc<Plane>) -> Option<Self> {
        if let Some(point) = edge_on_lattice(edge, cut) {
            return Some(Self::lattice(point));
        }
        let approx = Coordinates::on_edge(edge, cut)?.approx();
        let definition = Definition::OnEdge(edge.clone(), Arc::clone(cut));
        Some(Self { definition, approx })
    }

    /// The vertex with these homogeneous coordinates; w must be positive.
    pub fn homogeneous(x: [Int<6>; 3], w: Int<6>) -> Self {
        let given = Homogeneous { x, w };
        let approx = given.approx();
        let definition = Definition::Homogeneous(Box::new(given));
        Self { definition, approx }
    }

    /// The lattice point, if the vertex is stored as one; `None` for a constructed vertex.
    pub fn as_lattice(&self) -> Option<&Lattice> {
        match &self.definition {
            Definition::Lattice(p) => Some(p),
            _ => None,
        }
    }

    /// The exact homogeneous coordinates of the point, in six limbs.
    pub fn coordinates(&self) -> Homogeneous {
        match self.exact() {
            Coordinates::Short(h) => h.widened(),
            Coordinates::Long(h) => h,
        }
    }

    /// The exact homogeneous coordinates, computed from the construction.
    fn exact(&self) -> Coordinates {
        let known = match &self.definition {
            Definition::Lattice(p) => return Coordinates::of_lattice(p),
            Definition::Homogeneous(h) => return Coordinates::Long((**h).clone()),
            Definition::OnEdge(edge, cut) => Coordinates::on_edge(edge, cut),
            Definition::Meet([a, b, c]) => Coordinates::of_planes(a, b, c),
        };
        known.expect("what met when the point was made still meets")
    }

    /// The point in doubles, each coordinate within two units in the last place.
    pub fn approx(&self) -> [f64; 3] {
        let [x, y, z, w] = self.approx;
        [x / w, y / w, z / w]
    }

    /// The box of doubles in which the exact point certainly lies: its low and its high corner.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let p = self.approx();
        let slack = p.map(|c| c.abs() * 4.0 * f64::EPSILON);
        let ([x, y, z], [a, b, c]) = (p, slack);
        ([x - a, y - b, z - c], [x + a, y + b, z + c])
    }

    /// Return whether this may be the given lattice point, by doubles; may return false positives.
    pub fn may_lie_at(&self, point: &Lattice) -> bool {
        let (low, high) = self.bounds();
        (0..3).all(|i| low[i] <= as_double(point[i]) && as_double(point[i]) <= high[i])
    }

    /// The side of a plane on which the point lies, exactly.
    pub fn side_of(&self, plane: &Plane) -> Side {
        match &self.definition {
            Definition::Lattice(p) => plane.side_of_lattice(p),
            _ => match self.filtered_side(plane) {
                Filtered::Certain(side) => side,
                Filtered::Doubtful if self.is_defined_by(plane) => Side::On,
                Filtered::Doubtful => self.exact().side_of(plane),
            },
        }
    }

    /// The side of a plane on which the point lies; the plane contains a lattice edge and is parallel to
    /// `axis`.
    pub fn side_of_edge(&self, edge: &LatticeEdge, axis: usize) -> Side {
        let (a, b) = edge.ends();
        match &self.definition {
            Definition::Lattice(p) => Side::from_sign(edge.sign_beside(p, axis)),
            _ => match self.near_side_of_edge(edge, axis) {
                Filtered::Certain(side) => side,
                Filtered::Doubtful => self.side_of(&Plane::beside_edge(a, b, axis)),
            },
        }
    }

    /// The side of a plane on which the point lies, where doubles decide it; the plane contains a lattice
    /// edge and is parallel to `axis`.
    ///
    /// Coordinates carry one rounding, their products with a lattice point's two, differences three and the
    /// edge's steps one: five relative to the magnitudes of the operands, and three more for the products and
    /// their sum.
    fn near_side_of_edge(&self, edge: &LatticeEdge, axis: usize) -> Filtered<Side> {
        let (a, b) = edge.ends();
        let w = self.approx[3];
        let term = |i: usize, step: i64| {
            let from = as_double(a[i]) * w;
            let step = as_double(step);
            let size = step.abs() * (self.approx[i].abs() + from.abs());
            (step * (self.approx[i] - from), size)
        };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (first, second) = (term(u, b[v] - a[v]), term(v, a[u] - b[u]));
        let value = first.0 + second.0;
        let side = if value > 0.0 { Side::Plus } else { Side::Minus };
        Filtered::when(value.abs() > (first.1 + second.1) * FILTER, side)
    }

    /// A positive multiple of a plane's value at this point, in doubles, and a bound on its error.
    pub fn near_value(&self, plane: &Plane) -> (f64, f64) {
        let a = plane.approx();
        let x = &self.approx;
        let t = [a[0] * x[0], a[1] * x[1], a[2] * x[2], a[3] * x[3]];
        let size = t[0].abs() + t[1].abs() + t[2].abs() + t[3].abs();
        (t[0] + t[1] + t[2] + t[3], size * FILTER)
    }

    /// The exact value of a plane at this point, times the denominator w.
    pub fn value(&self, plane: &Plane) -> Int<8> {
        self.coordinates().value(plane)
    }

    fn filtered_side(&self, plane: &Plane) -> Filtered<Side> {
        let (value, doubt) = self.near_value(plane);
        let side = if value > 0.0 { Side::Plus } else { Side::Minus };
        Filtered::when(value.abs() > doubt, side)
    }

    /// Return whether the point lies in a plane because its construction says so; may return false negatives.
    fn is_defined_by(&self, plane: &Plane) -> bool {
        let is_it = |own: &Arc<Plane>| {
            std::ptr::eq(Arc::as_ptr(own), plane) || own.coincides(plane).is_some()
        };
        match &self.definition {
            Definition::OnEdge(edge, cut) => is_it(cut) || edge.lies_in(plane),
            Definition::Meet(planes) => planes.iter().any(is_it),
            _ => false,
        }
    }

    /// The exact order of two points by their coordinate along an axis.
    pub fn compare(&self, other: &Self, axis: usize) -> Ordering {
        if let (Definition::Lattice(p), Definition::Lattice(q)) =
            (&self.definition, &other.definition)
        {
            return p[axis].cmp(&q[axis]);
        }
        if let Filtered::Certain(order) = self.near_order(other, axis) {
            return order;
        }
        if let (Some(p), Some(q)) = (
            self.doubled_coordinate(axis),
            other.doubled_coordinate(axis),
        ) {
            return p.cmp(&q);
        }
        self.exact().compare(&other.exact(), axis)
    }

    /// The exact order of two points of one line by a coordinate that changes along the line.
    pub fn compare_along(&self, other: &Self, axis: usize) -> Ordering {
        if let (Definition::Lattice(p), Definition::Lattice(q)) =
            (&self.definition, &other.definition)
        {
            return p[axis].cmp(&q[axis]);
        }
        if let Filtered::Certain(order) = self.near_order(other, axis) {
            return order;
        }
        if self.equals(other) {
            return Ordering::Equal;
        }
        self.compare(other, axis)
    }

    /// An axis along which another, different vertex has a different coordinate: the axis of the largest
    /// difference in doubles, if that one is certain.
    pub fn axis_to(&self, other: &Self) -> usize {
        let (p, q) = (self.approx(), other.approx());
        let length = each_axis(|i| (q[i] - p[i]).abs());
        let longer = |i: &usize, j: &usize| length[*i].total_cmp(&length[*j]);
        let longest = (0..3).max_by(longer).unwrap_or(0);
        let differs = |axis: &usize| self.compare_along(other, *axis).is_ne();
        let mut axes = std::iter::once(longest).chain(0..3);
        axes.find(differs).unwrap_or(longest)
    }

    /// The order of two points by their coordinate along an axis, where doubles decide it.
    fn near_order(&self, other: &Self, axis: usize) -> Filtered<Ordering> {
        let left = self.approx[axis] * other.approx[3];
        let right = other.approx[axis] * self.approx[3];
        let certain = (left - right).abs() > (left.abs() + right.abs()) * FILTER;
        Filtered::when(certain, left.total_cmp(&right))
    }

    /// Return whether two vertices are the same point.
    ///
    /// The planes and edges that define a vertex have one common point, so a point that lies in all of them
    /// is this vertex.
    pub fn equals(&self, other: &Self) -> bool {
        if let (Definition::Lattice(p), Definition::Lattice(q)) =
            (&self.definition, &other.definition)
        {
            return p == q;
        }
        if (0..3).any(|axis| self.near_order(other, axis).is_certain()) {
            return false;
        }
        match (&self.definition, &other.definition) {
            (Definition::Lattice(p), _) => other.is_at(p),
            (_, Definition::Lattice(p)) => self.is_at(p),
            (Definition::OnEdge(edge, cut), Definition::OnEdge(same, _))
                if edge.shares_ends(same) =>
            {
                other.side_of(cut) == Side::On
            }
            (Definition::Meet(planes), _) => {
                planes.iter().all(|plane| other.side_of(plane) == Side::On)
            }
            (_, Definition::Meet(planes)) => {
                planes.iter().all(|plane| self.side_of(plane) == Side::On)
            }
            _ => self.has_coordinates_of(other),
        }
    }

    fn has_coordinates_of(&self, other: &Self) -> bool {
        let doubled = |axis: usize| {
            self.doubled_coordinate(axis)
                .zip(other.doubled_coordinate(axis))
        };
        if let [Some(x), Some(y), Some(z)] = each_axis(doubled) {
            return [x, y, z].iter().all(|(p, q)| p == q);
        }
        let (p, q) = (self.exact(), other.exact());
        (0..3).all(|axis| p.compare(&q, axis) == Ordering::Equal)
    }

    /// Return whether this vertex is the given lattice point, exactly.
    pub fn is_at(&self, point: &Lattice) -> bool {
        match &self.definition {
            Definition::Lattice(p) => p == point,
            Definition::OnEdge(edge, cut) => {
                edge.line_contains(point) && cut.side_of_lattice(point) == Side::On
            }
            Definition::Meet(planes) => planes.iter().all(|p| p.side_of_lattice(point) == Side::On),
            Definition::Homogeneous(_) => self.has_coordinates_of(&Self::lattice(*point)),
        }
    }

    /// Twice the coordinate along an axis, if the construction fixes it at a multiple of half a lattice step;
    /// else `None`.
    pub fn doubled_coordinate(&self, axis: usize) -> Option<i64> {
        match &self.definition {
            Definition::Lattice(p) => Some(2 * p[axis]),
            Definition::OnEdge(edge, cut) => {
                let (a, b) = edge.ends();
                let along = (a[axis] == b[axis]).then(|| 2 * a[axis]);
                along.or_else(|| cut.doubled_coordinate(axis))
            }
            Definition::Meet(planes) => planes.iter().find_map(|p| p.doubled_coordinate(axis)),
            Definition::Homogeneous(_) => None,
        }
    }

    /// The fingerprint of the point, which does not depend on the construction.
    pub fn key(&self) -> VertexKey {
        match &self.definition {
            Definition::Lattice(p) => VertexKey(p.map(|c| residue::<P1>(c.into()))),
            _ => VertexKey(self.exact().residues()),
        }
    }
}

/// The meet of an edge parallel to an axis with a plane across that axis, if it is a lattice point; else
/// `None`.
fn edge_on_lattice(edge: &LatticeEdge, cut: &Plane) -> Option<Lattice> {
    let axis = cut.only_axis()?;
    let (a, b) = edge.ends();
    let parallel = (0..3).all(|i| (i == axis) != (a[i] == b[i]));
    let mut point = *a;
    point[axis] = cut.lattice_coordinate(axis).filter(|_| parallel)?;
    Some(point)
}

/// The meet of three planes perpendicular to the three axes, if it is a lattice point; else `None`.
fn meet_on_lattice(planes: [&Plane; 3]) -> Option<Lattice> {
    let mut point = [None; 3];
    for plane in planes {
        let axis = plane.only_axis()?;
        point[axis] = Some(plane.lattice_coordinate(axis)?);
    }
    Some([point[0]?, point[1]?, point[2]?])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Lattice points, of which half lie near the origin and half anywhere.
    fn point() -> impl Strategy<Value = Lattice> {
        const LIMIT: i64 = (1 << 53) - 1;
        let coordinate = || prop_oneof![3 => -3i64..=3, 1 => -LIMIT..=LIMIT, 1 => Just(LIMIT)];
        [coordinate(), coordinate(), coordinate()]
    }

    proptest! {
        #[test]
        fn points_lie_beside_edges_as_beside_the_planes_through_them(
            [a, b, p, q] in [point(), point(), point(), point()], axis in 0..3usize, at in -4i64..=4,
        ) {
            let edge = LatticeEdge::new(a, b);
            let plane = Plane::beside_edge(&a, &b, axis);
            let cut = Arc::new(Plane::axis_cut(axis, at));
            let crossing = Vertex::on_edge(&LatticeEdge::new(p, q), &cut);
            // Doubles cannot decide the side of a point of the edge itself.
            let own = Vertex::on_edge(&edge, &cut);
            for at in [Some(Vertex::lattice(p)), crossing, own].into_iter().flatten() {
                prop_assert_eq!(at.side_of_edge(&edge, axis), at.side_of(&plane));
            }
        }
    }
}
