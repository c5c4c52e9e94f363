//! Computes properties of a mesh from its arrays: equal points, connected surfaces, counts and sums.

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{array, rows, triangles_of, wide};
use super::calls::errors::to_python;
use super::calls::run::run;
use crate::error::{Error, ErrorKind};
use crate::extract::outlines::triangulate_outlines;
use crate::mesh::measures::{measures, moments};
use crate::mesh::surfaces::{counts, surfaces};
use crate::mesh::weld::welded;

/// The different points, and for each given point its index among them.
type Welding<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<i64>>);

/// Return the different points in the order in which they first occur, and for each given point its number
/// among them.
#[pyfunction]
pub fn welded_points<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
) -> PyResult<Welding<'py>> {
    let points = rows(&points, "points").map_err(|e| to_python(py, &e))?;
    if u32::try_from(points.len()).is_err() {
        let text = format!(
            "{} points are too many; fewer than 2^32 are allowed",
            points.len()
        );
        return Err(to_python(py, &Error::new(ErrorKind::TooLarge, text)));
    }
    let found = run(py, 0, points.len(), || Ok(welded(&points)))?;
    let same = found.same.into_iter().map(i64::from).collect();
    Ok((array(py, found.points)?, PyArray1::from_vec(py, same)))
}

/// Return triangles of the region on the left of edges between points of the plane; None if the edges are
/// not the boundary of a region.
#[pyfunction]
pub fn outline_triangles<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    edges: PyReadonlyArray2<'py, i64>,
) -> PyResult<Option<Bound<'py, PyArray2<i64>>>> {
    let fail = |e: Error| to_python(py, &e);
    let points = rows::<f64, 2>(&points, "points").map_err(fail)?;
    let edges = rows::<i64, 2>(&edges, "edges").map_err(fail)?;
    let number = |end: i64| {
        u32::try_from(end)
            .ok()
            .filter(|n| (*n as usize) < points.len())
    };
    let ends = edges
        .iter()
        .map(|[from, to]| Some((number(*from)?, number(*to)?)));
    let Some(ends) = ends.collect::<Option<Vec<_>>>() else {
        let text = "an edge has a point index out of range";
        return Err(to_python(py, &Error::new(ErrorKind::IndexOutOfRange, text)));
    };
    let found = run(py, 0, ends.len(), || {
        Ok(triangulate_outlines(&points, &ends))
    })?;
    found
        .map(|triangles| array(py, wide(&triangles)))
        .transpose()
}

/// Return for each triangle the number of its connected surface.
#[pyfunction]
pub fn surfaces_of<'py>(
    py: Python<'py>,
    triangles: PyReadonlyArray2<'py, i64>,
    vertex_count: usize,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    let triangles = triangles_of(&triangles, vertex_count).map_err(|e| to_python(py, &e))?;
    let owner = run(py, 0, triangles.len(), || {
        Ok(surfaces(&triangles, vertex_count))
    })?;
    let owner = owner.into_iter().map(i64::from).collect();
    Ok(PyArray1::from_vec(py, owner))
}

/// Return the numbers of used vertices, edges, open edges and connected surfaces.
#[pyfunction]
pub fn mesh_counts(
    py: Python<'_>,
    triangles: PyReadonlyArray2<'_, i64>,
    vertex_count: usize,
) -> PyResult<(usize, usize, usize, usize)> {
    let triangles = triangles_of(&triangles, vertex_count).map_err(|e| to_python(py, &e))?;
    let found = run(py, 0, triangles.len(), || {
        Ok(counts(&triangles, vertex_count))
    })?;
    let surfaces = found.surfaces;
    Ok((found.vertices, found.edges, found.open_edges, surfaces))
}

/// Return the volume, summed over tetrahedra with their apex at `middle`, and the area.
#[pyfunction]
pub fn mesh_measures(
    py: Python<'_>,
    vertices: PyReadonlyArray2<'_, f64>,
    triangles: PyReadonlyArray2<'_, i64>,
    middle: [f64; 3],
) -> PyResult<(f64, f64)> {
    let vertices = rows(&vertices, "vertices").map_err(|e| to_python(py, &e))?;
    let triangles = triangles_of(&triangles, vertices.len()).map_err(|e| to_python(py, &e))?;
    let found = run(py, 0, triangles.len(), || {
        Ok(measures(&vertices, &triangles, middle))
    })?;
    Ok((found.volume, found.area))
}

/// Return the volume, the centroid relative to `middle`, and the second moments about the centroid.
#[pyfunction]
pub fn mesh_moments(
    py: Python<'_>,
    vertices: PyReadonlyArray2<'_, f64>,
    triangles: PyReadonlyArray2<'_, i64>,
    middle: [f64; 3],
) -> PyResult<(f64, [f64; 3], [[f64; 3]; 3])> {
    let vertices = rows(&vertices, "vertices").map_err(|e| to_python(py, &e))?;
    let triangles = triangles_of(&triangles, vertices.len()).map_err(|e| to_python(py, &e))?;
    let found = run(py, 0, triangles.len(), || {
        Ok(moments(&vertices, &triangles, middle))
    })?;
    Ok((found.volume, found.centroid, found.second))
}
