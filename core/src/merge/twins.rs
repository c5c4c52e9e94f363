//! Operands of an expression with equal meshes: a union or an intersection needs only the first of them.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use rustc_hash::{FxHashMap as HashMap, FxHasher};

use super::expression::Expression;
use crate::interrupt::poll;
use crate::mesh::source::Source;
use crate::tree::solid::Solid;

/// The approximate number of vertices, and of faces, that are hashed of each mesh; meshes with equal hashes
/// are compared completely.
const ROWS_SAMPLED: usize = 32;

/// The most different meshes with equal hashes with which another mesh is compared, so that all comparisons
/// together cost at most this many passes over the operands.
const MAX_MESHES_PER_SAMPLE: usize = 4;

/// Returns an expression for the same set whose unions and intersections name only the first of operands with
/// equal meshes; `None` if no two operands are equal.
pub(super) fn without_twins(expression: &Expression, solids: &[Solid]) -> Option<Expression> {
    let firsts = first_equal_solids(solids)?;
    Some(expression.merged(|operand| firsts[operand as usize]))
}

/// Returns for each operand the index of the first operand with an equal mesh; `None` if all meshes differ.
fn first_equal_solids(solids: &[Solid]) -> Option<Vec<u32>> {
    let mut known: HashMap<u64, Vec<(u32, &Solid)>> = HashMap::default();
    let mut found = false;
    let first = |(number, solid): (u32, _)| {
        poll();
        let Some(sample) = sample(solid) else {
            return number;
        };
        let others = known.entry(sample).or_default();
        if let Some((first, _)) = others.iter().find(|(_, other)| are_twins(other, solid)) {
            found = true;
            return *first;
        }
        if others.len() < MAX_MESHES_PER_SAMPLE {
            others.push((number, solid));
        }
        number
    };
    let firsts = (0..).zip(solids).map(first).collect();
    found.then_some(firsts)
}

/// Returns a hash of sampled vertices and faces, equal for equal meshes; `None` if the solid is the result of
/// an operation.
fn sample(solid: &Solid) -> Option<u64> {
    let mut hasher = FxHasher::default();
    solid.root().complement.hash(&mut hasher);
    let mesh = solid.whole_mesh()?.mesh()?;
    sampled(&mesh.vertices).for_each(|v| v.hash(&mut hasher));
    sampled(&mesh.faces).for_each(|f| f.map(|v| v.0).hash(&mut hasher));
    Some(hasher.finish())
}

fn sampled<T>(rows: &[T]) -> impl Iterator<Item = &T> {
    rows.iter()
        .step_by(rows.len().div_ceil(ROWS_SAMPLED).max(1))
}

fn are_twins(a: &Solid, b: &Solid) -> bool {
    let meshes = a.whole_mesh().zip(b.whole_mesh());
    a.root().complement == b.root().complement
        && meshes.is_some_and(|(a, b)| Arc::ptr_eq(a, b) || are_equal(a, b))
}

/// Returns true if two sources are meshes with the same arrays of lattice vertices and of faces.
fn are_equal(a: &Source, b: &Source) -> bool {
    let meshes = a.mesh().zip(b.mesh());
    meshes.is_some_and(|(a, b)| a.vertices == b.vertices && a.faces == b.faces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::mesh::import::import;

    fn tetrahedron(at: f64) -> Solid {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let moved = corners.map(|[x, y, z]| [x + at, y, z]);
        let source = import(&moved, &faces, None).expect("a closed mesh");
        Solid::of_source(Arc::new(source), false)
    }

    #[test]
    fn a_mesh_is_its_own_first_and_its_copies_follow() {
        let places = [0.0, 2.0, 0.0, 1e-12, 2.0];
        let solids = places.map(tetrahedron);
        assert_eq!(first_equal_solids(&solids), Some(vec![0, 1, 0, 0, 1]));
        assert_eq!(first_equal_solids(&solids[..2]), None);
    }

    #[test]
    fn a_mesh_turned_inside_out_is_another_set() {
        let solid = tetrahedron(0.0);
        let root = solid.root().complemented();
        let turned = Solid::new(root, solid.pitch(), solid.sources().clone(), false);
        let solids = [turned, tetrahedron(0.0)];
        assert_eq!(first_equal_solids(&solids), None);
    }

    #[test]
    fn what_an_operation_made_has_no_twin() {
        let cut = vec![Term::Operand(0), Term::Operand(1), Term::And(vec![0, 1])];
        let both = Expression::new(cut).expect("an expression");
        let operands = [tetrahedron(0.0), tetrahedron(0.5)];
        let (made, _) = crate::merge::evaluate::evaluate(&both, &operands).expect("a set");
        assert_eq!(sample(&made), None);
    }
}
