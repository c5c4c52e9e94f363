//! Evaluates an expression over a few meshes as they were imported, by comparing their faces.

use super::arrange::arrange;
use super::candidates::{Candidates, Operand};
use super::contacts::Contacts;
use super::facets::Facets;
use super::keep_rule::KeepRule;
use super::occupancy::Occupancy;
use super::sample::sample;
use super::scene::Scene;
use super::MIN_FACES_FOR_POOL;
use crate::arith::convert::as_double;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::geometry::plane::Lattice;
use crate::merge::expression::Expression;
use crate::merge::lists::list::Sources;
use crate::merge::profile::{Declined, Profile};
use crate::merge::rule::Rule;
use crate::mesh::handle::FaceId;
use crate::mesh::tasks::{both, WorkSize};
use crate::tree::node::Branch;
use crate::tree::solid::Solid;

/// The most meshes that are arranged at once: the table of walls has an entry for each two sets of them, and
/// each is compared with each other.
const MAX_MESHES: usize = 4;

/// The result of an expression over meshes, and how many faces were compared.
#[derive(Debug)]
pub struct Arranged {
    /// The root of the resulting tree.
    pub root: Branch,
    /// The number of faces of all meshes that were compared with others.
    pub compared: usize,
    /// For each operand, whether it was united with itself, too.
    pub resolved: Vec<bool>,
}

/// Evaluates an expression over two to four meshes as they were imported, and records its stages in `profile`.
///
/// # Errors
/// The reason why the expression must be evaluated by a descent instead.
pub fn arranged(
    expression: &Expression,
    solids: &[Solid],
    sources: &Sources,
    profile: &mut Profile,
) -> Result<Arranged, Declined> {
    let operands = operands(expression, solids, sources).ok_or(Declined::Operands)?;
    let faces: usize = operands.iter().map(|o| o.mesh.faces.len()).sum();
    let work_size = WorkSize::pool_if(faces >= MIN_FACES_FOR_POOL);
    let search = || near_pairs(&operands, work_size);
    let count = |found: &Result<Vec<NearPair>, Declined>| {
        found
            .as_ref()
            .map_or(0, |all| all.iter().map(NearPair::len).sum())
    };
    let mut pairs = profile.timed("candidates", search, count)?;
    let near = near_faces(operands.len(), &mut pairs);
    let facets = Facets::of(operands);
    let count = |found: &Result<Contacts, Declined>| found.as_ref().map_or(0, Contacts::len);
    let search = || contacts_of(&facets, &pairs, work_size);
    let mut found = profile.timed("contacts", search, count)?;
    let cells = solids.iter().map(|s| s.root().cell);
    let mut scene = Scene {
        kept: KeepRule::new(expression, solids.len(), Rule::Positive),
        facets,
        near,
        cell: cells
            .reduce(|all, cell| all.join(&cell))
            .ok_or(Declined::Operands)?,
        work_size,
    };
    let may_overlap = |k: usize| !solids[k].is_reduced();
    let root = arrange(&mut scene, &mut found, may_overlap, profile)?;
    Ok(Arranged {
        root,
        compared: scene.near.iter().map(Vec::len).sum(),
        resolved: (0..solids.len())
            .map(|k| scene.kept.is_resolved(k))
            .collect(),
    })
}

/// For two operands whose bounding boxes meet, the faces in the window (the intersection of both boxes), and the
/// candidates: faces that may meet faces of the other operand.
struct NearPair {
    operands: [usize; 2],
    within: [Vec<FaceId>; 2],
    candidates: [Candidates; 2],
}

impl NearPair {
    fn len(&self) -> usize {
        self.candidates.iter().map(|c| c.faces.len()).sum()
    }
}

/// Returns all pairs of operands whose bounding boxes meet, with their near faces.
fn near_pairs(operands: &[Operand], work_size: WorkSize) -> Result<Vec<NearPair>, Declined> {
    let mut pairs = Vec::new();
    for k in 0..operands.len() {
        for j in 0..k {
            if let Some(window) = window([j, k].map(|i| operands[i].bounds)) {
                pairs.push(near_pair(operands, [j, k], &window, work_size)?);
            }
        }
    }
    if pairs.is_empty() {
        return Err(Declined::Apart);
    }
    Ok(pairs)
}

fn near_pair(
    all: &[Operand],
    numbers: [usize; 2],
    window: &[Point; 2],
    work_size: WorkSize,
) -> Result<NearPair, Declined> {
    let operands = numbers.map(|i| all[i]);
    let within = for_both_operands(work_size, |k| operands[k].faces_in_window(window));
    sample(&operands, &within)?;
    let compared = within.iter().map(|w| w.faces.len()).sum();
    let occupied = for_both_operands(work_size, |k| {
        let triangle = |i: usize| operands[k].triangle(within[k].faces[i]);
        Occupancy::of(window, &within[k].boxes, triangle, compared)
    });
    let candidates = for_both_operands(work_size, |k| {
        operands[k].candidates(&within[k], &occupied[1 - k], &window[0])
    });
    Ok(NearPair {
        operands: numbers,
        within: within.map(|w| w.faces),
        candidates,
    })
}

/// Takes the faces in the windows of all pairs, and returns them for each operand, ascending.
fn near_faces(operands: usize, pairs: &mut [NearPair]) -> Vec<Vec<FaceId>> {
    let mut near = vec![Vec::new(); operands];
    for pair in pairs {
        for (k, within) in pair.operands.into_iter().zip(&mut pair.within) {
            if near[k].is_empty() {
                near[k] = std::mem::take(within);
            } else {
                near[k].append(within);
                near[k].sort_unstable();
                near[k].dedup();
            }
        }
    }
    near
}

/// Finds the contacts between the candidates of all pairs.
fn contacts_of(
    facets: &Facets,
    pairs: &[NearPair],
    work_size: WorkSize,
) -> Result<Contacts, Declined> {
    let mut found = Contacts::default();
    for pair in pairs {
        found.add_between(facets, pair.operands, &pair.candidates, work_size)?;
    }
    Ok(found)
}

/// Computes a value for operand 0 and one for operand 1, in parallel if `work_size` says so.
fn for_both_operands<T: Send>(work_size: WorkSize, value: impl Fn(usize) -> T + Sync) -> [T; 2] {
    both(work_size, || value(0), || value(1)).into()
}

/// Returns the operands if they are different meshes as they were imported, and the expression depends on all
/// of them; otherwise `None`.
fn operands<'a>(
    expression: &Expression,
    solids: &'a [Solid],
    sources: &Sources,
) -> Option<Vec<Operand<'a>>> {
    let count = solids.len();
    if !(2..=MAX_MESHES).contains(&count) || expression.operands().len() != count {
        return None;
    }
    let operand = |solid: &'a Solid| {
        let source = solid.whole_mesh().filter(|_| !solid.root().complement)?;
        Operand::new(sources.slot(source), source)
    };
    let operands = solids.iter().map(operand).collect::<Option<Vec<_>>>()?;
    let are_in_order = operands.windows(2).all(|pair| pair[0].slot < pair[1].slot);
    are_in_order.then_some(operands)
}

/// Returns the intersection of two boxes as its low and its high corner; `None` if they are disjoint.
fn window([[low, high], [others_low, others_high]]: [[Lattice; 2]; 2]) -> Option<[Point; 2]> {
    let low = each_axis(|i| low[i].max(others_low[i]));
    let high = each_axis(|i| high[i].min(others_high[i]));
    let meet = (0..3).all(|i| low[i] <= high[i]);
    meet.then(|| [low, high].map(|corner| corner.map(as_double)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both as expression_of_both, cuboid, cuboids, tetrahedra};
    use crate::tree::node::Node;

    fn sources(solids: &[Solid; 2]) -> Sources {
        Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect())
    }

    /// Returns how many whole faces and how many parts of faces the result of `arranged` lists; `None` if it
    /// declines.
    fn counts(solids: &[Solid; 2], term: fn(Vec<u32>) -> Term) -> Option<[usize; 2]> {
        let sources = sources(solids);
        let expression = expression_of_both(term);
        let found = arranged(&expression, solids, &sources, &mut Profile::default()).ok()?;
        Some(match &*found.root.node {
            Node::Deferred(leaf) => [leaf.len() - leaf.parts.len(), leaf.parts.len()],
            _ => [0; 2],
        })
    }

    #[test]
    fn only_faces_that_cross_are_divided() {
        let solids = tetrahedra();
        assert_eq!(counts(&solids, Term::And), Some([0, 4]));
        assert_eq!(counts(&solids, Term::Or), Some([4, 4]));
    }

    #[test]
    fn faces_in_one_plane_are_divided_by_each_other() {
        let touching = [cuboid([0; 3], [4; 3]), cuboid([4, 1, 1], [8, 3, 3])];
        assert_eq!(counts(&touching, Term::Or), Some([20, 2]));
        assert_eq!(counts(&touching, Term::And), Some([0; 2]));
    }

    #[test]
    fn a_mesh_that_overlaps_itself_is_united_where_the_other_one_meets_it() {
        let first = cuboid([0; 3], [4; 3]);
        let twice = cuboids([[[-9, 1, 1], [9, 3, 3]], [[-9, 2, 2], [9, 5, 5]]]);
        let solids = [first.clone(), twice];
        let [whole, parts] = counts(&solids, Term::Or).expect("not declined");
        assert!(whole > 0 && parts > 0);
        let known = [solids[0].clone(), solids[1].clone().with_reduced(true)];
        assert_eq!(counts(&known, Term::Or), None);
        let apart = [first, cuboid([5; 3], [8; 3])];
        assert_eq!(counts(&apart, Term::Or), None);
    }

    #[test]
    fn a_mesh_inside_another_has_numbers_without_crossings() {
        let solids = [cuboid([0; 3], [9; 3]), cuboid([3, 4, 3], [5, 6, 7])];
        assert_eq!(counts(&solids, Term::And), Some([12, 0]));
        assert_eq!(counts(&solids, Term::Or), Some([12, 0]));
        assert_eq!(counts(&solids, Term::Xor), Some([24, 0]));
    }
}
