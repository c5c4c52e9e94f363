//! A ray through a tree that counts: near child, cut, far child.

use smallvec::SmallVec;

use super::cast::Cast;
use super::cut::Stab;
use super::heap::Entry;
use super::node::{Content, Growth, Inner, Node};
use super::trace::{StabEvent, Trace};
use crate::query::ray::filter::Probe;
use crate::query::ray::first::{Candidate, Query};
use crate::query::ray::{Ray, Scene};
use crate::tree::trace::Watcher;

#[derive(Clone, Copy)]
enum Open {
    Node { node: u32, from: f64, to: f64 },
    Cut { node: u32, from: f64, far: Far },
}

/// What lies below a cut on the stack.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Far {
    /// Something else.
    No,
    /// The child beyond the cut, of this number.
    Child(usize),
}

type Stack = SmallVec<[Open; 64]>;

/// One ray on its way.
pub(super) struct Walk<'a, S: Cast<D>, W, const D: usize> {
    pub(super) scene: &'a Scene<D>,
    pub(super) query: &'a Query<'a, D>,
    pub(super) ray: &'a Ray<D>,
    pub(super) nodes: &'a mut [Node<S, D>],
    pub(super) growth: Growth,
    pub(super) best: Option<Candidate>,
    pub(super) trace: &'a mut Trace,
    pub(super) due: &'a mut SmallVec<[u32; 16]>,
    pub(super) watcher: &'a mut W,
}

impl<S: Cast<D>, W: Watcher<StabEvent>, const D: usize> Walk<'_, S, W, D> {
    /// Visits what the ray meets between two depths, nearest first.
    pub(super) fn run(&mut self, span: Option<(f64, f64)>) {
        let mut open = Stack::new();
        open.extend(span.map(|(from, to)| Open::Node { node: 0, from, to }));
        while let Some(next) = open.pop() {
            let limit = self.best.map_or(f64::INFINITY, |best| best.high());
            match next {
                Open::Node { node, from, to } if from <= limit => {
                    self.visit(node, (from, to), &mut open);
                }
                Open::Cut { node, from, far } if from <= limit && self.test_cut(node, far) => {
                    open.pop();
                }
                _ => {}
            }
        }
    }

    fn visit(&mut self, node: u32, span: (f64, f64), open: &mut Stack) {
        let visited = &mut self.nodes[node as usize];
        visited.visits += 1;
        self.trace.nodes += 1;
        self.watcher.tell(|| StabEvent::Visit {
            node,
            visits: visited.visits,
            leaf: matches!(visited.content, Content::Leaf(_)),
        });
        match &self.nodes[node as usize].content {
            Content::Leaf(_) => self.test_leaf(node, span.1),
            Content::Inner(inner) => push_parts(inner, self.ray, node, span, open),
        }
    }

    /// Tests the facets in a cut; whether what lies beyond the cut cannot matter any more.
    fn test_cut(&mut self, node: u32, far: Far) -> bool {
        let Content::Inner(inner) = &self.nodes[node as usize].content else {
            return false;
        };
        for facet in &inner.coplanar {
            self.trace.tests += 1;
            let met = self.query.offer(&mut self.best, *facet).is_some();
            self.watcher.tell(|| {
                let facet = self.scene.number(*facet);
                StabEvent::Test { node, facet, met }
            });
        }
        let Far::Child(child) = far else {
            return false;
        };
        // A hit in the interior of the only facet, with nothing beyond that touches it there.
        let inside = |facet| matches!(self.query.probe(facet), Probe::Hit(_));
        !inner.touched[child] && inner.coplanar.len() == 1 && inside(inner.coplanar[0])
    }

    /// Tests all of L(v); hits within the leaf count for its heap.
    fn test_leaf(&mut self, node: u32, to: f64) {
        self.trace.leaves += 1;
        let visits = self.nodes[node as usize].visits;
        let Content::Leaf(list) = &mut self.nodes[node as usize].content else {
            return;
        };
        let mut hit: SmallVec<[usize; 16]> = SmallVec::new();
        for (place, entry) in list.entries().iter().enumerate() {
            self.trace.tests += 1;
            let depth = self.query.offer(&mut self.best, entry.facet);
            let (facet, met) = (entry.facet, depth.is_some());
            self.watcher.tell(|| {
                let facet = self.scene.number(facet);
                StabEvent::Test { node, facet, met }
            });
            if depth.is_some_and(|d| d.low() <= to) {
                hit.push(place);
            }
        }
        if let Growth::Visits(threshold) = self.growth {
            // Ascending, because a count changes no later place.
            for place in hit {
                let Entry { facet, hits, .. } = list.entries()[place];
                list.count_hit(place);
                self.watcher.tell(|| StabEvent::Count {
                    node,
                    facet: self.scene.number(facet),
                    hits: hits + 1,
                });
            }
            if visits > threshold && list.len() > 1 {
                self.due.push(node);
            }
        }
    }
}

/// Puts the parts of an inner node that the ray meets on the stack, the nearest on top.
#[inline]
fn push_parts<const D: usize>(
    inner: &Inner<D>,
    ray: &Ray<D>,
    node: u32,
    (from, to): (f64, f64),
    open: &mut Stack,
) {
    let [minus, plus] = inner.children;
    let child = |node, from, to| Open::Node { node, from, to };
    match inner.cut.stab(ray) {
        Stab::Beside(-1) => open.push(child(minus, from, to)),
        Stab::Beside(1) => open.push(child(plus, from, to)),
        Stab::Beside(_) => {
            open.extend([child(plus, from, to), child(minus, from, to)]);
            let far = Far::No;
            open.push(Open::Cut { node, from, far });
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
                open.push(Open::Cut { node, from, far });
            }
            if high >= from {
                open.push(child(near, from, to.min(high)));
            }
        }
    }
}
