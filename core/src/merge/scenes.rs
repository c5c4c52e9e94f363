//! Small solids and expressions for tests.

use std::borrow::Cow;
use std::sync::Arc;

use super::evaluate::evaluate;
use super::expression::{Expression, Term};
use super::kernels::problem::{CellProblem, ListedOperand};
use super::lists::list::{List, Sources};
use super::rule::Rule;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Polygon;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::VertexId;
use crate::mesh::source::{Shape, Source};
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::Node;
use crate::tree::solid::Solid;

/// Returns a triangle as a polygon in its plane.
pub fn triangle(corners: [Lattice; 3]) -> Polygon {
    let [a, b, c] = &corners;
    let plane = Plane::through(a, b, c).expect("a triangle with an area");
    Polygon::triangle(&corners, Arc::new(plane))
}

/// Returns the tetrahedron with these corners; the last lies above the plane of the first three, which are
/// counterclockwise seen from it.
pub fn tetrahedron(corners: [Lattice; 4]) -> Solid {
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    solid(corners.to_vec(), faces.to_vec())
}

/// Returns the pyramid over a convex polygon that is counterclockwise seen from the apex.
pub fn pyramid(apex: Lattice, base: &[Lattice]) -> Solid {
    let top = as_number(base.len());
    let sides = (0..top).map(|i| [i, (i + 1) % top, top]);
    let bottom = (1..top - 1).map(|i| [0, i + 1, i]);
    solid([base, &[apex]].concat(), sides.chain(bottom).collect())
}

/// Returns the vertical prism over a horizontal convex polygon that is counterclockwise seen from above.
pub fn prism(base: &[Lattice], height: i64) -> Solid {
    let count = as_number(base.len());
    let above = base.iter().map(|[x, y, z]| [*x, *y, z + height]);
    let vertices = base.iter().copied().chain(above).collect();
    let sides = (0..count).flat_map(|i| {
        let next = (i + 1) % count;
        [[i, next, next + count], [i, next + count, i + count]]
    });
    let ends = (1..count - 1).flat_map(|i| [[0, i + 1, i], [count, count + i, count + i + 1]]);
    solid(vertices, sides.chain(ends).collect())
}

/// Returns the axis-parallel box between its low and its high corner.
pub fn cuboid(low: Lattice, high: Lattice) -> Solid {
    cuboids([[low, high]])
}

/// Returns a solid of one mesh with the 12 triangles of each box, given by its low and high corner.
pub fn cuboids(boxes: impl IntoIterator<Item = [Lattice; 2]>) -> Solid {
    const QUADS: [[u32; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for [low, high] in boxes {
        let first = as_number(vertices.len());
        let corner = |i: usize| each_axis(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
        vertices.extend((0..8).map(corner));
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        faces.extend(
            QUADS
                .map(|quad| quad.map(|v| first + v))
                .into_iter()
                .flat_map(halves),
        );
    }
    solid(vertices, faces)
}

fn solid(vertices: Vec<Lattice>, faces: Vec<[u32; 3]>) -> Solid {
    let mesh = TriangleMesh {
        doubles: vertices.iter().map(|p| p.map(as_double)).collect(),
        vertices,
        faces: faces.into_iter().map(|f| f.map(VertexId)).collect(),
        numbers: None,
    };
    let pitch = Pitch::new(0).expect("ten to the zero");
    let source = Source::new(pitch, Shape::Mesh(mesh), Vec::new());
    Solid::of_source(Arc::new(source), false)
}

/// Returns two tetrahedra; one corner of the second is inside the first, and the three faces at this corner
/// cross the last face of the first.
pub fn tetrahedra() -> [Solid; 2] {
    let a = [[0, 0, 0], [16, 0, 0], [0, 16, 0], [0, 0, 16]];
    let b = [[5, 4, 3], [25, 5, 4], [6, 27, 2], [4, 6, 24]];
    [tetrahedron(a), tetrahedron(b)]
}

/// Returns the two tetrahedra of `tetrahedra`, listed in the smallest cell that contains both.
pub fn crossing() -> Shared {
    Shared::of(&tetrahedra())
}

/// Returns the value of an operation, such as `Term::Or`, on two solids.
pub fn made_of(solids: &[Solid; 2], combined: fn(Vec<u32>) -> Term) -> Solid {
    evaluate(&both(combined), solids).expect("bounded solids").0
}

/// Lists of the faces of solids in the smallest cell that contains all solids.
pub struct Shared {
    pub cell: Cell,
    pub sources: Sources,
    pub lists: Vec<List>,
}

impl Shared {
    pub fn of(solids: &[Solid]) -> Self {
        let cells = solids.iter().map(|s| s.root().cell);
        let cell = cells.reduce(|a, b| a.join(&b)).expect("at least one solid");
        let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
        let list = |s: &Solid| List::of_larger_cell(s.root(), &cell, &sources).expect("a leaf");
        let lists = solids.iter().map(list).collect();
        Self {
            cell,
            sources,
            lists,
        }
    }

    pub fn operands(&self) -> Vec<ListedOperand<'_>> {
        let listed = |(number, list)| ListedOperand {
            number,
            list: Cow::Borrowed(list),
        };
        (0..).zip(&self.lists).map(listed).collect()
    }

    pub fn problem<'a>(&'a self, expression: &'a Expression) -> CellProblem<'a> {
        CellProblem {
            cell: &self.cell,
            expression,
            rule: Rule::Positive,
            operands: self.operands(),
            sources: &self.sources,
        }
    }
}

/// Returns the expression of one operation, such as `Term::Or`, on operands 0 and 1.
pub fn both(combined: fn(Vec<u32>) -> Term) -> Expression {
    let terms = vec![Term::Operand(0), Term::Operand(1), combined(vec![0, 1])];
    Expression::new(terms).expect("well formed")
}

/// Returns how many whole faces and how many parts of faces a deferred leaf lists; zeros for other nodes.
pub fn counts(node: &Node) -> (usize, usize) {
    match node {
        Node::Deferred(leaf) => {
            let whole = leaf.groups.iter().map(|g| g.faces.len()).sum();
            (whole, leaf.parts.len())
        }
        Node::Leaf(_) | Node::Cut(_) => (0, 0),
    }
}
