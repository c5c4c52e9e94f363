//! Leaves, cuts, and the references by which trees share them.

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

    /// The other label.
    #[must_use]
    pub fn complement(self) -> Self {
        Self::from_inside(self == Self::Out)
    }
}

/// A fragment and the input element it was cut from.
#[derive(Clone, Debug)]
pub struct Facet<S: Space> {
    /// The convex piece, oriented with the inside of its set on the minus side.
    pub fragment: S::Fragment,
    /// The element's number; the smallest number among overlapping facets owns a place.
    pub source: u64,
}

/// The contents of a node's cut: its sub-hyperplane and its coplanar set.
#[derive(Debug)]
pub struct SubHyperplane<S: Space> {
    /// The cut inside the node's region, oriented as the cut.
    pub span: S::Fragment,
    /// The coplanar set S(v): input fragments that lie in the span, in either orientation.
    pub facets: Vec<Facet<S>>,
}

impl<S: Space> SubHyperplane<S> {
    /// The two parts of a sub-hyperplane whose span was cut into `minus` and `plus` by `cut`.
    pub fn parted(&self, cut: &S::Hyperplane, minus: S::Fragment, plus: S::Fragment) -> [Self; 2] {
        let (inner, outer) = split_facets::<S>(&self.facets, cut);
        let sub_hyperplane = |span, facets| Self { span, facets };
        [sub_hyperplane(minus, inner), sub_hyperplane(plus, outer)]
    }
}

/// The parts of facets on the minus and plus side of a cut in which none lies.
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

/// A tree, or a reference to a subtree of one.
#[derive(Clone)]
pub enum PartitionTree<S: Space> {
    /// A region that is not divided.
    Leaf(Label),
    /// A region divided by a hyperplane.
    Cut(Cut<S>),
}

/// A shared reference to an inner node, with a bit for the complement of its set.
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
    /// The empty set.
    pub const EMPTY: Self = Self::Leaf(Label::Out);
    /// The whole region.
    pub const FULL: Self = Self::Leaf(Label::In);

    /// The tree divided along a sub-hyperplane, or a leaf if both sides are equal leaves.
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

    /// The set's complement within the region of the root.
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

    /// Return whether both are the same reference (or equal leaves), hence the same set.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Leaf(a), Self::Leaf(b)) => a == b,
            (Self::Cut(a), Self::Cut(b)) => a.shares(b) && a.complemented == b.complemented,
            _ => false,
        }
    }

    /// Return whether one is a reference to the complement of the other.
    pub fn is_complement(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Leaf(a), Self::Leaf(b)) => a != b,
            (Self::Cut(a), Self::Cut(b)) => a.shares(b) && a.complemented != b.complemented,
            _ => false,
        }
    }

    /// The label, if the tree is a leaf.
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

    /// Return the contents of the cut.
    pub fn sub_hyperplane(&self) -> &Arc<SubHyperplane<S>> {
        &self.node.sub_hyperplane
    }

    /// The subtree on one side.
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

    /// Both subtrees, plus first: a stack then pops minus first.
    pub fn children(&self) -> [PartitionTree<S>; 2] {
        [Half::Plus, Half::Minus].map(|half| self.child(half))
    }

    /// This node with one subtree replaced; the node itself if nothing changes.
    #[must_use]
    pub fn with_child(&self, half: Half, child: PartitionTree<S>) -> PartitionTree<S> {
        let (minus, plus) = match half {
            Half::Minus => (child, self.child(Half::Plus)),
            Half::Plus => (self.child(Half::Minus), child),
        };
        self.with_children(minus, plus)
    }

    /// This node with both subtrees replaced; the node itself if nothing changes.
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

    fn shares(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.node, &other.node)
    }
}

impl<S: Space> From<Cut<S>> for PartitionTree<S> {
    fn from(cut: Cut<S>) -> Self {
        Self::Cut(cut)
    }
}

impl<S: Space> fmt::Debug for PartitionTree<S> {
    /// Shows the root only: a tree can be deeper than the stack.
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
    /// Frees unshared subtrees, without recursion along the depth.
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
