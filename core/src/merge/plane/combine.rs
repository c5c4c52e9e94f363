//! Set operations on sets of the plane: by a sweep over both boundaries, or by merging trees.
//!
//! A sweep costs as much as both boundaries have, a merge as much as the smaller one has, once the larger
//! one has a tree. So a sweep suits operands of similar sizes, and a large one combined with few small
//! ones; merging suits a large one combined with many.

use super::input::Outlines;
use super::sweep::bounded;
use crate::error::Result;
use crate::merge::generic::merge_trees::merge;
use crate::merge::op::SetOp;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, PlaneSet, SWEEPS_PER_TREE};

/// Operands are unlike if their sizes differ by more than this factor.
const MAX_SIZE_RATIO: usize = 8;

/// A tree that grows to more than this many times its first size is rebuilt.
const MAX_GROWTH: usize = 4;

/// The most nodes of a tree that is never rebuilt.
const MAX_UNSHRUNK: usize = 64;

/// Return the result of a set operation on two sets.
///
/// # Errors
/// `Internal` for a defect.
pub fn combined(a: &PlaneSet, b: &PlaneSet, op: SetOp) -> Result<PlaneSet> {
    let larger = if a.size() < b.size() { b } else { a };
    let unlike = MAX_SIZE_RATIO * a.size().min(b.size()) < larger.size();
    let paid =
        larger.known_tree().is_some() || larger.spent.swept > SWEEPS_PER_TREE * larger.size();
    if unlike && paid {
        return merged(a, b, op);
    }
    match (a.closed()?, b.closed()?) {
        (Some(first), Some(second)) => {
            let mut set = PlaneSet::from(swept(first, second, op)?);
            if unlike {
                set.spent.swept = larger.spent.swept + larger.size();
            }
            Ok(set)
        }
        _ => merged(a, b, op),
    }
}

fn swept(a: &Boundary, b: &Boundary, op: SetOp) -> Result<Boundary> {
    let mut outlines = Outlines::default();
    outlines.extend(a, 1);
    outlines.extend(b, 2);
    // Inside the first set the number is odd, inside the second it is 2 or 3.
    let label = |bit: i32| Label::from_inside(bit != 0);
    bounded(&outlines, |number| {
        op.labels(label(number & 1), label(number & 2)) == Label::In
    })
}

fn merged(a: &PlaneSet, b: &PlaneSet, op: SetOp) -> Result<PlaneSet> {
    let tree = merge(a.tree()?, b.tree()?, op)?;
    let nodes = |set: &PlaneSet| match set.spent.built {
        0 => set.size(),
        built => built,
    };
    let built = nodes(a).max(nodes(b));
    let mut set = PlaneSet::from(tree);
    if set.size() > MAX_GROWTH * built + MAX_UNSHRUNK {
        return Ok(PlaneSet::from(Boundary::clone(set.boundary()?)));
    }
    set.spent.built = built;
    Ok(set)
}

/// Return whether two sets are equal.
///
/// # Errors
/// `Internal` for a defect.
pub fn equal(a: &PlaneSet, b: &PlaneSet) -> Result<bool> {
    if let (Some(first), Some(second)) = (a.closed()?, b.closed()?) {
        return Ok(first.equals(second));
    }
    let difference = merge(a.tree()?, b.tree()?, SetOp::SymmetricDifference)?;
    Ok(difference.label() == Some(Label::Out))
}

/// The union of any number of sets.
///
/// # Errors
/// `Internal` for a defect.
pub fn composed(sets: &[&PlaneSet]) -> Result<PlaneSet> {
    let mut outlines = Outlines::default();
    let mut open = Vec::new();
    for set in sets {
        match set.closed()? {
            Some(boundary) => outlines.extend(boundary, 1),
            None => open.push(*set),
        }
    }
    let union = PlaneSet::from(bounded(&outlines, |number| number > 0)?);
    open.into_iter()
        .try_fold(union, |union, set| merged(&union, set, SetOp::Union))
}
