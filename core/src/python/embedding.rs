//! Whether a mesh in doubles crosses itself.

use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{array, rows, wide};
use super::errors::to_python;
use super::run::run;
use crate::error::{Error, ErrorKind, Result};
use crate::extract::crossings::{all_faults, Faces};

type FaultArrays<'py> = (Bound<'py, PyArray2<i64>>, Bound<'py, PyArray1<i64>>);

/// The pairs of triangles that cross or overlap, and the triangles without area.
#[pyfunction]
pub fn mesh_faults<'py>(
    py: Python<'py>,
    vertices: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
) -> PyResult<FaultArrays<'py>> {
    let fail = |e: Error| to_python(py, &e);
    let vertices = rows(&vertices, "vertices").map_err(fail)?;
    let triangles = rows(&triangles, "triangles").map_err(fail)?;
    let indices = indices(&triangles, vertices.len()).map_err(fail)?;
    if vertices.as_flattened().iter().any(|x| !x.is_finite()) {
        let text = "a coordinate is not a finite number";
        return Err(fail(Error::new(ErrorKind::NonFinite, text)));
    }
    let found = run(py, 0, indices.len(), |_| {
        let faces = Faces {
            vertices: &vertices,
            triangles: &indices,
        };
        Ok(all_faults(&faces))
    })?;
    let flat = found.flat.into_iter().map(i64::from).collect();
    Ok((
        array(py, wide(&found.crossings))?,
        PyArray1::from_vec(py, flat),
    ))
}

/// Triangles with indices of vertices that exist.
fn indices(triangles: &[[i64; 3]], count: usize) -> Result<Vec<[u32; 3]>> {
    let index = |v: i64| u32::try_from(v).ok().filter(|v| (*v as usize) < count);
    let row = |(t, corners): (usize, &[i64; 3])| match corners.map(index) {
        [Some(a), Some(b), Some(c)] => Ok([a, b, c]),
        _ => {
            let text = format!("triangle {t} names a vertex that does not exist");
            Err(Error::new(ErrorKind::IndexOutOfRange, text))
        }
    };
    triangles.iter().enumerate().map(row).collect()
}
