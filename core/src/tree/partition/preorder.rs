//! Conversion between trees of sets and lists of hyperplanes and labels in preorder.

use std::sync::Arc;

use super::node::{Label, PartitionTree, SubHyperplane};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::space::{Region, Space};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A node of a tree listed in preorder: the hyperplane of a cut, or the label of a leaf.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Entry<H> {
    /// An inner node; the list continues with its minus subtree, then its plus subtree.
    Cut(H),
    /// A leaf.
    Leaf(Label),
}

/// The nodes of a tree in preorder: each before its subtrees, minus subtree first.
pub fn preorder<S: Space>(tree: &PartitionTree<S>) -> Vec<Entry<S::Hyperplane>> {
    let mut entries = Vec::new();
    let mut pending = vec![tree.clone()];
    while let Some(next) = pending.pop() {
        poll();
        entries.push(match next {
            PartitionTree::Leaf(label) => Entry::Leaf(label),
            PartitionTree::Cut(cut) => {
                pending.extend(cut.children());
                Entry::Cut(cut.hyperplane().clone())
            }
        });
    }
    entries
}

/// The tree with these nodes, without facets.
///
/// A cut that misses its region inside the frame, perhaps because hyperplanes have been moved, is left out
/// together with the subtree on the empty side.
///
/// # Errors
/// `BadSnapshot` if the list is not one tree in preorder or repeats a cut inside its own subtree; `TooLarge`
/// if the root's hyperplane misses the frame.
pub fn from_preorder<S: Space>(
    entries: &[Entry<S::Hyperplane>],
    frame: S::Frame,
) -> Result<PartitionTree<S>> {
    let plus = plus_children(entries)?;
    let mut reader = PreorderReader {
        entries,
        plus: &plus,
        region: Region::new(frame),
        steps: vec![Step::Visit(NodeId::ROOT, None)],
        done: Vec::new(),
    };
    while let Some(step) = reader.steps.pop() {
        poll();
        reader.advance(step)?;
    }
    reader.done.pop().ok_or_else(bad_list)
}

fn bad_list() -> Error {
    Error::new(
        ErrorKind::BadSnapshot,
        "the nodes do not form a partition tree in preorder",
    )
}

/// For each inner node, the index of its plus child in the list; an error if the list is not one tree.
fn plus_children<H>(entries: &[Entry<H>]) -> Result<Vec<NodeId>> {
    let mut plus = vec![NodeId::ROOT; entries.len()];
    let mut roots: Vec<NodeId> = Vec::new();
    for (i, entry) in entries.iter().enumerate().rev() {
        if let Entry::Cut(_) = entry {
            let (minus, other) = (roots.pop(), roots.pop());
            let (Some(_), Some(other)) = (minus, other) else {
                return Err(bad_list());
            };
            plus[i] = other;
        }
        roots.push(NodeId::of(i));
    }
    if roots.len() == 1 {
        Ok(plus)
    } else {
        Err(bad_list())
    }
}

struct PreorderReader<'a, S: Space> {
    entries: &'a [Entry<S::Hyperplane>],
    plus: &'a [NodeId],
    region: Region<S>,
    steps: Vec<Step<S>>,
    done: Vec<PartitionTree<S>>,
}

/// The sub-hyperplane of a node's parent, the node's side of it, and the depth of the parent's region; `None`
/// for the root.
type ParentSide<S> = Option<(Arc<SubHyperplane<S>>, Half, usize)>;

enum Step<S: Space> {
    Visit(NodeId, ParentSide<S>),
    Join(Arc<SubHyperplane<S>>),
}

impl<S: Space> PreorderReader<'_, S> {
    fn advance(&mut self, step: Step<S>) -> Result<()> {
        match step {
            Step::Join(sub_hyperplane) => {
                let (Some(plus), Some(minus)) = (self.done.pop(), self.done.pop()) else {
                    return Err(bad_list());
                };
                self.done
                    .push(PartitionTree::cut(sub_hyperplane, minus, plus));
                Ok(())
            }
            Step::Visit(at, above) => match &self.entries[at.index()] {
                Entry::Leaf(label) => {
                    self.done.push(PartitionTree::Leaf(*label));
                    Ok(())
                }
                Entry::Cut(cut) => self.divide(at, cut, above),
            },
        }
    }

    fn divide(&mut self, at: NodeId, cut: &S::Hyperplane, above: ParentSide<S>) -> Result<()> {
        if let Some((sub_hyperplane, half, depth)) = &above {
            self.region.truncate(*depth);
            self.region
                .push(S::hyperplane(&sub_hyperplane.span).clone(), *half);
        }
        let minus = NodeId::of(at.index() + 1);
        let Some(span) = self.region.span(cut) else {
            let only = match side_of_region::<S>(cut, above.as_ref())? {
                Half::Minus => minus,
                Half::Plus => self.plus[at.index()],
            };
            self.steps.push(Step::Visit(only, above));
            return Ok(());
        };
        let facets = Vec::new();
        let sub_hyperplane = Arc::new(SubHyperplane { span, facets });
        let depth = self.region.depth();
        let below = |half| Some((Arc::clone(&sub_hyperplane), half, depth));
        self.steps.push(Step::Join(Arc::clone(&sub_hyperplane)));
        self.steps
            .push(Step::Visit(self.plus[at.index()], below(Half::Plus)));
        self.steps.push(Step::Visit(minus, below(Half::Minus)));
        Ok(())
    }
}

/// For a cut that misses a region: the side of the cut on which the region lies.
///
/// The sub-hyperplane of the region's parent bounds the region, and so lies on the same side of the cut.
fn side_of_region<S: Space>(
    cut: &S::Hyperplane,
    above: Option<&(Arc<SubHyperplane<S>>, Half, usize)>,
) -> Result<Half> {
    let Some((sub_hyperplane, ..)) = above else {
        let text = "a moved or refined hyperplane misses the lattice of 2^53 steps; move the set \
                    less, or choose a coarser pitch";
        return Err(Error::new(ErrorKind::TooLarge, text));
    };
    match S::split(&sub_hyperplane.span, cut) {
        Split::Minus => Ok(Half::Minus),
        Split::Plus => Ok(Half::Plus),
        _ => Err(bad_list()),
    }
}
