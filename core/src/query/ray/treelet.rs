//! The wide hierarchy of boxes over blocks of facets: small trees, each made when a ray first visits it.
//!
//! The shape of a tree depends on its list only, never on the order of visits, and answers never
//! depend on the shape.
//!
//! # Source
//! Two levels, wide boxes over small trees: Cadet, Lécussan 2007, "Coupled use of BSP and BVH trees
//! in order to exploit ray bundle performance". Wide nodes by taking apart the largest child:
//! Wald, Benthin, Boulos 2008, "Getting rid of packets". Deferral: Ar, Montag, Tal 2002.

use std::collections::VecDeque;
use std::sync::{Mutex, OnceLock, PoisonError};

use rayon::prelude::*;

use super::block::{Block, LANES};
use super::cell::{Frame, Span};
use super::divide::{divide, BoxedFacet, Cuts};
use super::facet::Facet;
use crate::interrupt::{poll, spend, Task};
use crate::mesh::handle::NodeId;
use crate::mesh::tasks::in_pool;

/// The number of children of a node.
pub const CHILDREN_PER_NODE: usize = 8;

/// A list of at most this many facets becomes one treelet: some 100 µs of work, within 100 kB.
const MAX_FACETS_PER_TREELET: usize = 1024;

/// A list of at least this many facets is divided by cuts that a sample decides.
const SAMPLED_FROM: usize = 16 * MAX_FACETS_PER_TREELET;

/// In a treelet of which only the root is made, children with more facets than this are deferred.
const MAX_FACETS_INLINE: usize = LANES * CHILDREN_PER_NODE;

/// A child of a node, in one of its lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// No child.
    None,
    /// A node of the same treelet, by its number.
    Node(NodeId),
    /// A block of facets, by its number in the treelet.
    Block(u32),
    /// A treelet of its own, by its number among the deferred ones.
    Deferred(u32),
}

/// A node: the boxes of its children side by side, and the children.
#[derive(Clone, Debug)]
pub struct Wide<const D: usize> {
    /// The least coordinates of all boxes, then the largest: by axis and lane.
    pub bounds: [[[f32; CHILDREN_PER_NODE]; D]; 2],
    /// The child in each box; after the first `None` all are `None`.
    pub children: [Child; CHILDREN_PER_NODE],
}

impl<const D: usize> Wide<D> {
    const EMPTY: Self = Self {
        bounds: [
            [[Span::NOTHING.low[0]; CHILDREN_PER_NODE]; D],
            [[Span::NOTHING.high[0]; CHILDREN_PER_NODE]; D],
        ],
        children: [Child::None; CHILDREN_PER_NODE],
    };

    fn set(&mut self, lane: usize, span: &Span) {
        for k in 0..D {
            self.bounds[0][k][lane] = span.low[k];
            self.bounds[1][k][lane] = span.high[k];
        }
    }

    /// The box of the child in a lane.
    pub fn span(&self, lane: usize) -> Span {
        let mut span = Span::NOTHING;
        for k in 0..D {
            span.low[k] = self.bounds[0][k][lane];
            span.high[k] = self.bounds[1][k][lane];
        }
        span
    }

    fn whole(&self) -> Span {
        let spans: [Span; CHILDREN_PER_NODE] = std::array::from_fn(|lane| self.span(lane));
        Span::around(&spans)
    }
}

/// A small tree of boxes: the first node is its root, and children follow their parents.
#[derive(Debug, Default)]
pub struct Treelet<const D: usize> {
    /// The nodes; empty for an empty list of facets.
    pub nodes: Vec<Wide<D>>,
    /// The blocks of facets, which are the leaves.
    pub blocks: Vec<Block<D>>,
    /// The treelets below this one, some of them not made yet.
    pub deferred: Vec<Deferred<D>>,
}

/// A treelet that is made when a ray first visits it.
#[derive(Debug)]
pub struct Deferred<const D: usize> {
    treelet: OnceLock<Treelet<D>>,
    pending: Mutex<Vec<BoxedFacet>>,
}

impl<const D: usize> Deferred<D> {
    /// Makes the tree over facets, without dividing it yet.
    pub fn over(facets: &[Facet<D>], frame: &Frame<D>) -> Self {
        let item = |(facet, corners): (u32, _)| BoxedFacet::new(facet, frame.span(corners));
        Self::pending((0..).zip(facets).map(item).collect())
    }

    fn pending(items: Vec<BoxedFacet>) -> Self {
        Self {
            treelet: OnceLock::new(),
            pending: Mutex::new(items),
        }
    }

    /// Returns the treelet, and makes it on the first call.
    #[inline]
    pub fn treelet(&self, facets: &[Facet<D>]) -> &Treelet<D> {
        match self.treelet.get() {
            Some(treelet) => treelet,
            None => self.made(facets),
        }
    }

    /// Returns the treelet if it was already made.
    pub fn known(&self) -> Option<&Treelet<D>> {
        self.treelet.get()
    }

    #[cold]
    fn made(&self, facets: &[Facet<D>]) -> &Treelet<D> {
        // Not in the closure: a call that stops there would lose the list that is taken out of the slot.
        poll();
        self.treelet.get_or_init(|| {
            let mut slot = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
            let items = std::mem::take(&mut *slot);
            Treelet::begun(facets, &items).unwrap_or_else(|| Making::new(facets, items).finish())
        })
    }

    /// Makes all treelets below, level by level, each level in parallel.
    pub fn complete(&self, facets: &[Facet<D>]) {
        let mut level = vec![self];
        while !level.is_empty() {
            let make = |deferred: &&'_ Self| {
                deferred.treelet(facets);
            };
            if in_pool() {
                let task = Task::current();
                level.par_iter().for_each(|d| task.run(|| make(d)));
            } else {
                level.iter().for_each(make);
            }
            let below = level.iter().filter_map(|d| d.known());
            level = below.flat_map(|t| &t.deferred).collect();
        }
    }

    /// Returns the same tree over facets that have moved, with boxes refitted.
    #[must_use]
    pub fn refitted(&self, facets: &[Facet<D>], frame: &Frame<D>) -> Self {
        let mut order = vec![self];
        let mut next = 0;
        while next < order.len() {
            let below = order[next].known().map_or(&[][..], |t| &t.deferred);
            order.extend(below);
            next += 1;
        }
        // Children come in the order of their parents, so the last ones belong to the last parent.
        let mut done: VecDeque<(Self, Span)> = VecDeque::new();
        for deferred in order.into_iter().rev() {
            poll();
            let fitted = match deferred.known() {
                Some(treelet) => {
                    let start = treelet.deferred.len();
                    let mut below: Vec<_> = done.drain(..start).collect();
                    below.reverse();
                    treelet.fitted(facets, frame, below)
                }
                None => deferred.moved(facets, frame),
            };
            done.push_back(fitted);
        }
        match done.pop_back() {
            Some((root, _)) => root,
            None => Self::over(facets, frame),
        }
    }

    fn moved(&self, facets: &[Facet<D>], frame: &Frame<D>) -> (Self, Span) {
        let slot = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
        let again = |item: &BoxedFacet| {
            BoxedFacet::new(item.facet, frame.span(&facets[item.facet as usize]))
        };
        let items: Vec<BoxedFacet> = slot.iter().map(again).collect();
        let span = Span::around(items.iter().map(|item| &item.span));
        (Self::pending(items), span)
    }
}

impl<const D: usize> Treelet<D> {
    /// Makes the root over a long list, with all below it deferred; `None` if the list is short or has no
    /// cut.
    fn begun(facets: &[Facet<D>], items: &[BoxedFacet]) -> Option<Self> {
        if items.len() < SAMPLED_FROM {
            return None;
        }
        let mut treelet = Self::default();
        let mut root = Wide::EMPTY;
        let parts = Cuts::<D>::of(items, CHILDREN_PER_NODE)?.divided(items);
        for (lane, (list, span)) in parts.into_iter().enumerate() {
            root.set(lane, &span);
            root.children[lane] = if list.len() <= LANES {
                let facets_of = list.iter().map(|item| item.facet);
                treelet.blocks.push(Block::of(facets, facets_of));
                Child::Block(treelet.blocks.len() as u32 - 1)
            } else {
                treelet.deferred.push(Deferred::pending(list));
                Child::Deferred(treelet.deferred.len() as u32 - 1)
            };
        }
        treelet.nodes.push(root);
        Some(treelet)
    }

    /// Returns this treelet with its boxes refitted to moved facets; `below` are the refitted treelets of its
    /// deferred children.
    fn fitted(
        &self,
        facets: &[Facet<D>],
        frame: &Frame<D>,
        below: Vec<(Deferred<D>, Span)>,
    ) -> (Deferred<D>, Span) {
        spend(self.blocks.len());
        let again = |block: &Block<D>| Block::of(facets, block.facets().iter().copied());
        let blocks: Vec<Block<D>> = self.blocks.iter().map(again).collect();
        let around = |block: &Block<D>| {
            let spans = block
                .facets()
                .iter()
                .map(|f| frame.span(&facets[*f as usize]));
            spans.fold(Span::NOTHING, |all, span| all.with(&span))
        };
        let mut nodes = self.nodes.clone();
        for at in (0..nodes.len()).rev() {
            for lane in 0..CHILDREN_PER_NODE {
                let span = match nodes[at].children[lane] {
                    Child::None => break,
                    Child::Node(node) => nodes[node.index()].whole(),
                    Child::Block(block) => around(&blocks[block as usize]),
                    Child::Deferred(number) => below[number as usize].1,
                };
                nodes[at].set(lane, &span);
            }
        }
        let whole = nodes.first().map_or(Span::NOTHING, Wide::whole);
        let treelet = Self {
            nodes,
            blocks,
            deferred: below.into_iter().map(|(deferred, _)| deferred).collect(),
        };
        let deferred = Deferred {
            treelet: OnceLock::from(treelet),
            pending: Mutex::default(),
        };
        (deferred, whole)
    }
}

/// Returns the largest number of facets for one child of a node over `facets` facets, such that the nodes
/// below can be full.
fn room(facets: usize) -> usize {
    let mut room = LANES;
    while room * CHILDREN_PER_NODE < facets {
        room *= CHILDREN_PER_NODE;
    }
    room
}

/// A treelet that is being made.
struct Making<'a, const D: usize> {
    facets: &'a [Facet<D>],
    items: Vec<BoxedFacet>,
    treelet: Treelet<D>,
    /// True if only the root is made, and children with many facets are deferred.
    begun: bool,
}

/// A range of the items that becomes one child, its box, and the number of cuts above it.
#[derive(Clone, Copy)]
struct Part {
    from: usize,
    to: usize,
    level: u32,
    span: Span,
}

impl Part {
    fn len(&self) -> usize {
        self.to - self.from
    }
}

impl<'a, const D: usize> Making<'a, D> {
    fn new(facets: &'a [Facet<D>], items: Vec<BoxedFacet>) -> Self {
        let begun = items.len() > MAX_FACETS_PER_TREELET;
        Self {
            facets,
            items,
            begun,
            treelet: Treelet {
                nodes: Vec::new(),
                blocks: Vec::new(),
                deferred: Vec::new(),
            },
        }
    }

    fn finish(mut self) -> Treelet<D> {
        if self.items.is_empty() {
            return self.treelet;
        }
        let whole = Part {
            from: 0,
            to: self.items.len(),
            level: 0,
            span: Span::around(self.items.iter().map(|item| &item.span)),
        };
        self.treelet.nodes.push(Wide::EMPTY);
        let mut open = vec![(NodeId::ROOT, whole)];
        while let Some((node, part)) = open.pop() {
            for (lane, part) in self.parts(part).into_iter().enumerate() {
                let child = self.child(&part);
                if let Child::Node(below) = child {
                    self.treelet.nodes.push(Wide::EMPTY);
                    open.push((below, part));
                }
                let node = &mut self.treelet.nodes[node.index()];
                node.set(lane, &part.span);
                node.children[lane] = child;
            }
        }
        self.treelet
    }

    /// Divides a list into the children of a node, the part with the largest box first, until no part is too
    /// long.
    fn parts(&mut self, whole: Part) -> Vec<Part> {
        let room = if self.begun { LANES } else { room(whole.len()) };
        let mut parts = vec![whole];
        while parts.len() < CHILDREN_PER_NODE {
            let large = parts.iter().enumerate().filter(|(_, p)| p.len() > room);
            let surface = |part: &Part| part.span.surface::<D>();
            let largest = large.max_by(|a, b| surface(a.1).total_cmp(&surface(b.1)));
            let Some((at, part)) = largest.map(|(at, part)| (at, *part)) else {
                break;
            };
            let items = &mut self.items[part.from..part.to];
            let (count, spans) = divide::<D>(items, &part.span, part.level);
            let (middle, level) = (part.from + count, part.level + 1);
            let half = |from, to, span| Part {
                from,
                to,
                level,
                span,
            };
            parts[at] = half(part.from, middle, spans[0]);
            parts.push(half(middle, part.to, spans[1]));
        }
        parts
    }

    fn child(&mut self, part: &Part) -> Child {
        let items = &self.items[part.from..part.to];
        let treelet = &mut self.treelet;
        if items.len() <= LANES {
            let facets = items.iter().map(|item| item.facet);
            treelet.blocks.push(Block::of(self.facets, facets));
            Child::Block(treelet.blocks.len() as u32 - 1)
        } else if self.begun && items.len() > MAX_FACETS_INLINE {
            treelet.deferred.push(Deferred::pending(items.to_vec()));
            Child::Deferred(treelet.deferred.len() as u32 - 1)
        } else {
            Child::Node(NodeId::of(treelet.nodes.len()))
        }
    }
}
