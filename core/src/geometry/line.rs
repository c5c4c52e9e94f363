//! Fingerprints of lines, which do not depend on the planes or edges that define a line.

use num_bigint::BigInt;
use num_integer::Integer;
use smallvec::SmallVec;

use super::axes::each_axis;
use super::plane::{normal, Lattice, Plane};
use super::residue::{mul, reduce, residue};
use super::unbounded::big;
use crate::arith::{inv_mod, P1, P2};

/// The fingerprint of a line: its Plücker coordinates up to scale, modulo two primes.
///
/// Equal lines have equal keys.
///
/// # Bits
/// Two lines through lattice points have the same key only if they are the same: for primitive directions d
/// and e below 2^54, d × e is below 2^109, and so is (p − q) × d for points p and q of parallel lines;
/// P1·P2 divides neither unless it is zero. Two other lines share a key with probability 2^-488 (four
/// degrees of freedom, 122 bits each).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LineKey {
    first: [u64; 6],
    second: [u64; 6],
}

/// A line by its Plücker coordinates modulo the primes `P1` and `P2`.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    first: Pluecker<P1>,
    second: Pluecker<P2>,
}

/// Plücker coordinates of a line modulo a prime, up to a common factor; not all are zero.
#[derive(Clone, Copy, Debug)]
struct Pluecker<const P: u64> {
    direction: [u64; 3],
    moment: [u64; 3],
}

/// A plane by its coefficients modulo the primes `P1` and `P2`, together with its exact form.
#[derive(Clone, Copy, Debug)]
pub struct PlaneResidues<'a> {
    first: Coefficients<P1>,
    second: Coefficients<P2>,
    exact_plane: ExactPlane<'a>,
}

/// A plane's coefficients modulo the prime `P`, up to a common factor.
#[derive(Clone, Copy, Debug)]
struct Coefficients<const P: u64> {
    normal: [u64; 3],
    offset: u64,
}

/// The exact form of a plane: three lattice points on it, or its coefficients.
#[derive(Clone, Copy, Debug)]
enum ExactPlane<'a> {
    Corners([Lattice; 3]),
    Plane(&'a Plane),
}

impl<const P: u64> Coefficients<P> {
    fn through(normal: &[i128; 3], on: &Lattice) -> Self {
        let normal = normal.map(residue::<P>);
        let terms = each_axis(|i| {
            let negative = sub::<P>(0, normal[i]);
            u128::from(negative) * u128::from(residue::<P>(on[i].into()))
        });
        Self {
            normal,
            offset: reduce::<P>(terms.iter().sum()),
        }
    }

    fn of(plane: &Plane) -> Self {
        let offset = plane.offset();
        let short = offset.to_i128().map(residue::<P>);
        Self {
            normal: plane.normal().map(residue::<P>),
            offset: short.unwrap_or_else(|| offset.rem_u61(P)),
        }
    }
}

impl<'a> PlaneResidues<'a> {
    /// The residues of the plane through three lattice points; its coefficients may have a common factor.
    pub fn through(corners: &[Lattice; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = normal(a, b, c);
        Self {
            first: Coefficients::through(&normal, a),
            second: Coefficients::through(&normal, a),
            exact_plane: ExactPlane::Corners(*corners),
        }
    }

    /// The residues of the coefficients of a plane.
    pub fn of(plane: &'a Plane) -> Self {
        Self {
            first: Coefficients::of(plane),
            second: Coefficients::of(plane),
            exact_plane: ExactPlane::Plane(plane),
        }
    }

    /// The exact coefficients of the plane, up to a common factor: the three of the normal, then the offset.
    fn exact(&self) -> [BigInt; 4] {
        let of_plane = |plane: &Plane| {
            let [x, y, z] = plane.normal().map(BigInt::from);
            [x, y, z, big(plane.offset())]
        };
        match &self.exact_plane {
            ExactPlane::Plane(plane) => of_plane(plane),
            ExactPlane::Corners([a, b, c]) => {
                let plane = Plane::through(a, b, c);
                of_plane(&plane.expect("a face has an area"))
            }
        }
    }
}

impl<const P: u64> Pluecker<P> {
    fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        let residues = |point: &Lattice| point.map(|c| residue::<P>(c.into()));
        let p = residues(a);
        if let Some(direction) = unit_along(a, b) {
            let moment = cross::<P>(&p, &direction);
            return Self { direction, moment };
        }
        let q = residues(b);
        Self {
            direction: each_axis(|i| sub::<P>(q[i], p[i])),
            moment: cross::<P>(&p, &q),
        }
    }

    /// The line in which two planes meet, or `None` if the prime divides all of its coordinates.
    fn of_planes(a: &Coefficients<P>, b: &Coefficients<P>) -> Option<Self> {
        let (n, m) = (&a.normal, &b.normal);
        let line = Self {
            direction: cross::<P>(n, m),
            moment: each_axis(|i| minor::<P>(a.offset, m[i], b.offset, n[i])),
        };
        (line.first_nonzero() != 0).then_some(line)
    }

    /// The residues of a line's exact Plücker coordinates, which must have no common divisor.
    fn of_exact(coordinates: &[BigInt; 6]) -> Self {
        let prime = BigInt::from(P);
        let small = |k: usize| {
            coordinates[k]
                .mod_floor(&prime)
                .iter_u64_digits()
                .next()
                .unwrap_or(0)
        };
        Self {
            direction: each_axis(small),
            moment: each_axis(|i| small(3 + i)),
        }
    }

    /// The first Plücker coordinate that is not zero.
    fn first_nonzero(&self) -> u64 {
        let mut all = self.direction.iter().chain(&self.moment);
        all.find(|c| **c != 0).copied().unwrap_or(0)
    }

    /// The six Plücker coordinates, each times `scale`: with the inverse of the first nonzero one, it becomes
    /// 1.
    fn scaled(&self, scale: u64) -> [u64; 6] {
        let ([u, v, w], [x, y, z]) = (self.direction, self.moment);
        [u, v, w, x, y, z].map(|c| mul::<P>(c, scale))
    }

    /// The Plücker coordinates of several lines, each scaled so that its first nonzero one is 1; takes one
    /// modular inversion in all.
    fn all_scaled(lines: impl Iterator<Item = Self>) -> SmallVec<[[u64; 6]; 8]> {
        let mut product = 1;
        let before: SmallVec<[(Self, u64); 8]> = lines
            .map(|line| {
                let so_far = product;
                product = mul::<P>(product, line.first_nonzero());
                (line, so_far)
            })
            .collect();
        let mut inverse = inv_mod(product, P);
        let mut scaled: SmallVec<[[u64; 6]; 8]> = SmallVec::with_capacity(before.len());
        for (line, so_far) in before.iter().rev() {
            scaled.push(line.scaled(mul::<P>(inverse, *so_far)));
            inverse = mul::<P>(inverse, line.first_nonzero());
        }
        scaled.reverse();
        scaled
    }
}

impl Line {
    /// The line through two lattice points.
    pub fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        Self {
            first: Pluecker::of_edge(a, b),
            second: Pluecker::of_edge(a, b),
        }
    }

    /// The line in which two different, non-parallel planes meet.
    pub fn of_planes(a: &PlaneResidues, b: &PlaneResidues) -> Self {
        let first = Pluecker::of_planes(&a.first, &b.first);
        let second = Pluecker::of_planes(&a.second, &b.second);
        match (first, second) {
            (Some(first), Some(second)) => Self { first, second },
            _ => Self::of_exact(&a.exact(), &b.exact()),
        }
    }

    /// The line in which two planes meet, from their exact coefficients; used if a prime divides all
    /// coordinates.
    #[cold]
    fn of_exact(a: &[BigInt; 4], b: &[BigInt; 4]) -> Self {
        let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
        let all = [
            minor(1, 2),
            minor(2, 0),
            minor(0, 1),
            minor(3, 0),
            minor(3, 1),
            minor(3, 2),
        ];
        let divisor = all.iter().fold(BigInt::ZERO, |g, c| g.gcd(c));
        let primitive = all.map(|c| c / &divisor);
        Self {
            first: Pluecker::of_exact(&primitive),
            second: Pluecker::of_exact(&primitive),
        }
    }
}

impl LineKey {
    /// The key of the line through two lattice points.
    pub fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        Self::of(&Line::of_edge(a, b))
    }

    /// The key of the line in which two planes meet.
    pub fn of_planes(a: &Plane, b: &Plane) -> Self {
        Self::of(&Line::of_planes(
            &PlaneResidues::of(a),
            &PlaneResidues::of(b),
        ))
    }

    /// The key of a line that is given modulo both primes.
    pub fn of(line: &Line) -> Self {
        Self {
            first: line.first.scaled(inv_mod(line.first.first_nonzero(), P1)),
            second: line.second.scaled(inv_mod(line.second.first_nonzero(), P2)),
        }
    }

    /// The keys of several lines, computed with a single modular inversion for each prime.
    pub fn of_all(lines: impl Iterator<Item = Line>) -> SmallVec<[Self; 8]> {
        let lines: SmallVec<[Line; 8]> = lines.collect();
        let first = Pluecker::all_scaled(lines.iter().map(|line| line.first));
        let second = Pluecker::all_scaled(lines.iter().map(|line| line.second));
        let pairs = first.into_iter().zip(second);
        pairs
            .map(|(first, second)| Self { first, second })
            .collect()
    }

    /// A 64-bit hash of the key, for sorting: equal keys have equal hashes, different keys rarely do.
    pub fn line_hash(&self) -> u64 {
        // Odd constants of SplitMix (Steele, Lea, Flood 2014) keep small coordinates apart.
        let [_, v, w, x, y, z] = self.first;
        let first = v.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(x);
        let second = w.wrapping_mul(0xbf58_476d_1ce4_e5b9).wrapping_add(y);
        let third = first.wrapping_add(second.rotate_left(32));
        third
            .wrapping_mul(0x94d0_49bb_1331_11eb)
            .wrapping_add(z)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    /// The first axis to which the line is not perpendicular: points on the line can be ordered by this
    /// coordinate.
    pub fn axis(&self) -> usize {
        let mut axes = 0..3;
        axes.find(|i| self.first[*i] != 0 || self.second[*i] != 0)
            .unwrap_or(0)
    }
}

/// The unit direction of an edge parallel to an axis, which needs no modular inversion; `None` for other
/// edges.
fn unit_along(a: &Lattice, b: &Lattice) -> Option<[u64; 3]> {
    let along = each_axis(|i| u64::from(a[i] != b[i]));
    (along.iter().sum::<u64>() == 1).then_some(along)
}

fn sub<const P: u64>(a: u64, b: u64) -> u64 {
    if a >= b {
        a - b
    } else {
        a + P - b
    }
}

/// The difference a·d − c·b of products of residues, with one reduction modulo `P`.
fn minor<const P: u64>(a: u64, d: u64, c: u64, b: u64) -> u64 {
    // Products of residues are below the square of P, so that nothing overflows.
    let square = const { P as u128 * P as u128 };
    reduce::<P>(u128::from(a) * u128::from(d) + (square - u128::from(c) * u128::from(b)))
}

fn cross<const P: u64>(a: &[u64; 3], b: &[u64; 3]) -> [u64; 3] {
    let term = |i: usize, j: usize| minor::<P>(a[i], b[j], a[j], b[i]);
    [term(1, 2), term(2, 0), term(0, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::Int;

    #[test]
    fn parallel_edges_that_a_prime_cannot_tell_apart_have_keys_of_their_own() {
        // (1, 2^30, 0) x (2^31, 1, 0) = (0, 0, 1 - 2^61).
        let one = LineKey::of_edge(&[0; 3], &[1 << 31, 1, 0]);
        let other = LineKey::of_edge(&[1, 1 << 30, 0], &[1 + (1 << 31), 1 + (1 << 30), 0]);
        assert_eq!(one.first, other.first);
        assert_ne!(one, other);
    }

    #[test]
    fn a_prime_may_divide_all_coordinates_of_a_meet() {
        // The normals (2^31, 1, 0) and (1, 2^30, 0) have the product (0, 0, 2^61 - 1).
        let plane = |n: [i128; 3], d: i64| Plane::new(n, Int::from_i64(d)).expect("a normal");
        let cut = LineKey::of_planes(&plane([1 << 31, 1, 0], 0), &plane([1, 1 << 30, 0], 0));
        assert_eq!(cut, LineKey::of_edge(&[0; 3], &[0, 0, 5]));
        assert_eq!(cut.axis(), 2);
        // The plane of another test line, given by three of its lattice points.
        let [a, b] = [[0, 0, 0], [1, -(1 << 31), 0]];
        let through = PlaneResidues::through(&[a, b, [0, 0, 7]]);
        let slanted = plane([1, 1 << 30, 0], 0);
        let beside = PlaneResidues::of(&slanted);
        assert_eq!(cut, LineKey::of(&Line::of_planes(&through, &beside)));
    }
}
