//! Convex hulls of points on the lattice.

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{array, rows};
use super::calls::errors::to_python;
use super::calls::run::run;
use crate::geometry::doubles::hull::hull;
use crate::geometry::doubles::Point;
use crate::mesh::grid::Pitch;
use crate::mesh::snap::snap_all;

/// The triangles of the convex hull of points, snapped to the lattice, as rows of the array; none
/// if they lie in one plane.
#[pyfunction]
pub fn hull_faces<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    pitch: i64,
) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let points = rows(&points, "points").map_err(|e| to_python(py, &e))?;
    let faces = run(py, 0, points.len(), || {
        let lattice = snap_all(&points, Pitch::new(pitch)?)?;
        // Below 2^53 in magnitude, so that doubles hold them.
        let steps: Vec<Point> = lattice.iter().map(|p| p.map(|k| k as f64)).collect();
        Ok(hull(&steps))
    })?;
    array(py, faces.iter().map(|f| f.map(|p| p as i64)).collect())
}
