//! Where a plane cuts a solid.

use num_bigint::BigInt;
use num_integer::Integer;

use crate::error::{Error, ErrorKind, Result};
use crate::extract::assemble::assemble;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::vertex::{Homogeneous, Vertex};
use crate::query::measure::{big, homogeneous};
use crate::tree::solid::Solid;

/// The directed edges in which a plane cuts a bounded solid's boundary.
///
/// Seen from the plane's plus side the solid lies on the left. Faces and edges in the plane count
/// as lying above it, so that this is the section just below: the limit from the minus side. Each
/// end is the lattice point nearest to the exact one, halves rounded up; edges that this shrinks to
/// a point are left out.
///
/// # Errors
/// `Unbounded`.
pub fn section(solid: &Solid, plane: &Plane) -> Result<Vec<[Lattice; 2]>> {
    let mesh = assemble(solid)?;
    let points: Vec<Homogeneous> = (0u32..)
        .zip(&mesh.vertices)
        .map(|(i, _)| homogeneous(solid, &mesh, i))
        .collect();
    let below: Vec<bool> = points.iter().map(|p| is_below(p, plane)).collect();
    let mut edges = Vec::new();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| v as usize);
        if let Some([leave, enter]) = crossed(&corners, &below) {
            let ends = [meet(&points, enter, plane)?, meet(&points, leave, plane)?];
            if ends[0] != ends[1] {
                edges.push(ends);
            }
        }
    }
    Ok(edges)
}

fn is_below(point: &Homogeneous, plane: &Plane) -> bool {
    Vertex::homogeneous(point.x, point.w).side_of(plane) < 0
}

/// The edges of a triangle by which its outline leaves the half below and comes back to it, each
/// with its lower end first.
fn crossed(corners: &[usize; 3], below: &[bool]) -> Option<[[usize; 2]; 2]> {
    let edges = [0, 1, 2].map(|i| [corners[i], corners[(i + 1) % 3]]);
    let leave = edges.iter().find(|[a, b]| below[*a] && !below[*b])?;
    let [high, low] = edges.iter().find(|[a, b]| !below[*a] && below[*b])?;
    Some([*leave, [*low, *high]])
}

/// The lattice point nearest to where an edge meets a plane.
fn meet(points: &[Homogeneous], edge: [usize; 2], plane: &Plane) -> Result<Lattice> {
    let [p, q] = edge.map(|i| Wide::of(&points[i]));
    let (s, t) = (p.value(plane), q.value(plane));
    // With the values s/v < 0 ≤ t/w at p and q: the point is (t·p − s·q) / (t·v − s·w).
    let w: BigInt = &t * &p.w - &s * &q.w;
    let twice: BigInt = &w * 2i32;
    let mut meet = [0; 3];
    for (i, coordinate) in meet.iter_mut().enumerate() {
        let x: BigInt = &t * &p.x[i] - &s * &q.x[i];
        let nearest = Integer::div_floor(&(x * 2i32 + &w), &twice);
        *coordinate = i64::try_from(nearest)
            .map_err(|_| Error::new(ErrorKind::TooLarge, "a section leaves the lattice"))?;
    }
    Ok(meet)
}

struct Wide {
    x: [BigInt; 3],
    w: BigInt,
}

impl Wide {
    fn of(point: &Homogeneous) -> Self {
        let x = [0, 1, 2].map(|i| big(&point.x[i]));
        let w = big(&point.w);
        Self { x, w }
    }

    /// The plane's value here, times w.
    fn value(&self, plane: &Plane) -> BigInt {
        let terms = (0..3).map(|i| BigInt::from(plane.normal()[i]) * &self.x[i]);
        terms.sum::<BigInt>() + big(plane.offset()) * &self.w
    }
}
