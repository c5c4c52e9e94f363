//! Records of the steps by which partition trees are split and merged.
//!
//! The algorithms report the nodes themselves ([`MergeEvent`]). A [`Journal`] numbers the nodes of both
//! operands in preorder and records plain steps ([`MergeStep`]). Given the operands as lists of node numbers
//! and labels, these steps reproduce the result without any geometry.

use std::sync::Arc;

use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

use super::case::SplitCase;
use crate::geometry::spaces::space::Space;
use crate::mesh::handle::NodeId;
use crate::tree::partition::{Label, PartitionTree, SubHyperplane};
use crate::tree::trace::Watcher;

/// The root of a partition tree: the label of a leaf, or the sub-hyperplane of a cut.
#[derive(Clone, Debug)]
pub enum Root<S: Space> {
    /// A leaf: an undivided region with this label.
    Leaf(Label),
    /// A cut: the part of its hyperplane inside the node's region, with the facets in it. The complement of
    /// the tree has the same sub-hyperplane.
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

/// A step of splitting or merging trees, reported with the nodes themselves.
#[derive(Clone, Debug)]
pub enum MergeEvent<S: Space> {
    /// Two trees of the same region are about to be combined.
    Pair {
        /// The root of the first operand's tree in this region.
        a: Root<S>,
        /// The root of the second operand's tree in this region.
        b: Root<S>,
        /// How the two trees are combined.
        decision: Decision,
    },
    /// A subtree of the second operand is about to be split by a hyperplane.
    Split {
        /// The root of the subtree.
        root: Root<S>,
        /// The position of the splitting hyperplane relative to the subtree's root.
        case: SplitCase,
        /// The parts of the root's sub-hyperplane on the minus and the plus side of the splitting hyperplane,
        /// if they cross.
        parts: Option<[Arc<SubHyperplane<S>>; 2]>,
    },
    /// A subtree of the second operand has been split into two trees.
    Halves {
        /// The roots of the trees on the minus and the plus side.
        roots: [Root<S>; 2],
    },
    /// The two combined subtrees of a node of the first operand have been joined under it.
    Join {
        /// The sub-hyperplane of the node under which the subtrees are joined.
        sub_hyperplane: Arc<SubHyperplane<S>>,
        /// The form that the node has in the result.
        joined: Joined,
    },
}

/// How two trees of the same region are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Decision {
    /// The first tree's root splits the second tree, and the halves are combined with the first tree's
    /// subtrees.
    Divide,
    /// The result is a leaf with this label, for this reason.
    Leaf(Label, DecisionReason),
    /// The result is the first tree itself.
    First(DecisionReason),
    /// The result is the complement of the first tree.
    FirstComplement(DecisionReason),
    /// The result is the second tree itself.
    Second(DecisionReason),
    /// The result is the complement of the second tree.
    SecondComplement(DecisionReason),
}

/// The reason why two trees can be combined without dividing them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum DecisionReason {
    /// The first tree is a leaf.
    FirstIsLeaf,
    /// The second tree is a leaf.
    SecondIsLeaf,
    /// Both trees are the same shared tree.
    Same,
    /// One tree is the complement of the other.
    Complement,
}

/// The form that a node of the first operand has in the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Joined {
    /// The first operand's node itself, because nothing below it changed.
    Shared,
    /// A new node with the same hyperplane.
    Rebuilt,
    /// A leaf with this label, because both subtrees became leaves with this label.
    Collapsed(Label),
}

/// The root of a partition tree: a label, or the number of an inner node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NodeName {
    /// A leaf: an undivided region with this label.
    Leaf(Label),
    /// The inner node of the first operand at this index in preorder, minus before plus.
    First(NodeId),
    /// The inner node of the second operand at this index in preorder, minus before plus, or a part of that
    /// node.
    Second(NodeId),
}

/// A step of splitting or merging trees, recorded with node numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum MergeStep {
    /// Two trees of the same region are combined.
    Pair {
        /// The root of the first operand's tree in this region.
        a: NodeName,
        /// The root of the second operand's tree in this region.
        b: NodeName,
        /// How the two trees are combined.
        decision: Decision,
    },
    /// A subtree of the second operand is split by the cut of the first operand's node that the last `Pair`
    /// divides.
    Split {
        /// The root of the subtree.
        root: NodeName,
        /// The position of the splitting hyperplane relative to the subtree's root.
        case: SplitCase,
    },
    /// A subtree of the second operand has been split into two trees.
    Halves {
        /// The root of the tree on the minus side.
        minus: NodeName,
        /// The root of the tree on the plus side.
        plus: NodeName,
    },
    /// The two combined subtrees of a node of the first operand have been joined under it.
    Join {
        /// The number, in the first operand, of the node under which the subtrees are joined.
        node: NodeName,
        /// The form that the node has in the result.
        joined: Joined,
    },
}

/// A watcher that records the steps of splitting or merging two trees, with nodes by number.
///
/// It keeps the numbered nodes alive, because it recognises them by their addresses.
#[derive(Debug)]
pub struct Journal<S: Space> {
    first: Numbers<S>,
    second: Numbers<S>,
    steps: Vec<MergeStep>,
}

type Numbers<S> = FxHashMap<*const SubHyperplane<S>, (NodeId, Arc<SubHyperplane<S>>)>;

impl<S: Space> Journal<S> {
    /// Makes an empty journal for merging `first` with `second`, or for splitting `second`.
    pub fn new(first: &PartitionTree<S>, second: &PartitionTree<S>) -> Self {
        Self {
            first: numbered(first),
            second: numbered(second),
            steps: Vec::new(),
        }
    }

    /// Returns the recorded steps, in the order in which they happened.
    pub fn into_steps(self) -> Vec<MergeStep> {
        self.steps
    }

    fn record(&mut self, seen: &MergeEvent<S>) -> MergeStep {
        match seen {
            MergeEvent::Pair { a, b, decision } => MergeStep::Pair {
                a: self.first_name(a),
                b: self.second_name(b),
                decision: *decision,
            },
            MergeEvent::Split { root, case, parts } => {
                let name = self.second_name(root);
                if let (NodeName::Second(number), Some(parts)) = (name, parts) {
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

    fn first_name(&self, root: &Root<S>) -> NodeName {
        name(root, &self.first, NodeName::First)
    }

    fn second_name(&self, root: &Root<S>) -> NodeName {
        name(root, &self.second, NodeName::Second)
    }
}

impl<S: Space> Watcher<MergeEvent<S>> for Journal<S> {
    const LISTENS: bool = true;

    fn notify(&mut self, event: impl FnOnce() -> MergeEvent<S>) {
        let step = self.record(&event());
        self.steps.push(step);
    }
}

fn name<S: Space>(
    root: &Root<S>,
    numbers: &Numbers<S>,
    make: impl Fn(NodeId) -> NodeName,
) -> NodeName {
    match root {
        Root::Leaf(label) => NodeName::Leaf(*label),
        // All sub-hyperplanes that can occur are numbered; an unknown one would get a number without a node.
        Root::Cut(sub_hyperplane) => make(
            numbers
                .get(&Arc::as_ptr(sub_hyperplane))
                .map_or(NodeId(u32::MAX), |e| e.0),
        ),
    }
}

/// Numbers the inner nodes of a tree in preorder, minus before plus; keys are the addresses of their
/// sub-hyperplanes.
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
