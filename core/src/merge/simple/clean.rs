//! A mesh that overlaps itself, united with itself where it does.
//!
//! Most faces are clear of all others. Across an edge at which two such faces meet nothing else
//! bounds anything, so all faces of a *patch*, connected by such edges, have one winding number in
//! front of them. One small cell tells it, and with it whether the patch stays. Kernels are asked
//! only about cells in which some face may overlap another.

use std::borrow::Cow;
use std::sync::atomic::AtomicBool;

use super::places::any_small_cell;
use super::{only_mesh, Check, STUCK};
use crate::arith::convert::as_number;
use crate::error::{Error, Result};
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::interrupt::poll;
use crate::merge::descent::choice::{CROWD, LEAF};
use crate::merge::descent::join;
use crate::merge::descent::state::TASK;
use crate::merge::expression::{Expression, Term};
use crate::merge::kernels::itself::{number_before, united, Fate};
use crate::merge::kernels::problem::{CellProblem, Listed};
use crate::merge::kernels::trees::LeafTree;
use crate::merge::kernels::ALL;
use crate::merge::lists::list::{List, Record, Sources};
use crate::merge::rule::Rule;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;
use crate::mesh::tasks::both;
use crate::mesh::topology::NONE;
use crate::tree::node::Branch;
use crate::tree::solid::Solid;

/// The faces of a mesh, to be united cell by cell.
struct Uniting<'a> {
    sources: &'a Sources,
    fates: Vec<Fate>,
    /// The operand.
    itself: Expression,
}

/// The root of a mesh united with itself; `None` if the solid is not one closed mesh.
///
/// # Errors
/// `Internal`.
pub fn united_around(solid: &Solid, sources: &Sources) -> Result<Option<Branch>> {
    let Some((leaf, source, mesh)) = only_mesh(solid).filter(|_| solid.whole_mesh().is_some())
    else {
        return Ok(None);
    };
    if solid.root().complement || !source.open_vertices().is_empty() {
        return Ok(None);
    }
    let root = solid.root();
    let mut check = Check::new(source, mesh, sources);
    check.doubtful = mesh.faces.iter().map(|_| AtomicBool::new(false)).collect();
    check.cell(root.cell, List::open(leaf, root, sources));
    let doubtful: Vec<bool> = check
        .doubtful
        .into_iter()
        .map(AtomicBool::into_inner)
        .collect();
    let list = List::open(leaf, root, sources);
    let Some(fates) = fates(source, &doubtful, (root.cell, list.clone()), sources) else {
        return Ok(None);
    };
    let uniting = Uniting {
        sources,
        fates,
        itself: Expression::new(vec![Term::Operand(0)])?,
    };
    uniting.cell(root.cell, list).map(Some)
}

/// The fates of faces, given which are doubtful; `None` if the mesh has no topology.
fn fates(
    source: &Source,
    doubtful: &[bool],
    (cell, list): (Cell, List),
    sources: &Sources,
) -> Option<Vec<Fate>> {
    let mesh = source.mesh()?;
    let (patches, firsts) = patches(source.topology()?.mates(), doubtful);
    let place = |(patch, face): (u32, &FaceId)| (mesh.corners(*face)[0], (patch, *face));
    let places: Vec<(Lattice, (u32, FaceId))> = (0..).zip(&firsts).map(place).collect();
    let mut stays = vec![false; firsts.len()];
    any_small_cell(sources, (cell, list), places, |cell, list, places| {
        for (_, (patch, face)) in places {
            let number = number_before(cell, list, sources, *face)
                .or_else(|| LeafTree::new(list, cell, sources).number_before(*face));
            stays[*patch as usize] = number == Some(0);
        }
        false
    });
    let fate = |patch: &u32| match stays.get(*patch as usize) {
        None => Fate::Doubtful,
        Some(true) => Fate::Stays,
        Some(false) => Fate::Goes,
    };
    Some(patches.iter().map(fate).collect())
}

/// For each face the number of its patch, `NONE` for doubtful ones, and the first face of each.
fn patches(mates: &[u32], doubtful: &[bool]) -> (Vec<u32>, Vec<FaceId>) {
    let mut patches = vec![NONE; doubtful.len()];
    let mut firsts = Vec::new();
    for first in 0..doubtful.len() {
        if doubtful[first] || patches[first] != NONE {
            continue;
        }
        let patch = as_number(firsts.len());
        firsts.push(FaceId(as_number(first)));
        patches[first] = patch;
        let mut open = vec![first];
        while let Some(face) = open.pop() {
            poll();
            let mates = mates[3 * face..3 * face + 3].iter();
            for mate in mates.filter(|m| **m != NONE).map(|m| *m as usize / 3) {
                if !doubtful[mate] && patches[mate] == NONE {
                    patches[mate] = patch;
                    open.push(mate);
                }
            }
        }
    }
    (patches, firsts)
}

impl Uniting<'_> {
    fn fate(&self, face: FaceId) -> Fate {
        self.fates[face.place()]
    }

    fn cell(&self, cell: Cell, list: List) -> Result<Branch> {
        poll();
        let is_doubtful = |r: &&Record| self.fate(r.face) == Fate::Doubtful;
        let doubtful = list.records.iter().filter(is_doubtful).count();
        if doubtful == 0 {
            return Ok(self.settled(cell, list));
        }
        let total = list.len();
        let stuck = total <= STUCK && list.reaching_out(&cell) * 8 > total * 7;
        let cut = cell.cut().filter(|_| !stuck);
        if (cut.is_none() || doubtful <= LEAF && total <= CROWD)
            && let Some(node) = united(&cell, &list, self.sources, |face| self.fate(face))
        {
            return Ok(Branch::of_node(cell, node));
        }
        let Some(cut) = cut.filter(|_| total > LEAF) else {
            return self.solved(cell, &list);
        };
        let (minus, plus) = list.divide(&cell, cut, self.sources);
        let below = || self.cell(cell.half(cut, Half::Minus), minus);
        let above = || self.cell(cell.half(cut, Half::Plus), plus);
        let (minus, plus) = both(total >= TASK, below, above);
        Ok(join::branch(cell, cut, minus?, plus?, self.sources))
    }

    /// A cell in which every face stays or goes.
    fn settled(&self, cell: Cell, mut list: List) -> Branch {
        list.corner = i32::from(Rule::Positive.inside(list.corner));
        list.records.retain(|r| self.fate(r.face) == Fate::Stays);
        Branch::of_node(cell, list.close(false, self.sources))
    }

    fn solved(&self, cell: Cell, list: &List) -> Result<Branch> {
        let problem = CellProblem {
            cell: &cell,
            expression: &self.itself,
            rule: Rule::Positive,
            operands: vec![Listed {
                number: 0,
                list: Cow::Borrowed(list),
            }],
            sources: self.sources,
        };
        let solution = problem.solve_by(&ALL);
        let solution = solution.ok_or_else(|| Error::internal("a small cell that no kernel takes"));
        Ok(Branch::of_node(cell, solution?.node))
    }
}
