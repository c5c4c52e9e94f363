//! Exact positions of the vertices of a mesh.

use num_bigint::BigInt;
use num_integer::Integer;

use crate::extract::mesh::{Corner, ExactMesh};
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::{Homogeneous, Vertex};
use crate::mesh::handle::VertexId;
use crate::tree::solid::Solid;

/// The lattice point of a vertex; `None` if the vertex is not known to be one.
pub(super) fn lattice(solid: &Solid, mesh: &ExactMesh, vertex: VertexId) -> Option<Lattice> {
    match mesh.vertices[vertex.index()] {
        Corner::Source(slot, index) => {
            Some(solid.sources().get(slot).mesh()?.vertices[index.index()])
        }
        Corner::Point(point) => mesh.table.point(point).as_lattice().copied(),
    }
}

/// The exact position of a vertex.
pub(super) fn vertex(solid: &Solid, mesh: &ExactMesh, vertex: VertexId) -> Vertex {
    match mesh.vertices[vertex.index()] {
        Corner::Point(point) => Vertex::clone(mesh.table.point(point)),
        Corner::Source(..) => Vertex::lattice(lattice(solid, mesh, vertex).unwrap_or_default()),
    }
}

/// The homogeneous coordinates of a vertex.
pub(super) fn homogeneous(solid: &Solid, mesh: &ExactMesh, number: VertexId) -> Homogeneous {
    vertex(solid, mesh, number).coordinates()
}

/// A fraction in lowest terms.
pub(super) fn lowest(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    let g = numerator.gcd(&denominator);
    if g == BigInt::from(1) || g == BigInt::ZERO {
        return (numerator, denominator);
    }
    (numerator / &g, denominator / g)
}
