//! Splits a partition tree by a hyperplane into the trees of its two sides.
//!
//! Notation: T is the tree, H the hyperplane, and P = H ∩ region(T). A piece lies on one side of a cut if no
//! point of it lies *strictly* on the other. So in exact arithmetic P crosses the cut of T if and only if the
//! part of this cut inside region(T), its span, crosses H; exactly the cases of `Case` can occur.
//!
//! # Source
//! Naylor, Amanatides, Thibault 1990, section 4.

use std::sync::Arc;

use super::case::SplitCase;
use super::trace::{MergeEvent, Root};
use crate::error::{Error, Result};
use crate::geometry::side::{Half, Orientation, Split};
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::tree::partition::{Cut, Facet, PartitionTree, SubHyperplane};
use crate::tree::trace::Watcher;

/// The parts of a partition tree on the two sides of a hyperplane.
#[derive(Clone, Debug)]
pub struct Halves<S: Space> {
    /// The tree of the part on the minus side of the hyperplane.
    pub minus: PartitionTree<S>,
    /// The tree of the part on the plus side of the hyperplane.
    pub plus: PartitionTree<S>,
    /// The facets of the tree that lie in the hyperplane.
    pub coplanar: Vec<Facet<S>>,
}

/// The position of a splitting hyperplane H relative to the cut of an inner node, inside the node's region; P
/// is the part of H in this region, and the span is the part of the node's hyperplane in it.
enum Case<S: Space> {
    /// H is the node's hyperplane.
    Same,
    /// H is the node's hyperplane with its sides exchanged.
    Opposite,
    /// P lies on the side `deep` of the node's cut, and the node's span on the side `home` of H.
    ///
    /// The subtree `deep` is split; the node keeps its cut in the half `home` of H, which contains the
    /// other subtree entirely.
    OneSided { deep: Half, home: Half },
    /// P and the node's span cross.
    Crossing {
        /// The parts of P on the minus and plus sides of the node's cut.
        parts: [S::Fragment; 2],
        /// The parts of the node's sub-hyperplane on the minus and plus sides of H.
        sub_hyperplanes: [Arc<SubHyperplane<S>>; 2],
    },
}

/// Returns the position of the hyperplane of `span` relative to the cut at the root of a tree.
///
/// # Errors
/// As for [`split_tree`].
pub fn split_case<S: Space>(tree: &PartitionTree<S>, span: &S::Fragment) -> Result<SplitCase> {
    let PartitionTree::Cut(node) = tree else {
        return Ok(SplitCase::Leaf);
    };
    Ok(case_of(node, span)?.name())
}

impl<S: Space> Case<S> {
    fn name(&self) -> SplitCase {
        match self {
            Self::Same => SplitCase::Same,
            Self::Opposite => SplitCase::Opposite,
            Self::OneSided { deep, home } => SplitCase::OneSided {
                deep: *deep,
                home: *home,
            },
            Self::Crossing { .. } => SplitCase::Crossing,
        }
    }

    fn sub_hyperplanes(&self) -> Option<[Arc<SubHyperplane<S>>; 2]> {
        match self {
            Self::Crossing {
                sub_hyperplanes, ..
            } => Some(sub_hyperplanes.clone()),
            _ => None,
        }
    }
}

/// Splits a partition tree by a hyperplane into its parts on the minus and plus sides.
///
/// `span` is the part of the hyperplane inside the region of the tree's root. Subtrees that lie on one side
/// are shared, not copied.
///
/// # Order
/// Nodes keep the relative order of their originals.
///
/// # Cost
/// Proportional to the number of nodes whose regions the hyperplane crosses.
///
/// # Errors
/// `Internal` if `span` is not the part of its hyperplane inside the tree's region.
pub fn split_tree<S: Space>(tree: &PartitionTree<S>, span: &S::Fragment) -> Result<Halves<S>> {
    split_tree_watched(tree, span, &mut ())
}

/// Splits a partition tree as [`split_tree`] does, and reports each step to `watcher`.
///
/// # Errors
/// As for [`split_tree`].
pub fn split_tree_watched<S: Space, W: Watcher<MergeEvent<S>>>(
    tree: &PartitionTree<S>,
    span: &S::Fragment,
    watcher: &mut W,
) -> Result<Halves<S>> {
    let mut splitter = Splitter::new(watcher);
    splitter.steps.push(Step::Split(tree.clone(), span.clone()));
    while let Some(step) = splitter.steps.pop() {
        poll();
        splitter.advance(step)?;
    }
    let (minus, plus) = splitter.pop()?;
    let coplanar = splitter.coplanar;
    Ok(Halves {
        minus,
        plus,
        coplanar,
    })
}

struct Splitter<'a, S: Space, W> {
    steps: Vec<Step<S>>,
    done: Vec<(PartitionTree<S>, PartitionTree<S>)>,
    coplanar: Vec<Facet<S>>,
    watcher: &'a mut W,
}

enum Step<S: Space> {
    /// Splits a tree by the hyperplane of a fragment.
    Split(PartitionTree<S>, S::Fragment),
    /// Rebuilds a node whose subtree on the side `deep` has been split; only the half on the side `home` of
    /// the splitting hyperplane keeps the node.
    OneSided {
        node: Cut<S>,
        deep: Half,
        home: Half,
    },
    /// Joins the halves of both subtrees of a node under the two parts of its sub-hyperplane.
    Crossing {
        sub_hyperplanes: [Arc<SubHyperplane<S>>; 2],
    },
}

impl<'a, S: Space, W: Watcher<MergeEvent<S>>> Splitter<'a, S, W> {
    fn new(watcher: &'a mut W) -> Self {
        Self {
            steps: Vec::new(),
            done: Vec::new(),
            coplanar: Vec::new(),
            watcher,
        }
    }

    fn advance(&mut self, step: Step<S>) -> Result<()> {
        match step {
            Step::Split(PartitionTree::Leaf(label), _) => {
                let leaf = PartitionTree::Leaf(label);
                self.watcher.notify(|| MergeEvent::Split {
                    root: Root::Leaf(label),
                    case: SplitCase::Leaf,
                    parts: None,
                });
                self.push(leaf.clone(), leaf);
                Ok(())
            }
            Step::Split(PartitionTree::Cut(node), span) => self.split(node, span),
            Step::OneSided { node, deep, home } => self.rebuild(&node, deep, home),
            Step::Crossing { sub_hyperplanes } => self.join(sub_hyperplanes),
        }
    }

    fn split(&mut self, node: Cut<S>, span: S::Fragment) -> Result<()> {
        let case = case_of(&node, &span)?;
        self.watcher.notify(|| MergeEvent::Split {
            root: Root::Cut(Arc::clone(node.sub_hyperplane())),
            case: case.name(),
            parts: case.sub_hyperplanes(),
        });
        match case {
            Case::Same => self.open(&node, [Half::Minus, Half::Plus]),
            Case::Opposite => self.open(&node, [Half::Plus, Half::Minus]),
            Case::OneSided { deep, home } => {
                let child = node.child(deep);
                self.steps.push(Step::OneSided { node, deep, home });
                self.steps.push(Step::Split(child, span));
            }
            Case::Crossing {
                parts,
                sub_hyperplanes,
            } => {
                let [inner, outer] = parts;
                self.steps.push(Step::Crossing { sub_hyperplanes });
                let minus = Step::Split(node.child(Half::Minus), inner);
                let plus = Step::Split(node.child(Half::Plus), outer);
                self.steps.extend([plus, minus]);
            }
        }
        Ok(())
    }

    /// Handles a hyperplane equal to the node's: the subtrees are the halves, in the order `halves`, and the
    /// node's facets are coplanar.
    fn open(&mut self, node: &Cut<S>, halves: [Half; 2]) {
        let [minus, plus] = halves.map(|half| node.child(half));
        self.coplanar
            .extend_from_slice(&node.sub_hyperplane().facets);
        self.push(minus, plus);
    }

    /// Handles a hyperplane that splits only the subtree `deep`: the half on the side `home` keeps the node,
    /// and the other half is a half of the subtree.
    fn rebuild(&mut self, node: &Cut<S>, deep: Half, home: Half) -> Result<()> {
        let (minus, plus) = self.pop()?;
        match home {
            Half::Minus => self.push(node.with_child(deep, minus), plus),
            Half::Plus => self.push(minus, node.with_child(deep, plus)),
        }
        Ok(())
    }

    /// Handles a hyperplane that crosses the node's cut: each half gets a node with its part of the
    /// sub-hyperplane.
    fn join(&mut self, [inner, outer]: [Arc<SubHyperplane<S>>; 2]) -> Result<()> {
        let (plus_minus, plus_plus) = self.pop()?;
        let (minus_minus, minus_plus) = self.pop()?;
        let minus = PartitionTree::cut(inner, minus_minus, plus_minus);
        let plus = PartitionTree::cut(outer, minus_plus, plus_plus);
        self.push(minus, plus);
        Ok(())
    }

    fn push(&mut self, minus: PartitionTree<S>, plus: PartitionTree<S>) {
        self.watcher.notify(|| MergeEvent::Halves {
            roots: [Root::of(&minus), Root::of(&plus)],
        });
        self.done.push((minus, plus));
    }

    fn pop(&mut self) -> Result<(PartitionTree<S>, PartitionTree<S>)> {
        let missing = || Error::internal("split_tree joined a node before its subtrees");
        self.done.pop().ok_or_else(missing)
    }
}

/// Returns the position of a splitting hyperplane relative to the cut of `node`; `span` is the hyperplane's
/// part inside the node's region.
fn case_of<S: Space>(node: &Cut<S>, span: &S::Fragment) -> Result<Case<S>> {
    let (own, cut) = (node.hyperplane(), S::hyperplane(span));
    let sub_hyperplane = node.sub_hyperplane();
    let one_sided = |deep, home| Ok(Case::OneSided { deep, home });
    match (S::split(span, own), S::split(&sub_hyperplane.span, cut)) {
        (Split::Coplanar(Orientation::Same), _) => Ok(Case::Same),
        (Split::Coplanar(Orientation::Opposite), _) => Ok(Case::Opposite),
        (Split::Minus, Split::Minus) => one_sided(Half::Minus, Half::Minus),
        (Split::Minus, Split::Plus) => one_sided(Half::Minus, Half::Plus),
        (Split::Plus, Split::Minus) => one_sided(Half::Plus, Half::Minus),
        (Split::Plus, Split::Plus) => one_sided(Half::Plus, Half::Plus),
        (
            Split::Both { minus, plus },
            Split::Both {
                minus: inner,
                plus: outer,
            },
        ) => {
            let sub_hyperplanes = sub_hyperplane.parted(cut, inner, outer).map(Arc::new);
            let parts = [minus, plus];
            Ok(Case::Crossing {
                parts,
                sub_hyperplanes,
            })
        }
        _ => Err(Error::internal(
            "one of two crossing sub-hyperplanes does not cross the other",
        )),
    }
}
