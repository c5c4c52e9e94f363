//! The kernel for operands in general position.
//!
//! Only faces that truly cross are divided, by each other. All other faces have the same winding numbers over
//! the whole cell: these are counted once along a path from the cell's corner, for all faces that are
//! connected by common vertices. Special cases (faces in one plane, edges in faces, contacts without
//! crossing, operands that overlap themselves) are refused and left to the local trees.

mod anchors;
mod contact;
mod cut_status;
mod keep;
mod known_labels;
mod labels;
mod points;
mod scene;
mod segment;
mod trace;

use smallvec::SmallVec;

use super::counts::{KernelName, Refusal};
use super::kept::{assemble, KeptPart};
use super::problem::{CellProblem, Kernel};
use crate::merge::rule::Rule;
use crate::tree::node::Node;
use scene::Scene;

/// The most operands in a cell that this kernel solves: a label is a 64-bit word with one bit for each
/// operand.
pub const MAX_OPERANDS: usize = 64;

/// The label of a region: for each operand of the cell a bit that says whether the region is inside it.
type Labels = u64;

/// The labels of the parts into which other operands cut a face: one if nothing cuts it, otherwise usually
/// two.
type PieceLabels = SmallVec<[Labels; 2]>;

/// The kernel that divides only faces that truly cross, and needs no trees.
///
/// It refuses cells in which faces of different operands touch without crossing, or an operand overlaps
/// itself, and rules other than w > 0.
#[derive(Debug)]
pub struct GeneralPosition;

impl Kernel for GeneralPosition {
    fn name(&self) -> KernelName {
        KernelName::General
    }

    fn solve(&self, problem: &CellProblem, overlapping: &mut Vec<u32>) -> Result<Node, Refusal> {
        check(problem)?;
        let operands = &problem.operands;
        let scene = Scene::new(problem.cell, operands, problem.sources);
        let found = kept_and_corner(&scene, problem);
        overlapping.extend(scene.overlapping.get().map(|k| operands[*k].number));
        let (kept, corner) = found?;
        let touching = operands.iter().any(|l| l.list.is_touching());
        Ok(assemble(
            kept,
            corner,
            touching,
            problem.cell,
            problem.sources,
        ))
    }
}

/// Refuses a cell with another rule than w > 0, with too few or too many operands, or with an operand whose
/// winding number at the corner shows that it overlaps itself.
fn check(problem: &CellProblem) -> Result<(), Refusal> {
    let operands = &problem.operands;
    if problem.rule != Rule::Positive {
        return Err(Refusal::Rule);
    }
    if !(2..=MAX_OPERANDS).contains(&operands.len()) {
        return Err(Refusal::Operands);
    }
    let simple = operands.iter().all(|l| (0..=1).contains(&l.list.corner));
    simple.then_some(()).ok_or(Refusal::Overlap)
}

/// Returns the parts of the operands' faces that bound the result, and the expression's value at the cell's
/// corner (1 for inside).
fn kept_and_corner(scene: &Scene, problem: &CellProblem) -> Result<(Vec<KeptPart>, i32), Refusal> {
    let operands = &problem.operands;
    let statuses = scene.cut_statuses().ok_or(Refusal::Touching)?;
    let labels = scene.labels(&statuses).ok_or_else(|| {
        let overlap = scene.overlapping.get();
        overlap.map_or(Refusal::Doubtful, |_| Refusal::Overlap)
    })?;
    let operand_index = |number: u32| operands.partition_point(|l| l.number < number);
    let scratch = &mut Vec::new();
    let expression = problem.expression;
    let mut value = |bits: Labels| expression.value(|k| bits >> operand_index(k) & 1 == 1, scratch);
    let corner = i32::from(value(scene.at_corner()));
    let kept = scene.keep(statuses, &labels, &mut value);
    Ok((kept, corner))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::{Expression, Term};
    use crate::merge::scenes::{both, counts, crossing, cuboid, cuboids, tetrahedra, Shared};

    /// Three faces of the second solid cross one face of the first.
    #[test]
    fn only_faces_that_cross_are_divided() {
        let scene = crossing();
        let left = |combined| {
            let expression = both(combined);
            let node = GeneralPosition.solve(&scene.problem(&expression), &mut Vec::new());
            counts(&node.expect("general position"))
        };
        assert_eq!(left(Term::And), (0, 4));
        assert_eq!(left(Term::Or), (4, 4));
    }

    #[test]
    fn faces_in_one_plane_are_left_to_others() {
        let boxes = [[[0; 3], [4; 3]], [[4, 0, 0], [8, 4, 4]]];
        let scene = Shared::of(&boxes.map(|[low, high]| cuboid(low, high)));
        let expression = both(Term::Or);
        let problem = scene.problem(&expression);
        let mut seen = Vec::new();
        let refused = GeneralPosition.solve(&problem, &mut seen).err();
        assert_eq!(refused, Some(Refusal::Touching));
        assert!(seen.is_empty());
    }

    #[test]
    fn an_operand_that_winds_twice_around_a_vertex_of_another_overlaps_itself() {
        let [a, b] = tetrahedra();
        let boxes = [
            [[-30, -37, -23], [60, 61, 63]],
            [[-20, -27, -13], [50, 51, 53]],
        ];
        let around = cuboids(boxes);
        let scene = Shared::of(&[a, b, around]);
        let terms = (0..3).map(Term::Operand).chain([Term::Or(vec![0, 1, 2])]);
        let expression = Expression::new(terms.collect()).expect("well formed");
        let mut seen = Vec::new();
        let problem = scene.problem(&expression);
        let refused = GeneralPosition.solve(&problem, &mut seen).err();
        assert_eq!(refused, Some(Refusal::Overlap));
        assert_eq!(seen, [2]);
    }
}
