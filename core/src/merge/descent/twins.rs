//! Finds operands that are equal in a cell, so that one of them can stand for all.
//!
//! Revisions of one model differ in few cells, and so do a solid and the steps of the chain that led to it.

use std::hash::BuildHasher;
use std::sync::Arc;

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};
use smallvec::SmallVec;

use super::state::{State, States};
use crate::geometry::plane::Lattice;
use crate::interrupt::spend;
use crate::merge::kernels::problem::ListedOperand;
use crate::merge::lists::list::{FaceRecord, List, PartRecord, Sources};
use crate::merge::residual::Twin;
use crate::tree::node::Part;

/// For each operand of a cell, in ascending order, the first operand that is equal to it there (its twin).
pub struct TwinTable(Vec<(u32, Twin)>);

impl TwinTable {
    /// Returns the first operand that is equal to this one; itself if there is no earlier one.
    pub fn of(&self, operand: u32) -> Twin {
        let at = self.0.binary_search_by_key(&operand, |pair| pair.0);
        at.map_or(its_own_twin(operand), |at| self.0[at].1)
    }

    /// Makes a table of operands and their twins; `None` if no operand equals an earlier one.
    fn found(pairs: Vec<(u32, Twin)>) -> Option<Self> {
        let is_other = |pair: &(u32, Twin)| pair.0 != pair.1.first;
        pairs.iter().any(is_other).then_some(Self(pairs))
    }
}

/// Returns the operand as its own twin.
fn its_own_twin(operand: u32) -> Twin {
    Twin {
        first: operand,
        is_same_source: true,
    }
}

/// The most subtrees that are compared in a cell: more are rarely steps of one chain, and each costs a
/// look-up in each cell.
const MAX_SUBTREES_COMPARED: usize = 16;

/// Finds operands whose subtrees in a cell are the same shared node; `None` if there are none, or if more
/// than `MAX_SUBTREES_COMPARED` operands have subtrees.
///
/// # Cost
/// One look-up for each operand.
pub fn of_one_node(states: &States) -> Option<TwinTable> {
    let is_tree = |s: &&(u32, State)| matches!(s.1, State::Tree(_));
    if !(2..=MAX_SUBTREES_COMPARED).contains(&states.iter().filter(is_tree).count()) {
        return None;
    }
    let mut known = HashMap::default();
    let pair = |(number, state): &(u32, State)| {
        let first = match state {
            State::Tree(branch) => {
                let node = (Arc::as_ptr(&branch.node), branch.complement, branch.outside);
                *known.entry((node, branch.cell)).or_insert(*number)
            }
            State::Constant(_) | State::List(_) | State::Bins(_) => *number,
        };
        (*number, its_own_twin(first))
    };
    TwinTable::found(states.iter().map(pair).collect())
}

/// Finds operands whose lists have the same elements (faces or parts of faces), in any order, and the same
/// winding number at the cell's corner; `None` if there are none.
///
/// # Cost
/// One pass over lists of equal length, and a sort of lists with equal hashes.
pub fn of_one_boundary<'a>(
    operands: &'a [ListedOperand<'a>],
    sources: &Sources,
) -> Option<TwinTable> {
    let size = |listed: &ListedOperand| (listed.list.len(), listed.list.corner);
    let mut sizes: SmallVec<[_; 8]> = operands.iter().map(size).collect();
    sizes.sort_unstable();
    if sizes.is_sorted_by(|a, b| a < b) {
        return None;
    }
    let has_unique_size = |listed| {
        let next = sizes.partition_point(|other| *other < size(listed)) + 1;
        sizes.get(next) != Some(&size(listed))
    };
    let mut known: HashMap<_, &'a ListedOperand<'a>> = HashMap::default();
    let mut first = |listed: &'a ListedOperand<'a>| {
        if has_unique_size(listed) {
            return None;
        }
        let mark = content_hash(&listed.list, sources)?;
        let other = *known.entry((size(listed), mark)).or_insert(listed);
        if other.number == listed.number {
            return None;
        }
        are_equal(&other.list, &listed.list, |r| corners(r, sources)).then(|| Twin {
            first: other.number,
            is_same_source: are_equal(&other.list, &listed.list, |r| (r.slot(), r.face)),
        })
    };
    let own = operands.iter().map(|listed| listed.number);
    let pair = |(number, listed)| {
        (
            number,
            first(listed).unwrap_or_else(|| its_own_twin(number)),
        )
    };
    TwinTable::found(own.zip(operands).map(pair).collect())
}

/// Returns a hash that is the same for lists of the same elements (faces or parts of faces) in any order;
/// `None` if a face is not a triangle.
fn content_hash(list: &List, sources: &Sources) -> Option<u64> {
    spend(list.len());
    let mut sum = 0u64;
    for record in &list.records {
        sum = sum.wrapping_add(FxBuildHasher.hash_one(corners(record, sources)?));
    }
    let parts = list
        .parts
        .iter()
        .map(|p| FxBuildHasher.hash_one(address_of(p)));
    Some(parts.fold(sum, u64::wrapping_add))
}

/// Returns true if two lists have the same elements (faces or parts of faces) in any order; faces are the
/// same if their keys are equal.
fn are_equal<K: Ord>(a: &List, b: &List, key_of: impl Fn(&FaceRecord) -> K) -> bool {
    let faces = |list: &List| {
        let mut faces: Vec<K> = list.records.iter().map(&key_of).collect();
        faces.sort_unstable();
        faces
    };
    let parts = |list: &List| {
        let mut parts: Vec<_> = list.parts.iter().map(address_of).collect();
        parts.sort_unstable();
        parts
    };
    a.records.len() == b.records.len() && faces(a) == faces(b) && parts(a) == parts(b)
}

/// Returns the corners of a face in the order of its orientation, beginning with the least; `None` if it is
/// not a triangle.
fn corners(record: &FaceRecord, sources: &Sources) -> Option<[Lattice; 3]> {
    let mesh = sources.get(record.slot()).mesh()?;
    let [a, b, c] = mesh.corners(record.face);
    let [a, b, c] = if record.orientation().is_opposite() {
        [a, c, b]
    } else {
        [a, b, c]
    };
    Some(if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    })
}

/// Returns the identity of a part by its address, which steps of a chain share; equal parts made separately
/// have different keys.
fn address_of(part: &PartRecord) -> (*const Part, bool) {
    let element = &part.element;
    (
        Arc::as_ptr(&element.part),
        element.orientation.is_opposite(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::cell::Cell;
    use crate::merge::scenes::{cuboids, tetrahedron, Shared};
    use crate::tree::node::{Branch, Node};
    use crate::tree::solid::Solid;

    const BOXES: [[Lattice; 2]; 3] = [[[1; 3], [3; 3]], [[5; 3], [7; 3]], [[9; 3], [11; 3]]];

    /// Returns for each solid the index of the first one with the same boundary in a cell around all of them.
    fn firsts(solids: &[Solid]) -> Option<Vec<u32>> {
        let shared = Shared::of(solids);
        let firsts = of_one_boundary(&shared.operands(), &shared.sources)?;
        Some((0..).zip(solids).map(|(k, _)| firsts.of(k).first).collect())
    }

    #[test]
    fn faces_may_come_in_any_order() {
        let [a, b, c] = BOXES;
        let solids = [
            cuboids([a, b, c]),
            cuboids([a, b]),
            cuboids([c, a, b]),
            cuboids([b, a]),
        ];
        assert_eq!(firsts(&solids), Some(vec![0, 1, 0, 1]));
        assert!(firsts(&solids[..2]).is_none());
    }

    #[test]
    fn a_surface_turned_inside_out_is_another() {
        let [a, b, c, d] = [[0; 3], [8, 0, 0], [0, 8, 0], [0, 0, 8]];
        let solid = tetrahedron([a, b, c, d]);
        let root = solid.root().complemented();
        let turned = Solid::new(root, solid.pitch(), solid.sources().clone(), true);
        let same = tetrahedron([b, c, a, d]);
        assert_eq!(firsts(&[solid, turned, same]), Some(vec![0, 1, 0]));
    }

    #[test]
    fn a_node_in_another_place_is_another() {
        let node = Arc::new(Node::Leaf(1));
        let branch = |cell: Cell, complement: bool| {
            let node = Arc::clone(&node);
            State::Tree(Branch {
                cell,
                outside: 0,
                complement,
                node,
            })
        };
        let cells = [
            Cell::around(&[0; 3], &[3; 3]),
            Cell::around(&[8; 3], &[9; 3]),
        ];
        let states = [
            branch(cells[0], false),
            branch(cells[1], false),
            branch(cells[0], true),
            branch(cells[0], false),
        ];
        let states: States = (4..).zip(states).collect();
        let found = of_one_node(&states).expect("the last is the first");
        assert_eq!([4, 5, 6, 7].map(|k| found.of(k).first), [4, 5, 6, 4]);
        assert!(of_one_node(&states[..3].to_vec()).is_none());
    }
}
