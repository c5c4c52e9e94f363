//! The choice of the hyperplane that divides a region: by a policy, by given cuts, or by a callback.

use super::axis::median_cut;
use super::node::{FragmentTree, NodeCut, Piece};
use super::plan::{Answer, Ask, Lines, OpenRegion, Plan};
use super::policy::{Policy, Sample, Tally};
use super::trace::{Candidate, Reason};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::geometry::spaces::affine::Affine;
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;
use crate::tree::trace::Watcher;

type Chosen<S> = (
    NodeCut,
    <S as crate::geometry::spaces::space::Space>::Hyperplane,
    Reason,
);

pub(super) enum Chooser<S: Affine> {
    Policy { policy: Policy, top: Option<usize> },
    Given(std::vec::IntoIter<NodeCut>),
    Asked(Ask<S>),
    Lines(Lines),
    Grown(Box<FragmentTree<S>>, Box<Self>),
    OwnFirst(Box<Self>),
}

impl<S: Affine> Chooser<S> {
    /// Return the chooser for a plan, and the hyperplanes of the plan that come from no facet.
    pub fn of(plan: Plan<S>) -> (Self, Vec<S::Hyperplane>) {
        match plan {
            Plan::Policy { policy, top, .. } => (Self::Policy { policy, top }, Vec::new()),
            Plan::Given(cuts) => (Self::Given(cuts.into_iter()), Vec::new()),
            Plan::Asked(ask) => (Self::Asked(ask), Vec::new()),
            Plan::Lines(lines) => (Self::Lines(lines), Vec::new()),
            Plan::Grown(tree, rest) => {
                let (rest, more) = Self::of(*rest);
                let own = tree.own_hyperplanes().iter().cloned().chain(more).collect();
                (Self::Grown(tree, Box::new(rest)), own)
            }
            Plan::Own(mut own, rest) => {
                let (rest, more) = Self::of(*rest);
                own.extend(more);
                match rest {
                    given @ Self::Given(_) => (given, own),
                    rest => (Self::OwnFirst(Box::new(rest)), own),
                }
            }
        }
    }

    /// The root of the existing tree that the new tree extends; `None` if it extends none or an empty one.
    pub fn root(&self) -> Option<NodeId> {
        match self {
            Self::Grown(tree, _) if !tree.nodes().is_empty() => Some(NodeId::ROOT),
            Self::OwnFirst(rest) => rest.root(),
            _ => None,
        }
    }

    /// The child of a node in the existing tree that the new tree extends; `None` if there is none.
    pub fn existing_child(&self, old: Option<NodeId>, half: Half) -> Option<NodeId> {
        match self {
            Self::Grown(tree, _) => tree.child(old?, half),
            Self::OwnFirst(rest) => rest.existing_child(old, half),
            _ => None,
        }
    }

    pub fn choose(
        &mut self,
        open: &OpenRegion<S>,
        own: &mut Vec<S::Hyperplane>,
        watcher: &mut impl Watcher<Candidate>,
    ) -> Result<Chosen<S>> {
        let pieces = &open.pieces;
        match self {
            Self::Given(cuts) => given_cut(cuts.next(), pieces, own),
            Self::Policy { policy, top } => Ok(by_policy(policy, *top, open, watcher)),
            Self::Asked(ask) => asked_cut(ask, open, own, watcher),
            Self::Lines(lines) => Ok(through_ends(lines, pieces, own)),
            Self::Grown(tree, rest) => match open.old.and_then(|n| tree.nodes().get(n.index())) {
                Some(node) => Ok((node.cut, node.hyperplane.clone(), Reason::Given)),
                None => rest.choose(open, own, watcher),
            },
            Self::OwnFirst(rest) => match first_that_divides(pieces, own) {
                Some((number, cut)) => Ok((NodeCut::Own(number), cut, Reason::Given)),
                None => rest.choose(open, own, watcher),
            },
        }
    }

    /// Verifies that the tree has used all given cuts.
    pub fn finish(self) -> Result<()> {
        match self {
            Self::Given(rest) if rest.len() > 0 => {
                Err(unsuited_cut("there are more cuts than regions with facets"))
            }
            _ => Ok(()),
        }
    }
}

fn supporting<S: Affine>(piece: &Piece<S>, reason: Reason) -> Chosen<S> {
    let cut = S::hyperplane(&piece.fragment).clone();
    (NodeCut::Pivot(piece.number), cut, reason)
}

fn by_policy<S: Affine>(
    policy: &Policy,
    top: Option<usize>,
    open: &OpenRegion<S>,
    watcher: &mut impl Watcher<Candidate>,
) -> Chosen<S> {
    let pieces = &open.pieces;
    if top.is_some_and(|leaf| pieces.len() > leaf)
        && let Some((cut, hyperplane)) = median_cut(pieces)
    {
        return (cut, hyperplane, Reason::Median);
    }
    let pivot = policy.pivot(pieces, open.region.as_ref(), watcher);
    supporting(&pieces[pivot], policy.reason())
}

fn given_cut<S: Affine>(
    cut: Option<NodeCut>,
    pieces: &[Piece<S>],
    own: &[S::Hyperplane],
) -> Result<Chosen<S>> {
    let cut = cut.ok_or_else(|| unsuited_cut("there are fewer cuts than regions with facets"))?;
    let hyperplane = match cut {
        NodeCut::Pivot(number) => pieces
            .iter()
            .find(|p| p.number == number)
            .map(|p| S::hyperplane(&p.fragment).clone()),
        NodeCut::Axis { axis, at } => S::axis_cut(axis, at),
        NodeCut::Own(number) => own.get(number as usize).cloned(),
    };
    let hyperplane =
        hyperplane.ok_or_else(|| unsuited_cut("the facet of a cut does not lie in its region"))?;
    Ok((cut, hyperplane, Reason::Given))
}

fn unsuited_cut(why: &str) -> Error {
    let text = format!("the stored cuts do not fit the facets: {why}");
    Error::new(ErrorKind::BadSnapshot, text)
}

/// The first of the tree's own hyperplanes, with its index, that does not leave all pieces (convex parts of
/// facets) on one side; `None` if there is none.
fn first_that_divides<S: Affine>(
    pieces: &[Piece<S>],
    own: &[S::Hyperplane],
) -> Option<(u32, S::Hyperplane)> {
    let mut numbered = (0u32..).zip(own);
    let found = numbered.find(|(_, cut)| Tally::of(pieces, cut).divides(pieces.len()));
    found.map(|(number, cut)| (number, cut.clone()))
}

/// Evenly spaced indices below `count`, at most as many as the sample has.
fn evenly_spaced(count: usize, Sample(sample): Sample) -> impl Iterator<Item = usize> {
    let stride = count.div_ceil(sample.max(1)).max(1);
    (0..count).step_by(stride)
}

fn asked_cut<S: Affine>(
    ask: &mut Ask<S>,
    open: &OpenRegion<S>,
    own: &mut Vec<S::Hyperplane>,
    watcher: &mut impl Watcher<Candidate>,
) -> Result<Chosen<S>> {
    let pieces = &open.pieces;
    let shown: Vec<usize> = evenly_spaced(pieces.len(), ask.sample).collect();
    let candidates: Vec<Candidate> = shown
        .iter()
        .map(|&index| {
            let tally = Tally::of(pieces, S::hyperplane(&pieces[index].fragment));
            tally.candidate(pieces[index].number, tally.splits as f64)
        })
        .collect();
    for candidate in &candidates {
        watcher.notify(|| *candidate);
    }
    match (ask.answer)(open.depth, pieces.len(), &candidates)? {
        Answer::Candidate(index) => {
            let index = shown.get(index).ok_or_else(|| {
                let count = shown.len();
                let text = format!(
                    "the policy chose candidate {index}, but there are only {count} candidates"
                );
                Error::new(ErrorKind::IndexOutOfRange, text)
            })?;
            Ok(supporting(&pieces[*index], Reason::Asked))
        }
        Answer::Hyperplane(cut) => {
            if Tally::of(pieces, &cut).larger_side() >= pieces.len() {
                let text = "the policy chose a hyperplane that leaves all facets of a region on \
                            one side, or cuts each of them; choose one that separates them";
                return Err(Error::new(ErrorKind::BadNormal, text));
            }
            own.push(cut.clone());
            let number = (own.len() - 1) as u32;
            Ok((NodeCut::Own(number), cut, Reason::Asked))
        }
    }
}

/// The hyperplane whose larger side has the fewest pieces (convex parts of facets), among sampled hyperplanes
/// that contain a piece or pass through corners of pieces.
fn through_ends<S: Affine>(
    lines: &Lines,
    pieces: &[Piece<S>],
    own: &mut Vec<S::Hyperplane>,
) -> Chosen<S> {
    let pivot = |index: usize| {
        let larger = Tally::of(pieces, S::hyperplane(&pieces[index].fragment)).larger_side();
        (larger, index)
    };
    let supported = evenly_spaced(pieces.len(), lines.sample).map(pivot).min();
    let (least, index) = supported.unwrap_or((usize::MAX, 0));
    let crossing = corner_cuts::<S>(lines, pieces)
        .map(|cut| (Tally::of(pieces, &cut).larger_side(), cut))
        .min_by_key(|(larger, _)| *larger);
    match crossing {
        Some((larger, cut)) if larger < least => {
            own.push(cut.clone());
            (NodeCut::Own((own.len() - 1) as u32), cut, Reason::Ends)
        }
        _ => supporting(&pieces[index], Reason::Ends),
    }
}

/// A sample of hyperplanes through corners of the pieces (convex parts of facets): through one, two or three,
/// the dimension of the space.
fn corner_cuts<'a, S: Affine>(
    lines: &'a Lines,
    pieces: &[Piece<S>],
) -> impl Iterator<Item = S::Hyperplane> + 'a {
    let known = |piece: &Piece<S>| lines.corners.get(piece.number as usize);
    let mut corners: Vec<Lattice> = pieces.iter().filter_map(known).flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    let count = corners.len();
    let tuples = (0..S::DIM).fold(1usize, |all, _| all.saturating_mul(count));
    evenly_spaced(tuples, lines.sample).filter_map(move |mut number| {
        poll();
        let through: Vec<Lattice> = (0..S::DIM)
            .map(|_| {
                let corner = corners[number % count];
                number /= count;
                corner
            })
            .collect();
        let piece = S::fragment(&through)?;
        Some(S::hyperplane(&piece).clone())
    })
}
