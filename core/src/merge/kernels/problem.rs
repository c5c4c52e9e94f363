//! The problem that a kernel solves in one cell, and the trait of kernels.

use std::borrow::Cow;

use super::counts::{KernelCounters, KernelName, Refusal};
use crate::geometry::cell::Cell;
use crate::merge::expression::Expression;
use crate::merge::lists::list::{List, Sources};
use crate::merge::rule::Rule;
use crate::tree::node::Node;

/// An expression to be evaluated in one cell.
#[derive(Debug)]
pub struct CellProblem<'a> {
    /// The cell in which the expression is to be evaluated.
    pub cell: &'a Cell,
    /// The expression, simplified for operands that are constant in the cell.
    pub expression: &'a Expression,
    /// The rule that says which winding numbers of an operand are inside.
    pub rule: Rule,
    /// The operands with boundary in the cell, in ascending order of their numbers.
    pub operands: Vec<ListedOperand<'a>>,
    /// The meshes and half-spaces of all operands.
    pub sources: &'a Sources,
}

/// An operand with its boundary in a cell.
#[derive(Debug)]
pub struct ListedOperand<'a> {
    /// The number of the operand in the expression.
    pub number: u32,
    /// The elements (faces and parts of faces) of the operand that meet the cell.
    pub list: Cow<'a, List>,
}

/// A method to evaluate an expression in a cell.
///
/// All kernels compute the same set. A kernel may refuse a cell whose faces lie in a position that it does
/// not handle; then the next kernel is asked, or the cell is halved.
///
/// # Example
/// ```
/// use bspcsg::geometry::cell::Cell;
/// use bspcsg::merge::expression::{Expression, Term};
/// use bspcsg::merge::kernels::counts::{KernelCounters, KernelName, Refusal};
/// use bspcsg::merge::kernels::problem::{CellProblem, Kernel};
/// use bspcsg::merge::kernels::ALL;
/// use bspcsg::merge::lists::list::Sources;
/// use bspcsg::merge::rule::Rule;
/// use bspcsg::tree::node::Node;
///
/// /// A kernel for cells without boundary.
/// struct Empty;
///
/// impl Kernel for Empty {
///     fn name(&self) -> KernelName {
///         KernelName::Trees
///     }
///
///     fn solve(&self, problem: &CellProblem, _: &mut Vec<u32>) -> Result<Node, Refusal> {
///         let empty = problem.operands.is_empty();
///         empty.then(|| Node::Leaf(0)).ok_or(Refusal::Operands)
///     }
/// }
///
/// let problem = CellProblem {
///     cell: &Cell::UNIVERSE,
///     expression: &Expression::new(vec![Term::Or(Vec::new())])?,
///     rule: Rule::Positive,
///     operands: Vec::new(),
///     sources: &Sources::new(Default::default()),
/// };
/// let counters = KernelCounters::default();
/// let left = problem.solve_by(&[&Empty, ALL[0]], &counters, &mut Vec::new());
/// assert!(matches!(left, Some(Node::Leaf(0))));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub trait Kernel {
    /// Returns the name under which the kernel's answers are counted.
    fn name(&self) -> KernelName;

    /// Returns the result in the cell, or the reason why the kernel refuses the cell. In both cases adds to
    /// `overlapping` the numbers of operands found to overlap themselves.
    fn solve(&self, problem: &CellProblem, overlapping: &mut Vec<u32>) -> Result<Node, Refusal>;
}

impl CellProblem<'_> {
    /// Returns the result of the first kernel that does not refuse the cell; `None` if all do. Counts each
    /// kernel's answer.
    pub fn solve_by(
        &self,
        kernels: &[&dyn Kernel],
        counters: &KernelCounters,
        overlapping: &mut Vec<u32>,
    ) -> Option<Node> {
        kernels.iter().find_map(|kernel| {
            let answer = kernel.solve(self, overlapping);
            counters.record(kernel.name(), answer.as_ref().err().copied());
            answer.ok()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both, crossing};

    struct Refuses;

    struct Answers(i32);

    impl Kernel for Refuses {
        fn name(&self) -> KernelName {
            KernelName::General
        }

        fn solve(&self, _: &CellProblem, overlapping: &mut Vec<u32>) -> Result<Node, Refusal> {
            overlapping.push(1);
            Err(Refusal::Touching)
        }
    }

    impl Kernel for Answers {
        fn name(&self) -> KernelName {
            KernelName::Trees
        }

        fn solve(&self, _: &CellProblem, _: &mut Vec<u32>) -> Result<Node, Refusal> {
            Ok(Node::Leaf(self.0))
        }
    }

    #[test]
    fn the_first_kernel_that_takes_a_cell_answers() {
        let (scene, expression) = (crossing(), both(Term::And));
        let problem = scene.problem(&expression);
        let (counters, mut seen) = (KernelCounters::default(), Vec::new());
        let left = problem.solve_by(&[&Refuses, &Answers(1), &Answers(0)], &counters, &mut seen);
        assert!(matches!(left, Some(Node::Leaf(1))));
        // Overlaps are recorded even if the cell is not solved.
        let none = problem.solve_by(&[&Refuses], &counters, &mut seen);
        assert!(none.is_none());
        assert_eq!(seen, [1, 1]);
        let [orthogonal, general, trees] = counters.counts();
        assert_eq!(orthogonal.asked(), 0);
        assert_eq!((general.asked(), general.took), (2, 0));
        assert_eq!(general.refused, [("faces touch without crossing", 2)]);
        assert_eq!((trees.took, trees.refused.len()), (1, 0));
    }
}
