//! The set operations, and their results if one operand is empty or everything (the leaf table).

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
    /// The points in at least one of the two operands.
    Union,
    /// The points in both operands.
    Intersection,
    /// The points in the first operand and not in the second.
    Difference,
    /// The points in exactly one of the two operands.
    SymmetricDifference,
}

/// The result of a set operation that does not depend on two operands: one label, an operand or its
/// complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// A leaf with this label, whatever the operand is.
    Leaf(Label),
    /// The operand, unchanged.
    Operand,
    /// The complement of the operand.
    Complement,
}

impl SetOp {
    /// All set operations.
    pub const ALL: [Self; 4] = [
        Self::Union,
        Self::Intersection,
        Self::Difference,
        Self::SymmetricDifference,
    ];

    /// Returns the label of a point whose labels in the two operands are `a` and `b`.
    pub fn labels(self, a: Label, b: Label) -> Label {
        let (a, b) = (a == Label::In, b == Label::In);
        Label::from_inside(match self {
            Self::Union => a || b,
            Self::Intersection => a && b,
            Self::Difference => a && !b,
            Self::SymmetricDifference => a != b,
        })
    }

    /// Returns the result if the first operand is a leaf with label `a`, in terms of the second operand.
    pub fn with_first(self, a: Label) -> Outcome {
        Outcome::of(|b| self.labels(a, b))
    }

    /// Returns the result if the second operand is a leaf with label `b`, in terms of the first operand.
    pub fn with_second(self, b: Label) -> Outcome {
        Outcome::of(|a| self.labels(a, b))
    }

    /// Returns the result if both operands are the same set, in terms of that set.
    pub fn with_itself(self) -> Outcome {
        Outcome::of(|a| self.labels(a, a))
    }

    /// Returns the result if the second operand is the complement of the first, in terms of the first.
    pub fn with_complement(self) -> Outcome {
        Outcome::of(|a| self.labels(a, a.complement()))
    }
}

impl Outcome {
    /// Returns the outcome that changes labels as `function` does.
    fn of(function: impl Fn(Label) -> Label) -> Self {
        match (function(Label::Out), function(Label::In)) {
            (Label::Out, Label::In) => Self::Operand,
            (Label::In, Label::Out) => Self::Complement,
            (constant, _) => Self::Leaf(constant),
        }
    }

    /// Returns the resulting tree for this operand; it shares the operand's nodes.
    pub fn apply<S: Space>(self, operand: &PartitionTree<S>) -> PartitionTree<S> {
        match self {
            Self::Leaf(label) => PartitionTree::Leaf(label),
            Self::Operand => operand.clone(),
            Self::Complement => operand.complement(),
        }
    }
}
