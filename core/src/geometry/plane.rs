//! Oriented planes with coprime integer coefficients.

use super::axes::each_axis;
use super::side::{Half, Orientation, Side};
use crate::arith::bounds::{
    self, COORDINATE_BITS, HALF_SPACE_NORMAL_BITS, SHORT_NORMAL_BITS, SHORT_OFFSET_BITS,
};
use crate::arith::convert::{as_double, as_whole};
use crate::arith::{gcd_u128, Int, Sign};

/// A lattice point: three integer coordinates in lattice steps, each below 2^53 in magnitude.
pub type Lattice = [i64; 3];

/// An oriented plane n·x + d = 0; the minus side (negative values) is its inside.
///
/// The coefficients have no common divisor: equal oriented planes have equal coefficients.
///
/// # Bits
/// Planes through three lattice points have |n| < 2^108, |d| < 2^161 (`arith::bounds`).
///
/// # Example
/// ```
/// use bspcsg::geometry::plane::Plane;
/// use bspcsg::geometry::side::Side;
///
/// // Counterclockwise from above: the minus side, the inside, is below.
/// let floor = Plane::through(&[0, 0, 5], &[1, 0, 5], &[0, 1, 5]).expect("not on one line");
/// assert_eq!(floor.normal(), &[0, 0, 1]);
/// assert_eq!(floor.side_of_lattice(&[7, 7, 4]), Side::Minus);
/// assert_eq!(floor.side_of_lattice(&[7, 7, 5]), Side::On);
/// ```
#[derive(Clone, Debug)]
pub struct Plane {
    n: [i128; 3],
    d: Int<3>,
    approx: [f64; 4],
}

/// The coefficients of a short plane, one whose coefficients fit machine words; nearly all planes are short.
///
/// # Bits
/// |n| < 2^62, |d| < 2^124 (`arith::bounds`).
#[derive(Clone, Copy, Debug)]
pub struct ShortPlane {
    /// The normal's three components.
    pub n: [i64; 3],
    /// The constant term d of n·x + d = 0.
    pub d: i128,
}

impl ShortPlane {
    /// The plane's value at a lattice point.
    pub fn value_at(&self, p: &Lattice) -> i128 {
        dot_short(&self.n, p) + self.d
    }
}

impl PartialEq for Plane {
    fn eq(&self, other: &Self) -> bool {
        self.n == other.n && self.d == other.d
    }
}

impl Eq for Plane {}

impl std::hash::Hash for Plane {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.n.hash(state);
        self.d.hash(state);
    }
}

impl Plane {
    /// The plane with these coefficients, divided by their greatest common divisor.
    ///
    /// Returns `None` if the normal is zero.
    pub fn new(n: [i128; 3], d: Int<3>) -> Option<Self> {
        let g = n.iter().fold(0, |g, c| gcd_u128(g, c.unsigned_abs()));
        if g == 0 {
            return None;
        }
        let g = if g == 1 {
            1
        } else {
            gcd_u128(g, d.rem_u128(g))
        };
        if g == 1 {
            return Some(Self::primitive(n, d));
        }
        let divisor = i128::try_from(g).ok()?;
        Some(Self::primitive(n.map(|c| c / divisor), d.div_exact_u128(g)))
    }

    fn primitive(n: [i128; 3], d: Int<3>) -> Self {
        let approx = [
            nearest_double(n[0]),
            nearest_double(n[1]),
            nearest_double(n[2]),
            d.to_f64(),
        ];
        Self { n, d, approx }
    }

    /// The plane through the corners of a lattice triangle, its normal by the right-hand rule.
    ///
    /// Returns `None` if the triangle has no area.
    pub fn through(a: &Lattice, b: &Lattice, c: &Lattice) -> Option<Self> {
        let n = normal(a, b, c);
        let level = |i: &usize| a[*i] == b[*i] && b[*i] == c[*i];
        match (0..3).find(level) {
            Some(axis) => Self::axis_plane(axis, a[axis], Sign::of(n[axis])),
            None => Self::new(n, -dot_lattice(&n, a)),
        }
    }

    /// The plane across an axis at a lattice coordinate, its normal pointing along the axis with this sign;
    /// `None` if the sign is zero.
    fn axis_plane(axis: usize, at: i64, sign: Sign) -> Option<Self> {
        let plane = Self::axis_cut(axis, 2 * at);
        match sign {
            Sign::Zero => None,
            Sign::Positive => Some(plane),
            Sign::Negative => Some(plane.flipped()),
        }
    }

    /// The plane that contains a lattice edge and is parallel to an axis; `None` if the edge itself is
    /// parallel to that axis.
    ///
    /// The coefficients of such a plane have fewer bits than those of a plane through the edge and along a
    /// face's normal.
    pub fn through_edge(a: &Lattice, b: &Lattice, axis: usize) -> Option<Self> {
        let n = edge_normal(a, b, axis);
        Self::new(n, -dot_lattice(&n, a))
    }

    /// The plane that contains a lattice edge and is parallel to an axis, for side tests only: its
    /// coefficients may have a common divisor.
    pub fn beside_edge(a: &Lattice, b: &Lattice, axis: usize) -> Self {
        let n = edge_normal(a, b, axis);
        Self::primitive(n, -dot_lattice(&n, a))
    }

    /// The plane with this normal through a lattice point; `None` if the normal is zero.
    pub fn through_point(n: [i128; 3], p: &Lattice) -> Option<Self> {
        Self::new(n, -dot_lattice(&n, p))
    }

    /// The plane n·x = offset, with smaller values on its minus side, if it may meet the lattice.
    ///
    /// Returns `None` if the offset is too large for that, or if the normal is zero or has a component of
    /// [`HALF_SPACE_NORMAL_BITS`] bits or more.
    pub fn across_lattice(n: [i128; 3], offset: &Int<3>) -> Option<Self> {
        let wide = |c: &i128| c.unsigned_abs() >= 1 << HALF_SPACE_NORMAL_BITS;
        if n.iter().any(wide) {
            return None;
        }
        let size = n.iter().map(|c| c.abs()).sum();
        let reach: Int<3> = Int::<2>::from_i128(size).mul_i64(1 << COORDINATE_BITS);
        if offset.abs() < reach {
            Self::new(n, -*offset)
        } else {
            None
        }
    }

    /// The plane 2·x = `doubled` across an axis; smaller coordinates are on its minus side.
    pub fn axis_cut(axis: usize, doubled: i64) -> Self {
        let mut n = [0i128; 3];
        let even = doubled % 2 == 0;
        n[axis] = if even { 1 } else { 2 };
        let d = if even { doubled / 2 } else { doubled };
        Self::primitive(n, -Int::from_i64(d))
    }

    /// The normal's three components.
    pub fn normal(&self) -> &[i128; 3] {
        &self.n
    }

    /// The constant term d of n·x + d = 0.
    pub fn offset(&self) -> &Int<3> {
        &self.d
    }

    /// The coefficients in machine words if they are short enough, else `None`.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "only used if they are short"
    )]
    pub fn short(&self) -> Option<ShortPlane> {
        let fits = |c: &i128, bits: u32| c.unsigned_abs() < 1 << bits;
        let d = self.d.to_i128().filter(|d| fits(d, SHORT_OFFSET_BITS))?;
        let [x, y, z] = &self.n;
        let short = [x, y, z].iter().all(|c| fits(c, SHORT_NORMAL_BITS));
        let n = [*x as i64, *y as i64, *z as i64];
        short.then_some(ShortPlane { n, d })
    }

    /// The coefficients rounded to doubles, each within one half unit in the last place.
    pub fn approx(&self) -> &[f64; 4] {
        &self.approx
    }

    /// The same plane with its sides exchanged.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            n: self.n.map(|c| -c),
            d: -self.d,
            approx: self.approx.map(|c| -c),
        }
    }

    /// Return how this plane is oriented to another if both are the same set of points, else `None`.
    #[allow(clippy::float_cmp)]
    pub fn coincides(&self, other: &Self) -> Option<Orientation> {
        // Equal coefficients have equal doubles; these differ for most planes.
        if (0..4).any(|i| self.approx[i].abs() != other.approx[i].abs()) {
            return None;
        }
        if self == other {
            return Some(Orientation::Same);
        }
        let opposite = (0..3).all(|i| self.n[i] == -other.n[i]) && self.d == -other.d;
        opposite.then_some(Orientation::Opposite)
    }

    /// The axis to which the plane is perpendicular, or `None`.
    pub fn only_axis(&self) -> Option<usize> {
        match self.n {
            [_, 0, 0] => Some(0),
            [0, _, 0] => Some(1),
            [0, 0, _] => Some(2),
            _ => None,
        }
    }

    /// The coordinate of a plane perpendicular to `axis`, if it is a lattice coordinate; else `None`.
    pub fn lattice_coordinate(&self, axis: usize) -> Option<i64> {
        let at = -self.d.to_f64();
        // Below 2^53 in magnitude the double is exact.
        let exact = at.abs() < as_double(1u64 << COORDINATE_BITS);
        match self.n[axis] {
            1 if exact => Some(as_whole(at)),
            -1 if exact => Some(as_whole(-at)),
            _ => None,
        }
    }

    /// Twice the coordinate of a plane perpendicular to `axis`, if the plane lies on the lattice or halfway
    /// between lattice planes; else `None`.
    pub fn doubled_coordinate(&self, axis: usize) -> Option<i64> {
        let lead = self.n[axis];
        let short = lead.unsigned_abs() <= 2 && self.only_axis() == Some(axis);
        let offset = short.then(|| self.d.narrow::<1>()).flatten()?;
        let doubled = -2 * offset.to_i128()? / lead;
        i64::try_from(doubled).ok()
    }

    /// The axis along which the normal has the largest component; the first one of equals.
    pub fn main_axis(&self) -> usize {
        let size = |i: usize| self.n[i].unsigned_abs();
        let best = usize::from(size(1) > size(0));
        if size(2) > size(best) {
            2
        } else {
            best
        }
    }

    /// The side of the plane on which a lattice point lies, exactly.
    pub fn side_of_lattice(&self, p: &Lattice) -> Side {
        let a = &self.approx;
        let t = [
            a[0] * as_double(p[0]),
            a[1] * as_double(p[1]),
            a[2] * as_double(p[2]),
        ];
        let sum = t[0] + t[1] + t[2] + self.approx[3];
        let size = t[0].abs() + t[1].abs() + t[2].abs() + self.approx[3].abs();
        if sum.abs() > size * FILTER {
            return if sum > 0.0 { Side::Plus } else { Side::Minus };
        }
        Side::from_sign(self.value_at(p).sign())
    }

    /// The plane's value at a lattice point.
    pub fn value_at(&self, p: &Lattice) -> Int<3> {
        match self.short() {
            Some(short) => Int::from_i128(short.value_at(p)),
            None => dot_lattice(&self.n, p) + self.d,
        }
    }

    /// Twice the plane's value at the point `doubled` / 2, in doubles, and a bound on its error.
    pub fn near_value_at_doubled(&self, doubled: &Lattice) -> (f64, f64) {
        let (a, p) = (&self.approx, doubled);
        let t = [
            a[0] * as_double(p[0]),
            a[1] * as_double(p[1]),
            a[2] * as_double(p[2]),
        ];
        let twice = 2.0 * self.approx[3];
        let size = t[0].abs() + t[1].abs() + t[2].abs() + twice.abs();
        (t[0] + t[1] + t[2] + twice, size * FILTER)
    }

    /// The half-space in which the point `doubled` / 2 + (ε, ε², ε³) lies, for an infinitely small ε > 0.
    pub fn side_of_corner(&self, doubled: &Lattice) -> Half {
        let (value, doubt) = self.near_value_at_doubled(doubled);
        if value.abs() > doubt {
            return if value > 0.0 { Half::Plus } else { Half::Minus };
        }
        Half::from_sign(match self.value_at_doubled(doubled).sign() {
            Sign::Zero => first_sign(&self.n),
            sign => sign,
        })
    }

    /// Twice the plane's exact value at the point `doubled` / 2.
    pub fn value_at_doubled(&self, doubled: &Lattice) -> Int<3> {
        dot_lattice(&self.n, doubled) + self.d + self.d
    }

    /// The image of the plane under x ↦ s·x, for a positive integer s, as when the lattice is refined.
    ///
    /// Returns `None` if the coefficients leave their width.
    pub fn scaled(&self, s: i64) -> Option<Self> {
        let wide: Int<4> = self.d.mul(&Int::<1>::from_i64(s));
        Self::new(self.n, if_it_fits(wide.narrow()?)?)
    }

    /// The image of the plane under a lattice motion: a signed permutation of the axes, then a translation.
    ///
    /// Returns `None` if the coefficients leave their width.
    pub fn moved(&self, axes: &[(usize, i64); 3], shift: &Lattice) -> Option<Self> {
        let n = each_axis(|i| self.n[axes[i].0] * i128::from(axes[i].1));
        Self::new(n, if_it_fits(self.d - dot_lattice(&n, shift))?)
    }
}

/// The offset if it is not wider than offsets of planes may be, else `None`.
fn if_it_fits(d: Int<3>) -> Option<Int<3>> {
    (d.bit_length() <= bounds::offset(COORDINATE_BITS)).then_some(d)
}

/// The relative error bound of a filter: a sum of four products of rounded factors, in doubles.
///
/// Each factor has one rounding (u = 2^-53), the product one, the sum of four terms three: at most 6u +
/// O(u²) relative to the sum of magnitudes; 9u leaves room for the bound's own rounding.
pub const FILTER: f64 = 9.0 / 9_007_199_254_740_992.0;

/// The sign of the first non-zero component; zero if all are zero.
pub fn first_sign(n: &[i128; 3]) -> Sign {
    Sign::first(n.map(Sign::of))
}

/// The normal (b − a) × (c − a) of a lattice triangle, in lattice steps.
pub fn normal(a: &Lattice, b: &Lattice, c: &Lattice) -> [i128; 3] {
    let (u, v) = (step(a, b), step(a, c));
    let minor = |i: usize, j: usize| {
        i128::from(u[i]) * i128::from(v[j]) - i128::from(u[j]) * i128::from(v[i])
    };
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

fn step(from: &Lattice, to: &Lattice) -> [i64; 3] {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

/// The normal of the plane that contains an edge and is parallel to an axis.
fn edge_normal(a: &Lattice, b: &Lattice, axis: usize) -> [i128; 3] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut n = [0i128; 3];
    n[u] = i128::from(b[v]) - i128::from(a[v]);
    n[v] = i128::from(a[u]) - i128::from(b[u]);
    n
}

/// The double nearest to an integer; one machine instruction if the integer fits an `i64`.
fn nearest_double(value: i128) -> f64 {
    i64::try_from(value).map_or_else(|_| as_double(value), as_double)
}

fn dot_lattice(n: &[i128; 3], p: &Lattice) -> Int<3> {
    if let (Ok(x), Ok(y), Ok(z)) = (n[0].try_into(), n[1].try_into(), n[2].try_into()) {
        return Int::from_i128(dot_short(&[x, y, z], p));
    }
    let term = |i: usize| Int::<2>::from_i128(n[i]).mul::<1, 3>(&Int::from_i64(p[i]));
    term(0) + term(1) + term(2)
}

/// The dot product of a short normal and a lattice point or doubled lattice point, below 2^119: 63 bits of a
/// component, 54 of a doubled coordinate, a sum of three.
fn dot_short(n: &[i64; 3], p: &Lattice) -> i128 {
    let term = |i: usize| i128::from(n[i]) * i128::from(p[i]);
    term(0) + term(1) + term(2)
}
