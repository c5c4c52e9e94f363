//! Numpy arrays to rows and back.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::error::{Error, ErrorKind, Result};

/// The rows of an (n, 3) array.
pub fn rows<T: numpy::Element + Copy>(
    array: &PyReadonlyArray2<'_, T>,
    name: &str,
) -> Result<Vec<[T; 3]>> {
    let view = array.as_array();
    if view.ncols() != 3 {
        let text = format!("{name} must have shape (n, 3), not {:?}", view.shape());
        return Err(Error::new(ErrorKind::Shape, text));
    }
    if let Some(flat) = view.as_slice() {
        let row = |r: &[T]| [r[0], r[1], r[2]];
        return Ok(flat.chunks_exact(3).map(row).collect());
    }
    Ok(view
        .rows()
        .into_iter()
        .map(|r| [r[0], r[1], r[2]])
        .collect())
}

/// An (n, k) array from rows.
pub fn array<T, const K: usize>(
    py: Python<'_>,
    rows: Vec<[T; K]>,
) -> PyResult<Bound<'_, PyArray2<T>>>
where
    T: numpy::Element,
{
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_iter().flatten().collect()).reshape([count, K])
}
