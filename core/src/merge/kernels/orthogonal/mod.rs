//! The kernel for cells in which every face is perpendicular to an axis.
//!
//! The planes of the faces form a grid in the cell, and each box of the grid is inside or outside an operand
//! as a whole. So sets of boxes are bits, expressions are evaluated a 64-bit word at a time, and faces in one
//! plane need no care. The rectangles of the grid in a face's plane determine which parts of the face bound
//! the result.

mod facet;
mod grid;
mod keep;
mod labels;
mod pieces;
mod position;

use super::counts::{KernelName, Refusal};
use super::kept::{assemble, KeptPart};
use super::problem::{CellProblem, Kernel, ListedOperand};
use crate::merge::expression::Expression;
use crate::tree::node::Node;
use facet::Facets;
use grid::Grid;
use keep::Scene;
use position::FacetPosition;

/// The most 64-bit words for the grid columns of all operands: two megabytes, which fit into a cache.
const MAX_WORDS: usize = 1 << 18;

/// The kernel that solves cells on the grid formed by the planes of their faces.
///
/// It refuses cells with a face that is not perpendicular to an axis or with an operand that overlaps itself,
/// and grids that are too fine.
#[derive(Debug)]
pub struct Orthogonal;

impl Kernel for Orthogonal {
    fn name(&self) -> KernelName {
        KernelName::Orthogonal
    }

    fn solve(&self, problem: &CellProblem, _: &mut Vec<u32>) -> Result<Node, Refusal> {
        let CellProblem { cell, sources, .. } = *problem;
        let (kept, corner) = kept_and_corner(problem)?;
        Ok(assemble(kept, corner, true, cell, sources))
    }
}

/// Returns the parts of the operands' faces that bound the result, and the expression's value at the cell's
/// corner (1 for inside).
fn kept_and_corner(problem: &CellProblem) -> Result<(Vec<KeptPart>, i32), Refusal> {
    let operands = &problem.operands;
    let facets = Facets::new(problem.cell, operands, problem.sources).ok_or(Refusal::Slanted)?;
    let grid = Grid::new(problem.cell, &facets).ok_or(Refusal::Fine)?;
    if operands.len() * grid.columns() > MAX_WORDS {
        return Err(Refusal::Fine);
    }
    let positions: Vec<FacetPosition> = facets.all.iter().map(|f| f.position(&grid)).collect();
    let fields = fields(&grid, &facets, &positions, operands).ok_or(Refusal::Overlap)?;
    let operand_indices = operand_indices(operands);
    let value = value(
        problem.expression,
        &operand_indices,
        &fields,
        grid.columns(),
    );
    let scene = Scene {
        cell: problem.cell,
        grid: &grid,
        facets: &facets,
        positions: &positions,
        fields: &fields,
        value: &value,
        expression: problem.expression,
        operand_indices: &operand_indices,
    };
    let kept = scene.keep().ok_or(Refusal::Overlap)?;
    Ok((kept, i32::from(value[0] & 1 != 0)))
}

/// Returns for each operand the boxes of the grid that are inside it, as a word of bits for each column along
/// z; `None` if a winding number is neither 0 nor 1.
fn fields(
    grid: &Grid,
    facets: &Facets,
    positions: &[FacetPosition],
    operands: &[ListedOperand],
) -> Option<Vec<Vec<u64>>> {
    let mut start = 0;
    let field = |(operand, listed): (usize, &ListedOperand)| {
        let end = facets.all.partition_point(|f| f.operand <= operand);
        let own = std::mem::replace(&mut start, end)..end;
        let facets = facets.all[own.clone()].iter().zip(&positions[own]);
        labels::field(grid, facets, listed.list.corner)
    };
    operands.iter().enumerate().map(field).collect()
}

/// Returns a table that maps the numbers of operands in the expression to their indices in the list.
fn operand_indices(operands: &[ListedOperand]) -> Vec<usize> {
    let last = operands.last().map_or(0, |l| l.number as usize);
    let mut operand_indices = vec![0; last + 1];
    for (index, listed) in operands.iter().enumerate() {
        operand_indices[listed.number as usize] = index;
    }
    operand_indices
}

/// Returns the boxes of the grid in which an expression is true, as a word of bits for each column along z.
fn value(
    expression: &Expression,
    operand_indices: &[usize],
    fields: &[Vec<u64>],
    columns: usize,
) -> Vec<u64> {
    let scratch = &mut Vec::new();
    let word = |i: usize, scratch: &mut _| {
        expression.words(|k: u32| fields[operand_indices[k as usize]][i], scratch)
    };
    (0..columns).map(|i| word(i, scratch)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both, counts, crossing, cuboid, Shared};

    /// The union of two adjacent boxes has no wall between them.
    #[test]
    fn faces_in_one_plane_need_no_care() {
        let boxes = [[[0; 3], [4; 3]], [[4, 0, 0], [8, 4, 4]]];
        let scene = Shared::of(&boxes.map(|[low, high]| cuboid(low, high)));
        let left = |combined| {
            let expression = both(combined);
            let node = Orthogonal.solve(&scene.problem(&expression), &mut Vec::new());
            counts(&node.expect("upright faces"))
        };
        assert_eq!(left(Term::Or), (20, 0));
        assert_eq!(left(Term::And), (0, 0));
    }

    #[test]
    fn slanted_faces_are_left_to_others() {
        let (scene, expression) = (crossing(), both(Term::Or));
        let problem = scene.problem(&expression);
        let refused = Orthogonal.solve(&problem, &mut Vec::new()).err();
        assert_eq!(refused, Some(Refusal::Slanted));
    }
}
