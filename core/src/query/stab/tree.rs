//! The augmented tree: it starts as one leaf, and its leaves are divided where rays go.
//!
//! Each inner node stores its cut H(v) and the facets in it, S(v); a leaf stores its list L(v) as a heap by
//! hits, and its visits T(v). A leaf visited more often than a threshold is divided at the hyperplane of its
//! most hit fragment, which splits the other fragments exactly. The lists of leaves affect the time of an
//! answer, never the answer: facets are tested whole, and every node that may contain a nearer hit is
//! visited.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use super::cast::Cast;
use super::cut::Cut;
use super::heap::{Entry, Heap};
use super::node::{Content, Growth, Inner, Node, Nodes};
use super::trace::{StabEvent, Trace};
use super::walk::{PendingUpdates, Walk};
use crate::arith::Filtered;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::{Half, Split};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;
use crate::query::ray::facet::Facet;
use crate::query::ray::first::{Found, Query};
use crate::query::ray::walk::clip;
use crate::query::ray::{Ray, Scene};
use crate::tree::trace::Watcher;

/// A tree of supporting hyperplanes over the facets of a scene, which counts rays and grows with them.
#[derive(Debug)]
pub struct StabTree<S: Cast<D>, const D: usize> {
    scene: Scene<D>,
    /// Rays read the nodes concurrently, and change them afterwards.
    nodes: RwLock<Nodes<S, D>>,
    growth: Growth,
    pub(super) rays: AtomicU64,
}

/// The size and the counters of a stab tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// The number of inner nodes and leaves.
    pub nodes: u64,
    /// The number of leaves.
    pub leaves: u64,
    /// The largest number of cuts above a leaf.
    pub depth: u64,
    /// The number of fragments in leaves and cuts.
    pub fragments: u64,
    /// The number of leaves divided since the tree was made.
    pub subdivisions: u64,
    /// The number of rays tested since the tree was made.
    pub rays: u64,
    /// The sum of the visits of all nodes.
    pub visits: u64,
}

impl<S: Cast<D>, const D: usize> StabTree<S, D> {
    /// Makes a tree of one leaf with all facets; `hits` are the initial counters, by index in the input.
    ///
    /// # Errors
    /// `TooLarge` for facets beyond the reach of the space.
    pub fn new(scene: Scene<D>, growth: Growth, hits: Option<&[u64]>) -> Result<Self> {
        let mut list = Heap::default();
        for (facet, corners) in (0..).zip(scene.facets()) {
            poll();
            let beyond = |c: &f64| c.abs() > S::MAX_COORDINATE as f64;
            if corners.iter().flatten().any(beyond) {
                // Returns the error that explains the refusal.
                S::fragment(&lattice(corners))?;
            }
            let number = scene.number(facet) as usize;
            let hits = hits.and_then(|h| h.get(number)).copied().unwrap_or(0);
            list.push(Entry {
                facet,
                hits,
                fragment: None,
            });
        }
        let nodes = Nodes {
            all: vec![Node::leaf(list, 0)],
            subdivisions: 0,
        };
        Ok(Self {
            scene,
            nodes: RwLock::new(nodes),
            growth,
            rays: AtomicU64::new(0),
        })
    }

    /// The scene whose facets the tree divides.
    pub fn scene(&self) -> &Scene<D> {
        &self.scene
    }

    /// Locks the nodes for reading.
    pub(super) fn nodes(&self) -> RwLockReadGuard<'_, Nodes<S, D>> {
        self.nodes.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Locks the nodes for writing.
    pub(super) fn nodes_mut(&self) -> RwLockWriteGuard<'_, Nodes<S, D>> {
        self.nodes.write().unwrap_or_else(PoisonError::into_inner)
    }

    /// Divides leaves until each has at most one fragment.
    ///
    /// # Errors
    /// `TooLarge` if that takes more than `limit` nodes.
    pub fn complete(&mut self, limit: usize) -> Result<()> {
        let mut nodes = self.nodes_mut();
        let mut next = 0;
        while next < nodes.all.len() {
            poll();
            if nodes.all.len() > limit {
                let text = format!(
                    "the tree has more than {limit} nodes; raise max_nodes, or let rays grow the tree"
                );
                return Err(Error::new(ErrorKind::TooLarge, text));
            }
            nodes.divide(&self.scene, NodeId::of(next));
            next += 1;
        }
        Ok(())
    }

    /// Finds the first facet on a ray; counts visits and hits, and divides the leaves that reached the
    /// threshold.
    ///
    /// Several threads may test rays at the same time.
    pub fn test_ray(&self, ray: &Ray<D>) -> (Option<Found<D>>, Trace) {
        self.test_ray_watched(ray, &mut ())
    }

    /// Tests a ray as [`Self::test_ray`] does; reports visits, tests, counts and divisions.
    pub fn test_ray_watched(
        &self,
        ray: &Ray<D>,
        watcher: &mut impl Watcher<StabEvent>,
    ) -> (Option<Found<D>>, Trace) {
        self.rays.fetch_add(1, Ordering::Relaxed);
        let query = Query::new(&self.scene, ray);
        let nodes = self.nodes();
        let mut walk = Walk {
            scene: &self.scene,
            query: &query,
            ray,
            nodes: &nodes.all,
            growth: self.growth,
            best: None,
            met: None,
            trace: Trace::default(),
            pending: PendingUpdates::default(),
            watcher,
        };
        walk.run(clip(ray, self.scene.cell()));
        let (best, trace, pending) = (walk.best, walk.trace, walk.pending);
        drop(nodes);
        self.apply_updates(&pending, watcher);
        (best.and_then(|best| query.found(&best)), trace)
    }

    /// Counts the hits of a ray, and divides the leaves that reached the threshold.
    fn apply_updates(&self, pending: &PendingUpdates, watcher: &mut impl Watcher<StabEvent>) {
        if pending.hits.is_empty() && pending.due.is_empty() {
            return;
        }
        let mut nodes = self.nodes_mut();
        // The hits are ascending in each leaf, because counting one changes no later index.
        for hit in &pending.hits {
            // Another ray may have divided the leaf in the meantime.
            let Content::Leaf(list) = &mut nodes.all[hit.node.index()].content else {
                continue;
            };
            if let Some(place) = list.place(hit.facet, hit.place) {
                list.count_hit(place);
            }
        }
        for leaf in &pending.due {
            if nodes.divide(&self.scene, *leaf).is_some() {
                watcher.notify(|| nodes.division(&self.scene, *leaf));
            }
        }
    }

    /// Counts the nodes, fragments, rays and visits of the tree.
    pub fn shape(&self) -> Shape {
        let nodes = self.nodes();
        let mut shape = Shape {
            nodes: nodes.all.len() as u64,
            subdivisions: nodes.subdivisions,
            rays: self.rays.load(Ordering::Relaxed),
            ..Shape::default()
        };
        for node in &nodes.all {
            shape.depth = shape.depth.max(u64::from(node.depth));
            shape.visits += node.visits.load(Ordering::Relaxed);
            match &node.content {
                Content::Leaf(list) => {
                    shape.leaves += 1;
                    shape.fragments += list.len() as u64;
                }
                Content::Inner(inner) => shape.fragments += inner.coplanar.len() as u64,
            }
        }
        shape
    }
}

impl<S: Cast<D>, const D: usize> Nodes<S, D> {
    /// Divides a leaf at its most hit fragment; `None` if it has at most one fragment.
    fn divide(&mut self, scene: &Scene<D>, at: NodeId) -> Option<()> {
        let Content::Leaf(list) = &self.all[at.index()].content else {
            return None;
        };
        let [top, _, ..] = list.entries() else {
            return None;
        };
        let facet = top.facet;
        self.divide_by(scene, at, facet)
    }

    /// Divides a leaf at the fragment of a given facet; `None` if there is no such leaf or fragment.
    pub(super) fn divide_by(&mut self, scene: &Scene<D>, at: NodeId, facet: u32) -> Option<()> {
        let (first, depth) = (self.all.len(), self.all.get(at.index())?.depth + 1);
        let Content::Leaf(list) = &mut self.all[at.index()].content else {
            return None;
        };
        let place = list.entries().iter().position(|e| e.facet == facet)?;
        let pivot = fragment::<S, D>(scene, &list.entries()[place])?;
        let children = [first, first + 1].map(NodeId::of);
        let mut entries = std::mem::take(list).into_entries();
        entries.remove(place);
        let (inner, halves) = parts::<S, D>(facet, &pivot, entries, scene, children);
        self.all[at.index()].content = Content::Inner(Box::new(inner));
        self.all[at.index()].forget_places();
        self.all.extend(halves.map(|half| Node::leaf(half, depth)));
        self.subdivisions += 1;
        Some(())
    }

    /// Returns the event that describes the division of a node.
    fn division(&self, scene: &Scene<D>, node: NodeId) -> StabEvent {
        let number = |facet: &u32| scene.number(*facet);
        let list = |child: NodeId| match &self.all[child.index()].content {
            Content::Leaf(list) => list.entries().iter().map(|e| number(&e.facet)).collect(),
            Content::Inner(_) => Vec::new(),
        };
        let (coplanar, children) = match &self.all[node.index()].content {
            Content::Inner(inner) => (inner.coplanar.iter().map(number).collect(), inner.children),
            Content::Leaf(_) => (Vec::new(), [node; 2]),
        };
        StabEvent::Divide {
            node,
            facet: coplanar.first().copied().unwrap_or(u32::MAX),
            coplanar,
            children,
            lists: children.map(list),
        }
    }
}

fn lattice<const D: usize>(corners: &Facet<D>) -> [[i64; D]; D] {
    corners.map(|corner| corner.map(|c| c as i64))
}

/// Returns the fragment of an entry; makes it if the entry is a whole facet.
fn fragment<S: Cast<D>, const D: usize>(
    scene: &Scene<D>,
    entry: &Entry<S::Fragment>,
) -> Option<S::Fragment> {
    match &entry.fragment {
        Some(part) => Some((**part).clone()),
        None => S::fragment(&lattice(&scene.facets()[entry.facet as usize])).ok(),
    }
}

/// Divides a list at a pivot: returns the inner node, and the lists of its `children`.
fn parts<S: Cast<D>, const D: usize>(
    facet: u32,
    pivot: &S::Fragment,
    rest: Vec<Entry<S::Fragment>>,
    scene: &Scene<D>,
    children: [NodeId; 2],
) -> (Inner<D>, [Heap<S::Fragment>; 2]) {
    let plane = S::hyperplane(pivot).clone();
    let cut = Cut::of::<S>(&plane);
    let mut coplanar = vec![facet];
    let corners = lattice(&scene.facets()[facet as usize]);
    let [mut below, mut above] = [Heap::default(), Heap::default()];
    let mut touched = [false; 2];
    for entry in rest {
        // Most facets lie clearly on one side.
        match cut.half(&scene.facets()[entry.facet as usize]) {
            Filtered::Certain(Half::Minus) => {
                below.push(entry);
                continue;
            }
            Filtered::Certain(Half::Plus) => {
                above.push(entry);
                continue;
            }
            _ => {}
        }
        let Some(whole) = fragment::<S, D>(scene, &entry) else {
            continue;
        };
        let Entry { facet, hits, .. } = entry;
        let part = |fragment| Entry {
            facet,
            hits,
            fragment: Some(Box::new(fragment)),
        };
        match S::split(&whole, &plane) {
            Split::Minus => {
                touched[0] |= S::touches(&whole, &plane, &corners);
                below.push(entry);
            }
            Split::Plus => {
                touched[1] |= S::touches(&whole, &plane, &corners);
                above.push(entry);
            }
            Split::Coplanar(_) => coplanar.push(facet),
            // A facet that crosses the cut goes to both sides.
            Split::Both { minus, plus } => {
                below.push(part(minus));
                above.push(part(plus));
            }
        }
    }

    let inner = Inner {
        cut,
        coplanar,
        children,
        touched,
    };
    (inner, [below, above])
}
