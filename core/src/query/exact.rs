//! Exact positions of the vertices of a mesh.

use num_bigint::BigInt;
use num_integer::Integer;

use crate::extract::mesh::ExactMesh;
use crate::geometry::vertex::Homogeneous;
use crate::mesh::handle::VertexId;
use crate::tree::solid::Solid;

/// The homogeneous coordinates of a vertex.
pub(super) fn homogeneous(solid: &Solid, mesh: &ExactMesh, number: VertexId) -> Homogeneous {
    mesh.vertex(number, solid).coordinates()
}

/// A fraction in lowest terms.
pub(super) fn lowest(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    let g = numerator.gcd(&denominator);
    if g == BigInt::from(1) || g == BigInt::ZERO {
        return (numerator, denominator);
    }
    (numerator / &g, denominator / g)
}
