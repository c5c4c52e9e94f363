//! The augmented tree: it starts as one preliminary leaf and divides where rays go.
//!
//! Each inner node stores its cut H(v) and the facets in it, S(v); a preliminary leaf stores its
//! list L(v) as a heap by hits, and its visits T(v). A leaf visited more than a threshold is divided
//! at the hyperplane of its most hit fragment; the others are split exactly. Which facets a leaf
//! lists decides how long an answer takes, never what it is: facets are tested whole, and whatever
//! may be nearer than the best is visited.

use smallvec::SmallVec;

use super::cast::Cast;
use super::cut::{Cut, Stab};
use super::heap::{Entry, Heap};
use super::trace::Trace;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::Split;
use crate::query::ray::filter::Probe;
use crate::query::ray::first::{Candidate, Found, Query};
use crate::query::ray::walk::clip;
use crate::query::ray::{Ray, Scene};

/// When leaves are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// After more visits than this.
    Visits(u64),
    /// Not by rays.
    Never,
}

/// A tree of supporting hyperplanes over the facets of a scene.
#[derive(Debug)]
pub struct StabTree<S: Cast<D>, const D: usize> {
    scene: Scene<D>,
    nodes: Vec<Node<S, D>>,
    growth: Growth,
    subdivisions: u64,
    rays: u64,
}

#[derive(Debug)]
struct Node<S: Cast<D>, const D: usize> {
    visits: u64,
    depth: u32,
    content: Content<S, D>,
}

#[derive(Debug)]
enum Content<S: Cast<D>, const D: usize> {
    Leaf(Heap<S::Fragment>),
    Inner(Box<Inner<D>>),
}

#[derive(Debug)]
struct Inner<const D: usize> {
    cut: Cut<D>,
    coplanar: Vec<u32>,
    children: [u32; 2],
    /// Whether a facet of each child may have a point in the interior of a facet in the cut.
    touched: [bool; 2],
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

impl<S: Cast<D>, const D: usize> StabTree<S, D> {
    /// One leaf with all facets; `hits` are the counters to begin with, by place in the input.
    ///
    /// # Errors
    /// `TooLarge` for facets beyond the reach of the space.
    pub fn new(scene: Scene<D>, growth: Growth, hits: Option<&[u64]>) -> Result<Self> {
        let mut list = Heap::default();
        for (facet, corners) in scene.facets().iter().enumerate() {
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
        self.rays += 1;
        let mut trace = Trace::default();
        let mut due: SmallVec<[u32; 16]> = SmallVec::new();
        let found = {
            let query = Query::new(&self.scene, ray);
            let mut walk = Walk {
                query: &query,
                ray,
                nodes: &mut self.nodes,
                growth: self.growth,
                best: None,
                trace: &mut trace,
                due: &mut due,
            };
            walk.run(clip(ray, self.scene.cell()));
            walk.best.and_then(|best| query.found(&best))
        };
        for leaf in due {
            self.divide(leaf as usize);
        }
        (found, trace)
    }

    /// Divides a leaf at its most hit fragment; one with a single fragment stays.
    fn divide(&mut self, at: usize) {
        let (first, depth) = (self.nodes.len() as u32, self.nodes[at].depth + 1);
        let Content::Leaf(list) = &mut self.nodes[at].content else {
            return;
        };
        if list.len() < 2 {
            return;
        }
        let Some((inner, halves)) = parts::<S, D>(std::mem::take(list), &self.scene, first) else {
            return;
        };
        self.nodes[at].content = Content::Inner(Box::new(inner));
        self.nodes
            .extend(halves.map(|half| Node::leaf(half, depth)));
        self.subdivisions += 1;
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
    list: Heap<S::Fragment>,
    scene: &Scene<D>,
    first: u32,
) -> Option<(Inner<D>, [Heap<S::Fragment>; 2])> {
    let (top, rest) = list.into_top_and_rest()?;
    let plane = S::hyperplane(&top.fragment).clone();
    let mut coplanar = vec![top.facet];
    let corners = scene.facets()[top.facet as usize].map(|c| c.map(|x| x as i64));
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
    Some((inner, [below, above]))
}

impl<S: Cast<D>, const D: usize> Node<S, D> {
    fn leaf(list: Heap<S::Fragment>, depth: u32) -> Self {
        let (visits, content) = (0, Content::Leaf(list));
        Self {
            visits,
            depth,
            content,
        }
    }
}

/// One ray on its way.
struct Walk<'a, S: Cast<D>, const D: usize> {
    query: &'a Query<'a, D>,
    ray: &'a Ray<D>,
    nodes: &'a mut [Node<S, D>],
    growth: Growth,
    best: Option<Candidate>,
    trace: &'a mut Trace,
    due: &'a mut SmallVec<[u32; 16]>,
}

impl<S: Cast<D>, const D: usize> Walk<'_, S, D> {
    fn run(&mut self, span: Option<(f64, f64)>) {
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
        self.nodes[node as usize].visits += 1;
        self.trace.nodes += 1;
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
            self.query.offer(&mut self.best, *facet);
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
            if depth.is_some_and(|d| d.low() <= to) {
                hit.push(place);
            }
        }
        if let Growth::Visits(threshold) = self.growth {
            // Ascending, because a count changes no later place.
            for place in hit {
                list.count_hit(place);
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
