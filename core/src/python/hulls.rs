//! Computes convex hulls of points on the lattice.

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{array, rows, wide};
use super::calls::errors::to_python;
use super::calls::run::run;
use crate::mesh::grid::Pitch;
use crate::mesh::hulls::hull_of;

/// The vertices and triangles of a hull, and whether it is convex on the lattice.
type HullMesh<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>, bool);

/// Return the mesh of the convex hull of points, which are snapped to the lattice first; its vertices have
/// their given coordinates if all triangles then still face outwards. It is empty if the points lie in one
/// plane, up to rounding.
#[pyfunction]
pub fn hull_mesh<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    pitch: i64,
) -> PyResult<HullMesh<'py>> {
    let points = rows(&points, "points").map_err(|e| to_python(py, &e))?;
    let hull = run(py, 0, points.len(), || hull_of(&points, Pitch::new(pitch)?))?;
    Ok((
        array(py, hull.vertices)?,
        array(py, wide(&hull.triangles))?,
        hull.is_convex_there,
    ))
}
