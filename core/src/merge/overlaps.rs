//! Searches for self-overlaps of a solid in small cells around given points.

use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::interrupt::poll;
use crate::merge::descent::choice::MAX_ELEMENTS_PER_LEAF;
use crate::merge::kernels::trees::LeafTree;
use crate::merge::lists::list::{List, Sources};
use crate::tree::node::{Branch, Node};
use crate::tree::solid::Solid;

/// The most elements (faces or parts of faces) of a cell for which a local tree is built if halving the cell
/// no longer separates them.
const MAX_ELEMENTS_STUCK: usize = 256;

/// Returns true if a small cell around one of the points `points` shows that the solid's faces overlap or
/// enclose a region twice; false proves nothing.
///
/// # Cost
/// Divides lists of faces only around the points, and builds at most one local tree for each point.
pub fn overlaps_itself_at(solid: &Solid, points: &[Lattice]) -> bool {
    let sources = Sources::new(solid.sources().clone());
    let mut open: Vec<(Branch, Vec<Lattice>)> = vec![(solid.root().clone(), points.to_vec())];
    while let Some((branch, mut points)) = open.pop() {
        poll();
        points.retain(|p| branch.cell.contains_box(p, p));
        if points.is_empty() {
            continue;
        }
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(leaf) => {
                let list = List::open(leaf, &branch, &sources);
                if overlaps_in(&sources, branch.cell, list, points) {
                    return true;
                }
            }
            Node::Cut(halves) => {
                let children = halves.children.each_ref();
                open.extend(children.map(|c| (Branch::child(&branch, c), points.clone())));
            }
        }
    }
    false
}

/// Returns true if the local tree of a small cell around one of the points `points` shows that listed
/// elements (faces or parts of faces) overlap or enclose a region twice.
fn overlaps_in(sources: &Sources, cell: Cell, list: List, points: Vec<Lattice>) -> bool {
    let mut open = vec![(cell, list, points)];
    while let Some((cell, list, points)) = open.pop() {
        poll();
        if points.is_empty() || list.is_empty() {
            continue;
        }
        let is_stuck = || {
            list.len() <= MAX_ELEMENTS_STUCK && list.count_reaching_out(&cell) * 8 > list.len() * 7
        };
        let Some(cut) = cell
            .cut()
            .filter(|_| list.len() > MAX_ELEMENTS_PER_LEAF && !is_stuck())
        else {
            if list.len() <= MAX_ELEMENTS_STUCK && !LeafTree::new(&list, &cell, sources).is_simple()
            {
                return true;
            }
            continue;
        };
        let (below, above) = points.into_iter().partition(|p| p[cut.axis] < cut.at);
        let (minus, plus) = list.divide(&cell, cut, sources);
        for (half, list, points) in [(Half::Minus, minus, below), (Half::Plus, plus, above)] {
            open.push((cell.half(cut, half), list, points));
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;

    /// Nine boxes apart from each other in a diagonal row, and a tenth that overlaps the fifth.
    #[test]
    fn an_overlap_is_seen_where_it_is_and_nowhere_else() {
        let apart = |i: i64| [[8 * i; 3], [8 * i + 4; 3]];
        let solid = cuboids((0..9).map(apart).chain([[[34; 3], [38; 3]]]));
        assert!(overlaps_itself_at(&solid, &[[2; 3], [35; 3]]));
        assert!(!overlaps_itself_at(&solid, &[[2; 3], [66; 3], [900; 3]]));
    }
}
