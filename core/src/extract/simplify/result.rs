//! Turns the simplified mesh of a solid into a solid.

use std::sync::Arc;

use super::rounds::{simplify, Simplified};
use crate::error::Result;
use crate::extract::rounding::round::mesh;
use crate::merge::evaluate::normalize;
use crate::merge::rule::Rule;
use crate::mesh::finding::{Finding, Severity};
use crate::mesh::grid::Pitch;
use crate::mesh::import::import;
use crate::mesh::source::Source;
use crate::tree::solid::Solid;

/// The lattices that are tried for a simplified mesh, by how many powers of ten their step is finer than the
/// step of the solid's own lattice. On a lattice that is too coarse, triangles lower than a step would become
/// flat; the next lattice is then 1000 times finer.
const FINER_POWERS_OF_TEN: [i64; 3] = [0, 3, 6];

/// Returns the solid of a bounded solid's mesh without its short edges and slivers.
///
/// `None` if the mesh has none of them, or if no lattice represents the result: parts of the surface closer
/// together than the lattice step would vanish.
///
/// # Errors
/// `Unbounded`; `Internal`.
pub fn simplified(solid: &Solid, tolerance: f64) -> Result<Option<Solid>> {
    let rounded = mesh(solid)?;
    let before = rounded.triangles.len();
    let simplified = simplify(rounded.vertices, rounded.triangles, tolerance);
    if !simplified.changed {
        return Ok(None);
    }
    let noticed = findings(&simplified, before);
    for finer in FINER_POWERS_OF_TEN {
        let pitch = Pitch::new(solid.pitch().exponent() - finer);
        let held = pitch.map(|pitch| on_lattice(&simplified, pitch, noticed.clone()));
        if let Some(made) = held.unwrap_or(Ok(None))? {
            return Ok(Some(made));
        }
    }
    Ok(None)
}

/// Returns the solid of a mesh on a lattice; `None` if rounding to the lattice would change a face, or faces
/// would overlap there.
fn on_lattice(mesh: &Simplified, pitch: Pitch, noticed: Vec<Finding>) -> Result<Option<Solid>> {
    let faces: Vec<[i64; 3]> = mesh.triangles.iter().map(|t| t.map(i64::from)).collect();
    let imported = import(&mesh.vertices, &faces, Some(pitch)).ok();
    let Some(source) = imported.filter(Source::is_as_given) else {
        return Ok(None);
    };
    let solid = Solid::of_source(Arc::new(source.with_findings(noticed)), false);
    normalize(&solid, Rule::Positive)?;
    Ok(solid.is_reduced().then_some(solid))
}

fn findings(mesh: &Simplified, before: usize) -> Vec<Finding> {
    let (after, bound) = (mesh.triangles.len(), mesh.bound);
    let text = format!(
        "short edges and slivers were removed, which left {after} triangles of {before}; no point \
         of either surface is farther than {bound:?} from the other"
    );
    let done = Finding {
        count: 1,
        ..Finding::about("simplified", Severity::Note, &[], text)
    };
    let left: Vec<u64> = mesh.left.iter().map(|t| u64::from(*t)).collect();
    let rest = Finding::about("small_left", Severity::Note, &left, SMALL_LEFT_TEXT);
    [done, rest].into_iter().filter(|f| f.count > 0).collect()
}

const SMALL_LEFT_TEXT: &str =
    "an edge or a height of these triangles is still within the tolerance: removing it \
    would move the surface too far, make it cross itself, or remove a part of it";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of};

    #[test]
    fn a_solid_without_short_edges_is_left_alone() {
        let found = simplified(&cuboid([0; 3], [4; 3]), 0.5).expect("bounded");
        assert!(found.is_none());
    }

    #[test]
    fn steps_below_the_tolerance_go() {
        let boxes = [cuboid([0; 3], [1000; 3]), cuboid([1; 3], [1001; 3])];
        let solid = made_of(&boxes, Term::Or);
        let made = simplified(&solid, 2.0)
            .expect("bounded")
            .expect("short edges");
        let count = |solid: &Solid| mesh(solid).expect("bounded").triangles.len();
        assert!(count(&made) < count(&solid));
    }
}
