//! The counters and cuts of a stab tree as plain numbers, from which the tree over the same facets is made
//! again.

use std::sync::atomic::Ordering;

use serde::{Deserialize, Serialize};

use super::cast::Cast;
use super::heap::{Entry, Heap};
use super::node::{Content, Growth};
use super::tree::StabTree;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::handle::NodeId;
use crate::query::ray::Scene;

/// The counters of a stab tree, and the facets at which it was cut, from which the tree can be made again.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    rays: u64,
    /// The nodes, in the order in which they were made.
    nodes: Vec<NodeRecord>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct NodeRecord {
    visits: u64,
    content: ContentRecord,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum ContentRecord {
    /// The facets in the order of the heap, each with its hits.
    Leaf(Vec<(u32, u64)>),
    /// The facets in the cut, the pivot first, and the number of the minus child.
    Cut(Vec<u32>, NodeId),
}

impl<S: Cast<D>, const D: usize> StabTree<S, D> {
    /// Returns the record of the tree.
    pub fn record(&self) -> Record {
        let content = |content: &Content<S, D>| match content {
            Content::Leaf(list) => {
                let hits = list.entries().iter().map(|e| (e.facet, e.hits));
                ContentRecord::Leaf(hits.collect())
            }
            Content::Inner(inner) => ContentRecord::Cut(inner.coplanar.clone(), inner.children[0]),
        };
        let nodes = self.nodes();
        let records = nodes.all.iter().map(|node| NodeRecord {
            visits: node.visits.load(Ordering::Relaxed),
            content: content(&node.content),
        });
        Record {
            rays: self.rays.load(Ordering::Relaxed),
            nodes: records.collect(),
        }
    }

    /// Makes the tree of a record: repeats its cuts in their order, and restores the counters.
    ///
    /// # Errors
    /// `BadSnapshot` if the record does not belong to these facets; as for `new`.
    pub fn regrown(scene: Scene<D>, growth: Growth, record: &Record) -> Result<Self> {
        let tree = Self::new(scene, growth, None)?;
        tree.follow(record).ok_or_else(|| {
            let text = "the stored tree was not built over the given facets; give the facets over \
                        which it was built";
            Error::new(ErrorKind::BadSnapshot, text)
        })?;
        Ok(tree)
    }

    fn follow(&self, record: &Record) -> Option<()> {
        let mut nodes = self.nodes_mut();
        for (at, facets, child) in record.cuts() {
            if child.index() != nodes.all.len() {
                return None;
            }
            nodes.divide_by(self.scene(), at, *facets.first()?)?;
        }
        if nodes.all.len() != record.nodes.len() {
            return None;
        }
        for (node, stored) in nodes.all.iter_mut().zip(&record.nodes) {
            node.visits.store(stored.visits, Ordering::Relaxed);
            restore(&mut node.content, &stored.content)?;
        }
        self.rays.store(record.rays, Ordering::Relaxed);
        Some(())
    }
}

impl Record {
    /// Returns the inner nodes, each with the facets in its cut and its first child, in the order of
    /// division.
    fn cuts(&self) -> Vec<(NodeId, &[u32], NodeId)> {
        let mut cuts = Vec::new();
        for (at, node) in NodeId::all().zip(&self.nodes) {
            if let ContentRecord::Cut(facets, child) = &node.content {
                cuts.push((at, facets.as_slice(), *child));
            }
        }
        cuts.sort_unstable_by_key(|cut| cut.2);
        cuts
    }
}

/// Sorts the list of a node into the order in a record; `None` if the record names different facets.
fn restore<S: Cast<D>, const D: usize>(
    content: &mut Content<S, D>,
    stored: &ContentRecord,
) -> Option<()> {
    match (content, stored) {
        (Content::Leaf(list), ContentRecord::Leaf(hits)) => {
            *list = Heap::of(rearranged(std::mem::take(list).into_entries(), hits)?)?;
        }
        (Content::Inner(inner), ContentRecord::Cut(facets, _)) => {
            let (mut found, mut wanted) = (inner.coplanar.clone(), facets.clone());
            found.sort_unstable();
            wanted.sort_unstable();
            if found != wanted {
                return None;
            }
            inner.coplanar.clone_from(facets);
        }
        _ => return None,
    }
    Some(())
}

/// Sorts the entries of a leaf's list into the order of the stored facet numbers, and sets their hits; `None`
/// if they are not the same facets.
fn rearranged<F>(mut entries: Vec<Entry<F>>, hits: &[(u32, u64)]) -> Option<Vec<Entry<F>>> {
    let mut order: Vec<usize> = (0..hits.len()).collect();
    order.sort_unstable_by_key(|place| hits[*place].0);
    entries.sort_unstable_by_key(|entry| entry.facet);
    if entries.len() != hits.len() {
        return None;
    }
    let mut placed: Vec<Option<Entry<F>>> = entries.iter().map(|_| None).collect();
    for (mut entry, place) in entries.into_iter().zip(order) {
        let (facet, count) = hits[place];
        if entry.facet != facet {
            return None;
        }
        entry.hits = count;
        placed[place] = Some(entry);
    }
    placed.into_iter().collect()
}
