//! From exact vertices to doubles: the only rounding, and what it did.

use super::assemble::{assemble, Corner, ExactMesh};
use crate::error::Result;
use crate::mesh::finding::{Finding, Severity};
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
    let exact = assemble(solid)?;
    let vertices = exact
        .vertices
        .iter()
        .map(|c| position(solid, &exact, *c))
        .collect();
    let mut mesh = Mesh {
        vertices,
        triangles: exact.triangles,
        origins: exact.origins,
        findings: exact.findings,
    };
    report_collapsed(&mut mesh);
    Ok(mesh)
}

fn position(solid: &Solid, exact: &ExactMesh, corner: Corner) -> [f64; 3] {
    match corner {
        Corner::Point(point) => solid.pitch().position(exact.table.point(point)),
        Corner::Source(slot, vertex) => {
            let mesh = solid.sources()[slot as usize].mesh();
            mesh.map_or([0.0; 3], |m| m.doubles[vertex as usize])
        }
    }
}

/// Reports triangles two corners of which were rounded to the same place.
#[allow(clippy::float_cmp)]
fn report_collapsed(mesh: &mut Mesh) {
    let same = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
        a == b || b == c || c == a
    };
    let places: Vec<u64> = (0u64..)
        .zip(&mesh.triangles)
        .filter(|(_, t)| same(t))
        .map(|(i, _)| i)
        .collect();
    if !places.is_empty() {
        let text = "rounding to doubles put two corners of these triangles in one place";
        mesh.findings
            .push(Finding::about("collapsed", Severity::Note, &places, text));
    }
}
