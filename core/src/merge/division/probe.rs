//! Points inside the triangles of a division, at which winding numbers are counted.

use std::sync::Arc;

use super::Triangulation;
use crate::arith::convert::as_number;
use crate::geometry::plane::Plane;
use crate::geometry::vertex::Vertex;

/// A point in the plane of a face at which a winding number is counted, and its coordinates, in half lattice
/// steps, on the two axes other than the plane's main axis.
#[derive(Clone, Debug)]
pub struct Probe {
    pub point: Arc<Vertex>,
    pub doubled: [i64; 2],
}

impl Probe {
    /// Returns the point of a plane that has the coordinates `doubled`, in half lattice steps, on the two
    /// axes other than the plane's main axis; `None` if the plane is parallel to the main axis, which never
    /// happens.
    pub fn at_coordinates(doubled: [i64; 2], plane: &Arc<Plane>) -> Option<Self> {
        let axis = plane.main_axis();
        let cut = |i: usize| Arc::new(Plane::axis_cut((axis + i) % 3, doubled[i - 1]));
        let point = Arc::new(Vertex::meet(plane, &cut(1), &cut(2))?);
        Some(Self { point, doubled })
    }
}

/// Returns a triangle of a division for which `count` finds winding numbers at a point inside it, with these
/// numbers. Tries the widest triangles first, and several points of each, because another surface may touch the
/// triangle at a point.
pub fn cell_with_probe<T>(
    cells: &mut Triangulation,
    plane: &Arc<Plane>,
    mut count: impl FnMut(&Probe) -> Option<T>,
) -> Option<(usize, T)> {
    const WEIGHTS: [[f64; 3]; 4] = [
        [1.0, 1.0, 1.0],
        [5.0, 3.0, 2.0],
        [2.0, 5.0, 3.0],
        [3.0, 2.0, 5.0],
    ];
    let mut order: Vec<u32> = (0..as_number(cells.cells().len())).collect();
    order.sort_by(|a, b| cells.size(*b).total_cmp(&cells.size(*a)));
    let points = order
        .into_iter()
        .flat_map(|cell| WEIGHTS.map(|w| (cell, w)));
    points.into_iter().find_map(|(cell, weights)| {
        let probe = Probe::at_coordinates(cells.mean(cell, weights), plane)?;
        let is_inside = cells.contains(cell, Arc::clone(&probe.point));
        let numbers = if is_inside { count(&probe) } else { None };
        Some((cell as usize, numbers?))
    })
}
