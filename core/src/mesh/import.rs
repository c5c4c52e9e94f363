//! From arrays of doubles to a source: snapping, judging, welding.

use rustc_hash::FxHashMap as HashMap;
use std::sync::Arc;

use rayon::prelude::*;

use super::finding::{Finding, Severity};
use super::grid::{snap_point, Pitch};
use super::source::{Shape, Source, TriangleMesh};
use super::topology::{open_edges, Topology};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;
use crate::geometry::plane::{normal, Lattice};

/// Reads a closed triangle mesh onto the lattice.
///
/// `vertices` are in model units, `faces` index them, counterclockwise as seen from outside.
/// Faces without area are left out; vertices at one place are welded if the faces do not close by
/// index; T-junctions are accepted where the pieces of each line cancel.
///
/// # Errors
/// `NonFinite`, `IndexOutOfRange`, `TooLarge`, `EmptyMesh`, and `NotClosed` with the faces at open edges.
pub fn import(vertices: &[[f64; 3]], faces: &[[i64; 3]], pitch: Option<Pitch>) -> Result<Source> {
    let mut findings = Vec::new();
    let faces = check_indices(faces, vertices.len())?;
    let pitch = choose_pitch(vertices, pitch, &mut findings)?;
    let lattice = snap_all(vertices, pitch)?;
    let mut mesh = TriangleMesh {
        vertices: lattice,
        doubles: vertices.to_vec(),
        faces,
        numbers: None,
    };
    drop_flat_faces(&mut mesh, &mut findings);
    if mesh.faces.is_empty() {
        let text = "the mesh has no face of positive area";
        return Err(Error::new(ErrorKind::EmptyMesh, text));
    }
    let topology = close(&mut mesh, &mut findings)?;
    if !topology.irregular().is_empty() {
        findings.push(Finding::about(
            "non_manifold",
            Severity::Note,
            &topology
                .irregular()
                .iter()
                .map(|v| u64::from(*v))
                .collect::<Vec<_>>(),
            "more than two faces share an edge, or several fans a vertex, at these vertices",
        ));
    }
    if signed_volume(&mesh) < 0.0 {
        findings.push(Finding::about(
            "inside_out",
            Severity::Warning,
            &[0],
            "the faces enclose a negative volume: they are probably oriented inside out",
        ));
    }
    Ok(Source::with_topology(mesh, pitch, topology, findings))
}

/// Six times the enclosed volume in doubles, about the first vertex.
fn signed_volume(mesh: &TriangleMesh) -> f64 {
    let origin = mesh.doubles.first().copied().unwrap_or_default();
    let local = |v: u32| {
        let p = mesh.doubles[v as usize];
        [p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]]
    };
    let determinant = |f: &[u32; 3]| {
        let [a, b, c] = f.map(local);
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    mesh.faces.iter().map(determinant).sum()
}

/// The half-space normal·x ≤ offset, in model units.
///
/// # Errors
/// `BadNormal` if the normal is zero or not finite, `TooLarge` if the offset leaves the lattice.
pub fn half_space(normal: [f64; 3], offset: f64, pitch: Pitch) -> Result<Source> {
    let (n, p, exact) = oriented_foot(normal, offset, pitch)?;
    let plane = Plane::through_point(n, &p)
        .ok_or_else(|| Error::new(ErrorKind::BadNormal, "the normal is too small"))?;
    let mut findings = Vec::new();
    if !exact {
        findings.push(Finding::about(
            "half_space_rounded",
            Severity::Note,
            &[0],
            "the half-space's normal was rounded to 53 bits relative to its largest component",
        ));
    }
    Ok(Source::new(
        pitch,
        Shape::HalfSpace(Arc::new(plane)),
        findings,
    ))
}

/// An integer normal, a lattice point of the hyperplane n·x = offset, and whether the normal is exact.
///
/// The point is the foot of the origin, snapped to the lattice.
///
/// # Errors
/// `BadNormal`, `NonFinite`, `TooLarge`.
pub fn oriented_foot(
    normal: [f64; 3],
    offset: f64,
    pitch: Pitch,
) -> Result<([i128; 3], Lattice, bool)> {
    let size = normal.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    let square: f64 = normal.iter().map(|c| (c / size) * (c / size)).sum();
    if !(size > 0.0 && size.is_finite() && square.is_finite() && offset.is_finite()) {
        let text = "a half-space needs a finite normal that is not zero and a finite offset";
        return Err(Error::new(ErrorKind::BadNormal, text));
    }
    let (n, exact) = integer_normal(&normal, size);
    let axis = (0..3)
        .max_by(|i, j| normal[*i].abs().total_cmp(&normal[*j].abs()))
        .unwrap_or(0);
    let scale = offset / size / square;
    let mut foot = [0, 1, 2].map(|i| normal[i] / size * scale);
    if (0..3).all(|i| i == axis || normal[i] == 0.0) {
        foot = [0.0; 3];
        foot[axis] = offset / normal[axis];
    }
    let p = snap_point(pitch, &foot)?;
    Ok((n, p, exact))
}

/// The normal as integers of at most 53 bits, and whether nothing was lost.
#[allow(clippy::float_cmp)]
fn integer_normal(normal: &[f64; 3], size: f64) -> ([i128; 3], bool) {
    let exponent = size.log2().floor();
    let scaled = normal.map(|c| c / 2f64.powf(exponent) * 2f64.powi(52));
    let rounded = scaled.map(f64::round);
    let exact = (0..3).all(|i| scaled[i] == rounded[i]);
    (rounded.map(|c| c as i128), exact)
}

fn check_indices(faces: &[[i64; 3]], count: usize) -> Result<Vec<[u32; 3]>> {
    let limit = u32::try_from(count)
        .ok()
        .filter(|c| *c < u32::MAX / 4)
        .ok_or_else(|| Error::new(ErrorKind::TooLarge, "a mesh holds at most 2^30 vertices"))?;
    if faces.len() >= (u32::MAX / 4) as usize {
        return Err(Error::new(
            ErrorKind::TooLarge,
            "a mesh holds at most 2^30 faces",
        ));
    }
    let narrow = |(row, face): (usize, &[i64; 3])| {
        let ok = face.iter().all(|v| (0..i64::from(limit)).contains(v));
        if ok {
            return Ok(face.map(|v| v as u32));
        }
        let text = format!("face {row} names vertices {face:?}, but there are {count} vertices");
        Err(Error::at(
            ErrorKind::IndexOutOfRange,
            vec![row as u64],
            text,
        ))
    };
    faces.iter().enumerate().map(narrow).collect()
}

fn choose_pitch(
    vertices: &[[f64; 3]],
    pitch: Option<Pitch>,
    findings: &mut Vec<Finding>,
) -> Result<Pitch> {
    if let Some(row) = vertices
        .iter()
        .position(|p| p.iter().any(|c| !c.is_finite()))
    {
        let text = format!(
            "vertex {row} is {}; coordinates must be finite",
            place(&vertices[row])
        );
        return Err(Error::at(ErrorKind::NonFinite, vec![row as u64], text));
    }
    if let Some(pitch) = pitch {
        return Ok(pitch);
    }
    let mut largest = 0.0f64;
    let mut extent = 0.0f64;
    for i in 0..3 {
        let low = vertices.iter().fold(f64::INFINITY, |m, p| m.min(p[i]));
        let high = vertices.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[i]));
        largest = largest.max(low.abs()).max(high.abs());
        extent = extent.max(high - low);
    }
    let chosen = Pitch::suited(if largest.is_finite() { largest } else { 0.0 }, extent)?;
    if chosen != Pitch::DEFAULT {
        let text = format!(
            "coordinates up to {largest:e} do not suit the pitch 10^-9; using 10^{}",
            chosen.exponent()
        );
        findings.push(Finding::about("pitch", Severity::Note, &[0], text));
    }
    Ok(chosen)
}

fn snap_all(vertices: &[[f64; 3]], pitch: Pitch) -> Result<Vec<Lattice>> {
    vertices
        .par_iter()
        .with_min_len(1 << 13)
        .enumerate()
        .map(|(row, p)| {
            snap_point(pitch, p).map_err(|e| {
                Error::at(
                    e.kind(),
                    vec![row as u64],
                    format!("vertex {row}: {}", e.message()),
                )
            })
        })
        .collect()
}

/// Leaves out the faces without area.
fn drop_flat_faces(mesh: &mut TriangleMesh, findings: &mut Vec<Finding>) {
    let flat: Vec<bool> = mesh
        .faces
        .par_iter()
        .with_min_len(1 << 13)
        .map(|f| is_flat(&f.map(|v| mesh.vertices[v as usize])))
        .collect();
    let places: Vec<u64> = (0u64..)
        .zip(&flat)
        .filter(|(_, f)| **f)
        .map(|(i, _)| i)
        .collect();
    if places.is_empty() {
        return;
    }
    let keep: Vec<u32> = (0u32..)
        .zip(&flat)
        .filter(|(_, f)| !**f)
        .map(|(i, _)| i)
        .collect();
    mesh.faces = keep.iter().map(|i| mesh.faces[*i as usize]).collect();
    mesh.numbers = Some(keep);
    findings.push(Finding::about(
        "zero_area",
        Severity::Note,
        &places,
        "faces without area were left out",
    ));
}

/// Whether a triangle has no area.
pub fn is_flat(corners: &[Lattice; 3]) -> bool {
    let [a, b, c] = corners;
    let u = [0, 1, 2].map(|i| (b[i] - a[i]) as f64);
    let v = [0, 1, 2].map(|i| (c[i] - a[i]) as f64);
    let certain = |i: usize, j: usize| {
        let (p, q) = (u[i] * v[j], u[j] * v[i]);
        (p - q).abs() > 4.0 * f64::EPSILON * (p.abs() + q.abs())
    };
    if certain(0, 1) || certain(1, 2) || certain(2, 0) {
        return false;
    }
    normal(a, b, c) == [0; 3]
}

/// Pairs half-edges; welds by place, then cancels along lines, if they do not pair by index.
fn close(mesh: &mut TriangleMesh, findings: &mut Vec<Finding>) -> Result<Topology> {
    let topology = Topology::new(&mesh.faces, mesh.vertices.len());
    if topology.unpaired().next().is_none() {
        return Ok(topology);
    }
    let before = mesh.faces.clone();
    if weld(mesh) {
        findings.push(Finding::about(
            "welded",
            Severity::Note,
            &[0],
            "vertices at the same place were welded to close the mesh",
        ));
    } else {
        mesh.faces = before;
    }
    let topology = Topology::new(&mesh.faces, mesh.vertices.len());
    let open = open_edges(&mesh.vertices, &mesh.faces, topology.unpaired());
    if open.is_empty() {
        return Ok(topology);
    }
    Err(not_closed(mesh, &open))
}

fn not_closed(mesh: &TriangleMesh, open: &[u64]) -> Error {
    let number = |half: &u64| {
        let face = (*half / 3) as u32;
        u64::from(mesh.numbers.as_ref().map_or(face, |n| n[face as usize]))
    };
    let mut faces: Vec<u64> = open.iter().map(number).collect();
    faces.dedup();
    let half = open[0] as usize;
    let face = mesh.faces[half / 3];
    let (a, b) = (face[half % 3] as usize, face[(half % 3 + 1) % 3] as usize);
    let text = format!(
        "the mesh is not closed: {} edges have no matching opposite; the first belongs to face {} \
         and runs from {} to {}",
        open.len(),
        faces[0],
        place(&mesh.doubles[a]),
        place(&mesh.doubles[b]),
    );
    Error::at(ErrorKind::NotClosed, faces, text)
}

/// A point as a message shows it.
fn place([x, y, z]: &[f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}

/// Makes vertices at one lattice point one vertex; says whether there were any.
fn weld(mesh: &mut TriangleMesh) -> bool {
    let mut first: HashMap<Lattice, u32> =
        HashMap::with_capacity_and_hasher(mesh.vertices.len(), rustc_hash::FxBuildHasher);
    let image: Vec<u32> = (0u32..)
        .zip(&mesh.vertices)
        .map(|(i, p)| *first.entry(*p).or_insert(i))
        .collect();
    let changed = (0u32..).zip(&image).any(|(i, v)| i != *v);
    for vertex in mesh.faces.iter_mut().flatten() {
        *vertex = image[*vertex as usize];
    }
    changed
}
