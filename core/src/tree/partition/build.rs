//! Builds a tree of a set by autopartition: every cut is the hyperplane of a facet.
//!
//! A region without facets is labelled by its side of the last cut. This is correct if the facets are the
//! boundary of a set, each once, with the inside behind it. Otherwise, contradictions are reported where they
//! occur (`Built::simple`), and `winding` can label the tree instead.

use std::sync::Arc;

use super::node::{Facet, Label, PartitionTree, SubHyperplane};
use super::policy::{Choice, PivotPolicy};
use crate::error::{Error, Result};
use crate::geometry::side::{Half, Orientation, Split};
use crate::geometry::spaces::space::{Region, Space};
use crate::interrupt::poll;

/// A tree built from facets, and whether the facets looked like the boundary of one set.
#[derive(Clone, Debug)]
pub struct Built<S: Space> {
    /// The tree; its labels are meaningless unless the facets bound a set.
    pub tree: PartitionTree<S>,
    /// True if the facets next to each leaf agree on its label; false proves that facets overlap or a hole
    /// exists.
    pub simple: bool,
}

/// Builds the tree of a set from its boundary, with the facets' own hyperplanes as cuts.
///
/// `facets` lie in `frame`, with the inside on their minus sides; without facets, the tree is a leaf with the
/// label `empty`. Coplanar facets share one node.
///
/// # Order
/// The order of the facets and the policy determine the tree.
///
/// # Cost
/// Quadratic in the worst case: a convex body becomes a chain.
///
/// # Errors
/// `Internal` if a facet's hyperplane does not cross the facet's region.
///
/// # Source
/// Paterson, Yao 1990; de Berg et al., Computational Geometry, chapter 12.
pub fn autopartition<S: Space>(
    facets: Vec<Facet<S>>,
    frame: S::Frame,
    empty: Label,
    policy: PivotPolicy,
) -> Result<Built<S>> {
    let mut choice = Choice::new(policy);
    partition(facets, frame, empty, |_, facets| choice.cut(facets))
}

/// Builds a tree with cuts that `choose` picks for each region, from the region and its facets; there is at
/// least one.
///
/// Unlike in [`autopartition`], cuts need not be hyperplanes of facets. The labels next to a cut without
/// facets are meaningless.
///
/// # Errors
/// `Internal` if a cut does not cross its region, or cuts never separate the facets.
pub fn partition<S: Space>(
    facets: Vec<Facet<S>>,
    frame: S::Frame,
    empty: Label,
    choose: impl FnMut(&Region<S>, &[Facet<S>]) -> S::Hyperplane,
) -> Result<Built<S>> {
    let mut builder = Builder::new(frame, choose);
    if facets.is_empty() {
        builder.done.push(PartitionTree::Leaf(empty));
    } else {
        builder.divide(facets)?;
    }
    while let Some(step) = builder.steps.pop() {
        poll();
        builder.advance(step)?;
    }
    let tree = builder.done.pop();
    let simple = builder.simple;
    tree.map(|tree| Built { tree, simple })
        .ok_or_else(|| Error::internal("autopartition ended without a tree"))
}

struct Builder<S: Space, C> {
    region: Region<S>,
    choose: C,
    steps: Vec<Step<S>>,
    done: Vec<PartitionTree<S>>,
    simple: bool,
}

enum Step<S: Space> {
    /// Builds the subtree on one side of a sub-hyperplane whose node has `depth` cuts above it.
    Side {
        sub_hyperplane: Arc<SubHyperplane<S>>,
        half: Half,
        depth: usize,
        facets: Vec<Facet<S>>,
    },
    /// Joins the last two subtrees at a sub-hyperplane.
    Join(Arc<SubHyperplane<S>>),
}

impl<S: Space, C: FnMut(&Region<S>, &[Facet<S>]) -> S::Hyperplane> Builder<S, C> {
    fn new(frame: S::Frame, choose: C) -> Self {
        Self {
            region: Region::new(frame),
            choose,
            steps: Vec::new(),
            done: Vec::new(),
            simple: true,
        }
    }

    fn advance(&mut self, step: Step<S>) -> Result<()> {
        match step {
            Step::Side {
                sub_hyperplane,
                half,
                facets,
                ..
            } if facets.is_empty() => {
                self.label(&sub_hyperplane, half);
                Ok(())
            }
            Step::Side {
                sub_hyperplane,
                half,
                depth,
                facets,
            } => {
                self.region.truncate(depth);
                self.region
                    .push(S::hyperplane(&sub_hyperplane.span).clone(), half);
                self.divide(facets)
            }
            Step::Join(sub_hyperplane) => self.join(sub_hyperplane),
        }
    }

    /// Chooses a cut for the current region and schedules its two sides to be built.
    fn divide(&mut self, facets: Vec<Facet<S>>) -> Result<()> {
        let depth = self.region.depth();
        let cut = (self.choose)(&self.region, &facets);
        let span = self
            .region
            .span(&cut)
            .ok_or_else(|| Error::internal("a facet lies outside the region it was given to"))?;
        let [minus, plus, coplanar] = distribute(facets, &cut);
        let sub_hyperplane = Arc::new(SubHyperplane {
            span,
            facets: coplanar,
        });
        let side = |half, facets| Step::Side {
            sub_hyperplane: Arc::clone(&sub_hyperplane),
            half,
            depth,
            facets,
        };
        let (first, second) = (side(Half::Minus, minus), side(Half::Plus, plus));
        self.steps.push(Step::Join(sub_hyperplane));
        self.steps.extend([second, first]);
        Ok(())
    }

    /// Adds the leaf for a region without facets, labelled by its side of the last cut.
    fn label(&mut self, sub_hyperplane: &SubHyperplane<S>, half: Half) {
        let cut = S::hyperplane(&sub_hyperplane.span);
        let faces_as_cut = |facet: &Facet<S>| {
            S::coincide(S::hyperplane(&facet.fragment), cut) == Some(Orientation::Same)
        };
        let same = sub_hyperplane
            .facets
            .iter()
            .filter(|f| faces_as_cut(f))
            .count();
        self.simple &= same == 0 || same == sub_hyperplane.facets.len();
        let inside = (half == Half::Minus) == (same > 0);
        self.done
            .push(PartitionTree::Leaf(Label::from_inside(inside)));
    }

    fn join(&mut self, sub_hyperplane: Arc<SubHyperplane<S>>) -> Result<()> {
        let (Some(plus), Some(minus)) = (self.done.pop(), self.done.pop()) else {
            return Err(Error::internal(
                "a cut was joined before its sides were built",
            ));
        };
        self.done
            .push(PartitionTree::cut(sub_hyperplane, minus, plus));
        Ok(())
    }
}

/// The parts of facets on the minus side of a cut, on its plus side, and in the cut.
fn distribute<S: Space>(facets: Vec<Facet<S>>, cut: &S::Hyperplane) -> [Vec<Facet<S>>; 3] {
    let mut lists = [Vec::new(), Vec::new(), Vec::new()];
    for facet in facets {
        poll();
        let source = facet.source;
        let part = |fragment| Facet { fragment, source };
        match S::split(&facet.fragment, cut) {
            Split::Minus => lists[0].push(facet),
            Split::Plus => lists[1].push(facet),
            Split::Coplanar(_) => lists[2].push(facet),
            Split::Both { minus, plus } => {
                lists[0].push(part(minus));
                lists[1].push(part(plus));
            }
        }
    }
    lists
}
