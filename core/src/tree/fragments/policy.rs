//! Pivot policies: rules for the hyperplane that divides a region.

use super::node::Piece;
use super::trace::{Candidate, Reason};
use crate::geometry::side::Split;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::interrupt::poll;
use crate::tree::trace::Watcher;

/// The number of candidates that a policy compares at each node, evenly spaced in its list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample(pub usize);

/// The rule that chooses a region's pivot among its pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Policy {
    /// The first in the order given.
    First,
    /// The first in a random order of all pieces, drawn once; the seed makes it reproducible.
    ///
    /// One order for the whole tree, not a draw for each node: the analysis needs it.
    Random(u64),
    /// The candidate that cuts the fewest pieces.
    LeastSplits(Sample),
    /// The least |n⁻ − n⁺|.
    Balanced(Sample),
    /// The least alpha·|n⁻ − n⁺| + (1 − alpha)·splits.
    ///
    /// With alpha = 1/2: the candidate whose larger side has the fewest pieces.
    Weighted(Sample, f64),
    /// The least expected number of pieces left after one step, P⁻·n⁻ + P⁺·n⁺.
    ///
    /// # Source
    /// Naylor 1993, "Constructing good partitioning trees", with the length of a subtree's list for its
    /// unknown cost.
    LeastCost(Sample),
}

/// The numbers of pieces on each side of a hyperplane, and of those it cuts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    pub minus: usize,
    pub plus: usize,
    pub splits: usize,
}

impl Tally {
    /// Counts fragments on each side; cut fragments count on both.
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

    /// Return whether `count` pieces do not all lie on one side.
    pub fn divides(&self, count: usize) -> bool {
        let one_sided = |all: usize, none: usize| all == count && none == 0;
        !one_sided(self.minus, self.plus) && !one_sided(self.plus, self.minus)
    }

    /// The difference of fragments between the sides.
    fn skew(&self) -> f64 {
        self.minus.abs_diff(self.plus) as f64
    }

    /// The number of fragments on the larger side.
    pub fn larger(&self) -> usize {
        self.minus.max(self.plus)
    }
}

impl Policy {
    /// Return whether the policy needs the region to judge candidates.
    pub fn needs_region(&self) -> bool {
        matches!(self, Self::LeastCost(_))
    }

    /// Return the reason for the pivot.
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

    /// The index of the piece that becomes the pivot; the list is not empty.
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

/// P⁻ and P⁺: the shares of a region's volume on the two sides of a cut.
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

/// The first candidate with the least penalty.
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
