//! Exact points: lattice points and meets of three planes, in homogeneous coordinates.

use std::cmp::Ordering;

use super::plane::{Lattice, Plane, FILTER};
use super::residue::residue;
use crate::arith::{inv_mod, mul_mod, Int, P1};

/// An exact point (x/w, y/w, z/w) with w > 0.
///
/// # Bits
/// x, y, z below 2^379, w below 2^326 (`arith::bounds`).
#[derive(Clone, Debug)]
pub struct Vertex {
    place: Place,
    approx: [f64; 4],
}

#[derive(Clone, Debug)]
enum Place {
    Lattice(Lattice),
    Meet(Box<Homogeneous>),
}

/// Homogeneous coordinates, w > 0.
#[derive(Clone, Debug)]
pub struct Homogeneous {
    /// x, y and z times w.
    pub x: [Int<6>; 3],
    /// The positive denominator.
    pub w: Int<6>,
}

/// A fingerprint that equal points share; unequal points differ but for chance 2^-183.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct VertexKey([u64; 3]);

impl Vertex {
    /// The vertex at a lattice point.
    pub fn lattice(p: Lattice) -> Self {
        Self {
            approx: [p[0] as f64, p[1] as f64, p[2] as f64, 1.0],
            place: Place::Lattice(p),
        }
    }

    /// The meet of three planes; `None` if they have no single common point.
    pub fn meet(a: &Plane, b: &Plane, c: &Plane) -> Option<Self> {
        if let Some(point) = meet_on_lattice([a, b, c]) {
            return Some(Self::lattice(point));
        }
        for (cut, p, q) in [(c, a, b), (b, a, c), (a, b, c)] {
            if let Some(axis) = cut.only_axis() {
                return Self::meet_on_axis_cut(cut, axis, p, q);
            }
        }
        let bc = cross(b.normal(), c.normal());
        let ca = cross(c.normal(), a.normal());
        let ab = cross(a.normal(), b.normal());
        let term = |i: usize| -> Int<6> { Int::<2>::from_i128(a.normal()[i]).mul(&bc[i]) };
        let w = term(0) + term(1) + term(2);
        let x = [0, 1, 2].map(|i| {
            let p: Int<6> = a.offset().mul(&bc[i]);
            let q: Int<6> = b.offset().mul(&ca[i]);
            let r: Int<6> = c.offset().mul(&ab[i]);
            p + q + r
        });
        match w.signum() {
            0 => None,
            1 => Some(Self::homogeneous(x.map(|v| -v), w)),
            _ => Some(Self::homogeneous(x, -w)),
        }
    }

    /// The meet of a lattice edge's line with a plane; `None` if they are parallel.
    ///
    /// # Bits
    /// The denominator is a difference of two values at lattice points, far below that of three
    /// planes.
    pub fn on_edge(a: &Lattice, b: &Lattice, cut: &Plane) -> Option<Self> {
        let (va, vb) = (cut.value_at(a), cut.value_at(b));
        let w = vb - va;
        let x = [0, 1, 2].map(|i| -> Int<6> {
            let difference: Int<4> = vb.mul_i64::<4>(a[i]) - va.mul_i64::<4>(b[i]);
            difference.widen()
        });
        match w.signum() {
            0 => None,
            1 => Some(Self::homogeneous(x, w.widen())),
            _ => Some(Self::homogeneous(x.map(|c| -c), (-w).widen())),
        }
    }

    /// The meet of two planes with an axis-parallel one, by 2×2 determinants.
    fn meet_on_axis_cut(cut: &Plane, axis: usize, p: &Plane, q: &Plane) -> Option<Self> {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let lead = cut.normal()[axis];
        let reduced = |plane: &Plane| -> Int<5> {
            let here: Int<5> = plane.offset().mul_i128(lead);
            let there: Int<5> = cut.offset().mul_i128(plane.normal()[axis]);
            here - there
        };
        let (d, e) = (reduced(p), reduced(q));
        let (n, m) = (p.normal(), q.normal());
        let minor = product(n[u], m[v]) - product(n[v], m[u]);
        let w: Int<6> = minor.mul_i128(lead);
        let mut x = [Int::<6>::ZERO; 3];
        x[axis] = cut.offset().mul(&minor);
        x[u] = d.mul_i128::<6>(m[v]) - e.mul_i128::<6>(n[v]);
        x[v] = e.mul_i128::<6>(n[u]) - d.mul_i128::<6>(m[u]);
        match w.signum() {
            0 => None,
            1 => Some(Self::homogeneous(x.map(|c| -c), w)),
            _ => Some(Self::homogeneous(x, -w)),
        }
    }

    /// The vertex with these homogeneous coordinates; w must be positive.
    pub fn homogeneous(x: [Int<6>; 3], w: Int<6>) -> Self {
        let approx = [x[0].to_f64(), x[1].to_f64(), x[2].to_f64(), w.to_f64()];
        let place = Place::Meet(Box::new(Homogeneous { x, w }));
        Self { place, approx }
    }

    /// The lattice point this vertex was made from, if it was.
    pub fn as_lattice(&self) -> Option<&Lattice> {
        match &self.place {
            Place::Lattice(p) => Some(p),
            Place::Meet(_) => None,
        }
    }

    /// The homogeneous coordinates.
    pub fn coordinates(&self) -> Homogeneous {
        match &self.place {
            Place::Lattice(p) => Homogeneous {
                x: p.map(Int::from_i64),
                w: Int::ONE,
            },
            Place::Meet(h) => (**h).clone(),
        }
    }

    /// The point in doubles, each coordinate within two units in the last place.
    pub fn approx(&self) -> [f64; 3] {
        let [x, y, z, w] = self.approx;
        [x / w, y / w, z / w]
    }

    /// Sign of the plane's value here: -1 minus side, 0 on, +1 plus side.
    pub fn side_of(&self, plane: &Plane) -> i32 {
        match &self.place {
            Place::Lattice(p) => plane.side_of_lattice(p),
            Place::Meet(h) => self
                .filtered_side(plane)
                .unwrap_or_else(|| exact_side(h, plane)),
        }
    }

    /// The plane's value here times a positive number, in doubles, and a bound of its error.
    pub fn near_value(&self, plane: &Plane) -> (f64, f64) {
        let a = plane.approx();
        let t = [0, 1, 2, 3].map(|i| a[i] * self.approx[i]);
        let size = t[0].abs() + t[1].abs() + t[2].abs() + t[3].abs();
        (t[0] + t[1] + t[2] + t[3], size * FILTER)
    }

    /// The plane's value here times the denominator.
    pub fn value(&self, plane: &Plane) -> Int<8> {
        exact_value(&self.coordinates(), plane)
    }

    fn filtered_side(&self, plane: &Plane) -> Option<i32> {
        let (value, doubt) = self.near_value(plane);
        (value.abs() > doubt).then_some(if value > 0.0 { 1 } else { -1 })
    }

    /// Order of two points by one coordinate.
    pub fn compare(&self, other: &Self, axis: usize) -> Ordering {
        if let (Place::Lattice(p), Place::Lattice(q)) = (&self.place, &other.place) {
            return p[axis].cmp(&q[axis]);
        }
        let left = self.approx[axis] * other.approx[3];
        let right = other.approx[axis] * self.approx[3];
        if (left - right).abs() > (left.abs() + right.abs()) * FILTER {
            return left.partial_cmp(&right).unwrap_or(Ordering::Equal);
        }
        let (p, q) = (self.coordinates(), other.coordinates());
        let left: Int<12> = p.x[axis].mul(&q.w);
        let right: Int<12> = q.x[axis].mul(&p.w);
        left.cmp(&right)
    }

    /// Whether two vertices are the same point.
    pub fn same(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.compare(other, axis) == Ordering::Equal)
    }

    /// The key shared by all representations of this point.
    pub fn key(&self) -> VertexKey {
        match &self.place {
            Place::Lattice(p) => VertexKey(p.map(|c| residue(c.into()))),
            Place::Meet(h) => meet_key(h),
        }
    }
}

/// The meet of three planes perpendicular to the three axes, if it is a lattice point.
fn meet_on_lattice(planes: [&Plane; 3]) -> Option<Lattice> {
    let mut point = [None; 3];
    for plane in planes {
        let axis = plane.only_axis()?;
        point[axis] = Some(plane.lattice_coordinate(axis)?);
    }
    Some([point[0]?, point[1]?, point[2]?])
}

fn meet_key(h: &Homogeneous) -> VertexKey {
    let w = h.w.rem_u61(P1);
    if w == 0 {
        return VertexKey([u64::MAX; 3]);
    }
    let inverse = inv_mod(w, P1);
    VertexKey([0, 1, 2].map(|i| mul_mod(h.x[i].rem_u61(P1), inverse, P1)))
}

fn exact_side(h: &Homogeneous, plane: &Plane) -> i32 {
    exact_value(h, plane).signum()
}

fn exact_value(h: &Homogeneous, plane: &Plane) -> Int<8> {
    let term = |i: usize| -> Int<8> { h.x[i].mul(&Int::<2>::from_i128(plane.normal()[i])) };
    let last: Int<8> = h.w.mul(plane.offset());
    term(0) + term(1) + term(2) + last
}

/// The cross product of two normals, exact: components below 2^217.
pub fn cross(a: &[i128; 3], b: &[i128; 3]) -> [Int<4>; 3] {
    [
        product(a[1], b[2]) - product(a[2], b[1]),
        product(a[2], b[0]) - product(a[0], b[2]),
        product(a[0], b[1]) - product(a[1], b[0]),
    ]
}

/// The product of two normal components; one machine multiplication where both are short.
fn product(a: i128, b: i128) -> Int<4> {
    match (i64::try_from(a), i64::try_from(b)) {
        (Ok(a), Ok(b)) => Int::from_i128(i128::from(a) * i128::from(b)),
        _ => Int::<2>::from_i128(a).mul(&Int::<2>::from_i128(b)),
    }
}
