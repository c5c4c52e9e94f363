//! The tree of axis cuts over a scene: leaves keep lists and divide themselves when first visited.
//!
//! The shape of a node depends on its list and its cell only, never on the order of visits, and
//! answers never depend on the shape.
//!
//! # Source
//! Deferred leaves: Ar, Montag, Tal 2002, "Deferred, self-organizing BSP trees". Cuts by the
//! surface area heuristic with bins: `MacDonald`, Booth 1990; Wald, Havran 2006.

use std::sync::{Mutex, OnceLock, PoisonError};

use super::facet::Facet;
use crate::interrupt::poll;
use crate::mesh::tasks::both;

/// Candidate cuts on each axis.
const BINS: usize = 32;

/// The cost of a step down, in tests of one facet. With 0.7 the tree of a sphere of 330 000
/// triangles has four times as many nodes, and rays are no faster.
const STEP: f64 = 2.0;

/// The share of the cost that remains of a cut with nothing on one side.
const EMPTY: f64 = 0.8;

/// A list longer than this is completed on several threads.
const PARALLEL: usize = 4096;

/// A box of a node, in lattice steps.
#[derive(Clone, Copy, Debug)]
pub struct Cell<const D: usize> {
    /// The least coordinates.
    pub low: [f64; D],
    /// The largest coordinates.
    pub high: [f64; D],
}

impl<const D: usize> Cell<D> {
    /// The smallest box around facets; inside out if there is none.
    pub fn around(facets: &[Facet<D>]) -> Self {
        facets.iter().fold(Self::NOTHING, |cell, f| cell.with(f))
    }

    const NOTHING: Self = Self {
        low: [f64::INFINITY; D],
        high: [f64::NEG_INFINITY; D],
    };

    fn with(&self, facet: &Facet<D>) -> Self {
        facet.iter().fold(*self, |cell, corner| Self {
            low: std::array::from_fn(|k| cell.low[k].min(corner[k])),
            high: std::array::from_fn(|k| cell.high[k].max(corner[k])),
        })
    }

    fn common(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|k| self.low[k].max(other.low[k])),
            high: std::array::from_fn(|k| self.high[k].min(other.high[k])),
        }
    }

    fn halves(&self, axis: usize, at: f64) -> [Self; 2] {
        let (mut minus, mut plus) = (*self, *self);
        minus.high[axis] = at;
        plus.low[axis] = at;
        [minus, plus]
    }

    /// The measure of the boundary: area in 3D, length in 2D, a constant in 1D.
    fn surface(&self) -> f64 {
        let size = |k: usize| (self.high[k] - self.low[k]).max(0.0);
        match D {
            1 => size(0),
            2 => size(0) + size(1),
            _ => size(0) * size(1) + size(1) * size(2) + size(2) * size(0),
        }
    }
}

/// A node: what it is becomes known when a ray first visits it.
#[derive(Debug)]
pub struct Node<const D: usize> {
    content: OnceLock<Content<D>>,
    pending: Mutex<Option<Box<Pending<D>>>>,
}

/// What is known of a node.
#[derive(Clone, Debug)]
pub struct Known<const D: usize> {
    /// Its box, in lattice steps.
    pub cell: Cell<D>,
    /// The axis and the place of its cut.
    pub cut: Option<(u8, f64)>,
    /// The numbers of its children.
    pub children: [Option<u32>; 2],
    /// The facets of a leaf; `None` for a cut, and for what no ray has reached yet.
    pub facets: Option<Vec<u32>>,
}

/// What a node is.
#[derive(Debug)]
pub enum Content<const D: usize> {
    /// The facets to test.
    Leaf(Box<[u32]>),
    /// A cut across an axis, with the nodes below and above it.
    Cut {
        /// The axis.
        axis: u8,
        /// The coordinate of the cut.
        at: f64,
        /// Below and above.
        children: Box<[Node<D>; 2]>,
    },
}

#[derive(Debug)]
struct Pending<const D: usize> {
    cell: Cell<D>,
    facets: Vec<u32>,
    /// How many more cuts there may be below.
    levels: u32,
}

#[derive(Clone, Copy)]
struct Cut {
    axis: usize,
    at: f64,
    cost: f64,
}

impl<const D: usize> Node<D> {
    /// A leaf that has not been divided yet.
    pub fn deferred(cell: Cell<D>, facets: Vec<u32>) -> Self {
        Self::pending(Pending {
            cell,
            levels: most_levels(facets.len()),
            facets,
        })
    }

    fn pending(pending: Pending<D>) -> Self {
        Self {
            content: OnceLock::new(),
            pending: Mutex::new(Some(Box::new(pending))),
        }
    }

    /// What the node is; divides it if nobody has yet.
    #[inline]
    pub fn content(&self, facets: &[Facet<D>]) -> &Content<D> {
        match self.content.get() {
            Some(content) => content,
            None => self.divide(facets),
        }
    }

    #[cold]
    fn divide(&self, facets: &[Facet<D>]) -> &Content<D> {
        // Not below: what is taken out of the slot must arrive.
        poll();
        self.content.get_or_init(|| {
            let mut slot = self.pending.lock().unwrap_or_else(PoisonError::into_inner);
            match slot.take() {
                Some(pending) => pending.divided(facets),
                None => Content::Leaf(Box::default()),
            }
        })
    }

    /// The nodes that are known by now, in preorder, the root's box being `cell`.
    pub fn known(&self, cell: Cell<D>) -> Vec<Known<D>> {
        let mut found: Vec<Known<D>> = Vec::new();
        let mut open = vec![(self, cell, None)];
        while let Some((node, cell, place)) = open.pop() {
            poll();
            let number = found.len() as u32;
            if let Some((parent, side)) = place {
                let above: &mut Known<D> = &mut found[parent];
                above.children[side] = Some(number);
            }
            let mut known = Known {
                cell,
                cut: None,
                children: [None; 2],
                facets: None,
            };
            match node.content.get() {
                None => {}
                Some(Content::Leaf(facets)) => known.facets = Some(facets.to_vec()),
                Some(Content::Cut { axis, at, children }) => {
                    known.cut = Some((*axis, *at));
                    let halves = cell.halves(usize::from(*axis), *at);
                    for side in [1, 0] {
                        open.push((&children[side], halves[side], Some((found.len(), side))));
                    }
                }
            }
            found.push(known);
        }
        found
    }

    /// Divides everything below.
    pub fn complete(&self, facets: &[Facet<D>]) {
        let list = match &*self.pending.lock().unwrap_or_else(PoisonError::into_inner) {
            Some(pending) => pending.facets.len(),
            None => usize::MAX,
        };
        let Content::Cut { children, .. } = self.content(facets) else {
            return;
        };
        let [minus, plus] = &**children;
        let half = |node: &Self| node.complete(facets);
        both(list > PARALLEL, || half(minus), || half(plus));
    }
}

impl<const D: usize> Pending<D> {
    fn divided(self, facets: &[Facet<D>]) -> Content<D> {
        let leaf = self.facets.len() as f64;
        let chosen = self.best(facets).filter(|cut| cut.cost < leaf);
        match chosen {
            Some(cut) => self.cut(cut, facets),
            None => Content::Leaf(self.facets.into_boxed_slice()),
        }
    }

    fn cut(self, cut: Cut, facets: &[Facet<D>]) -> Content<D> {
        let [mut below, mut above] = [const { Vec::new() }; 2];
        for facet in self.facets {
            let (low, high) = extent(&facets[facet as usize], cut.axis);
            // A facet that only touches the cut is needed on one side: rays look at both there.
            if low < cut.at {
                below.push(facet);
            }
            if high > cut.at || low >= cut.at {
                above.push(facet);
            }
        }
        let cells = self.cell.halves(cut.axis, cut.at);
        let child = |facets: Vec<u32>, cell| {
            Node::pending(Self {
                cell,
                facets,
                levels: self.levels - 1,
            })
        };
        let children = Box::new([child(below, cells[0]), child(above, cells[1])]);
        Content::Cut {
            axis: cut.axis as u8,
            at: cut.at,
            children,
        }
    }

    /// The cut with the least expected cost of a ray through the cell.
    fn best(&self, facets: &[Facet<D>]) -> Option<Cut> {
        if self.facets.len() <= 1 || self.levels == 0 {
            return None;
        }
        let list = || self.facets.iter().map(|f| &facets[*f as usize]);
        let tight = list()
            .fold(Cell::NOTHING, |cell, f| cell.with(f))
            .common(&self.cell);
        let cuts = (0..D).filter_map(|axis| {
            let bins = Bins::of(list(), axis, tight.low[axis], tight.high[axis])?;
            bins.best(&self.cell, self.facets.len())
        });
        cuts.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// How many facets begin and end in each of equal parts of an interval.
struct Bins {
    axis: usize,
    low: f64,
    width: f64,
    begin: [u32; BINS],
    end: [u32; BINS],
}

impl Bins {
    fn of<'a, const D: usize>(
        facets: impl Iterator<Item = &'a Facet<D>>,
        axis: usize,
        low: f64,
        high: f64,
    ) -> Option<Self> {
        let width = (high - low) / BINS as f64;
        if width <= 0.0 {
            return None;
        }
        let (mut begin, mut end) = ([0; BINS], [0; BINS]);
        // Negative numbers become 0.
        let bin = |x: f64| (((x - low) / width) as usize).min(BINS - 1);
        for facet in facets {
            let (low, high) = extent(facet, axis);
            begin[bin(low)] += 1;
            end[bin(high)] += 1;
        }
        Some(Self {
            axis,
            low,
            width,
            begin,
            end,
        })
    }

    fn best<const D: usize>(&self, cell: &Cell<D>, count: usize) -> Option<Cut> {
        let whole = cell.surface();
        let (mut below, mut above) = (0, count as u32);
        let cut = |i: usize| -> Option<Cut> {
            let at = self.low + self.width * i as f64;
            let inside = at > cell.low[self.axis] && at < cell.high[self.axis];
            if i > 0 {
                below += self.begin[i - 1];
                above -= self.end[i - 1];
            }
            let [minus, plus] = cell.halves(self.axis, at).map(|c| c.surface() / whole);
            let tests = minus * f64::from(below) + plus * f64::from(above);
            let bonus = if below == 0 || above == 0 { EMPTY } else { 1.0 };
            let (axis, cost) = (self.axis, STEP + bonus * tests);
            inside.then_some(Cut { axis, at, cost })
        };
        let cuts = (0..=BINS).map(cut).collect::<Vec<_>>();
        let candidates = cuts.into_iter().flatten();
        candidates.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// How deep the tree over so many facets may get: 8 + 1.3 log₂ n (Havran 2000), at most 50.
fn most_levels(facets: usize) -> u32 {
    (8 + 13 * facets.max(1).ilog2() / 10).min(50)
}

fn extent<const D: usize>(facet: &Facet<D>, axis: usize) -> (f64, f64) {
    facet
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), corner| {
            (low.min(corner[axis]), high.max(corner[axis]))
        })
}
