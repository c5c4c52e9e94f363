//! What is known of the other operands at anchors.

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use super::anchors::{Anchor, Name, Spot};
use super::fates::Fate;
use super::scene::Scene;
use super::Labels;

/// Anchors with what is known of the other operands there. Those of an element that nothing
/// crosses have the same labels.
pub(super) struct Known {
    numbers: HashMap<(usize, Name), u32>,
    parents: Vec<u32>,
    /// By anchor that stands for others.
    pub(super) labels: Vec<Option<Labels>>,
    /// The cut elements at the anchors that stand for others: the anchor, the element, and the
    /// anchor's place among the element's.
    cuts: Vec<(u32, u32, u32)>,
}

impl Known {
    /// Nothing is known yet but which anchors are alike.
    pub(super) fn new(scene: &Scene, fates: &[Fate]) -> Self {
        let mut known = Self {
            numbers: HashMap::with_capacity_and_hasher(fates.len(), FxBuildHasher),
            parents: Vec::new(),
            labels: Vec::new(),
            cuts: Vec::new(),
        };
        for (element, fate) in scene.elements.iter().zip(fates) {
            if let Fate::Uncut(anchors) = fate {
                known.unite(element.operand, anchors);
            }
        }
        for (i, (element, fate)) in (0u32..).zip(scene.elements.iter().zip(fates)) {
            if let Fate::Cut(_, _, anchors) = fate {
                for (place, anchor) in (0u32..).zip(anchors) {
                    let root = known.root(element.operand, anchor);
                    known.cuts.push((root, i, place));
                }
            }
        }
        known.cuts.sort_unstable();
        known
    }

    /// Makes one anchor stand for all of an element.
    fn unite(&mut self, operand: usize, anchors: &[Anchor]) {
        let first = self.root(operand, &anchors[0]);
        anchors[1..].iter().fold(first, |a, other| {
            let b = self.root(operand, other);
            self.parents[b.max(a) as usize] = a.min(b);
            a.min(b)
        });
    }

    /// The number of the anchor that stands for this one.
    pub(super) fn root(&mut self, operand: usize, anchor: &Anchor) -> u32 {
        let next = self.parents.len() as u32;
        let mut at = *self.numbers.entry((operand, anchor.name)).or_insert(next);
        if at == next {
            self.parents.push(next);
            self.labels.push(None);
        }
        while self.parents[at as usize] != at {
            let above = self.parents[self.parents[at as usize] as usize];
            self.parents[at as usize] = above;
            at = above;
        }
        at
    }

    /// The cut elements at an anchor, with the piece there and its labels.
    pub(super) fn cut_at(
        &self,
        root: usize,
        fates: &[Fate],
        label: Labels,
    ) -> Option<Vec<(usize, usize, Labels)>> {
        let start = self.cuts.partition_point(|c| (c.0 as usize) < root);
        let here = self.cuts[start..].iter();
        let here = here.take_while(|c| c.0 as usize == root);
        here.map(|(_, i, place)| {
            let Fate::Cut(cutting, _, anchors) = &fates[*i as usize] else {
                return None;
            };
            let piece = anchors[*place as usize].piece(cutting)?;
            Some((*i as usize, piece, label))
        })
        .collect()
    }

    /// The labels of all operands but one at an anchor of that one.
    pub(super) fn label(
        &mut self,
        scene: &Scene,
        operand: usize,
        anchor: &Anchor,
    ) -> Option<Labels> {
        let root = self.root(operand, anchor) as usize;
        if self.labels[root].is_none() {
            self.labels[root] = Some(match &anchor.place {
                Spot::Lattice(point) => scene.count_at_lattice(operand, point)?,
                Spot::Exact(point) => scene.count(operand, point)?,
            });
        }
        self.labels[root]
    }
}
