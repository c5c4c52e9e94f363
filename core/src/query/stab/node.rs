//! The nodes of a stab tree, with their counters.

use std::sync::atomic::AtomicU64;
use std::sync::OnceLock;

use super::cast::Cast;
use super::cut::Cut;
use super::heap::Heap;
use crate::mesh::handle::NodeId;

/// When the leaves of a stab tree are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// After a ray, if a leaf that it visited has more visits than this number.
    Visits(u64),
    /// Never by rays.
    Never,
}

/// The nodes of a stab tree, by number.
#[derive(Debug)]
pub(super) struct Nodes<S: Cast<D>, const D: usize> {
    pub(super) all: Vec<Node<S, D>>,
    /// The number of leaves divided since the tree was made.
    pub(super) subdivisions: u64,
}

#[derive(Debug)]
pub(super) struct Node<S: Cast<D>, const D: usize> {
    /// The number of visits T(v) of the node; several rays may count at once.
    pub(super) visits: AtomicU64,
    pub(super) depth: u32,
    pub(super) content: Content<S, D>,
    /// For a leaf with a long list, its facets, ascending, each with its index in the list at the time when
    /// this table was made.
    places: OnceLock<Vec<(u32, u32)>>,
}

#[derive(Debug)]
pub(super) enum Content<S: Cast<D>, const D: usize> {
    Leaf(Heap<S::Fragment>),
    Inner(Box<Inner<D>>),
}

#[derive(Debug)]
pub(super) struct Inner<const D: usize> {
    pub(super) cut: Cut<D>,
    pub(super) coplanar: Vec<u32>,
    pub(super) children: [NodeId; 2],
    /// For each child, whether one of its facets may have a point in the interior of a facet in the cut.
    pub(super) touched: [bool; 2],
}

impl<S: Cast<D>, const D: usize> Node<S, D> {
    /// Makes a leaf that no ray has visited.
    pub(super) fn leaf(list: Heap<S::Fragment>, depth: u32) -> Self {
        Self {
            visits: AtomicU64::new(0),
            depth,
            content: Content::Leaf(list),
            places: OnceLock::new(),
        }
    }

    /// Returns the index of a facet in the list of this leaf; `None` if it is not there.
    pub(super) fn place(&self, list: &Heap<S::Fragment>, facet: u32) -> Option<usize> {
        let places = self.places.get_or_init(|| {
            let facets = list.entries().iter().map(|entry| entry.facet);
            let mut places: Vec<(u32, u32)> = facets.zip(0..).collect();
            places.sort_unstable();
            places
        });
        let at = places.binary_search_by_key(&facet, |known| known.0).ok()?;
        list.place(facet, places[at].1 as usize)
    }

    /// Drops the table of facet indices of a list that is being divided.
    pub(super) fn forget_places(&mut self) {
        self.places = OnceLock::new();
    }
}
