//! A tree as a list with numbered nodes, and the contacts between its leaves.

use std::collections::VecDeque;

use super::node::{Cut, Label, PartitionTree};
use crate::error::{Error, Result};
use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A tree as a list of numbered nodes, parents before children.
pub struct Flat<S: Space> {
    nodes: Vec<FlatNode<S>>,
}

enum FlatNode<S: Space> {
    Leaf(Label),
    Cut(FlatCut<S>),
}

/// An inner node of the list and the numbers of its children.
pub struct FlatCut<S: Space> {
    /// The inner node of the tree.
    pub cut: Cut<S>,
    /// The number of the child on the minus side.
    pub minus: NodeId,
    /// The number of the child on the plus side.
    pub plus: NodeId,
}

/// A convex piece of a node's cut with one leaf on each side.
pub struct Contact<S: Space> {
    /// The convex piece, with the orientation of the cut.
    pub fragment: S::Fragment,
    /// The number of the leaf on the cut's minus side.
    pub minus: NodeId,
    /// The number of the leaf on the cut's plus side.
    pub plus: NodeId,
}

impl<S: Space> Flat<S> {
    /// Lists the nodes of a tree, breadth first.
    pub fn new(tree: &PartitionTree<S>) -> Self {
        let mut nodes = Vec::new();
        let mut pending = VecDeque::from([tree.clone()]);
        while let Some(next) = pending.pop_front() {
            poll();
            nodes.push(match next {
                PartitionTree::Leaf(label) => FlatNode::Leaf(label),
                PartitionTree::Cut(cut) => {
                    let next = nodes.len() + 1 + pending.len();
                    pending.extend([cut.child(Half::Minus), cut.child(Half::Plus)]);
                    let [minus, plus] = [next, next + 1].map(NodeId::of);
                    FlatNode::Cut(FlatCut { cut, minus, plus })
                }
            });
        }
        Self { nodes }
    }

    /// The number of nodes, leaves included.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The numbers of the leaves, ascending.
    pub fn leaves(&self) -> impl Iterator<Item = NodeId> + '_ {
        let nodes = NodeId::all().take(self.len());
        nodes.filter(|&node| self.label(node).is_some())
    }

    /// The inner nodes in the order of the list.
    pub fn cuts(&self) -> impl Iterator<Item = &FlatCut<S>> {
        self.nodes.iter().filter_map(|node| match node {
            FlatNode::Leaf(_) => None,
            FlatNode::Cut(cut) => Some(cut),
        })
    }

    /// Return the label of the leaf with this number; `None` for an inner node.
    pub fn label(&self, node: NodeId) -> Option<Label> {
        match &self.nodes[node.index()] {
            FlatNode::Leaf(label) => Some(*label),
            FlatNode::Cut(_) => None,
        }
    }

    /// The number of the leaf that a path from the root reaches if `reference` picks the side of each cut.
    pub fn leaf_at(&self, reference: impl Fn(&S::Hyperplane) -> Half) -> NodeId {
        let mut at = NodeId::ROOT;
        while let FlatNode::Cut(node) = &self.nodes[at.index()] {
            at = match reference(node.cut.hyperplane()) {
                Half::Minus => node.minus,
                Half::Plus => node.plus,
            };
        }
        at
    }

    /// The parts of a fragment in the border of a node's region, each with the number of the leaf next to it.
    ///
    /// # Errors
    /// `Internal` if a cut lies in the border of its own region.
    pub fn leaves_beside(
        &self,
        node: NodeId,
        piece: S::Fragment,
    ) -> Result<Vec<(S::Fragment, NodeId)>> {
        let mut found = Vec::new();
        let mut pending = vec![(node, piece)];
        while let Some((at, piece)) = pending.pop() {
            poll();
            let FlatNode::Cut(node) = &self.nodes[at.index()] else {
                found.push((piece, at));
                continue;
            };
            match S::split(&piece, node.cut.hyperplane()) {
                Split::Minus => pending.push((node.minus, piece)),
                Split::Plus => pending.push((node.plus, piece)),
                Split::Both { minus, plus } => {
                    pending.extend([(node.plus, plus), (node.minus, minus)]);
                }
                Split::Coplanar(_) => {
                    return Err(Error::internal("a cut lies in its region's border"));
                }
            }
        }
        Ok(found)
    }

    /// All convex pieces of cuts that separate two leaves.
    ///
    /// # Order
    /// By inner node, in the order of the list.
    ///
    /// # Errors
    /// `Internal` if a cut lies in the border of its own region.
    pub fn contacts(&self) -> Result<Vec<Contact<S>>> {
        let mut contacts = Vec::new();
        for node in self.cuts() {
            poll();
            let span = node.cut.sub_hyperplane().span.clone();
            for (part, minus) in self.leaves_beside(node.minus, span)? {
                for (fragment, plus) in self.leaves_beside(node.plus, part)? {
                    contacts.push(Contact {
                        fragment,
                        minus,
                        plus,
                    });
                }
            }
        }
        Ok(contacts)
    }

    /// The same tree with the labels that `label` gives for the numbers of leaves.
    pub fn relabelled(&self, label: impl Fn(NodeId) -> Label) -> PartitionTree<S> {
        let mut trees: Vec<PartitionTree<S>> = Vec::new();
        trees.resize(self.len(), PartitionTree::EMPTY);
        for (i, node) in self.nodes.iter().enumerate().rev() {
            trees[i] = match node {
                FlatNode::Leaf(_) => PartitionTree::Leaf(label(NodeId::of(i))),
                FlatNode::Cut(node) => {
                    let [minus, plus] = [node.minus, node.plus].map(|at| trees[at.index()].clone());
                    node.cut.with_children(minus, plus)
                }
            };
        }
        trees.swap_remove(0)
    }
}
