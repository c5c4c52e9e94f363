//! Points that the surfaces of two solids have in common.

use std::sync::Arc;

use super::exact;
use crate::arith::convert::{as_double, as_number, as_whole};
use crate::arith::Sign;
use crate::error::Result;
use crate::extract::assemble::assemble;
use crate::extract::mesh::ExactMesh;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::points;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::pairs::{pairs_of_many, shift_of, Boxed, Part, Swept};
use crate::mesh::handle::{OrientedFace, VertexId};
use crate::tree::solid::Solid;

/// Return whether the surfaces of two reduced solids on one lattice have a point in common; exact.
///
/// # Cost
/// Both meshes, and the pairs of their triangles whose boxes overlap, up to the first that meets.
///
/// # Errors
/// `Unbounded`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::grid::Pitch;
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::contact::surfaces_meet;
/// use bspcsg::tree::solid::Solid;
///
/// let corner = |x: f64| {
///     let vertices = [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]];
///     let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
///     let source = import(&vertices, &faces, Some(Pitch::new(-1)?))?;
///     Ok::<_, bspcsg::error::Error>(Solid::of_source(Arc::new(source), false))
/// };
/// assert!(surfaces_meet(&corner(0.0)?, &corner(1.0)?)?);
/// assert!(!surfaces_meet(&corner(0.0)?, &corner(1.1)?)?);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn surfaces_meet(first: &Solid, second: &Solid) -> Result<bool> {
    let surfaces = [Surface::of(first)?, Surface::of(second)?];
    let space = surfaces[0].space().within(&surfaces[1].space());
    let mut near: Vec<Facet> = Vec::new();
    for (operand, surface) in surfaces.iter().enumerate() {
        near.extend(surface.facets_in(&space, operand));
    }
    let around = near.iter().map(|facet| facet.space);
    let around = around.fold(Space::NOTHING, |all, one| all.with(&one));
    let shift = shift_of(around.size());
    let boxed = |(number, facet): (usize, &Facet)| {
        let [low, high] = facet.space.from(&around.low);
        Boxed::new(facet.operand, as_number(number), [&low, &high], shift)
    };
    let boxes = near.iter().enumerate().map(boxed).collect();
    let facet = |number: u32| &near[number as usize];
    let swept = |number: u32| facet(number).swept(&around.low);
    let apart = pairs_of_many(Part::of(boxes, shift), swept, |p, q| {
        (!facet(p).meets(facet(q))).then_some(())
    });
    Ok(apart.is_none())
}

/// A box of lattice points, its ends included.
#[derive(Clone, Copy)]
struct Space {
    low: Lattice,
    high: Lattice,
}

impl Space {
    const NOTHING: Self = Self {
        low: [i64::MAX; 3],
        high: [i64::MIN; 3],
    };

    /// The smallest one around a point.
    fn around(vertex: &Vertex) -> Self {
        if let Some(place) = vertex.as_lattice() {
            return Self {
                low: *place,
                high: *place,
            };
        }
        let (low, high) = vertex.bounds();
        Self {
            low: low.map(|x| as_whole(x.floor())),
            high: high.map(|x| as_whole(x.ceil())),
        }
    }

    /// The smallest one that holds this and another.
    fn with(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    /// The part in another one.
    fn within(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].max(other.low[i])),
            high: each_axis(|i| self.high[i].min(other.high[i])),
        }
    }

    fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// The ends relative to a point.
    fn from(&self, origin: &Lattice) -> [Lattice; 2] {
        [&self.low, &self.high].map(|end| each_axis(|i| end[i] - origin[i]))
    }

    /// The length of the longest side.
    fn size(&self) -> u64 {
        let side = |i: usize| self.high[i].checked_sub(self.low[i]).unwrap_or(0);
        each_axis(side)
            .iter()
            .map(|x| x.unsigned_abs())
            .max()
            .unwrap_or(0)
    }
}

/// The surface of a solid.
struct Surface<'a> {
    solid: &'a Solid,
    mesh: ExactMesh,
}

impl<'a> Surface<'a> {
    fn of(solid: &'a Solid) -> Result<Self> {
        let mesh = assemble(solid)?;
        Ok(Self { solid, mesh })
    }

    fn vertex(&self, vertex: VertexId) -> Vertex {
        exact::vertex(self.solid, &self.mesh, vertex)
    }

    /// A box around all of it.
    fn space(&self) -> Space {
        let vertices = VertexId::all().take(self.mesh.vertices.len());
        vertices.fold(Space::NOTHING, |all, vertex| {
            poll();
            all.with(&Space::around(&self.vertex(vertex)))
        })
    }

    /// Its triangles whose boxes overlap another box, as those of an operand.
    fn facets_in(&self, space: &Space, operand: usize) -> Vec<Facet> {
        let triangles = self.mesh.triangles.iter().zip(&self.mesh.faces);
        let facet = |(triangle, face): (&[VertexId; 3], &OrientedFace)| {
            poll();
            let corners = triangle.map(|vertex| self.vertex(vertex));
            let around = corners.each_ref().map(Space::around);
            let around = around[0].with(&around[1]).with(&around[2]);
            around.overlaps(space).then(|| Facet {
                operand,
                plane: self.solid.sources().get(face.slot()).plane(face.id()),
                corners,
                space: around,
            })
        };
        triangles.filter_map(facet).collect()
    }
}

/// A triangle of one of the surfaces.
struct Facet {
    operand: usize,
    corners: [Vertex; 3],
    /// The plane that it lies in, whichever side is outside.
    plane: Arc<Plane>,
    /// A box around it.
    space: Space,
}

impl Facet {
    /// The triangle as a sweep sees it.
    fn swept(&self, origin: &Lattice) -> Swept {
        let [low, high] = self.space.from(origin);
        let [a, b, c] = self.corners.each_ref().map(Vertex::as_lattice);
        let corners = a
            .zip(b)
            .zip(c)
            .map(|((a, b), c)| [a, b, c].map(|p| each_axis(|i| as_double(p[i] - origin[i]))));
        Swept {
            operand: self.operand,
            low,
            high,
            corners,
        }
    }

    /// Return whether two triangles have a point in common: then an edge of one meets the other.
    fn meets(&self, other: &Self) -> bool {
        poll();
        let ours = self.sides_of(other);
        if is_beside(ours) {
            return false;
        }
        let theirs = other.sides_of(self);
        !is_beside(theirs) && (self.meets_edges(other, ours) || other.meets_edges(self, theirs))
    }

    /// The sides of this triangle's plane on which the corners of another lie.
    fn sides_of(&self, other: &Self) -> [Side; 3] {
        other.corners.each_ref().map(|p| p.side_of(&self.plane))
    }

    /// Return whether an edge of another triangle has a point in this one, given the sides of this
    /// one's plane on which its corners lie.
    fn meets_edges(&self, other: &Self, sides: [Side; 3]) -> bool {
        (0..3).any(|i| {
            let j = (i + 1) % 3;
            let ends = [&other.corners[i], &other.corners[j]];
            match [sides[i], sides[j]] {
                [Side::On, Side::On] => self.meets_flat(ends),
                [Side::On, _] => self.holds(ends[0]),
                [_, Side::On] => self.holds(ends[1]),
                [from, to] => from != to && self.is_pierced(ends),
            }
        })
    }

    /// Return whether a segment from one side of the plane to the other runs through the triangle:
    /// all edges turn one way around it.
    fn is_pierced(&self, [from, to]: [&Vertex; 2]) -> bool {
        let around = |i: usize| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            points::side([from, to, a], b)
        };
        !is_split(each_axis(around))
    }

    /// Return whether a point of the plane lies in the triangle.
    fn holds(&self, point: &Vertex) -> bool {
        let turns = each_axis(|i| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            Side::from_sign(points::turn([a, b, point], self.view()))
        });
        !is_split(turns)
    }

    /// Return whether a segment in the plane has a point in the triangle: an end of it, or one on an
    /// edge across it.
    fn meets_flat(&self, [from, to]: [&Vertex; 2]) -> bool {
        let turn = |a, b, c| points::turn([a, b, c], self.view());
        let is_across = |i: usize| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            let ends = [turn(from, to, a), turn(from, to, b)];
            let sides = [turn(a, b, from), turn(a, b, to)];
            // An edge on the segment's line begins and ends on others, which the segment meets as well
            // unless one of its ends is between.
            ends != [Sign::Zero; 2]
                && ends[0] * ends[1] != Sign::Positive
                && sides[0] * sides[1] != Sign::Positive
        };
        self.holds(from) || self.holds(to) || (0..3).any(is_across)
    }

    /// The axes of the view in which the plane is seen best.
    fn view(&self) -> [usize; 2] {
        let axis = self.plane.main_axis();
        [(axis + 1) % 3, (axis + 2) % 3]
    }
}

/// Return whether all of some points lie beside a plane, on one side.
fn is_beside(sides: [Side; 3]) -> bool {
    sides[0] != Side::On && sides.iter().all(|side| *side == sides[0])
}

/// Return whether some points lie on both sides.
fn is_split(sides: [Side; 3]) -> bool {
    sides.contains(&Side::Plus) && sides.contains(&Side::Minus)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn facet(corners: [Lattice; 3]) -> Option<Facet> {
        let [a, b, c] = corners;
        let corners = corners.map(Vertex::lattice);
        let around = corners.each_ref().map(Space::around);
        Some(Facet {
            operand: 0,
            plane: Arc::new(Plane::through(&a, &b, &c)?),
            space: around[0].with(&around[1]).with(&around[2]),
            corners,
        })
    }

    /// Return whether triangles have a point in common: unless a plane separates them, that is, has all
    /// differences of their points on one side, off it.
    fn touch(p: &[Lattice; 3], q: &[Lattice; 3]) -> bool {
        let differences: Vec<[i64; 3]> = p
            .iter()
            .flat_map(|a| q.iter().map(|b| each_axis(|i| a[i] - b[i])))
            .collect();
        let edges =
            |t: &[Lattice; 3]| [0, 1, 2].map(|k| each_axis(|i| t[(k + 1) % 3][i] - t[k][i]));
        let cross = |a: [i64; 3], b: [i64; 3]| {
            each_axis(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
        };
        let (own, other) = (edges(p), edges(q));
        let faces = [cross(own[0], own[1]), cross(other[0], other[1])];
        let mut normals: Vec<[i64; 3]> = faces.to_vec();
        normals.extend(own.iter().flat_map(|e| other.iter().map(|f| cross(*e, *f))));
        // For triangles of one plane.
        normals.extend(own.iter().map(|e| cross(*e, faces[0])));
        normals.extend(other.iter().map(|e| cross(*e, faces[1])));
        let separates = |n: &[i64; 3]| {
            let along = |d: &[i64; 3]| (0..3).map(|i| n[i] * d[i]).sum::<i64>();
            let signs = differences.iter().map(|d| along(d).signum());
            let sum: i64 = signs.sum();
            sum.unsigned_abs() == differences.len() as u64
        };
        !normals.iter().any(separates)
    }

    fn triangle() -> impl Strategy<Value = [Lattice; 3]> {
        let point = || [0..=4i64, 0..=4i64, 0..=3i64];
        [point(), point(), point()]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn triangles_meet_where_no_plane_separates_them(p in triangle(), q in triangle()) {
            if let (Some(first), Some(second)) = (facet(p), facet(q)) {
                prop_assert_eq!(first.meets(&second), touch(&p, &q));
                prop_assert_eq!(second.meets(&first), touch(&p, &q));
            }
        }
    }
}
