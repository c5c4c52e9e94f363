//! The nodes of a tree that counts.

use super::cast::Cast;
use super::cut::Cut;
use super::heap::Heap;

/// When leaves are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// After more visits than this.
    Visits(u64),
    /// Not by rays.
    Never,
}

#[derive(Debug)]
pub(super) struct Node<S: Cast<D>, const D: usize> {
    pub(super) visits: u64,
    pub(super) depth: u32,
    pub(super) content: Content<S, D>,
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
    pub(super) children: [u32; 2],
    /// Whether a facet of each child may have a point in the interior of a facet in the cut.
    pub(super) touched: [bool; 2],
}

impl<S: Cast<D>, const D: usize> Node<S, D> {
    /// A preliminary leaf that nobody has visited.
    pub(super) fn leaf(list: Heap<S::Fragment>, depth: u32) -> Self {
        let (visits, content) = (0, Content::Leaf(list));
        Self {
            visits,
            depth,
            content,
        }
    }
}
