//! Counts of the nodes of a set's tree, and a check of its invariants.

use super::node::{Cut, PartitionTree};
use crate::error::{Error, Result};
use crate::geometry::side::Half;
use crate::geometry::spaces::space::{overlay, Region, Space};
use crate::interrupt::poll;

/// Counts of the nodes and facets of a tree, and its depth; shared subtrees count at each occurrence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TreeStats {
    /// The number of inner nodes.
    pub cuts: usize,
    /// The number of leaves.
    pub leaves: usize,
    /// The number of cuts on the longest path from the root to a leaf.
    pub depth: usize,
    /// The number of fragments in all coplanar sets.
    pub facets: usize,
}

/// Counts the nodes and facets of a tree.
pub fn stats<S: Space>(tree: &PartitionTree<S>) -> TreeStats {
    let mut stats = TreeStats::default();
    let mut pending = vec![(tree.clone(), 0)];
    while let Some((next, depth)) = pending.pop() {
        match next {
            PartitionTree::Leaf(_) => {
                stats.leaves += 1;
                stats.depth = stats.depth.max(depth);
            }
            PartitionTree::Cut(cut) => {
                stats.cuts += 1;
                stats.facets += cut.sub_hyperplane().facets.len();
                pending.extend(cut.children().map(|child| (child, depth + 1)));
            }
        }
    }
    stats
}

/// Verifies that each span is its cut inside the region, that coplanar facets lie in their spans, and that no
/// cut has two equal leaves.
///
/// # Cost
/// One split of a fragment for each node and each of its ancestors.
///
/// # Errors
/// `Internal`, with the first violated invariant.
pub fn check<S: Space>(tree: &PartitionTree<S>, frame: &S::Frame) -> Result<()> {
    let mut region = Region::new(frame.clone());
    let mut pending = vec![(tree.clone(), None)];
    while let Some((next, from)) = pending.pop() {
        poll();
        if let Some((depth, bound, half)) = from {
            region.truncate(depth);
            region.push(bound, half);
        }
        if let PartitionTree::Cut(cut) = next {
            check_cut(&cut, &region)?;
            let depth = region.depth();
            for (half, child) in [Half::Plus, Half::Minus].into_iter().zip(cut.children()) {
                pending.push((child, Some((depth, cut.hyperplane().clone(), half))));
            }
        }
    }
    Ok(())
}

fn check_cut<S: Space>(cut: &Cut<S>, region: &Region<S>) -> Result<()> {
    let span = &cut.sub_hyperplane().span;
    let broken = |what: &str| Err(Error::internal(format!("{what} at {cut:?}")));
    let Some(expected) = region.span(cut.hyperplane()) else {
        return broken("a cut misses its node's region");
    };
    if !contains::<S>(span, &expected) || !contains::<S>(&expected, span) {
        return broken("a stored span is not the cut inside its region");
    }
    let in_span = |piece: &S::Fragment| {
        S::coincide(S::hyperplane(piece), cut.hyperplane()).is_some() && contains::<S>(span, piece)
    };
    if !cut
        .sub_hyperplane()
        .facets
        .iter()
        .all(|f| in_span(&f.fragment))
    {
        return broken("a coplanar fragment lies outside its node's span");
    }
    let [a, b] = cut.children().map(|child| child.label());
    if a.is_some() && a == b {
        return broken("equal leaves on both sides");
    }
    Ok(())
}

/// Return whether the fragment `outer` covers the coplanar fragment `inner`.
fn contains<S: Space>(outer: &S::Fragment, inner: &S::Fragment) -> bool {
    let (inside, outside) = overlay::<S>(inner.clone(), outer);
    inside.is_some() && outside.is_empty()
}
