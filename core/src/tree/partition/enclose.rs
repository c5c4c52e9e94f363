//! Builds a set from facets: axis-parallel cuts on top, the facets' hyperplanes below, labels by winding
//! numbers.
//!
//! An autopartition of a convex outline is a chain. Cuts through the middle of long lists that support no
//! facet (a free partition) make the depth logarithmic as long as they divide the list.

use super::build::partition;
use super::node::{Facet, Label, PartitionTree};
use super::policy::{Choice, PivotPolicy};
use super::winding::winding_tree;
use crate::error::Result;
use crate::geometry::side::Split;
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::space::Region;
use crate::interrupt::poll;

/// The largest number of facets in a region that gets no axis-parallel cut.
const MAX_WITHOUT_AXIS_CUT: usize = 12;

/// How to divide the regions of a tree before the facets' own hyperplanes do.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a, S: AxisSpace> {
    /// Cuts to make first, in this order, in every region with facets that they cross.
    pub cuts: &'a [S::Hyperplane],
    /// True if regions with long lists of facets are divided by axis-parallel cuts.
    pub axis_cuts: bool,
    /// The rule that chooses among the facets' hyperplanes.
    pub policy: PivotPolicy,
}

impl<S: AxisSpace> Plan<'_, S> {
    /// The plan with axis-parallel cuts, then the facets' hyperplanes in random order; no given cuts.
    pub const BALANCED: Self = Self {
        cuts: &[],
        axis_cuts: true,
        policy: PivotPolicy::Random(0),
    };
}

/// The set of points at which the winding number of the facets satisfies the rule `inside`.
///
/// Facets may cross, overlap and repeat. `base` is the winding number at the frame's corner of least
/// coordinates.
///
/// # Order
/// The order of the facets and the plan determine the tree.
///
/// # Cost
/// O(n log n) splits for outlines whose facets are short compared with the whole outline.
///
/// # Errors
/// `NotClosed` if the facets do not define one winding number for every point; `Internal` for a defect.
///
/// # Source
/// Thibault, Naylor 1987; free partitions: de Berg et al., Computational Geometry, chapter 12.
pub fn enclosed<S: AxisSpace>(
    facets: Vec<Facet<S>>,
    base: i32,
    inside: impl Fn(i32) -> bool,
    plan: &Plan<'_, S>,
) -> Result<PartitionTree<S>> {
    if facets.is_empty() {
        return Ok(PartitionTree::Leaf(Label::from_inside(inside(base))));
    }
    let mut choice = Choice::new(plan.policy);
    let built = partition(facets, S::universe(), Label::Out, |region, facets| {
        planned_cut(plan, region, facets).unwrap_or_else(|| choice.cut(facets))
    })?;
    let wound = winding_tree(&built.tree, S::side_of_corner, base, inside)?;
    Ok(wound.tree)
}

fn planned_cut<S: AxisSpace>(
    plan: &Plan<'_, S>,
    region: &Region<S>,
    facets: &[Facet<S>],
) -> Option<S::Hyperplane> {
    let given = plan.cuts.iter().find(|cut| region.span(cut).is_some());
    if given.is_some() || !plan.axis_cuts || facets.len() <= MAX_WITHOUT_AXIS_CUT {
        return given.cloned();
    }
    let middles = (0..S::DIM).filter_map(|axis| middle_cut(facets, axis));
    middles.min_by_key(|(size, _)| *size).map(|(_, cut)| cut)
}

/// The cut across an axis at the median corner, and the number of facets with parts on its larger side.
/// `None` if these are more than three quarters of all, or if more than a sixteenth are cut.
///
/// For long facets side by side, their own hyperplanes divide better.
fn middle_cut<S: AxisSpace>(facets: &[Facet<S>], axis: usize) -> Option<(usize, S::Hyperplane)> {
    let corner = |facet: &Facet<S>| S::corner(&facet.fragment, axis);
    let mut corners: Vec<i64> = facets.iter().map(corner).collect();
    let middle = corners.len() / 2;
    let (_, &mut at, _) = corners.select_nth_unstable(middle);
    let cut = S::axis_cut(axis, at);
    let (mut minus, mut plus, mut both) = (0, 0, 0);
    for facet in facets {
        poll();
        match S::split(&facet.fragment, &cut) {
            Split::Minus => minus += 1,
            Split::Plus => plus += 1,
            Split::Both { .. } => both += 1,
            Split::Coplanar(_) => {}
        }
    }
    let size = minus.max(plus) + both;
    (4 * size <= 3 * facets.len() && 16 * both <= facets.len()).then_some((size, cut))
}
