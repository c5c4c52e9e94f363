//! Edges of four or more faces, and vertices of several fans, at which a solid's surface touches itself.

pub mod fans;

use rustc_hash::FxHashSet as HashSet;

use self::fans::{split_fans, Radial};
use super::emission::assembly::Assembly;
use super::failure::{Failure, Overlap};
use super::mesh::{outward_normal, renumber, ExactMesh};
use super::vertices::direction;
use crate::arith::convert::as_number;
use crate::arith::Sign;
use crate::error::{Error, Result};
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::handle::VertexId;

/// Splits edges and vertices at which the surface touches itself, and adds findings about them: then every
/// directed edge has exactly one opposite by index, and the triangles around every vertex form one ring.
/// Copies of a vertex directly follow it.
pub(super) fn split(mesh: &mut ExactMesh, sources: &Sources) -> Result<()> {
    let count = as_number(mesh.vertices.len());
    let split = split_fans(&mesh.triangles, count, &Geometry { mesh, sources })
        .map_err(|e| Error::internal(format!("contacts could not be split: {e}")))?;
    mesh.counts = Some(split.counts);
    let origin = &split.origin;
    mesh.vertices = origin.iter().map(|v| mesh.vertices[v.index()]).collect();
    mesh.triangles = split.corners;
    // Copies follow their originals.
    let mut order: Vec<VertexId> = VertexId::all().take(origin.len()).collect();
    order.sort_by_key(|v| origin[v.index()]);
    let numbers = renumber(&mut mesh.vertices, &mut mesh.triangles, &order);
    let starts = split.split_edges.iter().map(|e| e[0]);
    let text = "the solid touches itself along edges, which were split into separate edges (start vertices)";
    add_finding(mesh, "edge_contact", starts, &numbers, text);
    let ends: HashSet<VertexId> = split.split_edges.iter().flatten().copied().collect();
    let alone = split.split_vertices.iter().copied();
    let alone = alone.filter(|v| !ends.contains(v));
    let text = "the solid touches itself at vertices, which were split into separate vertices";
    add_finding(mesh, "vertex_contact", alone, &numbers, text);
    Ok(())
}

/// Adds a finding about vertices, if there are any; `numbers` maps each given vertex to its final number.
fn add_finding(
    mesh: &mut ExactMesh,
    code: &'static str,
    vertices: impl Iterator<Item = VertexId>,
    numbers: &[VertexId],
    text: &str,
) {
    let places: Vec<u64> = vertices.map(|v| u64::from(numbers[v.index()])).collect();
    if !places.is_empty() {
        let finding = Finding::about(code, Severity::Note, &places, text);
        mesh.findings.push(finding);
    }
}

/// Returns true if the triangles around each special vertex form one closed ring. A vertex is special unless
/// only untouched input faces use it.
///
/// # Errors
/// `Overlap` if an edge at a special vertex has no opposite: the assembly is not closed.
pub(super) fn is_manifold(assembly: &Assembly) -> Result<bool, Failure> {
    let special: Vec<u32> = assembly.special_triangles().collect();
    let mut fans = Fans::of(assembly, &special);
    let mut single = fans.edges_apart_are_single();
    for place in 0..fans.starts.len() - 1 {
        poll();
        let fan = &mut fans.corners[fans.starts[place]..fans.starts[place + 1]];
        if !is_single_fan(fan) {
            if !is_balanced(fan) {
                let vertex = assembly.special_vertex(place);
                return Err(Failure::Overlap(Overlap {
                    sign: format!("the computed boundary is open at vertex {vertex}"),
                    faces: assembly.faces_at(vertex),
                }));
            }
            single = false;
        }
    }
    Ok(single)
}

/// For each special vertex, the next and the previous vertex in each triangle around it. A vertex is special
/// unless only untouched input faces use it.
struct Fans {
    starts: Vec<usize>,
    corners: Vec<[VertexId; 2]>,
    /// Directed edges, in triangles with a special vertex, between two vertices that are not special.
    apart: Vec<[VertexId; 2]>,
}

impl Fans {
    fn of(assembly: &Assembly, triangles: &[u32]) -> Self {
        let mut starts = vec![0; assembly.special_count() + 1];
        let corners = || triangles.iter().map(|t| assembly.triangles[*t as usize]);
        let places = |t: [VertexId; 3]| t.map(|v| assembly.special_place(v));
        for place in corners().flat_map(places).flatten() {
            starts[place] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut fans = Self {
            corners: vec![[VertexId(0); 2]; sum],
            apart: Vec::new(),
            starts,
        };
        for t in corners() {
            let place = places(t);
            for i in 0..3 {
                let (b, c) = ((i + 1) % 3, (i + 2) % 3);
                if let Some(a) = place[i] {
                    fans.starts[a] -= 1;
                    fans.corners[fans.starts[a]] = [t[b], t[c]];
                } else if place[b].is_none() {
                    fans.apart.push([t[i], t[b]]);
                }
            }
        }
        fans
    }

    /// Sorts the directed edges between vertices that only untouched input faces use; returns true if none
    /// occurs twice.
    fn edges_apart_are_single(&mut self) -> bool {
        self.apart.sort_unstable();
        self.apart.windows(2).all(|pair| pair[0] != pair[1])
    }
}

/// Returns true if, along each edge at a vertex, as many triangles begin as end, in their order around the
/// vertex.
fn is_balanced(fan: &[[VertexId; 2]]) -> bool {
    let mut starts: Vec<VertexId> = fan.iter().map(|c| c[0]).collect();
    let mut ends: Vec<VertexId> = fan.iter().map(|c| c[1]).collect();
    starts.sort_unstable();
    ends.sort_unstable();
    starts == ends
}

/// Sorts the corners of triangles at a vertex; returns true if the triangles form one closed ring that uses
/// each edge once.
fn is_single_fan(fan: &mut [[VertexId; 2]]) -> bool {
    fan.sort_unstable();
    if fan.windows(2).any(|pair| pair[0][0] == pair[1][0]) {
        return false;
    }
    let Some([first, mut next]) = fan.first().copied() else {
        return true;
    };
    for _ in 1..fan.len() {
        let corner = fan.binary_search_by_key(&next, |c| c[0]);
        match corner {
            Ok(at) if next != first => next = fan[at][1],
            _ => return false,
        }
    }
    next == first
}

struct Geometry<'a> {
    mesh: &'a ExactMesh,
    sources: &'a Sources,
}

impl Radial for Geometry<'_> {
    fn normal(&self, triangle: u32) -> [i128; 3] {
        outward_normal(self.mesh.faces[triangle as usize], self.sources)
    }

    fn direction(&self, a: VertexId, b: VertexId) -> [Sign; 3] {
        let [a, b] = [a, b].map(|v| self.mesh.exact(v, self.sources));
        direction(&a, &b)
    }
}

#[cfg(test)]
mod tests {
    use crate::extract::assemble::assemble;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of};
    use crate::tree::solid::Solid;

    fn findings(second: Solid) -> Vec<String> {
        let solid = made_of(&[cuboid([0; 3], [4; 3]), second], Term::Or);
        let mesh = assemble(&solid).expect("bounded");
        mesh.findings.iter().map(|f| f.code.to_string()).collect()
    }

    #[test]
    fn contacts_along_edges_and_at_vertices_are_told_apart() {
        assert_eq!(findings(cuboid([4, 4, 0], [8, 8, 4])), ["edge_contact"]);
        assert_eq!(findings(cuboid([4; 3], [8; 3])), ["vertex_contact"]);
        assert!(findings(cuboid([9; 3], [12; 3])).is_empty());
    }
}
