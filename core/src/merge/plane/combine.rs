//! Set operations on sets of the plane, by a sweep over both boundaries or by merging partition trees.
//!
//! A sweep visits all edges of both boundaries; a merge visits the smaller operand and few nodes of the
//! larger one, once that has a tree. So a sweep suits operands with similar numbers of edges, and a large
//! operand that is combined with few small ones; merging suits a large operand that is combined with many.

use super::input::Outlines;
use super::sweep::bounded;
use crate::error::Result;
use crate::merge::generic::merge_trees::merge;
use crate::merge::op::SetOp;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, PlaneSet, SWEEPS_PER_TREE};

/// Two sets of the plane count as unlike if their sizes (numbers of edges or nodes) differ by more than this
/// factor.
const MAX_SIZE_RATIO: usize = 8;

/// A merged tree with more than this many times the nodes of the larger operand's first tree is replaced by
/// its boundary, from which a new tree is built on demand.
const MAX_GROWTH: usize = 4;

/// A merged tree with at most this many nodes is never replaced by its boundary.
const MAX_UNSHRUNK: usize = 64;

/// Returns the result of a set operation on two sets of the plane.
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
    // The winding number is odd inside the first set, and 2 or 3 inside the second.
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

/// Returns true if two sets of the plane are equal, up to their boundaries.
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

/// Returns the union of any number of sets of the plane.
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
