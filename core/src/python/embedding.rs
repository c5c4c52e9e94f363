//! Finds crossings of a mesh with itself, and rounds meshes to single precision.

use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::arrays::{array, rows, triangles_of, wide};
use super::calls::errors::to_python;
use super::calls::run::run;
use crate::error::{Error, ErrorKind, Result};
use crate::extract::rounding::crossings::{all_faults, Faults};
use crate::extract::rounding::settle::{settle_in_single, settle_moved, Rounded, Settled};
use crate::mesh::faces::Faces;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::VertexId;

/// Return the pairs of triangles that cross or overlap, and the triangles without area.
#[pyfunction]
pub fn mesh_faults<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
) -> PyResult<Bound<'py, PyDict>> {
    let mesh = given(&vertices, &triangles).map_err(|e| to_python(py, &e))?;
    let found = run(py, 0, mesh.triangles.len(), || {
        Ok(all_faults(&Faces {
            vertices: &mesh.vertices,
            triangles: &mesh.triangles,
        }))
    })?;
    let dict = PyDict::new(py);
    set_faults(&dict, found)?;
    Ok(dict)
}

/// Return a mesh, closed by index, rounded to single precision, without the crossings that the rounding
/// makes.
#[pyfunction]
pub fn mesh_in_single<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut mesh = given(&vertices, &triangles).map_err(|e| to_python(py, &e))?;
    let settled = run(py, 0, mesh.triangles.len(), || {
        Ok(settle_in_single(&mut mesh))
    })?;
    settled_mesh(py, mesh, settled)
}

/// Return a mesh whose vertices a transform moved, after removing the crossings that this made; None if
/// nothing had to change. The mesh must be closed by index, or become so by welding equal vertices.
#[pyfunction]
pub fn mesh_moved<'py>(
    py: Python<'py>,
    before: PyReadonlyArray2<'py, f64>,
    vertices: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
    pitch: i64,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let pitch = Pitch::new(pitch).map_err(|e| to_python(py, &e))?;
    let before = given(&before, &triangles).map_err(|e| to_python(py, &e))?;
    let mut mesh = given(&vertices, &triangles).map_err(|e| to_python(py, &e))?;
    let settled = run(py, 0, mesh.triangles.len(), || {
        Ok(settle_moved(&mut mesh, &before.vertices, pitch))
    })?;
    let is_changed = !(settled.moved.is_empty() && settled.mended.is_empty());
    (is_changed || !settled.left.is_empty())
        .then(|| settled_mesh(py, mesh, settled))
        .transpose()
}

fn settled_mesh(py: Python<'_>, mesh: Rounded, settled: Settled) -> PyResult<Bound<'_, PyDict>> {
    let numbers = (0..).zip(&mesh.triangles);
    let (kept, left): (Vec<i64>, Vec<[VertexId; 3]>) =
        numbers.filter(|(_, t)| t[0] != t[1]).unzip();
    let dict = PyDict::new(py);
    dict.set_item("vertices", array(py, mesh.vertices)?)?;
    dict.set_item("triangles", array(py, wide(&left))?)?;
    dict.set_item("kept", PyArray1::from_vec(py, kept))?;
    dict.set_item("mended", settled.mended.len())?;
    set_faults(&dict, settled.left)?;
    Ok(dict)
}

fn set_faults(dict: &Bound<'_, PyDict>, found: Faults) -> PyResult<()> {
    let py = dict.py();
    let flat = found.flat.into_iter().map(i64::from).collect();
    dict.set_item("crossings", array(py, wide(&found.crossings))?)?;
    dict.set_item("flat", PyArray1::from_vec(py, flat))
}

/// Converts the arrays of a mesh, and checks that coordinates are finite and that all vertices exist.
fn given(
    vertices: &PyReadonlyArray2<'_, f64>,
    triangles: &PyReadonlyArray2<'_, i64>,
) -> Result<Rounded> {
    let vertices = rows(vertices, "vertices")?.into_owned();
    if vertices.as_flattened().iter().any(|x| !x.is_finite()) {
        let text = "a coordinate is not a finite number";
        return Err(Error::new(ErrorKind::NonFinite, text));
    }
    Ok(Rounded {
        triangles: triangles_of(triangles, vertices.len())?,
        vertices,
    })
}
