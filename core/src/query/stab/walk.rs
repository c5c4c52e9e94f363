//! Takes a ray through a stab tree: near child, cut, far child.

use std::sync::atomic::Ordering;

use smallvec::SmallVec;

use super::cast::Cast;
use super::cut::Stab;
use super::heap::Heap;
use super::node::{Content, Growth, Inner, Node};
use super::trace::{StabEvent, Trace};
use crate::geometry::side::Side;
use crate::mesh::handle::NodeId;
use crate::query::ray::block::Block;
use crate::query::ray::filter::{Depth, Probe};
use crate::query::ray::first::{Candidate, Query};
use crate::query::ray::walk::walk;
use crate::query::ray::{Ray, Scene};
use crate::tree::trace::Watcher;

#[derive(Clone, Copy)]
enum StackEntry {
    Node { node: NodeId, from: f64, to: f64 },
    Cut { node: NodeId, from: f64, far: Far },
}

/// The part of a ray's walk that waits, on its stack, directly below a cut.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Far {
    /// A part other than the child on the far side of the cut.
    No,
    /// The child on the far side of the cut, by its index.
    Child(usize),
}

type Stack = SmallVec<[StackEntry; 64]>;

/// A leaf's list of at most this many facets is tested from end to end, as in the lecture notes, in some 40
/// µs; of a longer one only the facets whose boxes the ray meets.
const MAX_FACETS_TESTED: usize = 4096;

/// A facet that was hit within a leaf, and its index in the leaf's list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) node: NodeId,
    pub(super) facet: u32,
    pub(super) place: usize,
}

/// The updates after a ray: hits to count, and leaves to divide.
#[derive(Debug, Default)]
pub(super) struct PendingUpdates {
    pub(super) hits: SmallVec<[Hit; 16]>,
    pub(super) due: SmallVec<[NodeId; 16]>,
}

/// A ray on its path through a tree.
pub(super) struct Walk<'a, S: Cast<D>, W, const D: usize> {
    pub(super) scene: &'a Scene<D>,
    pub(super) query: &'a Query<'a, D>,
    pub(super) ray: &'a Ray<D>,
    pub(super) nodes: &'a [Node<S, D>],
    pub(super) growth: Growth,
    pub(super) best: Option<Candidate>,
    /// All facets that the ray hits, with depths; found when the first long list is reached.
    pub(super) met: Option<Vec<(u32, Depth)>>,
    pub(super) trace: Trace,
    pub(super) pending: PendingUpdates,
    pub(super) watcher: &'a mut W,
}

impl<S: Cast<D>, W: Watcher<StabEvent>, const D: usize> Walk<'_, S, W, D> {
    /// Visits the nodes that the ray meets between two depths, nearest first.
    pub(super) fn run(&mut self, span: Option<(f64, f64)>) {
        let mut open = Stack::new();
        open.extend(span.map(|(from, to)| StackEntry::Node {
            node: NodeId::ROOT,
            from,
            to,
        }));
        while let Some(next) = open.pop() {
            let limit = self.best.map_or(f64::INFINITY, |best| best.high());
            match next {
                StackEntry::Node { node, from, to } if from <= limit => {
                    self.visit(node, (from, to), &mut open);
                }
                StackEntry::Cut { node, from, far }
                    if from <= limit && self.test_cut(node, far) =>
                {
                    open.pop();
                }
                _ => {}
            }
        }
    }

    fn visit(&mut self, node: NodeId, span: (f64, f64), open: &mut Stack) {
        let visited = &self.nodes[node.index()];
        let visits = visited.visits.fetch_add(1, Ordering::Relaxed) + 1;
        self.trace.nodes += 1;
        self.watcher.notify(|| StabEvent::Visit {
            node,
            visits,
            leaf: matches!(visited.content, Content::Leaf(_)),
        });
        match &visited.content {
            Content::Leaf(list) => self.test_leaf(node, list, visits, span.1),
            Content::Inner(inner) => push_parts(inner, self.ray, node, span, open),
        }
    }

    /// Tests the facets in a cut; returns true if the child behind it can be skipped.
    fn test_cut(&mut self, node: NodeId, far: Far) -> bool {
        let Content::Inner(inner) = &self.nodes[node.index()].content else {
            return false;
        };
        for facet in &inner.coplanar {
            self.trace.tests += 1;
            let met = self.query.offer(&mut self.best, *facet).is_some();
            self.watcher.notify(|| {
                let facet = self.scene.number(*facet);
                StabEvent::Test { node, facet, met }
            });
        }
        let Far::Child(child) = far else {
            return false;
        };
        // The ray hits the interior of the only facet, and no facet of the far child touches it there.
        let inside = |facet| matches!(self.query.probe(facet), Probe::Hit(_));
        !inner.touched[child] && inner.coplanar.len() == 1 && inside(inner.coplanar[0])
    }

    /// Tests the facets in a leaf's list that the ray may hit; notes the hits within the leaf for counting.
    fn test_leaf(&mut self, node: NodeId, list: &Heap<S::Fragment>, visits: u64, to: f64) {
        self.trace.leaves += 1;
        let hits = if list.len() > MAX_FACETS_TESTED {
            self.search(node, list, to)
        } else {
            self.test_all(node, list, to)
        };
        let Growth::Visits(threshold) = self.growth else {
            return;
        };
        for hit in &hits {
            self.watcher.notify(|| StabEvent::Count {
                node,
                facet: self.scene.number(hit.facet),
                hits: list.entries()[hit.place].hits + 1,
            });
        }
        self.pending.hits.extend(hits);
        if visits > threshold && list.len() > 1 {
            self.pending.due.push(node);
        }
    }

    /// Tests all facets of a list; returns the hits within the leaf.
    fn test_all(&mut self, node: NodeId, list: &Heap<S::Fragment>, to: f64) -> SmallVec<[Hit; 16]> {
        let mut hits = SmallVec::new();
        for (place, entry) in list.entries().iter().enumerate() {
            let facet = entry.facet;
            self.trace.tests += 1;
            let depth = self.query.offer(&mut self.best, facet);
            self.watcher.notify(|| StabEvent::Test {
                node,
                facet: self.scene.number(facet),
                met: depth.is_some(),
            });
            if depth.is_some_and(|d| d.low() <= to) {
                hits.push(Hit { node, facet, place });
            }
        }
        hits
    }

    /// Returns the hits within the leaf, by index, among the facets whose boxes the ray meets.
    fn search(&mut self, node: NodeId, list: &Heap<S::Fragment>, to: f64) -> SmallVec<[Hit; 16]> {
        let met = match self.met.take() {
            Some(met) => met,
            None => self.test_boxes(node),
        };
        let leaf = &self.nodes[node.index()];
        let within = met.iter().filter(|(_, depth)| depth.low() <= to);
        let hit = |facet: u32| {
            let place = leaf.place(list, facet)?;
            Some(Hit { node, facet, place })
        };
        let mut hits: SmallVec<[Hit; 16]> = within.filter_map(|(facet, _)| hit(*facet)).collect();
        hits.sort_unstable_by_key(|hit| hit.place);
        self.met = Some(met);
        hits
    }

    /// Tests the facets of the scene whose boxes the ray meets; returns those that it hits, with their
    /// depths.
    fn test_boxes(&mut self, node: NodeId) -> Vec<(u32, Depth)> {
        let mut met = Vec::new();
        let (query, scene) = (self.query, self.scene);
        let (best, trace, watcher) = (&mut self.best, &mut self.trace, &mut self.watcher);
        let visit = |_, block: &Block<D>| {
            trace.tests += block.facets().len() as u32;
            let known = met.len();
            query.try_block(best, block, |facet, depth| met.push((facet, depth)));
            for facet in block.facets() {
                watcher.notify(|| StabEvent::Test {
                    node,
                    facet: scene.number(*facet),
                    met: met[known..].iter().any(|(hit, _)| hit == facet),
                });
            }
            f64::INFINITY
        };
        walk(
            scene,
            std::slice::from_ref(self.ray),
            |_| f64::INFINITY,
            visit,
        );
        met
    }
}

/// Pushes the children and the cut of an inner node that the ray meets, the nearest last.
#[inline]
fn push_parts<const D: usize>(
    inner: &Inner<D>,
    ray: &Ray<D>,
    node: NodeId,
    (from, to): (f64, f64),
    open: &mut Stack,
) {
    let [minus, plus] = inner.children;
    let child = |node, from, to| StackEntry::Node { node, from, to };
    match inner.cut.stab(ray) {
        Stab::Beside(Side::Minus) => open.push(child(minus, from, to)),
        Stab::Beside(Side::Plus) => open.push(child(plus, from, to)),
        Stab::Beside(Side::On) => {
            open.extend([child(plus, from, to), child(minus, from, to)]);
            let far = Far::No;
            open.push(StackEntry::Cut { node, from, far });
        }
        Stab::Through { depth, rising } => {
            let beyond = usize::from(rising);
            let (near, far) = if rising { (minus, plus) } else { (plus, minus) };
            let (low, high) = (depth.low(), depth.high());
            if low <= to {
                open.push(child(far, from.max(low), to));
            }
            if low <= to && high >= from {
                let (from, far) = (from.max(low), Far::Child(beyond));
                open.push(StackEntry::Cut { node, from, far });
            }
            if high >= from {
                open.push(child(near, from, to.min(high)));
            }
        }
    }
}
