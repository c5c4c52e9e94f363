//! Stores lists of convex pieces or outlines as flat arrays.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;

/// A list of convex polygons, segments or points: the coordinates of all corners, the index of the first
/// corner of each, and a tag of each.
#[derive(Debug, Default)]
pub struct PieceList {
    /// The coordinates of all corners, `dimension` for each.
    pub coordinates: Vec<f64>,
    /// The index of each piece's first corner; the last entry is the number of corners.
    pub offsets: Vec<i64>,
    /// The tag of each polygon, segment or point: the number of its node or cell, or of the outline around
    /// it.
    pub tags: Vec<i64>,
}

impl PieceList {
    /// Makes an empty list.
    pub fn new() -> Self {
        Self {
            offsets: vec![0],
            ..Self::default()
        }
    }

    /// Adds a polygon, segment or point with its corners and its tag.
    pub fn push<const D: usize>(&mut self, corners: impl IntoIterator<Item = [f64; D]>, tag: i64) {
        self.coordinates.extend(corners.into_iter().flatten());
        self.offsets.push((self.coordinates.len() / D) as i64);
        self.tags.push(tag);
    }
}

/// Vertices (n, d), offsets (k + 1,) and tags (k,) of k pieces.
pub type Pieces<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<i64>>,
    Bound<'py, PyArray1<i64>>,
);

/// Converts a list of polygons, segments or points to arrays.
pub fn arrays(py: Python<'_>, list: PieceList, dimension: usize) -> PyResult<Pieces<'_>> {
    let count = list.coordinates.len() / dimension;
    let vertices = PyArray1::from_vec(py, list.coordinates).reshape([count, dimension])?;
    Ok((
        vertices,
        PyArray1::from_vec(py, list.offsets),
        PyArray1::from_vec(py, list.tags),
    ))
}
