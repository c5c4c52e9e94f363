//! Volume and area of a mesh in doubles, the sums rounded once.

use super::handle::VertexId;
use crate::arith::Sum;
use crate::interrupt::poll;

/// The sums over all faces.
#[derive(Debug)]
pub struct Measures {
    /// Of the signed tetrahedra between the faces and a point.
    pub volume: f64,
    /// Of the faces.
    pub area: f64,
}

/// Measures a mesh; each face's part is rounded, their sums are not rounded further.
pub fn measures(vertices: &[[f64; 3]], faces: &[[VertexId; 3]], middle: [f64; 3]) -> Measures {
    let (mut volume, mut area) = (Sum::default(), Sum::default());
    for face in faces {
        poll();
        let [a, b, c] = face.map(|vertex| vertices[vertex.place()]);
        let [p, q, r] = [a, b, c].map(|corner| minus(corner, middle));
        volume.add(dot(cross(p, q), r) / 6.0);
        let normal = cross(minus(b, a), minus(c, a));
        area.add(dot(normal, normal).sqrt() / 2.0);
    }
    Measures {
        volume: volume.rounded(),
        area: area.rounded(),
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
