//! The steps of splitting and merging trees, node by node.
//!
//! The algorithms report shared nodes ([`MergeEvent`]); a [`Journal`] numbers the nodes of both operands in
//! preorder and keeps plain records ([`MergeStep`]). With the operands as lists of numbers and labels, the
//! records reproduce the result without any geometry.

use std::sync::Arc;

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

use super::case::SplitCase;
use crate::geometry::spaces::space::Space;
use crate::mesh::handle::NodeId;
use crate::tree::partition::{Label, PartitionTree, SubHyperplane};
use crate::tree::trace::Watcher;

/// A tree's root: a leaf, or the contents of its cut.
#[derive(Clone, Debug)]
pub enum Root<S: Space> {
    /// An undivided region.
    Leaf(Label),
    /// A divided region; complements have the same sub-hyperplanes.
    Cut(Arc<SubHyperplane<S>>),
}

impl<S: Space> Root<S> {
    pub(super) fn of(tree: &PartitionTree<S>) -> Self {
        match tree {
            PartitionTree::Leaf(label) => Self::Leaf(*label),
            PartitionTree::Cut(cut) => Self::Cut(Arc::clone(cut.sub_hyperplane())),
        }
    }
}

/// An event, in terms of shared nodes.
#[derive(Clone, Debug)]
pub enum MergeEvent<S: Space> {
    /// A pair of trees of one region is to be combined.
    Pair {
        /// The part of the first operand.
        a: Root<S>,
        /// The part of the second.
        b: Root<S>,
        /// The decision for them.
        decision: Decision,
    },
    /// A subtree is to be split.
    Split {
        /// Its root.
        root: Root<S>,
        /// The case for it and the splitting hyperplane.
        case: SplitCase,
        /// The parts of the cut's contents on the minus and the plus side, if the two cross.
        parts: Option<[Arc<SubHyperplane<S>>; 2]>,
    },
    /// A subtree has been split.
    Halves {
        /// The roots on the minus and the plus side.
        roots: [Root<S>; 2],
    },
    /// The combined subtrees of a node of the first operand have been joined.
    Join {
        /// The node's own sub-hyperplane.
        sub_hyperplane: Arc<SubHyperplane<S>>,
        /// What became of it in the result.
        joined: Joined,
    },
}

/// The decision for a pair of trees of one region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Decision {
    /// The second tree is split by the first one's root; the halves are combined.
    Divide,
    /// A leaf, and why.
    Leaf(Label, DecisionReason),
    /// The first tree unchanged, shared.
    First(DecisionReason),
    /// The complement of the first tree.
    FirstComplement(DecisionReason),
    /// The second tree unchanged, shared.
    Second(DecisionReason),
    /// The complement of the second tree.
    SecondComplement(DecisionReason),
}

/// The reason for a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum DecisionReason {
    /// The first tree is a leaf.
    FirstIsLeaf,
    /// The second tree is a leaf.
    SecondIsLeaf,
    /// Both are the same shared tree.
    Same,
    /// One is the complement of the other.
    Complement,
}

/// What a node of the first operand became in the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Joined {
    /// Itself: nothing below it changed.
    Shared,
    /// A new node with the same cut.
    Rebuilt,
    /// This leaf, because both its sides became equal leaves.
    Collapsed(Label),
}

/// A tree's root, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Name {
    /// An undivided region.
    Leaf(Label),
    /// The inner node of the first operand at this index in preorder, minus before plus.
    First(NodeId),
    /// The inner node of the second operand, or a part of it.
    Second(NodeId),
}

/// One step of splitting or merging, in the order of the work.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum MergeStep {
    /// A pair of trees of one region.
    Pair {
        /// The part of the first operand.
        a: Name,
        /// The part of the second.
        b: Name,
        /// The decision for them.
        decision: Decision,
    },
    /// A subtree is split by the cut of the first tree chosen last.
    Split {
        /// The subtree's root.
        root: Name,
        /// The case for it and the splitting hyperplane.
        case: SplitCase,
    },
    /// A subtree has been split.
    Halves {
        /// The root on the minus side.
        minus: Name,
        /// The root on the plus side.
        plus: Name,
    },
    /// The combined subtrees of a node have been joined.
    Join {
        /// The node of the first operand.
        node: Name,
        /// What became of it in the result.
        joined: Joined,
    },
}

/// A watcher that records the steps, with the operands' nodes by number.
///
/// It keeps the numbered nodes alive, so that no address is reused.
#[derive(Debug)]
pub struct Journal<S: Space> {
    first: Numbers<S>,
    second: Numbers<S>,
    steps: Vec<MergeStep>,
}

type Numbers<S> = FxHashMap<*const SubHyperplane<S>, (NodeId, Arc<SubHyperplane<S>>)>;

impl<S: Space> Journal<S> {
    /// A journal of merging two trees, or of splitting the second one.
    pub fn new(first: &PartitionTree<S>, second: &PartitionTree<S>) -> Self {
        Self {
            first: numbered(first),
            second: numbered(second),
            steps: Vec::new(),
        }
    }

    /// Return the recorded steps.
    pub fn into_steps(self) -> Vec<MergeStep> {
        self.steps
    }

    fn note(&mut self, seen: &MergeEvent<S>) -> MergeStep {
        match seen {
            MergeEvent::Pair { a, b, decision } => MergeStep::Pair {
                a: self.first_name(a),
                b: self.second_name(b),
                decision: *decision,
            },
            MergeEvent::Split { root, case, parts } => {
                let name = self.second_name(root);
                if let (Name::Second(number), Some(parts)) = (name, parts) {
                    let part = |p: &Arc<_>| (Arc::as_ptr(p), (number, Arc::clone(p)));
                    self.second.extend(parts.iter().map(part));
                }
                MergeStep::Split {
                    root: name,
                    case: *case,
                }
            }
            MergeEvent::Halves { roots } => MergeStep::Halves {
                minus: self.second_name(&roots[0]),
                plus: self.second_name(&roots[1]),
            },
            MergeEvent::Join {
                sub_hyperplane,
                joined,
            } => MergeStep::Join {
                node: self.first_name(&Root::Cut(Arc::clone(sub_hyperplane))),
                joined: *joined,
            },
        }
    }

    fn first_name(&self, root: &Root<S>) -> Name {
        name(root, &self.first, Name::First)
    }

    fn second_name(&self, root: &Root<S>) -> Name {
        name(root, &self.second, Name::Second)
    }
}

impl<S: Space> Watcher<MergeEvent<S>> for Journal<S> {
    const LISTENS: bool = true;

    fn notify(&mut self, event: impl FnOnce() -> MergeEvent<S>) {
        let step = self.note(&event());
        self.steps.push(step);
    }
}

fn name<S: Space>(root: &Root<S>, numbers: &Numbers<S>, make: impl Fn(NodeId) -> Name) -> Name {
    match root {
        Root::Leaf(label) => Name::Leaf(*label),
        // All sub-hyperplanes that can occur are numbered; an unknown one would get a number without a node.
        Root::Cut(sub_hyperplane) => make(
            numbers
                .get(&Arc::as_ptr(sub_hyperplane))
                .map_or(NodeId(u32::MAX), |e| e.0),
        ),
    }
}

/// The inner nodes of a tree in preorder, minus before plus, by the contents of their cuts.
fn numbered<S: Space>(tree: &PartitionTree<S>) -> Numbers<S> {
    let mut numbers = Numbers::default();
    let mut pending = vec![tree.clone()];
    while let Some(next) = pending.pop() {
        if let PartitionTree::Cut(cut) = next {
            let sub_hyperplane = Arc::clone(cut.sub_hyperplane());
            let number = NodeId::of(numbers.len());
            numbers.insert(Arc::as_ptr(&sub_hyperplane), (number, sub_hyperplane));
            pending.extend(cut.children());
        }
    }
    numbers
}
