//! Converts numpy arrays to rows, and rows to arrays.

use std::borrow::Cow;

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::error::{Error, ErrorKind, Result};
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::fill_chunks;

/// Returns the rows of an (n, k) array: borrowed from the array, or copied if the array is not contiguous.
pub fn rows<'a, T: Element + Copy, const K: usize>(
    array: &'a PyReadonlyArray2<'_, T>,
    name: &str,
) -> Result<Cow<'a, [[T; K]]>> {
    let view = array.as_array();
    if view.ncols() != K {
        let text = format!("{name} must have shape (n, {K}), not {:?}", view.shape());
        return Err(Error::new(ErrorKind::Shape, text));
    }
    // An array that was sliced by columns stores its columns one after another.
    if let (true, Ok(flat)) = (view.is_standard_layout(), array.as_slice()) {
        return Ok(Cow::Borrowed(flat.as_chunks().0));
    }
    let row = |r: numpy::ndarray::ArrayView1<'_, T>| std::array::from_fn(|k| r[k]);
    Ok(Cow::Owned(view.rows().into_iter().map(row).collect()))
}

/// Returns the numbers of an array, row by row: borrowed from the array, or copied if its memory has another
/// order.
pub fn flat<'a, T: Element + Copy>(array: &'a PyReadonlyArray2<'_, T>) -> Cow<'a, [T]> {
    let view = array.as_array();
    match array.as_slice() {
        Ok(flat) if view.is_standard_layout() => Cow::Borrowed(flat),
        _ => Cow::Owned(view.iter().copied().collect()),
    }
}

/// Returns triangles as vertex numbers, each below `vertex_count`.
///
/// # Errors
/// `Shape` if the rows have not three numbers each, `IndexOutOfRange` if a vertex does not exist.
pub fn triangles_of(
    triangles: &PyReadonlyArray2<'_, i64>,
    vertex_count: usize,
) -> Result<Vec<[VertexId; 3]>> {
    let index = |v: i64| {
        u32::try_from(v)
            .ok()
            .map(VertexId)
            .filter(|v| v.index() < vertex_count)
    };
    let row = |(t, corners): (usize, &[i64; 3])| {
        if let [Some(a), Some(b), Some(c)] = corners.map(index) {
            return Ok([a, b, c]);
        }
        let text = format!(
            "triangle {t} has a vertex index out of range; there are {vertex_count} vertices"
        );
        Err(Error::new(ErrorKind::IndexOutOfRange, text))
    };
    let triangles = rows(triangles, "triangles")?;
    triangles.iter().enumerate().map(row).collect()
}

/// Converts rows of indices to 64-bit integers, the type of index arrays in Python.
pub fn wide<T: Copy + Into<i64> + Sync, const K: usize>(rows: &[[T; K]]) -> Vec<[i64; K]> {
    let mut wide = vec![[0; K]; rows.len()];
    fill_chunks(rows, &mut wide, |_, rows, wide| {
        for (row, wide) in rows.iter().zip(wide) {
            *wide = row.map(T::into);
        }
    });
    wide
}

/// Makes an (n, k) array of rows, without copying them.
pub fn array<T: Element, const K: usize>(
    py: Python<'_>,
    rows: Vec<[T; K]>,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = rows.len();
    PyArray1::from_vec(py, rows.into_flattened()).reshape([count, K])
}
