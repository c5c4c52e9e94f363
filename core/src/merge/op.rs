//! The set operations and their leaf table.

use crate::geometry::spaces::space::Space;
use crate::tree::partition::{Label, PartitionTree};

/// A regularized set operation of two operands.
///
/// # Example
/// ```
/// use bspcsg::merge::{Outcome, SetOp};
/// use bspcsg::tree::partition::Label;
///
/// assert_eq!(SetOp::Difference.labels(Label::In, Label::In), Label::Out);
/// // A leaf decides: nothing minus anything is nothing.
/// assert_eq!(SetOp::Difference.with_first(Label::Out), Outcome::Leaf(Label::Out));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SetOp {
    /// In either.
    Union,
    /// In both.
    Intersection,
    /// In the first, not in the second.
    Difference,
    /// In exactly one.
    SymmetricDifference,
}

/// The result of an operation whose other operand is a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// A leaf, whatever the operand is.
    Leaf(Label),
    /// The operand, unchanged.
    Operand,
    /// The operand's complement.
    Complement,
}

impl SetOp {
    /// All operations.
    pub const ALL: [Self; 4] = [
        Self::Union,
        Self::Intersection,
        Self::Difference,
        Self::SymmetricDifference,
    ];

    /// The operation on two labels.
    pub fn labels(self, a: Label, b: Label) -> Label {
        let (a, b) = (a == Label::In, b == Label::In);
        Label::from_inside(match self {
            Self::Union => a || b,
            Self::Intersection => a && b,
            Self::Difference => a && !b,
            Self::SymmetricDifference => a != b,
        })
    }

    /// The leaf table: the outcome for the second operand where the first is a leaf.
    pub fn with_first(self, a: Label) -> Outcome {
        Outcome::of(|b| self.labels(a, b))
    }

    /// The leaf table: the outcome for the first operand where the second is a leaf.
    pub fn with_second(self, b: Label) -> Outcome {
        Outcome::of(|a| self.labels(a, b))
    }

    /// The outcome for an operand combined with itself.
    pub fn with_itself(self) -> Outcome {
        Outcome::of(|a| self.labels(a, a))
    }

    /// The outcome for an operand combined with its complement.
    pub fn with_complement(self) -> Outcome {
        Outcome::of(|a| self.labels(a, a.complement()))
    }
}

impl Outcome {
    /// The outcome equivalent to a function of one label.
    fn of(function: impl Fn(Label) -> Label) -> Self {
        match (function(Label::Out), function(Label::In)) {
            (Label::Out, Label::In) => Self::Operand,
            (Label::In, Label::Out) => Self::Complement,
            (constant, _) => Self::Leaf(constant),
        }
    }

    /// The tree that results from an operand; shares its nodes.
    pub fn apply<S: Space>(self, operand: &PartitionTree<S>) -> PartitionTree<S> {
        match self {
            Self::Leaf(label) => PartitionTree::Leaf(label),
            Self::Operand => operand.clone(),
            Self::Complement => operand.complement(),
        }
    }
}
