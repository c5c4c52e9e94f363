//! Builds a fragment tree from pieces, node by node from the root down.

use super::choosing::Chooser;
use super::node::{Crossing, Fragment, FragmentTree, Node, Piece};
use super::plan::{OpenRegion, Plan};
use super::trace::Division;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::{Half, Orientation, Split};
use crate::geometry::spaces::affine::Affine;
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;
use crate::tree::partition::SplitMix;
use crate::tree::trace::Watcher;

/// Builds the tree that divides the pieces (convex parts of facets) as the plan says.
///
/// # Order
/// The list of pieces and the plan determine the tree.
///
/// # Cost
/// With autopartition, quadratic in the worst case: a convex body becomes a chain.
///
/// # Errors
/// `BadSnapshot` if the plan's given cuts do not suit the pieces.
pub fn build<S: Affine>(pieces: Vec<Piece<S>>, plan: Plan<S>) -> Result<FragmentTree<S>> {
    build_watched(pieces, plan, &mut ())
}

/// Builds the same tree as [`build`], and reports each division of a region to the watcher.
///
/// # Errors
/// As for [`build`].
pub fn build_watched<S: Affine, W: Watcher<Division>>(
    mut pieces: Vec<Piece<S>>,
    plan: Plan<S>,
    watcher: &mut W,
) -> Result<FragmentTree<S>> {
    if let Some(seed) = plan.seed() {
        shuffle(&mut pieces, seed);
    }
    let region = plan.region();
    let (chooser, own) = Chooser::of(plan);
    let root = chooser.root();
    let mut builder = Builder {
        tree: FragmentTree::empty(own),
        open: Vec::new(),
        chooser,
        watcher,
    };
    builder.push(OpenRegion {
        pieces,
        parent: None,
        depth: 0,
        region,
        old: root,
    });
    while let Some(open) = builder.open.pop() {
        builder.divide(open)?;
    }
    builder.chooser.finish()?;
    Ok(builder.tree)
}

/// Shuffles a list into a random order that the seed determines (Fisher and Yates).
fn shuffle<T>(list: &mut [T], seed: u64) {
    let mut random = SplitMix::new(seed);
    for end in (1..list.len()).rev() {
        list.swap(end, random.below(end + 1));
    }
}

struct Builder<'a, S: Affine, W> {
    tree: FragmentTree<S>,
    open: Vec<OpenRegion<S>>,
    chooser: Chooser<S>,
    watcher: &'a mut W,
}

impl<S: Affine, W: Watcher<Division>> Builder<'_, S, W> {
    fn push(&mut self, open: OpenRegion<S>) {
        if !open.pieces.is_empty() {
            self.open.push(open);
        }
    }

    fn divide(&mut self, open: OpenRegion<S>) -> Result<()> {
        let node = self.next_number()?;
        let mut candidates = Vec::new();
        let (cut, hyperplane, reason) = if W::LISTENS {
            self.chooser
                .choose(&open, &mut self.tree.own, &mut candidates)?
        } else {
            self.chooser.choose(&open, &mut self.tree.own, &mut ())?
        };
        let [minus_region, plus_region] = match &open.region {
            Some(region) => region.divided(&hyperplane),
            None => [None, None],
        };
        let pieces = if W::LISTENS {
            piece_numbers(&open.pieces)
        } else {
            Vec::new()
        };
        let (start, crossed) = (self.tree.fragments.len(), self.tree.crossings.len());
        let [minus, plus] = self.distribute(open.pieces, &hyperplane, node);
        self.watcher.notify(|| Division {
            node,
            place: open.parent,
            depth: open.depth,
            cut,
            reason,
            candidates,
            pieces,
            minus: piece_numbers(&minus),
            plus: piece_numbers(&plus),
            split: crossed_pieces(&self.tree.crossings[crossed..]),
            coplanar: coplanar_pieces(&self.tree.fragments[start..]),
        });
        self.link(open.parent, node);
        self.tree.nodes.push(Node {
            hyperplane,
            cut,
            coplanar: as_u32(start)?..as_u32(self.tree.fragments.len())?,
            minus: None,
            plus: None,
            parent: open.parent,
            depth: open.depth,
        });
        let chooser = &self.chooser;
        let side = |half, pieces, region| OpenRegion {
            pieces,
            parent: Some((node, half)),
            depth: open.depth + 1,
            region,
            old: chooser.existing_child(open.old, half),
        };
        let [below, above] = [
            side(Half::Minus, minus, minus_region),
            side(Half::Plus, plus, plus_region),
        ];
        self.push(above);
        self.push(below);
        Ok(())
    }

    fn next_number(&self) -> Result<NodeId> {
        as_u32(self.tree.nodes.len()).map(NodeId)
    }

    /// Enters a node as the child of its parent, on the given side; `None` stands for the root.
    fn link(&mut self, parent: Option<(NodeId, Half)>, node: NodeId) {
        let Some((above, half)) = parent else {
            return;
        };
        let above = &mut self.tree.nodes[above.index()];
        match half {
            Half::Minus => above.minus = Some(node),
            Half::Plus => above.plus = Some(node),
        }
    }

    /// Distributes pieces (convex parts of facets) to the two sides of a node's cut, in their order; stores
    /// coplanar pieces and crossings in the tree.
    fn distribute(
        &mut self,
        pieces: Vec<Piece<S>>,
        cut: &S::Hyperplane,
        node: NodeId,
    ) -> [Vec<Piece<S>>; 2] {
        let (mut minus, mut plus) = (Vec::new(), Vec::new());
        for piece in pieces {
            poll();
            let number = piece.number;
            let part = |fragment| Piece { fragment, number };
            match S::split(&piece.fragment, cut) {
                Split::Minus => minus.push(piece),
                Split::Plus => plus.push(piece),
                Split::Coplanar(orientation) => self.tree.fragments.push(Fragment {
                    piece,
                    flipped: orientation == Orientation::Opposite,
                }),
                Split::Both { minus: m, plus: p } => {
                    self.tree.crossings.push(Crossing {
                        node,
                        piece: number,
                    });
                    minus.push(part(m));
                    plus.push(part(p));
                }
            }
        }
        [minus, plus]
    }
}

fn piece_numbers<S: Affine>(pieces: &[Piece<S>]) -> Vec<u32> {
    pieces.iter().map(|piece| piece.number).collect()
}

fn crossed_pieces(crossings: &[Crossing]) -> Vec<u32> {
    crossings.iter().map(|crossing| crossing.piece).collect()
}

fn coplanar_pieces<S: Affine>(fragments: &[Fragment<S>]) -> Vec<u32> {
    let number = |fragment: &Fragment<S>| fragment.piece.number;
    fragments.iter().map(number).collect()
}

fn as_u32(count: usize) -> Result<u32> {
    u32::try_from(count)
        .map_err(|_| Error::new(ErrorKind::TooLarge, "a tree holds at most 2^32 fragments"))
}

#[cfg(test)]
mod tests;
