//! The volume of a mesh as an exact sum of contributions (shares) of its triangles.
//!
//! The denominator of a triangle's share is the product of the weights of its constructed corners. Halving
//! space recursively makes groups of triangles that share few points with other groups. The sum of a group
//! is a numerator over the weights of all its points, each taken once: the weights of points that no
//! triangle outside uses are multiplied, the few others stay in a list. So no weight is in the denominator
//! twice, and all products have factors of similar length.

use num_bigint::BigInt;
use num_integer::Integer;
use smallvec::SmallVec;

use super::exact::{homogeneous, lowest};
use crate::arith::{inv_mod, mul_mod, Int};
use crate::extract::mesh::ExactMesh;
use crate::geometry::plane::Lattice;
use crate::geometry::unbounded::big;
use crate::interrupt::{poll, spend};
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::{both, WorkSize};
use crate::tree::solid::Solid;

/// A sum is reduced if its denominator has at most this many bits: for longer ones finding the common
/// divisor costs more than it saves.
const MAX_BITS_REDUCED: u64 = 1024;

/// Groups of at least this many triangles are summed as two tasks, of more than 100 µs each.
const MIN_TRIANGLES_DIVIDED: usize = 64;

/// The contributions (shares) of all triangles of a mesh to six times its volume, in cubic steps.
pub struct Shares {
    /// The sum of the shares of all triangles between lattice points.
    pub whole: BigInt,
    cut: Vec<Share>,
    /// The weight of each constructed corner.
    weights: Vec<BigInt>,
    /// For each constructed corner, the number of triangles that use it.
    uses: Vec<u32>,
}

/// The contribution (share) of one triangle with constructed corners to six times the volume.
struct Share {
    /// The numerator; the denominator is the product of the weights of `points`.
    value: BigInt,
    /// The constructed corners, by number, ascending.
    points: SmallVec<[u32; 3]>,
    /// Three times the centre of the triangle, rounded.
    at: [f64; 3],
}

/// A sum of contributions of triangles to the volume. Its denominator is the product of `closed` and of the
/// homogeneous weights of the points in `open`.
struct Partial {
    numerator: BigInt,
    /// The product of the weights of points that only this sum uses.
    closed: BigInt,
    /// The points whose weights are the other factors of the denominator, ascending, each with the number of
    /// triangles of this sum that use it.
    open: Vec<(u32, u32)>,
}

/// A point in homogeneous coordinates, and its coordinates in doubles.
struct Point {
    x: [BigInt; 3],
    weight: BigInt,
    /// The coordinates of the point, rounded.
    near: [f64; 3],
}

impl Shares {
    /// Computes the contribution of each triangle of a solid's mesh to the volume.
    pub fn of(solid: &Solid, mesh: &ExactMesh) -> Self {
        let mut shares = Self {
            whole: BigInt::ZERO,
            cut: Vec::new(),
            weights: Vec::new(),
            uses: Vec::new(),
        };
        let mut sum = Int::<4>::ZERO;
        let mut known: Vec<Option<u32>> = vec![None; mesh.vertices.len()];
        let mut points: Vec<Point> = Vec::new();
        for triangle in &mesh.triangles {
            poll();
            let corners = triangle.map(|v| mesh.lattice(v, solid));
            if let [Some(a), Some(b), Some(c)] = corners {
                sum += determinant(&a, &b, &c);
                continue;
            }
            let numbers = [0, 1, 2].map(|i| {
                let number = &mut known[triangle[i].index()];
                *number.get_or_insert_with(|| {
                    points.push(Point::of(solid, mesh, triangle[i]));
                    points.len() as u32 - 1
                })
            });
            let share = Share::of(numbers, &points);
            shares.cut.push(share);
        }
        shares.whole = big(&sum);
        shares.uses = vec![0; points.len()];
        let named = shares.cut.iter().flat_map(|share| &share.points);
        named.for_each(|point| shares.uses[*point as usize] += 1);
        shares.weights = points.into_iter().map(|p| p.weight).collect();
        shares
    }

    /// Returns an upper bound on the bits of the denominator of the sum.
    pub fn denominator_bits(&self) -> u64 {
        let used = self.weights.iter().zip(&self.uses).filter(|w| *w.1 > 0);
        used.map(|(weight, _)| weight.bits()).sum()
    }

    /// Yields the contributions to the volume of triangles with constructed corners, rounded down to
    /// multiples of 2^-`places`.
    pub fn near(&self, places: usize) -> impl Iterator<Item = BigInt> + '_ {
        self.cut.iter().map(move |share| {
            poll();
            let weight: BigInt = share.points.iter().map(|p| self.weight(*p)).product();
            (&share.value << places).div_floor(&weight)
        })
    }

    /// Returns the sum of all triangles' contributions to the volume modulo a prime; `None` if a weight is a
    /// multiple of it.
    pub fn modulo(&self, prime: u64) -> Option<u64> {
        let residue = |n: &BigInt| {
            let rest = n.mod_floor(&BigInt::from(prime));
            u64::try_from(rest).unwrap_or(0)
        };
        let inverse = |weight: &BigInt| {
            let weight = residue(weight);
            (weight != 0).then(|| inv_mod(weight, prime))
        };
        let inverses: Option<Vec<u64>> = self.weights.iter().map(inverse).collect();
        let inverses = inverses?;
        let share = |share: &Share| {
            poll();
            let over = |value, point: &u32| mul_mod(value, inverses[*point as usize], prime);
            share.points.iter().fold(residue(&share.value), over)
        };
        let add = |sum, share| (sum + share) % prime;
        Some(self.cut.iter().map(share).fold(residue(&self.whole), add))
    }

    /// Returns the sum of all triangles' contributions to the volume, as a numerator and a positive
    /// denominator.
    pub fn sum(mut self) -> (BigInt, BigInt) {
        let mut cut = std::mem::take(&mut self.cut);
        let sum = self.partial(&mut cut);
        let numerator = sum.numerator + &self.whole * &sum.closed;
        (numerator, sum.closed)
    }

    fn weight(&self, point: u32) -> &BigInt {
        &self.weights[point as usize]
    }

    fn partial(&self, shares: &mut [Share]) -> Partial {
        spend(shares.len());
        match shares {
            [] => Partial {
                numerator: BigInt::ZERO,
                closed: BigInt::from(1),
                open: Vec::new(),
            },
            [share] => self.settled(Partial {
                numerator: std::mem::take(&mut share.value),
                closed: BigInt::from(1),
                open: share.points.iter().map(|p| (*p, 1)).collect(),
            }),
            _ => {
                let work_size = WorkSize::pool_if(shares.len() >= MIN_TRIANGLES_DIVIDED);
                let (low, high) = halves(shares);
                let (low, high) = both(work_size, || self.partial(low), || self.partial(high));
                self.joined(low, high)
            }
        }
    }

    /// Adds two sums of triangles' contributions to the volume.
    fn joined(&self, a: Partial, b: Partial) -> Partial {
        let missing = |here: &[(u32, u32)], there: &[(u32, u32)]| {
            let lacks = |p: &&(u32, u32)| here.binary_search_by_key(&p.0, |q| q.0).is_err();
            let factors = there.iter().filter(lacks);
            self.product(&factors.map(|p| p.0).collect::<Vec<u32>>())
        };
        let for_a = &b.closed * missing(&a.open, &b.open);
        let for_b = &a.closed * missing(&b.open, &a.open);
        let mut open = [a.open, b.open].concat();
        open.sort_unstable();
        open.dedup_by(|later, kept| {
            let same = later.0 == kept.0;
            kept.1 += if same { later.1 } else { 0 };
            same
        });
        self.settled(Partial {
            numerator: a.numerator * for_a + b.numerator * for_b,
            closed: a.closed * b.closed,
            open,
        })
    }

    /// Multiplies into `closed` the weights of those `open` points that no triangle outside the sum uses.
    fn settled(&self, mut sum: Partial) -> Partial {
        let is_closed = |p: &(u32, u32)| self.uses[p.0 as usize] == p.1;
        let closed = sum.open.iter().filter(|p| is_closed(p)).map(|p| p.0);
        let closed: Vec<u32> = closed.collect();
        if closed.is_empty() {
            return sum;
        }
        sum.open.retain(|p| !is_closed(p));
        sum.closed *= self.product(&closed);
        if sum.closed.bits() <= MAX_BITS_REDUCED {
            (sum.numerator, sum.closed) = lowest(sum.numerator, sum.closed);
        }
        sum
    }

    /// The product of the weights of points, computed by halving the list.
    fn product(&self, points: &[u32]) -> BigInt {
        match points {
            [] => BigInt::from(1),
            [point] => self.weight(*point).clone(),
            _ => {
                let (low, high) = points.split_at(points.len() / 2);
                self.product(low) * self.product(high)
            }
        }
    }
}

impl Share {
    fn of(numbers: [u32; 3], points: &[Point]) -> Self {
        let [a, b, c] = numbers.map(|n| &points[n as usize]);
        let minor = |i: usize, j: usize| &b.x[i] * &c.x[j] - &b.x[j] * &c.x[i];
        let value = &a.x[0] * minor(1, 2) + &a.x[1] * minor(2, 0) + &a.x[2] * minor(0, 1);
        let one = BigInt::from(1);
        let mut constructed = SmallVec::from(numbers);
        constructed.retain(|n| points[*n as usize].weight != one);
        constructed.sort_unstable();
        Self {
            value,
            points: constructed,
            at: [0, 1, 2].map(|i| a.near[i] + b.near[i] + c.near[i]),
        }
    }
}

impl Point {
    fn of(solid: &Solid, mesh: &ExactMesh, vertex: VertexId) -> Self {
        let h = homogeneous(solid, mesh, vertex);
        let [x, y, z, w] = h.approx();
        let common = h.x.iter().fold(big(&h.w), |g, x| {
            if g == BigInt::from(1) {
                g
            } else {
                g.gcd(&big(x))
            }
        });
        Self {
            x: [0, 1, 2].map(|i| big(&h.x[i]) / &common),
            weight: big(&h.w) / common,
            near: [x / w, y / w, z / w],
        }
    }
}

/// Halves a list of triangles' contributions to the volume by the centres of the triangles, along the axis on
/// which these extend farthest.
fn halves(shares: &mut [Share]) -> (&mut [Share], &mut [Share]) {
    let extent = |axis: usize| {
        let ends = shares
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], s| {
                [low.min(s.at[axis]), high.max(s.at[axis])]
            });
        ends[1] - ends[0]
    };
    let axis = (0..3).max_by(|i, j| extent(*i).total_cmp(&extent(*j)));
    let axis = axis.unwrap_or(0);
    let middle = shares.len() / 2;
    shares.select_nth_unstable_by(middle, |a, b| a.at[axis].total_cmp(&b.at[axis]));
    shares.split_at_mut(middle)
}

/// Six times the volume of the tetrahedron from the origin over the triangle a b c.
fn determinant(a: &Lattice, b: &Lattice, c: &Lattice) -> Int<4> {
    let minor = |i: usize, j: usize| {
        i128::from(b[i]) * i128::from(c[j]) - i128::from(b[j]) * i128::from(c[i])
    };
    let term = |i: usize, m: i128| -> Int<4> { Int::<2>::from_i128(m).mul_i64(a[i]) };
    term(0, minor(1, 2)) + term(1, minor(2, 0)) + term(2, minor(0, 1))
}
