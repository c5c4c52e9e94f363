//! Rounds exact vertices to doubles, and repairs or reports what this changes.

use rustc_hash::FxHashMap as HashMap;

use super::crossings::Faults;
use super::mend::Precision;
use super::places::places;
use super::settle::{settle, Rounded, Settled};
use super::snapping::crossing_faces;
use super::touching::touching;
use super::unfold::{turned, unfold};
use super::upright::keeps_order;
use crate::arith::convert::{as_index, as_number};
use crate::error::Result;
use crate::extract::assemble::assemble_patches;
use crate::extract::joining::patches::Patches;
use crate::extract::mesh::{numbers_left, Corner, ExactMesh, Mesh};
use crate::extract::order::put_in_order;
use crate::extract::surface::passing::{passing, share_more_than_points};
use crate::extract::surface::Surface;
use crate::geometry::doubles::bit_key;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Vertex;
use crate::merge::evaluate::is_simple;
use crate::merge::lists::list::Sources;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::grid::snap_point;
use crate::mesh::handle::{OrientedFace, VertexId};
use crate::mesh::tasks::{both, WorkSize, CHUNK};
use crate::mesh::topology::NONE;
use crate::tree::solid::Solid;

/// Returns the mesh of a bounded solid, with each constructed vertex rounded to the nearest doubles.
///
/// A vertex of an input mesh returns with its original doubles.
///
/// # Errors
/// `Unbounded`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::extract::rounding::round::mesh;
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// // Nothing was cut, so it comes out as it came in.
/// let mesh = mesh(&solid)?;
/// assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (4, 4));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn mesh(solid: &Solid) -> Result<Mesh> {
    mesh_of_patches(solid, &Patches::default())
}

/// Returns the rounded mesh of a bounded solid, in which faces of different patches are not joined.
///
/// # Errors
/// `Unbounded`.
pub fn mesh_of_patches(solid: &Solid, patches: &Patches) -> Result<Mesh> {
    let mut exact = assemble_patches(solid, patches)?;
    let mut vertices = exact.positions(solid);
    put_in_order(&mut exact, &mut vertices);
    let mut mesh = Mesh {
        vertices,
        triangles: exact.triangles.clone(),
        findings: std::mem::take(&mut exact.findings),
        patches: patches.clone(),
        ..Mesh::default()
    };
    let sources = Sources::new(solid.sources().clone());
    let unfolded = unfold(&mut mesh, &exact, &sources);
    let (parties, names) = both(
        WorkSize::pool_if(exact.faces.len() > CHUNK),
        || parties(&mesh, &exact),
        || names(&exact.faces, &sources),
    );
    (mesh.origins, mesh.flips) = names;
    let surface = Surface::new(solid, patches, &exact);
    let settled = match settle_mesh(&mut mesh, solid, &surface, &sources, &parties)? {
        Settling::Settled(settled) => settled,
        Settling::Divided(patches) => return mesh_of_patches(solid, &patches),
    };
    let left = if unfolded.left.is_empty() && settled.mended.is_empty() {
        Vec::new()
    } else {
        turned(&mesh, &exact, &sources)
    };
    tell_moved(&mut mesh, &settled.moved);
    tell_touching(&mut mesh, &exact, &sources, !settled.mended.is_empty());
    let renumbered = if settled.mended.is_empty() {
        Vec::new()
    } else {
        drop_removed(&mut mesh)
    };
    report(&mut mesh, &unfolded.repaired, &left, &settled, &renumbered);
    mesh.compared = settled.compared as u64;
    Ok(mesh)
}

/// Returns for each face its source's slot and its number in the input, and whether it is turned around.
fn names(faces: &[OrientedFace], sources: &Sources) -> (Vec<[u32; 2]>, Vec<bool>) {
    let mut origins = Vec::with_capacity(faces.len());
    for run in faces.chunk_by(|a, b| a.slot() == b.slot()) {
        let slot = run[0].slot();
        let source = sources.get(slot);
        origins.extend(run.iter().map(|f| [slot.0, source.number(f.id())]));
    }
    let flips = faces.iter().map(|f| f.orientation.is_opposite());
    (origins, flips.collect())
}

/// Finds and mends the crossings that rounding made.
///
/// Compares each new triangle with all triangles near it, and each untouched face with untouched faces of
/// other inputs or connected pieces: on the lattice untouched faces do not cross, but with their given
/// doubles they may. If untouched faces cross on the lattice, too, because an input overlaps itself, the mesh
/// stays as it is, and the faults are `own`. If exact triangles pass through one another, they are divided
/// there first.
fn settle_mesh(
    mesh: &mut Mesh,
    solid: &Solid,
    surface: &Surface,
    sources: &Sources,
    parties: &[u32],
) -> Result<Settling> {
    let exact = surface.mesh();
    let changed = changed(mesh, solid, exact, sources);
    let party = |t: u32| parties[t as usize];
    let corner = |v: VertexId| exact.vertices.get(v.index());
    let on_lattice = |v: VertexId| match corner(v) {
        Some(Corner::Source(slot, vertex)) => {
            let mesh = solid.sources().get(*slot).mesh()?;
            let place = Vertex::lattice(mesh.vertices[vertex.index()]);
            Some(solid.pitch().position(&place))
        }
        _ => None,
    };
    let given = |v: VertexId| matches!(corner(v), Some(Corner::Source(..)));
    let mut rounded = Rounded {
        vertices: std::mem::take(&mut mesh.vertices),
        triangles: std::mem::take(&mut mesh.triangles),
    };
    let found = if keeps_order(&rounded.faces(), exact, sources, solid.pitch()) {
        Faults::default()
    } else {
        rounded.faults(&changed, party)
    };
    let double = Precision::Double;
    let seem_to_cross = || -> Vec<Lattice> {
        let places = places(&rounded.faces(), &found);
        let snapped = places.iter().map(|p| snap_point(solid.pitch(), p));
        snapped.flatten().collect()
    };
    // What meets in points only before rounding does not overlap; the question about the whole solid is dear.
    let crosses_before = share_more_than_points(surface, &found.crossings);
    let settled = if !crosses_before || is_simple(solid, &seem_to_cross())? {
        let passing = passing(surface, &found.crossings);
        if let Some(divided) = surface.patches().divided(&passing, sources) {
            return Ok(Settling::Divided(divided));
        }
        settle(
            &mut rounded,
            changed,
            found,
            double,
            on_lattice,
            given,
            party,
        )
    } else {
        Settled {
            own: found,
            ..Settled::default()
        }
    };
    mesh.vertices = rounded.vertices;
    mesh.triangles = rounded.triangles;
    Ok(Settling::Settled(settled))
}

/// What came of settling a mesh.
enum Settling {
    /// The crossings were mended or are reported.
    Settled(Settled),
    /// Exact triangles pass through one another, so polygons must be divided as these patches say.
    Divided(Patches),
}

/// Returns the triangles that may cross any other triangle, ascending: those that are not untouched faces, or
/// whose corners have other doubles than when they did not cross.
fn changed(mesh: &Mesh, solid: &Solid, exact: &ExactMesh, sources: &Sources) -> Vec<u32> {
    let mut changed = at_blurred(solid, exact);
    changed.extend(with_others_corners(mesh, sources, exact));
    changed.extend(where_own_faces_cross(sources, exact));
    changed.sort_unstable();
    changed.dedup();
    changed.extend(as_number(exact.untouched)..as_number(mesh.triangles.len()));
    changed
}

/// Returns a party number for each triangle: triangles have equal numbers if they lie in faces of one input
/// and in one connected piece of the mesh.
///
/// Two pieces of one input may touch at a point that is a vertex of only one of them; a transform rounds each
/// piece separately, so that they may then cross.
fn parties(mesh: &Mesh, exact: &ExactMesh) -> Vec<u32> {
    let mut pieces = DisjointSets::of_triangles(mesh.vertices.len(), &mesh.triangles);
    let mut numbers: HashMap<(u32, u32), u32> = HashMap::default();
    let mut last = ((NONE, NONE), 0);
    let number = |(triangle, face): (&[VertexId; 3], &OrientedFace)| {
        let key = (face.slot().0, pieces.least(triangle[0].0));
        if key != last.0 {
            let next = as_number(numbers.len());
            last = (key, *numbers.entry(key).or_insert(next));
        }
        last.1
    };
    mesh.triangles
        .iter()
        .zip(&exact.faces)
        .map(number)
        .collect()
}

/// Returns the untouched faces with a corner that import welded with a vertex of other doubles, ascending.
fn at_blurred(solid: &Solid, exact: &ExactMesh) -> Vec<u32> {
    let mut found = Vec::new();
    let mut first = 0;
    for run in exact.faces[..exact.untouched].chunk_by(|a, b| a.slot() == b.slot()) {
        let source = solid.sources().get(run[0].slot());
        let blurred = source.blurred_vertices();
        let at_blurred = |face: &OrientedFace| {
            let is_blurred = |v: &VertexId| blurred.binary_search(v).is_ok();
            let mesh = source.mesh();
            mesh.is_some_and(|mesh| mesh.vertices_of(face.id()).iter().any(is_blurred))
        };
        if !blurred.is_empty() {
            let numbered = (first..).zip(run).filter(|(_, face)| at_blurred(face));
            found.extend(numbered.map(|(triangle, _)| triangle));
        }
        first += as_number(run.len());
    }
    found
}

/// Returns the untouched faces that cross other faces of their input, ascending: because a motion of the
/// lattice rounded their vertices, or because walls of the input pass through one another in an edge.
fn where_own_faces_cross(sources: &Sources, exact: &ExactMesh) -> Vec<u32> {
    let mut found = Vec::new();
    let mut first = 0;
    for run in exact.faces[..exact.untouched].chunk_by(|a, b| a.slot() == b.slot()) {
        let source = sources.get(run[0].slot());
        let suspected = |mesh| crossing_faces(mesh, &source.suspected_pairs());
        let crossing = source.mesh().map_or_else(Vec::new, suspected);
        if !crossing.is_empty() {
            let crosses = |face: &OrientedFace| crossing.binary_search(&face.id().0).is_ok();
            let numbered = (first..).zip(run).filter(|(_, face)| crosses(face));
            found.extend(numbered.map(|(triangle, _)| triangle));
        }
        first += as_number(run.len());
    }
    found
}

/// Returns the untouched faces with a corner whose doubles are those of another vertex at the same lattice
/// point, ascending.
fn with_others_corners(mesh: &Mesh, sources: &Sources, exact: &ExactMesh) -> Vec<u32> {
    let bits = |p: &[f64; 3]| p.map(f64::to_bits);
    let has_others = |t: &u32| {
        let face = exact.faces[*t as usize];
        let corners = mesh.triangles[*t as usize].map(|v| bits(&mesh.vertices[v.index()]));
        sources.get(face.slot()).mesh().is_some_and(|source| {
            let given = source.vertices_of(face.id());
            let given = given.map(|v| bits(&source.doubles[v.index()]));
            corners.iter().any(|corner| !given.contains(corner))
        })
    };
    exact.special.iter().copied().filter(has_others).collect()
}

/// Drops the triangles that mending removed, and unused vertices; returns the new number of each triangle.
fn drop_removed(mesh: &mut Mesh) -> Vec<u64> {
    let next = |next: &mut u64, t: &[VertexId; 3]| {
        *next += u64::from(is_left(t));
        Some(*next - u64::from(is_left(t)))
    };
    let numbers = mesh.triangles.iter().scan(0, next).collect();
    let mut kept = mesh.triangles.iter().map(is_left);
    mesh.origins.retain(|_| kept.next().unwrap_or(true));
    let mut kept = mesh.triangles.iter().map(is_left);
    mesh.flips.retain(|_| kept.next().unwrap_or(true));
    mesh.triangles.retain(is_left);
    drop_unused(mesh);
    numbers
}

fn drop_unused(mesh: &mut Mesh) {
    let used = used(mesh);
    let numbers = numbers_left(&used);
    for v in mesh.triangles.iter_mut().flatten() {
        *v = numbers[v.index()];
    }
    // At this stage findings name vertices only: contacts, and corners that were moved.
    for finding in &mut mesh.findings {
        finding.place.retain(|v| used[as_index(*v)]);
        for v in &mut finding.place {
            *v = u64::from(numbers[as_index(*v)]);
        }
    }
    let mut kept = used.iter();
    mesh.vertices
        .retain(|_| kept.next().copied().unwrap_or(false));
}

/// Returns for each vertex whether a triangle that was not removed uses it.
fn used(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.vertices.len()];
    for v in mesh.triangles.iter().filter(|t| is_left(t)).flatten() {
        used[v.index()] = true;
    }
    used
}

fn is_left(triangle: &[VertexId; 3]) -> bool {
    triangle[0] != triangle[1]
}

/// Adds a finding about the corners that were moved to the lattice.
fn tell_moved(mesh: &mut Mesh, moved: &[VertexId]) {
    if !moved.is_empty() {
        let places: Vec<u64> = moved.iter().map(|v| u64::from(*v)).collect();
        let finding = Finding::about("moved", Severity::Note, &places, MOVED_MESSAGE);
        mesh.findings.push(finding);
    }
}

/// Adds findings about vertices with equal positions, at which the mesh touches itself.
fn tell_touching(mesh: &mut Mesh, exact: &ExactMesh, sources: &Sources, is_mended: bool) {
    let used = if is_mended { used(mesh) } else { Vec::new() };
    let is_used = |v: u32| !is_mended || used[v as usize];
    let is_given = |v: u32| match exact.vertices.get(v as usize) {
        Some(Corner::Source(slot, vertex)) => sources.get(*slot).mesh().is_some_and(|source| {
            bit_key(&source.doubles[vertex.index()]) == bit_key(&mesh.vertices[v as usize])
        }),
        _ => false,
    };
    let found = touching(&mesh.vertices, &exact.vertices, is_used, is_given);
    for (code, places, text) in [
        ("rounded_contact", found.rounded, TOUCHING_MESSAGE),
        ("given_contact", found.given, GIVEN_MESSAGE),
    ] {
        if !places.is_empty() {
            let finding = Finding::about(code, Severity::Note, &places, text);
            mesh.findings.push(finding);
        }
    }
}

/// Adds findings about the triangles that rounding changed; `numbers` are the new numbers of triangles,
/// empty if none was removed.
fn report(mesh: &mut Mesh, swapped: &[u64], turned: &[u64], settled: &Settled, numbers: &[u64]) {
    let number = |t: &u64| numbers.get(as_index(*t)).copied().unwrap_or(*t);
    let numbered = |ids: &[u64]| ids.iter().map(number).collect::<Vec<u64>>();
    let wide = |ids: &mut dyn Iterator<Item = &u32>| ids.map(|t| number(&u64::from(*t))).collect();
    let [crossing, own] = [&settled.left, &settled.own].map(|faults| {
        let mut places: Vec<u64> = wide(&mut faults.crossings.iter().flatten());
        places.sort_unstable();
        places.dedup();
        places
    });
    let mut faulty = numbered(turned);
    faulty.extend(wide(&mut settled.left.flat.iter()).iter());
    faulty.sort_unstable();
    faulty.dedup();
    let (collapsed, over): (Vec<u64>, Vec<u64>) =
        faulty.iter().partition(|t| is_collapsed(mesh, **t));
    let mended: Vec<u64> = wide(&mut settled.mended.iter());
    for (code, severity, places, text) in [
        (
            "swapped",
            Severity::Note,
            &numbered(swapped),
            SWAPPED_MESSAGE,
        ),
        ("mended", Severity::Note, &mended, MENDED_MESSAGE),
        ("collapsed", Severity::Note, &collapsed, COLLAPSED_MESSAGE),
        ("turned", Severity::Warning, &over, TURNED_MESSAGE),
        ("crossing", Severity::Warning, &crossing, CROSSING_MESSAGE),
        ("self_overlap", Severity::Warning, &own, OWN_MESSAGE),
    ] {
        if !places.is_empty() {
            let finding = Finding::about(code, severity, places, text);
            mesh.findings.push(finding);
        }
    }
}

const SWAPPED_MESSAGE: &str =
    "rounding to doubles turned these triangles over, so an edge was flipped";
const MOVED_MESSAGE: &str =
    "surfaces would cross with the given coordinates of these corners; the corners \
    were moved to the lattice, by less than a step";
const TOUCHING_MESSAGE: &str =
    "rounding to doubles, or its repair, gave these vertices the coordinates of \
    others, so the mesh touches itself there";
const GIVEN_MESSAGE: &str = "an input has these vertices twice, so the mesh touches itself there";
const MENDED_MESSAGE: &str =
    "rounding to doubles made surfaces cross or triangles lose their area; to repair \
    this, these triangles were changed within the rounding error";
const COLLAPSED_MESSAGE: &str =
    "rounding to doubles gave two corners of these triangles equal coordinates";
const TURNED_MESSAGE: &str =
    "rounding to doubles turned these triangles over or removed their area";
const CROSSING_MESSAGE: &str =
    "rounding to doubles makes these triangles cross or overlap others, which \
    could not be repaired";
const OWN_MESSAGE: &str = "an operand crosses itself, so these triangles cross or overlap others; \
    `normalized()` resolves the overlaps";

/// Returns true if two corners of a triangle have equal doubles.
#[allow(clippy::float_cmp)]
fn is_collapsed(mesh: &Mesh, triangle: u64) -> bool {
    let [a, b, c] = mesh.triangles[as_index(triangle)].map(|v| mesh.vertices[v.index()]);
    a == b || b == c || c == a
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{made_of, tetrahedra};
    use crate::mesh::handle::Slot;

    #[test]
    fn what_was_not_cut_keeps_its_doubles_and_is_not_compared() {
        let solids = tetrahedra();
        let mesh = mesh(&made_of(&solids, Term::Or)).expect("bounded");
        for solid in &solids {
            let given = solid.sources().get(Slot(0)).mesh().expect("a mesh");
            // The corner inside the other solid is gone.
            let kept = given.doubles.iter().filter(|p| mesh.vertices.contains(p));
            assert!(kept.count() >= 3);
        }
        assert_eq!(mesh.compared, mesh.triangles.len() as u64 - 4);
        assert_eq!(mesh.origins[..4], [[0, 0], [0, 1], [0, 2], [1, 3]]);
        assert!(mesh.findings.is_empty() && !mesh.flips.contains(&true));
    }
}
