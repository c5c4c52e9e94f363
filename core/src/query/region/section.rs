//! Cuts a solid's boundary by planes.

use num_bigint::BigInt;
use num_integer::Integer;
use rustc_hash::FxHashMap as HashMap;

use crate::arith::convert::as_double;
use crate::arith::Sign;
use crate::error::{Error, ErrorKind, Result};
use crate::extract::assemble::assemble;
use crate::geometry::plane::{Lattice, Plane, ShortPlane, FILTER};
use crate::geometry::side::Side;
use crate::geometry::unbounded::big;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::determinant;
use crate::interrupt::poll;
use crate::mesh::handle::VertexId;
use crate::tree::solid::Solid;

/// A bounded solid's boundary, prepared for any number of sections by planes.
pub struct Sections {
    points: Vec<Vertex>,
    /// The coordinates of lattice points; NaN for all other points.
    near: Vec<[f64; 3]>,
    triangles: Vec<[VertexId; 3]>,
}

impl Sections {
    /// Reads the boundary of a solid.
    ///
    /// # Errors
    /// `Unbounded`.
    pub fn of(solid: &Solid) -> Result<Self> {
        let mesh = assemble(solid)?;
        let numbered = VertexId::all().zip(&mesh.vertices);
        let points: Vec<Vertex> = numbered.map(|(i, _)| mesh.vertex(i, solid)).collect();
        let near = |p: &Vertex| p.as_lattice().map_or([f64::NAN; 3], |p| p.map(as_double));
        Ok(Self {
            near: points.iter().map(near).collect(),
            points,
            triangles: mesh.triangles,
        })
    }

    /// Returns the directed edges in which a plane cuts the boundary, with lattice points as ends.
    ///
    /// Seen from the plane's plus side the solid lies on the left. Faces and edges in the plane count as
    /// above it, so that this is the section just below: the limit from the minus side. Each end is the
    /// lattice point nearest to the exact one, halves rounded up; edges that this shrinks to a point are
    /// left out.
    ///
    /// # Cost
    /// One pass over vertices and triangles.
    ///
    /// # Errors
    /// `TooLarge` if the section leaves the lattice.
    pub fn by(&self, plane: &Plane) -> Result<Vec<[Lattice; 2]>> {
        poll();
        let below: Vec<bool> = (0..self.points.len())
            .map(|i| self.is_below(i, plane))
            .collect();
        let crossings: Vec<Crossing> = self
            .triangles
            .iter()
            .map(|triangle| triangle.map(VertexId::index))
            .filter(|[a, b, c]| below[*a] != below[*b] || below[*b] != below[*c])
            .filter_map(|corners| Crossing::of(corners, &below))
            .collect();
        let mut edges = Vec::new();
        for [enter, leave] in straight(&self.points, &crossings) {
            poll();
            let meet = |rung| meet(&self.points, rung, plane);
            let ends = [meet(enter)?, meet(leave)?];
            if ends[0] != ends[1] {
                edges.push(ends);
            }
        }
        Ok(edges)
    }

    /// Returns true if a point lies strictly on the minus side of a plane.
    fn is_below(&self, point: usize, plane: &Plane) -> bool {
        let ([a, b, c, d], [x, y, z]) = (plane.approx(), &self.near[point]);
        let (sum, size) = (
            a * x + b * y + c * z + d,
            (a * x).abs() + (b * y).abs() + (c * z).abs(),
        );
        if sum.abs() > (size + d.abs()) * FILTER {
            return sum < 0.0;
        }
        self.points[point].side_of(plane) == Side::Minus
    }
}

/// An edge of the mesh that the cutting plane crosses, as two vertices: first the end below the plane, then
/// the end above it.
type Rung = [usize; 2];

/// A triangle that the plane crosses, with the two edges at which the plane crosses it.
struct Crossing {
    /// The edge at which the triangle's outline comes back below the cutting plane.
    enter: Rung,
    leave: Rung,
    corners: [usize; 3],
}

impl Crossing {
    fn of(corners: [usize; 3], below: &[bool]) -> Option<Self> {
        let edges = [0, 1, 2].map(|i| [corners[i], corners[(i + 1) % 3]]);
        let leave = edges.iter().find(|[a, b]| below[*a] && !below[*b])?;
        let [high, low] = edges.iter().find(|[a, b]| !below[*a] && below[*b])?;
        Some(Self {
            enter: [*low, *high],
            leave: *leave,
            corners,
        })
    }

    /// Returns the corner of the triangle that is not on an edge.
    fn apex(&self, rung: Rung) -> Option<usize> {
        self.corners.into_iter().find(|c| !rung.contains(c))
    }
}

/// Returns the first and the last crossed edge of each sequence of adjacent coplanar triangles; between them
/// the section is straight.
fn straight(points: &[Vertex], crossings: &[Crossing]) -> Vec<[Rung; 2]> {
    let next = successors(points, crossings);
    let mut follows = vec![false; crossings.len()];
    for &i in next.iter().flatten() {
        follows[i] = true;
    }
    let heads = (0..crossings.len()).filter(|&i| !follows[i]);
    let run = |head: usize| {
        let last = std::iter::successors(Some(head), |&i| next[i]).last();
        [crossings[head].enter, crossings[last.unwrap_or(head)].leave]
    };
    heads.map(run).collect()
}

/// Returns for each crossed triangle the coplanar triangle across the edge where it leaves, if there is one.
fn successors(points: &[Vertex], crossings: &[Crossing]) -> Vec<Option<usize>> {
    let mut entered: HashMap<Rung, Vec<usize>> = HashMap::default();
    for (i, crossing) in crossings.iter().enumerate() {
        poll();
        entered.entry(crossing.enter).or_default().push(i);
    }
    let beyond = |crossing: &Crossing| match entered.get(&crossing.leave)?.as_slice() {
        [only] => {
            let apexes = [crossing, &crossings[*only]].map(|c| c.apex(crossing.leave));
            let [a, b] = [apexes[0]?, apexes[1]?];
            let [p, q] = crossing.leave;
            coplanar([p, q, a, b].map(|i| &points[i])).then_some(*only)
        }
        _ => None,
    };
    crossings.iter().map(beyond).collect()
}

/// Returns true if four points lie in one plane.
fn coplanar(points: [&Vertex; 4]) -> bool {
    if let [Some(p), Some(q), Some(r), Some(s)] = points.map(Vertex::as_lattice) {
        let [u, v, w] = [q, r, s].map(|other| [0, 1, 2].map(|i| other[i] - p[i]));
        return determinant(&u, &v, &w) == Sign::Zero;
    }
    let [p, q, r, s] = points.map(Wide::of);
    // The differences to p, times both denominators.
    let [u, v, w] = [&q, &r, &s]
        .map(|other| [0, 1, 2].map(|i| -> BigInt { &other.x[i] * &p.w - &p.x[i] * &other.w }));
    let minor = |i: usize, j: usize| -> BigInt { &v[i] * &w[j] - &v[j] * &w[i] };
    let sum: BigInt = &u[0] * minor(1, 2) + &u[1] * minor(2, 0) + &u[2] * minor(0, 1);
    sum == BigInt::ZERO
}

/// Returns the lattice point nearest to the point where an edge meets a plane.
fn meet(points: &[Vertex], edge: Rung, plane: &Plane) -> Result<Lattice> {
    if let [Some(p), Some(q)] = edge.map(|i| points[i].as_lattice())
        && let Some(near) = plane.short().and_then(|plane| meet_near(p, q, &plane))
    {
        return Ok(near);
    }
    meet_wide(edge.map(|i| &points[i]), plane)
}

fn meet_wide(ends: [&Vertex; 2], plane: &Plane) -> Result<Lattice> {
    let [p, q] = ends.map(Wide::of);
    let (s, t) = (p.value(plane), q.value(plane));
    // With the values s/v < 0 ≤ t/w at p and q: the point is (t·p − s·q) / (t·v − s·w).
    let w: BigInt = &t * &p.w - &s * &q.w;
    let twice: BigInt = &w * 2i32;
    let mut meet = [0; 3];
    for (i, coordinate) in meet.iter_mut().enumerate() {
        let x: BigInt = &t * &p.x[i] - &s * &q.x[i];
        let nearest = Integer::div_floor(&(x * 2i32 + &w), &twice);
        *coordinate = i64::try_from(nearest).map_err(|_| {
            let text = "the section of the solid has a corner beyond the lattice of 2^53 steps; \
                            move the solid nearer to the origin";
            Error::new(ErrorKind::TooLarge, text)
        })?;
    }
    Ok(meet)
}

/// Returns the lattice point nearest to the point where an edge between lattice points meets a plane,
/// computed in 128-bit integers; `None` if these do not suffice.
fn meet_near(p: &Lattice, q: &Lattice, plane: &ShortPlane) -> Option<Lattice> {
    let (s, t) = (plane.value_at(p), plane.value_at(q));
    if s.unsigned_abs().max(t.unsigned_abs()) >= SHORT_VALUE {
        return None;
    }
    // The point is p + (q − p)·(−s)/w; half of w is added before the quotient is rounded down.
    let w = t - s;
    let along = |i: usize| {
        let twice = 2 * i128::from(q[i] - p[i]) * -s + w;
        i64::try_from(Integer::div_floor(&twice, &(2 * w))).ok()
    };
    Some([p[0] + along(0)?, p[1] + along(1)?, p[2] + along(2)?])
}

/// A value of a plane's equation below this bound can be multiplied by twice a difference of coordinates
/// (below 2^55) within 127 bits.
const SHORT_VALUE: u128 = 1 << 70;

struct Wide {
    x: [BigInt; 3],
    w: BigInt,
}

impl Wide {
    fn of(point: &Vertex) -> Self {
        let point = point.coordinates();
        let x = [0, 1, 2].map(|i| big(&point.x[i]));
        let w = big(&point.w);
        Self { x, w }
    }

    /// The value of the plane's equation at the point, times the point's weight `w`.
    fn value(&self, plane: &Plane) -> BigInt {
        let terms = (0..3).map(|i| BigInt::from(plane.normal()[i]) * &self.x[i]);
        terms.sum::<BigInt>() + big(plane.offset()) * &self.w
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::arith::Int;

    fn place() -> impl Strategy<Value = Lattice> {
        let near = || prop_oneof![-5i64..=5, -(1i64 << 53)..=1 << 53];
        [near(), near(), near()]
    }

    proptest! {
        #[test]
        fn short_edges_meet_planes_where_wide_ones_do(
            p in place(),
            q in place(),
            normal in [-9i128..=9, -9i128..=9, -9i128..=9],
            offset in -30i128..=30,
        ) {
            let plane = Plane::new(normal, Int::from_i128(offset));
            let Some(plane) = plane.filter(|h| h.side_of_lattice(&p) == Side::Minus && h.side_of_lattice(&q) != Side::Minus)
            else {
                return Ok(());
            };
            let short = plane.short().and_then(|plane| meet_near(&p, &q, &plane));
            let wide = meet_wide([&Vertex::lattice(p), &Vertex::lattice(q)], &plane).ok();
            prop_assert!(short.is_some());
            prop_assert_eq!(short, wide);
        }
    }
}
