//! Counts winding numbers of a mesh along rays.

use super::boxes::RoundedBox;
use super::candidates::{Candidates, Operand};
use crate::arith::convert::as_double;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::side::Side;
use crate::geometry::winding::crossing::{triangle_change, Segment};
use crate::merge::division::Probe;

/// Counts winding numbers of a mesh around points; sorts its faces into a tree of boxes on first use.
#[derive(Debug)]
pub(super) struct Windings<'a> {
    operand: Operand<'a>,
    faces: Option<Candidates>,
}

impl<'a> Windings<'a> {
    pub(super) fn of(operand: Operand<'a>) -> Self {
        Self {
            operand,
            faces: None,
        }
    }

    /// Returns true if a point lies outside the bounding box of the mesh, so that the winding number is zero.
    pub(super) fn is_outside_bounds(&self, point: &Lattice) -> bool {
        let [low, high] = &self.operand.bounds;
        (0..3).any(|i| point[i] < low[i] || point[i] > high[i])
    }

    /// Returns the winding number of the mesh around a lattice point, which must lie on no face.
    pub(super) fn winding_number_at(&mut self, point: &Lattice) -> i32 {
        let Operand { mesh, bounds, .. } = self.operand;
        let way = Segment {
            from: point.map(|x| 2 * x),
            axis: 0,
            to: 2 * bounds[1][0] + 2,
        };
        let faces = self.faces.get_or_insert_with(|| self.operand.tree());
        let from: Point = point.map(as_double);
        let to = each_axis(|i| {
            if i == 0 {
                as_double(bounds[1][0])
            } else {
                from[i]
            }
        });
        let mut change = 0;
        faces
            .tree
            .each_meeting(&RoundedBox::between(&from, &to), |i| {
                change += triangle_change(&mesh.corners(faces.faces[i]), &way);
            });
        -change
    }

    /// Returns the winding number of the mesh just in front of a plane at a point of it; `None` if a face in
    /// another plane contains this point.
    pub(super) fn winding_number_in_front(&mut self, plane: &Plane, probe: &Probe) -> Option<i32> {
        let Probe { point, doubled } = probe;
        let Operand { mesh, bounds, .. } = self.operand;
        let axis = plane.main_axis();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut from = [0; 3];
        (from[axis], from[u], from[v]) = (2 * bounds[0][axis] - 2, doubled[0], doubled[1]);
        let to = 2 * bounds[1][axis] + 2;
        let way = Segment { from, axis, to };
        let is_up = plane.normal()[axis] > 0;
        let faces = self.faces.get_or_insert_with(|| self.operand.tree());
        let (low, high) = (point.approx(), point.approx());
        let reach = |i: usize, low: f64, end: i64| if i == axis { as_double(end) } else { low };
        let low = each_axis(|i| reach(i, low[i], bounds[0][i]));
        let high = each_axis(|i| reach(i, high[i], bounds[1][i]));
        let (mut number, mut touches) = (0, false);
        faces
            .tree
            .each_meeting(&RoundedBox::between(&low, &high), |i| {
                let corners = mesh.corners(faces.faces[i]);
                let change = triangle_change(&corners, &way);
                if change == 0 {
                    return;
                }
                let [a, b, c] = &corners;
                let Some(other) = Plane::through(a, b, c) else {
                    return;
                };
                // On a ray upwards, the winding number increases where the ray passes from in front of a face
                // to behind it.
                let is_above = match point.side_of(&other) {
                    Side::On => {
                        touches |= other.coincides(plane).is_none();
                        return;
                    }
                    side => (side == Side::Plus) == (change > 0),
                };
                if is_above == is_up {
                    number += if is_up { -change } else { change };
                }
            });
        (!touches).then_some(number)
    }
}
