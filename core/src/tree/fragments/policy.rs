//! Pivot policies of fragment trees: rules that choose the piece whose hyperplane divides a region.

use super::node::Piece;
use super::trace::{Candidate, Reason};
use crate::geometry::side::Split;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::interrupt::poll;
use crate::tree::trace::Watcher;

/// The number of candidates that a policy compares at each node, evenly spaced in the list of pieces (convex
/// parts of facets).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample(pub usize);

/// The rule that chooses the pivot of a region: the piece (a convex part of a facet) whose hyperplane divides
/// it. The numbers of pieces on the two sides are n⁻ and n⁺; a cut piece counts on both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Policy {
    /// The first piece (a convex part of a facet) in the order given.
    First,
    /// The first piece (a convex part of a facet) in a random order of all pieces, drawn once; the seed makes
    /// it reproducible.
    ///
    /// There is one order for the whole tree, not a draw for each node, as the analysis requires.
    Random(u64),
    /// The candidate whose hyperplane cuts the fewest pieces (convex parts of facets).
    LeastSplits(Sample),
    /// The candidate with the least |n⁻ − n⁺|, the difference between the numbers of pieces (convex parts of
    /// facets) on the two sides of its hyperplane.
    Balanced(Sample),
    /// The candidate with the least alpha·|n⁻ − n⁺| + (1 − alpha)·splits, where n⁻ and n⁺ are the numbers of
    /// pieces (convex parts of facets) on the two sides of its hyperplane, and splits is the number of pieces
    /// that it cuts.
    ///
    /// With alpha = 1/2, this is the candidate whose larger side has the fewest pieces.
    Weighted(Sample, f64),
    /// The candidate with the least P⁻·n⁻ + P⁺·n⁺, the expected number of pieces (convex parts of facets) on
    /// a random point's side: n⁻ and n⁺ are the numbers of pieces on the two sides of its hyperplane, and P⁻
    /// and P⁺ the sides' shares of the region's volume.
    ///
    /// # Source
    /// Naylor 1993, "Constructing good partitioning trees", with the number of pieces instead of the unknown
    /// cost of a subtree.
    LeastCost(Sample),
}

/// The numbers of pieces (convex parts of facets) with parts on the minus side of a hyperplane, on its plus
/// side, and on both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    pub minus: usize,
    pub plus: usize,
    pub splits: usize,
}

impl Tally {
    /// Counts the pieces (convex parts of facets) on each side of a hyperplane; a piece that it cuts counts
    /// on both sides.
    pub fn of<S: Affine>(pieces: &[Piece<S>], cut: &S::Hyperplane) -> Self {
        let mut tally = Self::default();
        for piece in pieces {
            poll();
            match S::relation(&piece.fragment, cut) {
                Split::Minus => tally.minus += 1,
                Split::Plus => tally.plus += 1,
                Split::Both { .. } => tally.splits += 1,
                Split::Coplanar(_) => {}
            }
        }
        tally.minus += tally.splits;
        tally.plus += tally.splits;
        tally
    }

    pub fn candidate(&self, piece: u32, score: f64) -> Candidate {
        Candidate {
            piece,
            minus: self.minus as u32,
            plus: self.plus as u32,
            splits: self.splits as u32,
            score,
        }
    }

    /// Return whether a hyperplane with this tally does not leave all of `count` pieces (convex parts of
    /// facets) on one side.
    pub fn divides(&self, count: usize) -> bool {
        let one_sided = |all: usize, none: usize| all == count && none == 0;
        !one_sided(self.minus, self.plus) && !one_sided(self.plus, self.minus)
    }

    /// The difference between the numbers of pieces (convex parts of facets) on the two sides.
    fn skew(&self) -> f64 {
        self.minus.abs_diff(self.plus) as f64
    }

    /// The number of pieces (convex parts of facets) on the side that has more.
    pub fn larger_side(&self) -> usize {
        self.minus.max(self.plus)
    }
}

impl Policy {
    /// Return whether the policy compares volumes and so needs the region.
    pub fn needs_region(&self) -> bool {
        matches!(self, Self::LeastCost(_))
    }

    /// Return the reason that a trace gives for pivots of this policy.
    pub(super) fn reason(&self) -> Reason {
        match self {
            Self::First => Reason::First,
            Self::Random(_) => Reason::Random,
            Self::LeastSplits(_) => Reason::LeastSplits,
            Self::Balanced(_) => Reason::Balanced,
            Self::Weighted(..) => Reason::Weighted,
            Self::LeastCost(_) => Reason::LeastCost,
        }
    }

    /// The index of the piece (a convex part of a facet) that the policy chooses as pivot; `pieces` must not
    /// be empty.
    pub(super) fn pivot<S: Affine>(
        &self,
        pieces: &[Piece<S>],
        region: Option<&Polytope<S>>,
        watcher: &mut impl Watcher<Candidate>,
    ) -> usize {
        let mut best = |sample, penalty: &dyn Fn(&Tally, &S::Hyperplane) -> f64| {
            best(pieces, sample, penalty, watcher)
        };
        match *self {
            Self::First | Self::Random(_) => 0,
            Self::LeastSplits(sample) => best(sample, &|tally, _| tally.splits as f64),
            Self::Balanced(sample) => best(sample, &|tally, _| tally.skew()),
            Self::Weighted(sample, alpha) => best(sample, &|tally, _| {
                alpha * tally.skew() + (1.0 - alpha) * tally.splits as f64
            }),
            Self::LeastCost(sample) => best(sample, &|tally, cut| {
                let [minus, plus] = shares(region, cut);
                minus * tally.minus as f64 + plus * tally.plus as f64
            }),
        }
    }
}

/// P⁻ and P⁺: the shares of a region's volume on the minus and on the plus side of a cut; one half each if
/// the region is unknown or has no volume.
fn shares<S: Affine>(region: Option<&Polytope<S>>, cut: &S::Hyperplane) -> [f64; 2] {
    let Some(region) = region else {
        return [0.5; 2];
    };
    let volumes = region.divided(cut).map(|p| p.map_or(0.0, |p| p.volume()));
    let whole = volumes[0] + volumes[1];
    if whole > 0.0 {
        volumes.map(|v| v / whole)
    } else {
        [0.5; 2]
    }
}

/// The index of the first candidate with the least penalty.
fn best<S: Affine>(
    pieces: &[Piece<S>],
    Sample(count): Sample,
    penalty: &dyn Fn(&Tally, &S::Hyperplane) -> f64,
    watcher: &mut impl Watcher<Candidate>,
) -> usize {
    let stride = pieces.len().div_ceil(count.max(1)).max(1);
    let judged = (0..pieces.len()).step_by(stride).map(|candidate| {
        let Piece { fragment, number } = &pieces[candidate];
        let cut = S::hyperplane(fragment);
        let tally = Tally::of(pieces, cut);
        let score = penalty(&tally, cut);
        watcher.notify(|| tally.candidate(*number, score));
        (candidate, score)
    });
    judged
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(candidate, _)| candidate)
}
