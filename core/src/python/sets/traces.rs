//! Converts the steps of merging two sets to plain tuples.

use super::each::{each, Set};
use crate::error::Result;
use crate::geometry::spaces::affine::Affine;
use crate::geometry::spaces::space::Space;
use crate::merge::generic::trace::{
    Decision, DecisionReason, Joined, Journal, MergeStep, NodeName,
};
use crate::merge::{merge_watched, SetOp};
use crate::python::hyperplanes::{row_of, shape, Row};
use crate::tree::partition::{preorder, Entry, Label, PartitionTree};

/// A step of merging two trees: its kind, two numbers, the action, and the reason.
pub type StepRow = (&'static str, i64, i64, &'static str, &'static str);

impl Set {
    /// Applies a set operation by merging trees; returns the result and the steps.
    pub fn merge_steps(&self, other: &Self, op: SetOp) -> Result<(Self, Vec<MergeStep>)> {
        match (self, other) {
            (Self::Line(a), Self::Line(b)) => {
                merge_traced(a, b, op).map(|(t, s)| (Self::Line(t), s))
            }
            (Self::Plane(a), Self::Plane(b)) => {
                let (tree, steps) = merge_traced(a.tree()?, b.tree()?, op)?;
                Ok((Self::Plane(tree.into()), steps))
            }
            (Self::Space(a), Self::Space(b)) => {
                merge_traced(a, b, op).map(|(t, s)| (Self::Space(t), s))
            }
            _ => Err(shape("the sets have different dimensions")),
        }
    }

    /// Returns the hyperplanes of the inner nodes in preorder.
    pub fn hyperplanes(&self) -> Result<Vec<Row>> {
        Ok(each!(self, tree => rows(tree)))
    }
}

fn merge_traced<S: Space>(
    a: &PartitionTree<S>,
    b: &PartitionTree<S>,
    op: SetOp,
) -> Result<(PartitionTree<S>, Vec<MergeStep>)> {
    let mut journal = Journal::new(a, b);
    let tree = merge_watched(a, b, op, &mut journal)?;
    Ok((tree, journal.into_steps()))
}

fn rows<S: Affine>(tree: &PartitionTree<S>) -> Vec<Row> {
    let row = |entry: Entry<S::Hyperplane>| match entry {
        Entry::Cut(cut) => Some(row_of::<S>(&cut)),
        Entry::Leaf(_) => None,
    };
    preorder(tree).into_iter().filter_map(row).collect()
}

pub fn step_row(step: &MergeStep) -> StepRow {
    match step {
        MergeStep::Pair { a, b, decision } => {
            let (what, why) = decided(*decision);
            ("pair", number(*a), number(*b), what, why)
        }
        MergeStep::Split { root, case } => ("split", number(*root), 0, case.name(), ""),
        MergeStep::Halves { minus, plus } => ("halves", number(*minus), number(*plus), "", ""),
        MergeStep::Join { node, joined } => {
            let what = match joined {
                Joined::Shared => "shared",
                Joined::Rebuilt => "rebuilt",
                Joined::Collapsed(Label::In) => "collapsed-in",
                Joined::Collapsed(Label::Out) => "collapsed-out",
            };
            ("join", number(*node), 0, what, "")
        }
    }
}

fn number(name: NodeName) -> i64 {
    match name {
        NodeName::Leaf(Label::Out) => -1,
        NodeName::Leaf(Label::In) => -2,
        NodeName::First(number) | NodeName::Second(number) => i64::from(number),
    }
}

fn decided(decision: Decision) -> (&'static str, &'static str) {
    let why = |because| match because {
        DecisionReason::FirstIsLeaf => "first-is-leaf",
        DecisionReason::SecondIsLeaf => "second-is-leaf",
        DecisionReason::Same => "same",
        DecisionReason::Complement => "complement",
    };
    match decision {
        Decision::Divide => ("divide", ""),
        Decision::Leaf(Label::In, because) => ("leaf-in", why(because)),
        Decision::Leaf(Label::Out, because) => ("leaf-out", why(because)),
        Decision::First(because) => ("first", why(because)),
        Decision::FirstComplement(because) => ("first-complement", why(because)),
        Decision::Second(because) => ("second", why(because)),
        Decision::SecondComplement(because) => ("second-complement", why(because)),
    }
}
