//! The problem for a kernel, and the order in which kernels are tried.

use std::borrow::Cow;

use crate::geometry::cell::Cell;
use crate::merge::expression::Expression;
use crate::merge::lists::list::{List, Sources};
use crate::merge::rule::Rule;
use crate::tree::node::Node;

/// A cell in which an expression is to be evaluated.
#[derive(Debug)]
pub struct CellProblem<'a> {
    /// The cell.
    pub cell: &'a Cell,
    /// What remains of the expression there.
    pub expression: &'a Expression,
    /// The rule for which winding numbers of an operand are inside.
    pub rule: Rule,
    /// The operands, in order of their numbers.
    pub operands: Vec<Listed<'a>>,
    /// The sources of all operands.
    pub sources: &'a Sources,
}

/// An operand with boundary in a cell.
#[derive(Debug)]
pub struct Listed<'a> {
    /// Its number in the expression.
    pub number: u32,
    /// Its boundary in the cell.
    pub list: Cow<'a, List>,
}

/// A way to evaluate an expression in a cell.
///
/// All kernels compute the same set. Each refuses some positions; the cell then goes to the next kernel, or
/// is halved.
///
/// # Example
/// ```
/// use bspcsg::geometry::cell::Cell;
/// use bspcsg::merge::expression::{Expression, Term};
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
///     fn solve(&self, problem: &CellProblem, _: &mut Vec<u32>) -> Option<Node> {
///         problem.operands.is_empty().then(|| Node::Leaf(0))
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
/// let left = problem.solve_by(&[&Empty, ALL[0]], &mut Vec::new());
/// assert!(matches!(left, Some(Node::Leaf(0))));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub trait Kernel {
    /// Return the result in the cell; `None` if the kernel refuses the cell. In both cases adds the
    /// operands found to overlap themselves.
    fn solve(&self, problem: &CellProblem, overlapping: &mut Vec<u32>) -> Option<Node>;
}

impl CellProblem<'_> {
    /// The result of the first kernel that takes the cell.
    pub fn solve_by(&self, kernels: &[&dyn Kernel], overlapping: &mut Vec<u32>) -> Option<Node> {
        let mut answers = kernels.iter().map(|kernel| kernel.solve(self, overlapping));
        answers.find_map(|answer| answer)
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
        fn solve(&self, _: &CellProblem, overlapping: &mut Vec<u32>) -> Option<Node> {
            overlapping.push(1);
            None
        }
    }

    impl Kernel for Answers {
        fn solve(&self, _: &CellProblem, _: &mut Vec<u32>) -> Option<Node> {
            Some(Node::Leaf(self.0))
        }
    }

    #[test]
    fn the_first_kernel_that_takes_a_cell_answers() {
        let (scene, expression) = (crossing(), both(Term::And));
        let problem = scene.problem(&expression);
        let mut seen = Vec::new();
        let left = problem.solve_by(&[&Refuses, &Answers(1), &Answers(0)], &mut seen);
        assert!(matches!(left, Some(Node::Leaf(1))));
        // Overlaps are recorded even if the cell is not solved.
        assert!(problem.solve_by(&[&Refuses], &mut seen).is_none());
        assert_eq!(seen, [1, 1]);
    }
}
