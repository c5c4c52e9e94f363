//! Import of a mesh: from arrays of doubles to a source, by snapping, checking and welding.

use super::chain::is_closed;
use super::finding::{Finding, Severity};
use super::grid::{snap_point, Pitch};
use super::snap::snap_all;
use super::source::{Source, WELDED};
use super::tasks::{each_chunk, fill_chunks};
use super::topology::{open_edges, Topology};
use super::triangles::TriangleMesh;
use crate::arith::convert::{as_double, as_index, as_number};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::{normal, Lattice};
use crate::interrupt::poll;
use crate::mesh::handle::VertexId;

/// The magnitudes of numbers that a message writes without an exponent.
const WITHOUT_EXPONENT: std::ops::Range<f64> = 1e-4..1e6;

/// Snaps a closed triangle mesh to the lattice.
///
/// `vertices` are in model units; `faces` are indices of them, counterclockwise from outside. Faces without
/// area are dropped; vertices at one lattice point are welded if the faces do not close by index; T-junctions
/// are accepted if the edges on each line cancel.
///
/// # Errors
/// `NonFinite`, `IndexOutOfRange`, `TooLarge`, `EmptyMesh`, and `NotClosed` with the faces at open edges.
///
/// # Example
/// ```
/// use bspcsg::mesh::import::import;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let source = import(&vertices, &faces, None)?;
/// assert!(source.is_closed());
/// let open = import(&vertices, &faces[1..], None).expect_err("a face is missing");
/// assert_eq!(open.kind().code(), "not_closed");
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn import(vertices: &[[f64; 3]], faces: &[[i64; 3]], pitch: Option<Pitch>) -> Result<Source> {
    let mut findings = Vec::new();
    let faces = check_indices(faces, vertices.len())?;
    let bounds = Bounds::of(vertices)?;
    let pitch = choose_pitch(&bounds, pitch, &mut findings)?;
    let lattice = snap_all(vertices, pitch)?;
    let mut mesh = TriangleMesh {
        vertices: lattice,
        doubles: vertices.to_vec(),
        faces,
        numbers: None,
    };
    let (volume, flat) = volume_and_flat_faces(&mesh);
    drop_faces(&mut mesh, flat, &mut findings);
    if mesh.faces.is_empty() {
        let exponent = pitch.exponent();
        let text = format!(
            "the mesh has no face of positive area on the lattice of steps of 10^{exponent} units"
        );
        return Err(Error::new(ErrorKind::EmptyMesh, text));
    }
    let open = closed_or_welded(&mut mesh, &mut findings)?;
    if volume < 0.0 {
        findings.push(Finding::about(
            "inside_out",
            Severity::Warning,
            &[0],
            "the faces enclose a negative volume: they are probably oriented inside out",
        ));
    }
    let cell = Cell::around(
        &snap_point(pitch, &bounds.low)?,
        &snap_point(pitch, &bounds.high)?,
    );
    Ok(Source::checked(mesh, pitch, open, cell, findings))
}

/// The faces with indices of 32 bits, after a check that all of them are below `count`.
fn check_indices(faces: &[[i64; 3]], count: usize) -> Result<Vec<[VertexId; 3]>> {
    let limit = u32::try_from(count)
        .ok()
        .filter(|c| *c < u32::MAX / 4)
        .ok_or_else(|| {
            Error::new(
                ErrorKind::TooLarge,
                "the mesh has more than 2^30 vertices, the largest number allowed",
            )
        })?;
    if faces.len() >= (u32::MAX / 4) as usize {
        return Err(Error::new(
            ErrorKind::TooLarge,
            "the mesh has more than 2^30 faces, the largest number allowed",
        ));
    }
    let mut narrow = vec![[VertexId::default(); 3]; faces.len()];
    let good = fill_chunks(faces, &mut narrow, |_, faces, narrow| {
        narrow_all(faces, limit, narrow)
    });
    if good.iter().all(|g| *g) {
        return Ok(narrow);
    }
    let bad = |face: &[i64; 3]| face.iter().any(|v| !(0..i64::from(limit)).contains(v));
    let row = faces.iter().position(bad).unwrap_or(0);
    let face = faces[row];
    let text =
        format!("face {row} has the vertex indices {face:?}, but there are only {count} vertices");
    Err(Error::at(
        ErrorKind::IndexOutOfRange,
        vec![row as u64],
        text,
    ))
}

/// Converts indices to 32 bits; returns whether all are at least 0 and below the limit.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is cut off is noticed"
)]
fn narrow_all(faces: &[[i64; 3]], limit: u32, narrow: &mut [[VertexId; 3]]) -> bool {
    let mut good = true;
    for (wide, narrow) in faces.as_flattened().iter().zip(narrow.as_flattened_mut()) {
        *narrow = VertexId(*wide as u32);
        good &= wide.cast_unsigned() < u64::from(limit);
    }
    good
}

/// The box around points in model units.
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    const NOTHING: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn of(points: &[[f64; 3]]) -> Result<Self> {
        let mut chunks = each_chunk(points, |_, points| Self::of_chunk(points)).into_iter();
        let found = chunks.try_fold(Self::NOTHING, |all, chunk| Some(all.with(&chunk?)));
        found.ok_or_else(|| {
            let bad = |p: &[f64; 3]| p.iter().any(|c| !c.is_finite());
            let row = points.iter().position(bad).unwrap_or(0);
            let point = point_text(&points[row]);
            let text = format!("vertex {row} is {point}; all coordinates must be finite numbers");
            Error::at(ErrorKind::NonFinite, vec![row as u64], text)
        })
    }

    /// The box around points, or `None` if a coordinate is not finite.
    fn of_chunk(points: &[[f64; 3]]) -> Option<Self> {
        let mut bounds = Self::NOTHING;
        let mut finite = true;
        for point in points {
            for (i, c) in point.iter().enumerate() {
                bounds.low[i] = if *c < bounds.low[i] {
                    *c
                } else {
                    bounds.low[i]
                };
                bounds.high[i] = if *c > bounds.high[i] {
                    *c
                } else {
                    bounds.high[i]
                };
                finite &= c.is_finite();
            }
        }
        finite.then_some(bounds)
    }

    fn with(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    fn largest(&self) -> f64 {
        let magnitudes = self.low.iter().chain(&self.high).map(|c| c.abs());
        magnitudes.fold(0.0, f64::max)
    }

    fn extent(&self) -> f64 {
        (0..3).fold(0.0, |m, i| f64::max(m, self.high[i] - self.low[i]))
    }
}

fn choose_pitch(
    bounds: &Bounds,
    pitch: Option<Pitch>,
    findings: &mut Vec<Finding>,
) -> Result<Pitch> {
    if let Some(pitch) = pitch {
        return Ok(pitch);
    }
    let (largest, extent) = (bounds.largest(), bounds.extent());
    let chosen = Pitch::suited(if largest.is_finite() { largest } else { 0.0 }, extent)?;
    if chosen != Pitch::DEFAULT {
        let text = format!(
            "coordinates up to {largest:e} do not suit the default lattice step 10^-9; the step is 10^{}",
            chosen.exponent()
        );
        findings.push(Finding::about("pitch", Severity::Note, &[0], text));
    }
    Ok(chosen)
}

/// Six times the enclosed volume in cubic steps, and the numbers of the faces without area.
///
/// The volume is summed in doubles, relative to the first vertex, in the order of the faces.
fn volume_and_flat_faces(mesh: &TriangleMesh) -> (f64, Vec<u32>) {
    let origin = mesh.vertices.first().copied().unwrap_or_default();
    let weigh = |first: usize, faces: &[[VertexId; 3]]| {
        volume_and_flat_faces_of_chunk(faces, &mesh.vertices, &origin, first)
    };
    let (volumes, flat): (Vec<f64>, Vec<Vec<u32>>) =
        each_chunk(&mesh.faces, weigh).into_iter().unzip();
    (volumes.iter().sum(), flat.concat())
}

/// Removes faces, given by their numbers in ascending order, and reports them as a finding.
fn drop_faces(mesh: &mut TriangleMesh, faces: Vec<u32>, findings: &mut Vec<Finding>) {
    if faces.is_empty() {
        return;
    }
    let mut dropped = faces.iter().peekable();
    let kept = |face: &u32| dropped.next_if_eq(&face).is_none();
    let keep: Vec<u32> = (0..as_number(mesh.faces.len())).filter(kept).collect();
    mesh.faces = keep.iter().map(|i| mesh.faces[*i as usize]).collect();
    mesh.numbers = Some(keep);
    let places: Vec<u64> = faces.into_iter().map(u64::from).collect();
    let text = "faces without area were left out";
    findings.push(Finding::about("zero_area", Severity::Note, &places, text));
}

/// Six times the volume of a chunk of faces, and the numbers of its faces without area; the chunk begins with
/// face `first`.
fn volume_and_flat_faces_of_chunk(
    faces: &[[VertexId; 3]],
    vertices: &[Lattice],
    origin: &Lattice,
    first: usize,
) -> (f64, Vec<u32>) {
    let mut volume = 0.0;
    let mut flat = Vec::new();
    for (number, face) in (as_number(first)..).zip(faces) {
        poll();
        let corners = face.map(|v| &vertices[v.index()]);
        let [u, v] = edge_vectors(corners);
        let arm = each_axis(|i| as_double(corners[0][i] - origin[i]));
        volume += arm[0] * (u[1] * v[2] - u[2] * v[1])
            + arm[1] * (u[2] * v[0] - u[0] * v[2])
            + arm[2] * (u[0] * v[1] - u[1] * v[0]);
        if !are_surely_not_parallel(&u, &v) && is_flat(&corners.map(|c| *c)) {
            flat.push(number);
        }
    }
    (volume, flat)
}

/// Return whether a triangle has no area, exactly.
pub fn is_flat(corners: &[Lattice; 3]) -> bool {
    let [a, b, c] = corners;
    let [u, v] = edge_vectors([a, b, c]);
    !are_surely_not_parallel(&u, &v) && normal(a, b, c) == [0; 3]
}

/// The vectors from the first corner of a triangle to the two others, in doubles.
fn edge_vectors([a, b, c]: [&Lattice; 3]) -> [[f64; 3]; 2] {
    [b, c].map(|end| each_axis(|i| as_double(end[i] - a[i])))
}

/// Return whether doubles prove that two vectors are not parallel; may return false negatives.
fn are_surely_not_parallel(u: &[f64; 3], v: &[f64; 3]) -> bool {
    let certain = |i: usize, j: usize| {
        let (p, q) = (u[i] * v[j], u[j] * v[i]);
        (p - q).abs() > 4.0 * f64::EPSILON * (p.abs() + q.abs())
    };
    certain(0, 1) || certain(1, 2) || certain(2, 0)
}

/// Returns the end vertices of edges that have no opposite edge between the same vertex numbers. If there are
/// such edges, welds vertices at one lattice point, and then cancels opposite edges along common lines; an
/// error if edges remain.
fn closed_or_welded(mesh: &mut TriangleMesh, findings: &mut Vec<Finding>) -> Result<Vec<VertexId>> {
    if is_closed(&mesh.faces) {
        return Ok(Vec::new());
    }
    if let Some(welded) = welded_faces(mesh) {
        mesh.faces = welded;
        findings.push(Finding::about(
            WELDED,
            Severity::Note,
            &[0],
            "vertices with equal coordinates were welded to close the mesh",
        ));
        if is_closed(&mesh.faces) {
            return Ok(Vec::new());
        }
    }
    let topology = Topology::new(&mesh.faces, mesh.vertices.len());
    let open = open_edges(&mesh.vertices, &mesh.faces, topology.unpaired());
    if open.is_empty() {
        return Ok(topology.open_vertices(&mesh.faces));
    }
    Err(not_closed(mesh, &open))
}

fn not_closed(mesh: &TriangleMesh, open: &[u64]) -> Error {
    let number = |half: &u64| {
        let face = as_number(as_index(*half / 3));
        u64::from(mesh.numbers.as_ref().map_or(face, |n| n[face as usize]))
    };
    let mut faces: Vec<u64> = open.iter().map(number).collect();
    faces.dedup();
    let half = as_index(open[0]);
    let face = mesh.faces[half / 3];
    let (a, b) = (face[half % 3].index(), face[(half % 3 + 1) % 3].index());
    let text = format!(
        "the mesh is not closed: {} edges have no matching opposite; the first belongs to face {} \
         and runs from {} to {}",
        open.len(),
        faces[0],
        point_text(&mesh.doubles[a]),
        point_text(&mesh.doubles[b]),
    );
    Error::at(ErrorKind::NotClosed, faces, text)
}

/// A point as messages write it.
fn point_text([x, y, z]: &[f64; 3]) -> String {
    format!("({}, {}, {})", rounded(*x), rounded(*y), rounded(*z))
}

/// A number rounded to six significant digits, as messages write it.
fn rounded(number: f64) -> String {
    let digits = format!("{number:.5e}");
    let short: f64 = digits.parse().unwrap_or(number);
    if short == 0.0 || WITHOUT_EXPONENT.contains(&short.abs()) {
        format!("{short}")
    } else {
        format!("{short:e}")
    }
}

/// The faces after vertices at one lattice point are merged; `None` if no two vertices are at one point.
fn welded_faces(mesh: &TriangleMesh) -> Option<Vec<[VertexId; 3]>> {
    let image = mesh.first_equal_vertices();
    let changed = VertexId::all().zip(&image).any(|(i, v)| i != *v);
    let weld = |face: &[VertexId; 3]| face.map(|v| image[v.index()]);
    changed.then(|| mesh.faces.iter().map(weld).collect())
}
