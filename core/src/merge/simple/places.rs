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

/// So many places are looked at in a larger cell at less cost than in the cells of all halvings down to
/// the least cell; three halvings that leave most elements in one part do not tell that the next do.
const ALONE: usize = 50;

/// Calls `look` with the small cells around places in a cell, their elements, and the places there,
/// until it returns true; returns whether it did. Cells are small where halving separates no more; of
/// at most `most` elements and [`ALONE`] places also where three halvings leave most elements in one
/// part.
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
        let few = places.len() <= ALONE && list.len() <= most;
        let stuck = || few && round.kept_most() || list.len() <= STUCK && reaches_out();
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

    // Found: of a plate that reached a little across the origin each place was looked at among all
    // faces.
    /// The first halvings cut off only the first of a row of boxes.
    #[test]
    fn many_places_are_looked_at_in_small_cells() {
        let apart = |i: i64| [[8 * i - 4; 3], [8 * i; 3]];
        let solid = cuboids((0..200).map(apart));
        let Node::Deferred(leaf) = &*solid.root().node else {
            panic!("a mesh is one leaf");
        };
        let sources = Sources::new(solid.sources().clone());
        let list = List::open(leaf, solid.root(), &sources);
        let most = list.len();
        let places = (0..200).map(|i| ([8 * i - 2; 3], ())).collect();
        let mut largest = 0;
        any_small_cell(
            &sources,
            &(solid.root().cell, list),
            places,
            most,
            |_, list, _| {
                largest = largest.max(list.len());
                false
            },
        );
        assert!(largest <= 12 * (ALONE + 1), "{largest} of {most}");
    }
}
