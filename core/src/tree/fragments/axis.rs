//! Axis-parallel cuts for the top of a tree.
//!
//! # Source
//! The lecture notes' general partition. A convex body, which becomes a chain by autopartition, gets a tree
//! of logarithmic depth; in practice, each facet of a surface mesh is cut a constant number of times.

use super::node::{NodeCut, Piece};
use super::policy::Tally;
use crate::geometry::spaces::affine::Affine;

/// The cut at the median of the pieces' lowest and highest corners, across the axis along which they are
/// spread widest.
///
/// As the cut passes through corners, it does not cut facets that meet there, and facets that lie in the cut
/// need no further division.
///
/// `None` if no axis divides the pieces (convex parts of facets) well: each side may have at most three
/// quarters of them. This bounds the depth by log(n)/log(4/3), and so the number of fragments.
pub fn median_cut<S: Affine>(pieces: &[Piece<S>]) -> Option<(NodeCut, S::Hyperplane)> {
    let boxes: Vec<_> = pieces.iter().map(|p| S::bounds(&p.fragment)).collect();
    axes_by_spread::<S>(&boxes).into_iter().find_map(|axis| {
        let at = median(boxes.iter().flatten().map(|end| end[axis]))?;
        let cut = S::axis_cut(axis, at)?;
        let tally = Tally::of(pieces, &cut);
        (4 * tally.larger_side() <= 3 * pieces.len()).then_some((NodeCut::Axis { axis, at }, cut))
    })
}

fn axes_by_spread<S: Affine>(boxes: &[[[f64; 3]; 2]]) -> Vec<usize> {
    let spread = |axis: usize| {
        let low = boxes.iter().fold(f64::INFINITY, |m, b| m.min(b[0][axis]));
        let high = boxes
            .iter()
            .fold(f64::NEG_INFINITY, |m, b| m.max(b[1][axis]));
        high - low
    };
    let spreads = [0, 1, 2].map(spread);
    let mut axes: Vec<usize> = (0..S::DIM).collect();
    axes.sort_by(|a, b| spreads[*b].total_cmp(&spreads[*a]));
    axes
}

/// The median, rounded to the nearest integer; `None` if there are no values.
fn median(values: impl Iterator<Item = f64>) -> Option<i64> {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    let (_, median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    // All values are lattice coordinates, hence far below 2^63.
    Some(median.round() as i64)
}
