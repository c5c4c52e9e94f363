//! The augmented tree: it starts as one preliminary leaf and divides where rays go.
//!
//! Each inner node stores its cut H(v) and the facets in it, S(v); a preliminary leaf stores its
//! list L(v) as a heap by hits, and its visits T(v). A leaf visited more than a threshold is divided
//! at the hyperplane of its most hit fragment; the others are split exactly. Which facets a leaf
//! lists decides how long an answer takes, never what it is: facets are tested whole, and whatever
//! may be nearer than the best is visited.

use smallvec::SmallVec;

use super::cast::Cast;
use super::cut::Cut;
use super::heap::{Entry, Heap};
use super::node::{Content, Growth, Inner, Node};
use super::trace::{StabEvent, Trace};
use super::walk::Walk;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::Split;
use crate::interrupt::poll;
use crate::query::ray::first::{Found, Query};
use crate::query::ray::walk::clip;
use crate::query::ray::{Ray, Scene};
use crate::tree::trace::Watcher;

/// A tree of supporting hyperplanes over the facets of a scene.
#[derive(Debug)]
pub struct StabTree<S: Cast<D>, const D: usize> {
    scene: Scene<D>,
    pub(super) nodes: Vec<Node<S, D>>,
    growth: Growth,
    subdivisions: u64,
    pub(super) rays: u64,
}

/// The size and the past of a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Shape {
    /// Inner nodes and leaves.
    pub nodes: u64,
    /// Leaves.
    pub leaves: u64,
    /// The most cuts above a leaf.
    pub depth: u64,
    /// Fragments in leaves and cuts.
    pub fragments: u64,
    /// Leaves divided so far.
    pub subdivisions: u64,
    /// Rays tested so far.
    pub rays: u64,
    /// Visits of all nodes that are now in the tree.
    pub visits: u64,
}

impl<S: Cast<D>, const D: usize> StabTree<S, D> {
    /// One leaf with all facets; `hits` are the counters to begin with, by place in the input.
    ///
    /// # Errors
    /// `TooLarge` for facets beyond the reach of the space.
    pub fn new(scene: Scene<D>, growth: Growth, hits: Option<&[u64]>) -> Result<Self> {
        let mut list = Heap::default();
        for (facet, corners) in scene.facets().iter().enumerate() {
            poll();
            let facet = facet as u32;
            let number = scene.number(facet) as usize;
            list.push(Entry {
                facet,
                hits: hits.and_then(|h| h.get(number)).copied().unwrap_or(0),
                fragment: S::fragment(&corners.map(|c| c.map(|x| x as i64)))?,
            });
        }
        Ok(Self {
            scene,
            nodes: vec![Node::leaf(list, 0)],
            growth,
            subdivisions: 0,
            rays: 0,
        })
    }

    /// The facets.
    pub fn scene(&self) -> &Scene<D> {
        &self.scene
    }

    /// Divides leaves until none has more than one fragment.
    ///
    /// # Errors
    /// `TooLarge` if that takes more than `limit` nodes.
    pub fn complete(&mut self, limit: usize) -> Result<()> {
        let mut next = 0;
        while next < self.nodes.len() {
            poll();
            if self.nodes.len() > limit {
                let text = format!(
                    "the tree has more than {limit} nodes; allow more, or let rays grow a tree"
                );
                return Err(Error::new(ErrorKind::TooLarge, text));
            }
            self.divide(next);
            next += 1;
        }
        Ok(())
    }

    /// The first facet on a ray; counts visits and hits, and divides the leaves that are due.
    pub fn test_ray(&mut self, ray: &Ray<D>) -> (Option<Found<D>>, Trace) {
        self.test_ray_watched(ray, &mut ())
    }

    /// Tests a ray as [`Self::test_ray`] does, and tells of visits, tests, counts and divisions.
    pub fn test_ray_watched(
        &mut self,
        ray: &Ray<D>,
        watcher: &mut impl Watcher<StabEvent>,
    ) -> (Option<Found<D>>, Trace) {
        self.rays += 1;
        let mut trace = Trace::default();
        let mut due: SmallVec<[u32; 16]> = SmallVec::new();
        let found = {
            let query = Query::new(&self.scene, ray);
            let mut walk = Walk {
                scene: &self.scene,
                query: &query,
                ray,
                nodes: &mut self.nodes,
                growth: self.growth,
                best: None,
                trace: &mut trace,
                due: &mut due,
                watcher,
            };
            walk.run(clip(ray, self.scene.cell()));
            walk.best.and_then(|best| query.found(&best))
        };
        for leaf in due {
            self.divide(leaf as usize);
            watcher.tell(|| self.division(leaf));
        }
        (found, trace)
    }

    /// Divides a leaf at its most hit fragment; one with a single fragment stays.
    fn divide(&mut self, at: usize) {
        let Content::Leaf(list) = &self.nodes[at].content else {
            return;
        };
        if let [top, _, ..] = list.entries() {
            self.divide_by(at, top.facet);
        }
    }

    /// The event of a leaf that was divided last.
    fn division(&self, node: u32) -> StabEvent {
        let number = |facet: &u32| self.scene.number(*facet);
        let list = |child: u32| match &self.nodes[child as usize].content {
            Content::Leaf(list) => list.entries().iter().map(|e| number(&e.facet)).collect(),
            Content::Inner(_) => Vec::new(),
        };
        let (coplanar, children) = match &self.nodes[node as usize].content {
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

    /// Divides a leaf at the fragment of this facet; `None` if there is no such leaf or fragment.
    pub(super) fn divide_by(&mut self, at: usize, facet: u32) -> Option<()> {
        let (first, depth) = (self.nodes.len() as u32, self.nodes.get(at)?.depth + 1);
        let Content::Leaf(list) = &mut self.nodes[at].content else {
            return None;
        };
        let place = list.entries().iter().position(|e| e.facet == facet)?;
        let mut entries = std::mem::take(list).into_entries();
        let pivot = entries.remove(place);
        let (inner, halves) = parts::<S, D>(&pivot, entries, &self.scene, first);
        self.nodes[at].content = Content::Inner(Box::new(inner));
        self.nodes
            .extend(halves.map(|half| Node::leaf(half, depth)));
        self.subdivisions += 1;
        Some(())
    }

    /// Counts what is there.
    pub fn shape(&self) -> Shape {
        let mut shape = Shape {
            nodes: self.nodes.len() as u64,
            subdivisions: self.subdivisions,
            rays: self.rays,
            ..Shape::default()
        };
        for node in &self.nodes {
            shape.depth = shape.depth.max(u64::from(node.depth));
            shape.visits += node.visits;
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

/// The node that divides a list, and the lists of its children, the first to be at `first`.
fn parts<S: Cast<D>, const D: usize>(
    pivot: &Entry<S::Fragment>,
    rest: Vec<Entry<S::Fragment>>,
    scene: &Scene<D>,
    first: u32,
) -> (Inner<D>, [Heap<S::Fragment>; 2]) {
    let plane = S::hyperplane(&pivot.fragment).clone();
    let mut coplanar = vec![pivot.facet];
    let corners = scene.facets()[pivot.facet as usize].map(|c| c.map(|x| x as i64));
    let [mut below, mut above] = [Heap::default(), Heap::default()];
    let mut touched = [false; 2];
    for entry in rest {
        let part = |fragment| Entry { fragment, ..entry };
        match S::split(&entry.fragment, &plane) {
            Split::Minus => {
                touched[0] |= S::touches(&entry.fragment, &plane, &corners);
                below.push(entry);
            }
            Split::Plus => {
                touched[1] |= S::touches(&entry.fragment, &plane, &corners);
                above.push(entry);
            }
            Split::Coplanar(_) => coplanar.push(entry.facet),
            // What crosses the cut is met on both sides of it.
            Split::Both { minus, plus } => {
                below.push(part(minus));
                above.push(part(plus));
            }
        }
    }
    let cut = Cut::of::<S>(&plane);
    let children = [first, first + 1];
    let inner = Inner {
        cut,
        coplanar,
        children,
        touched,
    };
    (inner, [below, above])
}
