//! Partition trees of sets: leaves, cuts, and the references by which trees share subtrees.

use std::fmt;
use std::mem;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::space::Space;

/// The label of a leaf: whether its region is in the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Label {
    /// The region belongs to the set.
    In,
    /// The region does not belong to the set.
    Out,
}

impl Label {
    /// `In` for true, `Out` for false.
    pub fn from_inside(inside: bool) -> Self {
        if inside {
            Self::In
        } else {
            Self::Out
        }
    }

    /// The opposite label: `Out` for `In`, `In` for `Out`.
    #[must_use]
    pub fn complement(self) -> Self {
        Self::from_inside(self == Self::Out)
    }
}

/// A fragment of a set's boundary, and the number of the input facet from which it was cut.
#[derive(Clone, Debug)]
pub struct Facet<S: Space> {
    /// The convex piece, oriented with the inside of its set on the minus side.
    pub fragment: S::Fragment,
    /// The number of the input facet; where facets overlap, the one with the smallest number counts.
    pub source: u64,
}

/// The contents of a node's cut: its part inside the node's region, and the input facets that lie in it.
#[derive(Debug)]
pub struct SubHyperplane<S: Space> {
    /// The part of the cut inside the node's region, with the orientation of the cut.
    pub span: S::Fragment,
    /// The coplanar set: input fragments that lie in the span, with either orientation.
    pub facets: Vec<Facet<S>>,
}

impl<S: Space> SubHyperplane<S> {
    /// The parts of a sub-hyperplane on the minus and on the plus side of `cut`, which divides its span into
    /// `minus` and `plus`.
    pub fn parted(&self, cut: &S::Hyperplane, minus: S::Fragment, plus: S::Fragment) -> [Self; 2] {
        let (inner, outer) = split_facets::<S>(&self.facets, cut);
        let sub_hyperplane = |span, facets| Self { span, facets };
        [sub_hyperplane(minus, inner), sub_hyperplane(plus, outer)]
    }
}

/// The parts of facets on the minus and on the plus side of a cut; facets that lie in the cut are dropped.
fn split_facets<S: Space>(
    facets: &[Facet<S>],
    cut: &S::Hyperplane,
) -> (Vec<Facet<S>>, Vec<Facet<S>>) {
    let (mut inner, mut outer) = (Vec::new(), Vec::new());
    for facet in facets {
        let part = |fragment| Facet {
            fragment,
            source: facet.source,
        };
        match S::split(&facet.fragment, cut) {
            Split::Minus => inner.push(facet.clone()),
            Split::Plus => outer.push(facet.clone()),
            Split::Both { minus, plus } => {
                inner.push(part(minus));
                outer.push(part(plus));
            }
            Split::Coplanar(_) => {}
        }
    }
    (inner, outer)
}

/// A partition tree of a set, or a shared reference to a subtree.
#[derive(Clone)]
pub enum PartitionTree<S: Space> {
    /// A region that is not divided, with its label.
    Leaf(Label),
    /// A region that a hyperplane divides.
    Cut(Cut<S>),
}

/// A shared reference to an inner node; `complemented` exchanges In and Out in its subtree.
#[derive(Clone)]
pub struct Cut<S: Space> {
    node: Arc<Node<S>>,
    complemented: bool,
}

struct Node<S: Space> {
    sub_hyperplane: Arc<SubHyperplane<S>>,
    minus: PartitionTree<S>,
    plus: PartitionTree<S>,
}

impl<S: Space> PartitionTree<S> {
    /// The tree of the empty set.
    pub const EMPTY: Self = Self::Leaf(Label::Out);
    /// The tree of the whole region.
    pub const FULL: Self = Self::Leaf(Label::In);

    /// The tree divided by a sub-hyperplane, or a single leaf if both sides are leaves with equal labels.
    pub fn cut(sub_hyperplane: Arc<SubHyperplane<S>>, minus: Self, plus: Self) -> Self {
        if let (Self::Leaf(a), Self::Leaf(b)) = (&minus, &plus)
            && a == b
        {
            return minus;
        }
        let node = Node {
            sub_hyperplane,
            minus,
            plus,
        };
        Self::Cut(Cut {
            node: Arc::new(node),
            complemented: false,
        })
    }

    /// The tree of the set's complement within the region of the root.
    ///
    /// # Cost
    /// Constant: all nodes are shared.
    #[must_use]
    pub fn complement(&self) -> Self {
        match self {
            Self::Leaf(label) => Self::Leaf(label.complement()),
            Self::Cut(cut) => Self::Cut(Cut {
                node: Arc::clone(&cut.node),
                complemented: !cut.complemented,
            }),
        }
    }

    /// Return whether both trees refer to the same node, or are equal leaves, so that they are the same set.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Leaf(a), Self::Leaf(b)) => a == b,
            (Self::Cut(a), Self::Cut(b)) => a.shares_node(b) && a.complemented == b.complemented,
            _ => false,
        }
    }

    /// Return whether both trees refer to the same node and one is complemented, or are different leaves.
    pub fn is_complement(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Leaf(a), Self::Leaf(b)) => a != b,
            (Self::Cut(a), Self::Cut(b)) => a.shares_node(b) && a.complemented != b.complemented,
            _ => false,
        }
    }

    /// The label if the tree is a leaf, else `None`.
    pub fn label(&self) -> Option<Label> {
        match self {
            Self::Leaf(label) => Some(*label),
            Self::Cut(_) => None,
        }
    }
}

impl<S: Space> Cut<S> {
    /// The hyperplane that divides the region.
    pub fn hyperplane(&self) -> &S::Hyperplane {
        S::hyperplane(&self.node.sub_hyperplane.span)
    }

    /// Return the part of the cut inside the node's region, with the facets that lie in it.
    pub fn sub_hyperplane(&self) -> &Arc<SubHyperplane<S>> {
        &self.node.sub_hyperplane
    }

    /// The subtree on one side of the cut.
    pub fn child(&self, half: Half) -> PartitionTree<S> {
        let child = match half {
            Half::Minus => &self.node.minus,
            Half::Plus => &self.node.plus,
        };
        if self.complemented {
            child.complement()
        } else {
            child.clone()
        }
    }

    /// Both subtrees, plus before minus, so that a stack pops the minus subtree first.
    pub fn children(&self) -> [PartitionTree<S>; 2] {
        [Half::Plus, Half::Minus].map(|half| self.child(half))
    }

    /// This node with one subtree replaced; the same node if the subtree is the same.
    #[must_use]
    pub fn with_child(&self, half: Half, child: PartitionTree<S>) -> PartitionTree<S> {
        let (minus, plus) = match half {
            Half::Minus => (child, self.child(Half::Plus)),
            Half::Plus => (self.child(Half::Minus), child),
        };
        self.with_children(minus, plus)
    }

    /// This node with both subtrees replaced; the same node if both subtrees are the same.
    #[must_use]
    pub fn with_children(
        &self,
        minus: PartitionTree<S>,
        plus: PartitionTree<S>,
    ) -> PartitionTree<S> {
        if minus.is_same(&self.child(Half::Minus)) && plus.is_same(&self.child(Half::Plus)) {
            return PartitionTree::Cut(self.clone());
        }
        PartitionTree::cut(Arc::clone(&self.node.sub_hyperplane), minus, plus)
    }

    fn shares_node(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.node, &other.node)
    }
}

impl<S: Space> From<Cut<S>> for PartitionTree<S> {
    fn from(cut: Cut<S>) -> Self {
        Self::Cut(cut)
    }
}

impl<S: Space> fmt::Debug for PartitionTree<S> {
    /// Writes the root only: the depth of a tree may exceed the stack.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Leaf(label) => write!(f, "{label:?}"),
            Self::Cut(cut) => write!(f, "{cut:?}"),
        }
    }
}

impl<S: Space> fmt::Debug for Cut<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.complemented { "~" } else { "" };
        write!(f, "{sign}Cut({:?}, ..)", self.hyperplane())
    }
}

impl<S: Space> Drop for Node<S> {
    /// Frees unshared subtrees, without recursion over the depth.
    fn drop(&mut self) {
        let mut pending = Vec::new();
        self.release_into(&mut pending);
        while let Some(node) = pending.pop() {
            if let Some(mut last) = Arc::into_inner(node) {
                last.release_into(&mut pending);
            }
        }
    }
}

impl<S: Space> Node<S> {
    fn release_into(&mut self, pending: &mut Vec<Arc<Self>>) {
        for child in [&mut self.minus, &mut self.plus] {
            if let PartitionTree::Cut(cut) = mem::replace(child, PartitionTree::EMPTY) {
                pending.push(cut.node);
            }
        }
    }
}
