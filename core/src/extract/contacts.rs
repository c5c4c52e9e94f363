//! Where a solid touches itself: edges of four or more faces, vertices of several fans.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::assemble::Assembly;
use super::fans::{split_fans, Radial};
use super::vertices::direction;
use crate::error::{Error, Result};
use crate::geometry::plane::normal;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::source::Shape;

/// Splits contacts, so that every directed edge has exactly one opposite by index and every vertex
/// one fan; reports them.
pub(super) fn split(assembly: &mut Assembly) -> Result<Vec<Finding>> {
    let special: Vec<u32> = assembly.special_triangles().collect();
    if is_manifold(assembly, &special)? {
        return Ok(Vec::new());
    }
    let count = assembly.vertices.len() as u32;
    let split = split_fans(&assembly.triangles, count, &Geometry(assembly))
        .map_err(|e| Error::internal(format!("contacts could not be split: {e}")))?;
    let place = |ids: &[u32]| ids.iter().map(|v| u64::from(*v)).collect::<Vec<_>>();
    let edges: Vec<u32> = split.split_edges.iter().map(|e| e[0]).collect();
    let mut findings = Vec::new();
    if !edges.is_empty() {
        let text = "the solid touches itself along edges, here split (start vertices)";
        findings.push(Finding::about(
            "edge_contact",
            Severity::Note,
            &place(&edges),
            text,
        ));
    }
    let ends: HashSet<u32> = split.split_edges.iter().flatten().copied().collect();
    let alone: Vec<u32> = split
        .split_vertices
        .iter()
        .copied()
        .filter(|v| !ends.contains(v))
        .collect();
    if !alone.is_empty() {
        let text = "the solid touches itself at vertices, here split";
        let places = place(&alone);
        findings.push(Finding::about(
            "vertex_contact",
            Severity::Note,
            &places,
            text,
        ));
    }
    assembly.vertices = split
        .origin
        .iter()
        .map(|v| assembly.vertices[*v as usize])
        .collect();
    assembly.triangles = split.corners;
    Ok(findings)
}

/// Whether the triangles around special vertices form one closed fan each.
///
/// # Errors
/// `Internal` if an edge at a special vertex has no opposite: the assembly is not closed.
fn is_manifold(assembly: &Assembly, triangles: &[u32]) -> Result<bool> {
    let mut fans: HashMap<u32, Vec<(u32, u32)>> = HashMap::default();
    let mut directed: HashSet<(u32, u32)> =
        HashSet::with_capacity_and_hasher(3 * triangles.len(), rustc_hash::FxBuildHasher);
    let mut single = true;
    for triangle in triangles {
        let t = assembly.triangles[*triangle as usize];
        for i in 0..3 {
            let (a, b, c) = (t[i], t[(i + 1) % 3], t[(i + 2) % 3]);
            single &= directed.insert((a, b));
            if assembly.is_special(a) {
                fans.entry(a).or_default().push((b, c));
            }
        }
    }
    for (vertex, fan) in &fans {
        balanced(*vertex, fan)?;
    }
    Ok(single && fans.values().all(|fan| is_single_fan(fan)))
}

/// Checks that as many triangles leave along each edge at a vertex as arrive.
fn balanced(vertex: u32, fan: &[(u32, u32)]) -> Result<()> {
    let mut starts: Vec<u32> = fan.iter().map(|c| c.0).collect();
    let mut ends: Vec<u32> = fan.iter().map(|c| c.1).collect();
    starts.sort_unstable();
    ends.sort_unstable();
    if starts == ends {
        return Ok(());
    }
    Err(Error::internal(format!(
        "the assembled boundary is open at vertex {vertex}"
    )))
}

fn is_single_fan(fan: &[(u32, u32)]) -> bool {
    let mut next = fan[0].1;
    for step in 1..fan.len() {
        if next == fan[0].0 {
            return step == fan.len();
        }
        match fan.iter().find(|c| c.0 == next) {
            Some(corner) => next = corner.1,
            None => return false,
        }
    }
    next == fan[0].0
}

struct Geometry<'a, 'b>(&'a Assembly<'b>);

impl Radial for Geometry<'_, '_> {
    fn normal(&self, triangle: u32) -> [i128; 3] {
        let face = self.0.faces[triangle as usize];
        let source = self.0.sources.get(face.slot as usize);
        let n = match source.shape() {
            Shape::Mesh(mesh) => {
                let [a, b, c] = mesh.corners(face.face);
                normal(&a, &b, &c)
            }
            Shape::HalfSpace(plane) => *plane.normal(),
        };
        if face.flip {
            n.map(|c| -c)
        } else {
            n
        }
    }

    fn direction(&self, a: u32, b: u32) -> [i32; 3] {
        direction(&self.0.position(a), &self.0.position(b))
    }
}
