//! A look at a solid around given places: enough where its boundary is seen to cross itself.

use super::STUCK;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::interrupt::poll;
use crate::merge::descent::choice::{Round, LEAF};
use crate::merge::kernels::trees::LeafTree;
use crate::merge::lists::list::{List, Sources};
use crate::tree::node::{Branch, Node};
use crate::tree::solid::Solid;

/// Return whether a small cell around one of the places shows that a solid is not the reduced
/// boundary; errs on no.
///
/// # Cost
/// Lists are divided where places are, and one local tree is grown for each place at most.
pub fn overlaps_at(solid: &Solid, places: &[Lattice]) -> bool {
    let sources = Sources::new(solid.sources().clone());
    let overlaps = |cell: &Cell, list: &List, _: &[(Lattice, ())]| {
        list.len() <= STUCK && !LeafTree::new(list, cell, &sources).is_simple()
    };
    let places = places.iter().map(|p| (*p, ())).collect();
    let mut open: Vec<(Branch, Vec<(Lattice, ())>)> = vec![(solid.root().clone(), places)];
    while let Some((branch, mut places)) = open.pop() {
        poll();
        places.retain(|(p, ())| branch.cell.holds_box(p, p));
        if places.is_empty() {
            continue;
        }
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(leaf) => {
                let list = List::open(leaf, &branch, &sources);
                if any_small_cell(&sources, &(branch.cell, list), places, 0, overlaps) {
                    return true;
                }
            }
            Node::Cut(halves) => {
                let children = halves.children.each_ref();
                open.extend(children.map(|c| (Branch::child(&branch, c), places.clone())));
            }
        }
    }
    false
}

/// Calls `look` with the small cells around places in a cell, their elements, and the places there,
/// until it returns true; returns whether it did. Cells are small where halving separates no more; of
/// at most `most` elements also where three halvings leave most of them in one part.
pub(super) fn any_small_cell<P>(
    sources: &Sources,
    within: &(Cell, List),
    places: Vec<(Lattice, P)>,
    most: usize,
    mut look: impl FnMut(&Cell, &List, &[(Lattice, P)]) -> bool,
) -> bool {
    if places.is_empty() {
        return false;
    }
    let mut open = vec![(within.0, within.1.clone(), places, Round::START)];
    while let Some((cell, list, places, round)) = open.pop() {
        poll();
        if places.is_empty() || list.is_empty() {
            continue;
        }
        let reaches_out = || list.reaching_out(&cell) * 8 > list.len() * 7;
        let stuck =
            || list.len() <= most && round.kept_most() || list.len() <= STUCK && reaches_out();
        let Some(cut) = cell.cut().filter(|_| list.len() > LEAF && !stuck()) else {
            if look(&cell, &list, &places) {
                return true;
            }
            continue;
        };
        let (below, above) = places.into_iter().partition(|p| p.0[cut.axis] < cut.at);
        let (minus, plus) = list.divide(&cell, cut, sources);
        for (half, list, places) in [(Half::Minus, minus, below), (Half::Plus, plus, above)] {
            let round = round.next(list.len());
            open.push((cell.half(cut, half), list, places, round));
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;

    /// Two rows of boxes side by side; the two in the middle overlap.
    #[test]
    fn an_overlap_is_seen_where_it_is_and_nowhere_else() {
        let apart = |i: i64| [[8 * i; 3], [8 * i + 4; 3]];
        let solid = cuboids((0..9).map(apart).chain([[[34; 3], [38; 3]]]));
        assert!(overlaps_at(&solid, &[[2; 3], [35; 3]]));
        assert!(!overlaps_at(&solid, &[[2; 3], [66; 3], [900; 3]]));
    }
}
