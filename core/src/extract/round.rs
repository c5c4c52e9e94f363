//! From exact vertices to doubles: the only rounding, and what it did.

use super::assemble::{assemble, Corner, ExactMesh, TriangleFace};
use super::unfold::{unfold, Unfolded};
use crate::error::Result;
use crate::merge::list::Sources;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::tasks::fill_chunks;
use crate::tree::solid::Solid;

/// A triangle mesh in doubles.
#[derive(Debug, Default)]
pub struct Mesh {
    /// Vertices in model units.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, counterclockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the source's slot and the number of the face in its input.
    pub origins: Vec<[u32; 2]>,
    /// What was noticed on the way.
    pub findings: Vec<Finding>,
}

/// The mesh of a bounded solid, each vertex at the nearest double.
///
/// A vertex of an input mesh returns with its original doubles.
///
/// # Errors
/// `Unbounded`.
pub fn mesh(solid: &Solid) -> Result<Mesh> {
    let mut exact = assemble(solid)?;
    let mut vertices = vec![[0.0; 3]; exact.vertices.len()];
    fill_chunks(&exact.vertices, &mut vertices, |_, corners, out| {
        for (corner, place) in corners.iter().zip(out) {
            *place = position(solid, &exact, *corner);
        }
    });
    let mut mesh = Mesh {
        vertices,
        triangles: std::mem::take(&mut exact.triangles),
        origins: Vec::new(),
        findings: std::mem::take(&mut exact.findings),
    };
    let sources = Sources::new(solid.sources().clone());
    let unfolded = unfold(&mut mesh, &exact, &sources);
    report(&mut mesh, &unfolded);
    let origin = |f: TriangleFace| [f.slot, sources.get(f.slot as usize).number(f.face)];
    mesh.origins = exact.faces.into_iter().map(origin).collect();
    Ok(mesh)
}

fn position(solid: &Solid, exact: &ExactMesh, corner: Corner) -> [f64; 3] {
    match corner {
        Corner::Point(point) => solid.pitch().position(exact.table.point(point)),
        Corner::Source(slot, vertex) => {
            let mesh = solid.sources().get(slot as usize).mesh();
            mesh.map_or([0.0; 3], |m| m.doubles[vertex as usize])
        }
    }
}

/// Reports the triangles that rounding changed, by what became of them.
fn report(mesh: &mut Mesh, unfolded: &Unfolded) {
    let (collapsed, turned): (Vec<u64>, Vec<u64>) =
        unfolded.left.iter().partition(|t| is_collapsed(mesh, **t));
    let repaired = "rounding to doubles turned triangles over; an edge of these was swapped";
    let together = "rounding to doubles put two corners of these triangles in one place";
    let over = "rounding to doubles turned these triangles over or left them no area";
    for (code, severity, places, text) in [
        ("swapped", Severity::Note, &unfolded.repaired, repaired),
        ("collapsed", Severity::Note, &collapsed, together),
        ("turned", Severity::Warning, &turned, over),
    ] {
        if !places.is_empty() {
            let finding = Finding::about(code, severity, places, text);
            mesh.findings.push(finding);
        }
    }
}

/// Whether two corners of a triangle were rounded to the same place.
#[allow(clippy::float_cmp)]
fn is_collapsed(mesh: &Mesh, triangle: u64) -> bool {
    let [a, b, c] = mesh.triangles[triangle as usize].map(|v| mesh.vertices[v as usize]);
    a == b || b == c || c == a
}
