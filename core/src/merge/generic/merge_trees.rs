//! Combines two partition trees by a set operation.

use std::sync::Arc;

use super::split_tree::split_tree_watched;
use super::trace::{Decision, DecisionReason, Joined, MergeEvent, Root};
use crate::error::{Error, Result};
use crate::geometry::side::Half;
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::merge::op::{Outcome, SetOp};
use crate::tree::partition::{Cut, Facet, PartitionTree, SubHyperplane};
use crate::tree::trace::Watcher;

/// Combines two partition trees of the same region by a set operation.
///
/// The first tree's cuts split the second tree, from the root down, until one of two combined subtrees is a
/// leaf, which decides the result. The result shares unchanged subtrees with the operands. It keeps the
/// coplanar facets of both trees, so that each part of its boundary has a source.
///
/// # Order
/// Nodes of `a` before those of `b`.
///
/// # Cost
/// One split of a part of `b` for each node of `a` whose region meets an undecided part of `b`.
///
/// # Errors
/// `Internal` if the trees do not have the same region.
///
/// # Source
/// Naylor, Amanatides, Thibault 1990, section 3.
///
/// # Example
/// ```
/// use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
/// use bspcsg::merge::{merge, SetOp};
/// use bspcsg::tree::partition::{
///     autopartition, classify, Facet, Label, Location, PartitionTree, PivotPolicy,
/// };
///
/// let up_to = |at| -> Result<PartitionTree<Dim1>, bspcsg::error::Error> {
///     let fragment = Point1::new(at, Direction::Below);
///     let facets = vec![Facet { fragment, source: 0 }];
///     Ok(autopartition(facets, (), Label::Out, PivotPolicy::First)?.tree)
/// };
/// let between = merge(&up_to(10)?, &up_to(4)?, SetOp::Difference)?;
/// assert_eq!(classify(&between, &7), Location::In);
/// assert_eq!(classify(&between, &3), Location::Out);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn merge<S: Space>(
    a: &PartitionTree<S>,
    b: &PartitionTree<S>,
    op: SetOp,
) -> Result<PartitionTree<S>> {
    merge_watched(a, b, op, &mut ())
}

/// Combines two partition trees as [`merge`] does, and reports each step to `watcher`.
///
/// # Errors
/// As for [`merge`].
pub fn merge_watched<S: Space, W: Watcher<MergeEvent<S>>>(
    a: &PartitionTree<S>,
    b: &PartitionTree<S>,
    op: SetOp,
    watcher: &mut W,
) -> Result<PartitionTree<S>> {
    let mut steps = vec![Step::Merge(a.clone(), b.clone())];
    let mut done = Vec::new();
    while let Some(step) = steps.pop() {
        poll();
        match step {
            Step::Merge(a, b) => {
                let found = decided(&a, &b, op);
                watcher.notify(|| MergeEvent::Pair {
                    a: Root::of(&a),
                    b: Root::of(&b),
                    decision: found.as_ref().map_or(Decision::Divide, Decided::decision),
                });
                match found {
                    Ok(decided) => done.push(decided.tree()),
                    Err(cut) => divide(cut, &b, &mut steps, watcher)?,
                }
            }
            Step::Join { node, coplanar } => join(&node, coplanar, &mut done, watcher)?,
        }
    }
    done.pop()
        .ok_or_else(|| Error::internal("merge ended without a tree"))
}

enum Step<S: Space> {
    /// Combines two trees of the same region.
    Merge(PartitionTree<S>, PartitionTree<S>),
    /// Joins the two trees combined last under a node of the first operand, and adds coplanar facets to its
    /// cut.
    Join {
        node: Cut<S>,
        coplanar: Vec<Facet<S>>,
    },
}

/// The result for two trees that need not be divided: the operand on which it depends, how it depends on this
/// operand, and why.
struct Decided<'a, S: Space> {
    outcome: Outcome,
    operand: &'a PartitionTree<S>,
    because: DecisionReason,
}

impl<S: Space> Decided<'_, S> {
    fn tree(&self) -> PartitionTree<S> {
        self.outcome.apply(self.operand)
    }

    fn decision(&self) -> Decision {
        let because = self.because;
        let second = because == DecisionReason::FirstIsLeaf;
        match self.outcome {
            Outcome::Leaf(label) => Decision::Leaf(label, because),
            Outcome::Operand if second => Decision::Second(because),
            Outcome::Operand => Decision::First(because),
            Outcome::Complement if second => Decision::SecondComplement(because),
            Outcome::Complement => Decision::FirstComplement(because),
        }
    }
}

/// Returns the result if one tree is a leaf, or if the trees are the same or complements; otherwise, as
/// `Err`, the cut at the root of `a`.
fn decided<'a, S: Space>(
    a: &'a PartitionTree<S>,
    b: &'a PartitionTree<S>,
    op: SetOp,
) -> std::result::Result<Decided<'a, S>, &'a Cut<S>> {
    let by = |outcome, operand, because| {
        Ok(Decided {
            outcome,
            operand,
            because,
        })
    };
    match (a, b) {
        (_, PartitionTree::Leaf(label)) => {
            by(op.with_second(*label), a, DecisionReason::SecondIsLeaf)
        }
        (PartitionTree::Leaf(label), _) => {
            by(op.with_first(*label), b, DecisionReason::FirstIsLeaf)
        }
        _ if a.is_same(b) => by(op.with_itself(), a, DecisionReason::Same),
        _ if a.is_complement(b) => by(op.with_complement(), a, DecisionReason::Complement),
        (PartitionTree::Cut(cut), _) => Err(cut),
    }
}

/// Splits the second tree by the cut of the first tree's root, and schedules the merging of both sides.
fn divide<S: Space>(
    cut: &Cut<S>,
    b: &PartitionTree<S>,
    steps: &mut Vec<Step<S>>,
    watcher: &mut impl Watcher<MergeEvent<S>>,
) -> Result<()> {
    let halves = split_tree_watched(b, &cut.sub_hyperplane().span, watcher)?;
    steps.push(Step::Join {
        node: cut.clone(),
        coplanar: halves.coplanar,
    });
    steps.push(Step::Merge(cut.child(Half::Plus), halves.plus));
    steps.push(Step::Merge(cut.child(Half::Minus), halves.minus));
    Ok(())
}

fn join<S: Space>(
    node: &Cut<S>,
    coplanar: Vec<Facet<S>>,
    done: &mut Vec<PartitionTree<S>>,
    watcher: &mut impl Watcher<MergeEvent<S>>,
) -> Result<()> {
    let (Some(plus), Some(minus)) = (done.pop(), done.pop()) else {
        return Err(Error::internal("merge joined a node before its subtrees"));
    };
    let tree = if coplanar.is_empty() {
        node.with_children(minus, plus)
    } else {
        PartitionTree::cut(joined(node.sub_hyperplane(), coplanar), minus, plus)
    };
    watcher.notify(|| join_event(node, &tree));
    done.push(tree);
    Ok(())
}

fn join_event<S: Space>(node: &Cut<S>, tree: &PartitionTree<S>) -> MergeEvent<S> {
    let joined = match tree {
        PartitionTree::Leaf(label) => Joined::Collapsed(*label),
        PartitionTree::Cut(_) if tree.is_same(&node.clone().into()) => Joined::Shared,
        PartitionTree::Cut(_) => Joined::Rebuilt,
    };
    MergeEvent::Join {
        sub_hyperplane: Arc::clone(node.sub_hyperplane()),
        joined,
    }
}

/// Returns a copy of a sub-hyperplane with these facets added to its own.
fn joined<S: Space>(
    sub_hyperplane: &SubHyperplane<S>,
    coplanar: Vec<Facet<S>>,
) -> Arc<SubHyperplane<S>> {
    let mut facets = sub_hyperplane.facets.clone();
    facets.extend(coplanar);
    Arc::new(SubHyperplane {
        span: sub_hyperplane.span.clone(),
        facets,
    })
}
