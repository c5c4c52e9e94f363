//! Lists of convex pieces or outlines as flat arrays.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// Pieces one after another: coordinates of all corners, the number of corners of each piece, and
/// a number that each piece carries.
#[derive(Debug, Default)]
pub struct PieceList {
    /// Coordinates, `dimension` for each corner.
    pub coordinates: Vec<f64>,
    /// The place where each piece begins, counted in corners, and where the last one ends.
    pub offsets: Vec<i64>,
    /// The owner of each piece: a node, a cell or a parent.
    pub tags: Vec<i64>,
}

impl PieceList {
    /// An empty list.
    pub fn new() -> Self {
        Self {
            offsets: vec![0],
            ..Self::default()
        }
    }

    /// Adds a piece.
    pub fn push<const D: usize>(&mut self, corners: impl IntoIterator<Item = [f64; D]>, tag: i64) {
        self.coordinates.extend(corners.into_iter().flatten());
        self.offsets.push((self.coordinates.len() / D) as i64);
        self.tags.push(tag);
    }
}

/// Vertices (n, d), offsets (k + 1,), tags (k,).
pub type Pieces<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<i64>>,
);

/// The arrays of a list.
pub fn arrays(py: Python<'_>, list: PieceList, dimension: usize) -> PyResult<Pieces<'_>> {
    let count = list.coordinates.len() / dimension;
    let vertices = PyArray1::from_vec(py, list.coordinates).reshape([count, dimension])?;
    Ok((
        vertices,
        PyArray1::from_vec(py, list.offsets),
        PyArray1::from_vec(py, list.tags),
    ))
}
