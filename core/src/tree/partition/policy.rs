//! Pivot policies of set trees: rules that choose the facet whose hyperplane divides a region.

use super::node::Facet;
use super::random::SplitMix;
use crate::geometry::side::Split;
use crate::geometry::spaces::space::Space;

/// The rule that chooses a node's cut among the hyperplanes of its facets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PivotPolicy {
    /// The first facet in the order given.
    First,
    /// A random facet; the seed makes the tree reproducible.
    Random(u64),
    /// The first facet that cuts the fewest others, among this many evenly spaced candidates.
    FewestSplits(usize),
}

/// A pivot policy and the state of its random sequence.
pub(super) struct Choice {
    policy: PivotPolicy,
    random: SplitMix,
}

impl Choice {
    pub(super) fn new(policy: PivotPolicy) -> Self {
        let seed = match policy {
            PivotPolicy::Random(seed) => seed,
            _ => 0,
        };
        let random = SplitMix::new(seed);
        Self { policy, random }
    }

    /// The hyperplane of the facet that the policy chooses; `facets` must not be empty.
    pub(super) fn cut<S: Space>(&mut self, facets: &[Facet<S>]) -> S::Hyperplane {
        S::hyperplane(&facets[self.pivot(facets)].fragment).clone()
    }

    /// The index of the facet that the policy chooses; `facets` must not be empty.
    fn pivot<S: Space>(&mut self, facets: &[Facet<S>]) -> usize {
        match self.policy {
            PivotPolicy::First => 0,
            PivotPolicy::Random(_) => self.random.below(facets.len()),
            PivotPolicy::FewestSplits(sample) => fewest_splits(facets, sample),
        }
    }
}

fn fewest_splits<S: Space>(facets: &[Facet<S>], sample: usize) -> usize {
    let stride = facets.len().div_ceil(sample.max(1)).max(1);
    (0..facets.len())
        .step_by(stride)
        .min_by_key(|&candidate| splits_by(facets, candidate))
        .unwrap_or(0)
}

fn splits_by<S: Space>(facets: &[Facet<S>], candidate: usize) -> usize {
    let cut = S::hyperplane(&facets[candidate].fragment);
    let crossed = |facet: &&Facet<S>| matches!(S::split(&facet.fragment, cut), Split::Both { .. });
    facets.iter().filter(crossed).count()
}
