//! Convex hulls of points on the lattice.

use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use super::arrays::{array, rows, wide};
use super::calls::errors::to_python;
use super::calls::run::run;
use crate::extract::rounding::settle::{settle_snapped, Rounded};
use crate::geometry::doubles::hull::hull;
use crate::geometry::doubles::Point;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::VertexId;
use crate::mesh::snap::snap_all;

/// The vertices and triangles of a hull, and whether it was mended.
type HullMesh<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<i64>>, bool);

/// The mesh of the convex hull of points, snapped to the lattice, with the coordinates that were
/// given; empty if they lie in one plane. Faces that would cross or have no area are mended.
#[pyfunction]
pub fn hull_mesh<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    pitch: i64,
) -> PyResult<HullMesh<'py>> {
    let points = rows(&points, "points").map_err(|e| to_python(py, &e))?;
    let (mesh, is_mended) = run(py, 0, points.len(), || {
        let pitch = Pitch::new(pitch)?;
        let lattice = snap_all(&points, pitch)?;
        // Below 2^53 in magnitude, so that doubles hold them.
        let steps: Vec<Point> = lattice.iter().map(|p| p.map(|k| k as f64)).collect();
        let faces = hull(&steps);
        let used = corners_of(&faces);
        let mut mesh = Rounded {
            vertices: used.iter().map(|p| points[*p]).collect(),
            triangles: numbered(&faces, &used),
        };
        let settled = settle_snapped(&mut mesh, pitch);
        mesh.triangles.retain(|t| t[0] != t[1]);
        Ok((
            mesh,
            !(settled.moved.is_empty() && settled.mended.is_empty()),
        ))
    })?;
    Ok((
        array(py, mesh.vertices)?,
        array(py, wide(&mesh.triangles))?,
        is_mended,
    ))
}

/// The points that faces use, ascending.
fn corners_of(faces: &[[usize; 3]]) -> Vec<usize> {
    let mut used: Vec<usize> = faces.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    used
}

/// Faces by the places of their corners among the used points.
fn numbered(faces: &[[usize; 3]], used: &[usize]) -> Vec<[VertexId; 3]> {
    let place = |p: usize| used.partition_point(|q| *q < p);
    faces
        .iter()
        .map(|face| face.map(|p| VertexId::of(place(p))))
        .collect()
}
