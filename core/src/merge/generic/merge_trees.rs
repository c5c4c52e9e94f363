//! Tree × tree → tree.

use std::sync::Arc;

use super::split_tree::split_tree;
use crate::error::{Error, Result};
use crate::geometry::side::Half;
use crate::geometry::space::Space;
use crate::interrupt::poll;
use crate::merge::op::SetOp;
use crate::tree::partition::{Cut, Facet, PartitionTree, Sheet};

/// Combines two trees of one region by a set operation.
///
/// The second tree is split by the first one's cuts, from the root down; where one of them is a
/// leaf, the leaf table decides. Subtrees that the operation does not change are shared with the
/// operands. Coplanar sets are joined, so that each part of the result's boundary keeps its source.
///
/// # Order
/// Nodes of `a` before those of `b`.
///
/// # Cost
/// One split of a part of `b` per node of `a` that meets an undecided part of `b`.
///
/// # Errors
/// `Internal` if the trees do not have the same region.
///
/// # Source
/// Naylor, Amanatides, Thibault 1990, section 3.
pub fn merge<S: Space>(
    a: &PartitionTree<S>,
    b: &PartitionTree<S>,
    op: SetOp,
) -> Result<PartitionTree<S>> {
    let mut steps = vec![Step::Merge(a.clone(), b.clone())];
    let mut done = Vec::new();
    while let Some(step) = steps.pop() {
        poll();
        match step {
            Step::Merge(a, b) => match decided(&a, &b, op) {
                Ok(tree) => done.push(tree),
                Err(cut) => divide(cut, &b, &mut steps)?,
            },
            Step::Join { node, coplanar } => join(&node, coplanar, &mut done)?,
        }
    }
    done.pop()
        .ok_or_else(|| Error::internal("merge ended without a tree"))
}

enum Step<S: Space> {
    /// Combine two trees of one region.
    Merge(PartitionTree<S>, PartitionTree<S>),
    /// Put the two trees combined last under a node of the first operand.
    Join {
        node: Cut<S>,
        coplanar: Vec<Facet<S>>,
    },
}

/// The result where a leaf or equal references decide it, else the first operand's cut.
fn decided<'a, S: Space>(
    a: &'a PartitionTree<S>,
    b: &PartitionTree<S>,
    op: SetOp,
) -> std::result::Result<PartitionTree<S>, &'a Cut<S>> {
    if let PartitionTree::Leaf(label) = b {
        return Ok(op.with_second(*label).apply(a));
    }
    match a {
        PartitionTree::Leaf(label) => Ok(op.with_first(*label).apply(b)),
        PartitionTree::Cut(_) if a.is_same(b) => Ok(op.with_itself().apply(a)),
        PartitionTree::Cut(_) if a.is_complement(b) => Ok(op.with_complement().apply(a)),
        PartitionTree::Cut(cut) => Err(cut),
    }
}

/// Splits the second operand by the first one's cut and leaves the two sides to be combined.
fn divide<S: Space>(cut: &Cut<S>, b: &PartitionTree<S>, steps: &mut Vec<Step<S>>) -> Result<()> {
    let halves = split_tree(b, &cut.sheet().span)?;
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
) -> Result<()> {
    let (Some(plus), Some(minus)) = (done.pop(), done.pop()) else {
        return Err(Error::internal("merge joined a node before its subtrees"));
    };
    done.push(if coplanar.is_empty() {
        node.with_children(minus, plus)
    } else {
        PartitionTree::cut(joined(node.sheet(), coplanar), minus, plus)
    });
    Ok(())
}

/// A sheet with more coplanar fragments.
fn joined<S: Space>(sheet: &Sheet<S>, coplanar: Vec<Facet<S>>) -> Arc<Sheet<S>> {
    let mut facets = sheet.facets.clone();
    facets.extend(coplanar);
    Arc::new(Sheet {
        span: sheet.span.clone(),
        facets,
    })
}
