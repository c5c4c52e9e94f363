//! Volume and area of a mesh in doubles, the sums rounded once.

use super::handle::VertexId;
use crate::arith::Sum;
use crate::geometry::doubles::vector::{dot, less, normal};
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
        let normal = normal(&[a, b, c]);
        // With the normal of the edges no digits cancel that a small face far out would need.
        volume.add(dot(&normal, &less(&a, &middle)) / 6.0);
        area.add(dot(&normal, &normal).sqrt() / 2.0);
    }
    Measures {
        volume: volume.rounded(),
        area: area.rounded(),
    }
}
