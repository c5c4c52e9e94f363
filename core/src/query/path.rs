//! The paths of a point and of a ray through a tree of fragments, exact and step by step.
//!
//! A ray visits the child on its origin's side first, then the facets in the cut, then the other child, and
//! stops at the first hit. All depths are exact fractions. A ray also visits children that it only touches in
//! a point, so that such cases need no separate code.
//!
//! # Source
//! Lecture notes on BSP trees, "Ray casting" and "Distribution optimized BSP"; Havran, Kopal,
//! Bittner, Žára 1997 for the order of children.

use serde::{Deserialize, Serialize};

use crate::arith::Int;
use crate::geometry::side::{Half, Side};
use crate::geometry::spaces::affine::{Affine, Viewpoint};
use crate::interrupt::poll;
use crate::mesh::facets::Facet;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::NodeId;
use crate::query::ray::facet::meet;
use crate::query::ray::scene::parameter;
use crate::query::ray::{Ratio, Ray};
use crate::query::stab::Cast;
use crate::tree::fragments::FragmentTree;
use crate::tree::trace::Watcher;

/// A node that a point passes on its path from the root to its leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointStep {
    /// The number of the node.
    pub node: NodeId,
    /// The side of the node's hyperplane on which the point lies.
    pub side: Side,
}

/// Returns the nodes that a point passes, down to its leaf or to the first hyperplane that contains it.
pub fn locate<S: Affine>(tree: &FragmentTree<S>, point: &Viewpoint) -> Vec<PointStep> {
    let mut steps = Vec::new();
    let mut next = (!tree.nodes().is_empty()).then_some(NodeId::ROOT);
    while let Some(number) = next {
        poll();
        let node = &tree.nodes()[number.index()];
        let side = point.side::<S>(&node.hyperplane);
        steps.push(PointStep { node: number, side });
        next = match side {
            Side::Minus => node.minus,
            Side::Plus => node.plus,
            Side::On => None,
        };
    }
    steps
}

/// An event on a ray's path through a tree; parameters are in model units per length of the direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum RayEvent {
    /// The ray visits an inner node.
    Visit {
        /// The number of the node.
        node: NodeId,
        /// The parameter at which the ray enters the node's region.
        from: f64,
        /// The parameter at which the ray leaves the region; `None` if it never does.
        to: Option<f64>,
        /// The side of the node's hyperplane on which the ray starts, where the near child is.
        near: Side,
        /// The parameter at which the ray's line crosses the hyperplane; `None` if it is parallel.
        at: Option<f64>,
    },
    /// The ray is tested against a piece of a facet in the hyperplane of a node.
    Test {
        /// The number of the node.
        node: NodeId,
        /// The number of the piece of a facet.
        piece: u32,
        /// The parameter at which the ray meets the piece of a facet; `None` if it does not.
        at: Option<f64>,
    },
    /// The ray enters a leaf, which is an empty region.
    Leaf {
        /// The node above the leaf and the side of the leaf; `None` for a tree without nodes.
        place: Option<(NodeId, Half)>,
        /// The parameter at which the ray enters the region.
        from: f64,
        /// The parameter at which the ray leaves the region; `None` if it never does.
        to: Option<f64>,
    },
}

/// The first facet that a ray meets in a tree, and the cost of finding it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RayPath {
    /// The number of the piece of a facet and the parameter, correctly rounded; `None` if the ray meets no
    /// piece.
    pub hit: Option<(u32, f64)>,
    /// The number of inner nodes visited.
    pub nodes: u64,
    /// The number of leaves visited.
    pub leaves: u64,
    /// The number of pieces of facets tested.
    pub tests: u64,
}

impl RayPath {
    /// Returns the number of inner nodes and leaves that the ray visited, the cost C(T) of the lecture
    /// notes.
    pub fn cost(&self) -> u64 {
        self.nodes + self.leaves
    }
}

/// Finds the first piece that a ray meets, and reports each step to `watcher`.
///
/// If the ray meets several pieces at one point, the result is the piece that the walk through the tree tests
/// first; within a node, the piece that is first in the input.
///
/// `facets` are the tree's facets, indexed by piece number.
pub fn cast_ray<S: Cast<D> + Affine, const D: usize>(
    tree: &FragmentTree<S>,
    facets: &[Facet],
    pitch: Pitch,
    ray: &Ray<D>,
    watcher: &mut impl Watcher<RayEvent>,
) -> RayPath {
    let mut walk = Walk {
        tree,
        facets,
        pitch,
        ray,
        best: None,
        path: RayPath {
            hit: None,
            nodes: 0,
            leaves: 0,
            tests: 0,
        },
        watcher,
    };
    walk.run();
    let mut path = walk.path;
    let best = walk.best;
    path.hit = best.map(|(piece, at)| (piece, parameter(pitch, &at, ray.exponent())));
    path
}

/// An interval of parameters on a ray, unbounded if it has no end.
#[derive(Clone, Copy)]
struct Stretch {
    from: Ratio,
    to: Option<Ratio>,
}

impl Stretch {
    fn before(&self, at: Ratio) -> Self {
        let to = Some(self.to.map_or(at, |to| to.min(at)));
        Self { to, ..*self }
    }

    fn after(&self, at: Ratio) -> Self {
        let from = self.from.max(at);
        Self { from, ..*self }
    }

    fn is_empty(&self) -> bool {
        self.to.is_some_and(|to| to < self.from)
    }
}

enum StackEntry {
    /// A child to visit, or an empty leaf, with the interval of the ray in it.
    Child(Option<NodeId>, Option<(NodeId, Half)>, Stretch),
    /// The facets in a node's hyperplane, to be tested.
    Cut(NodeId, Stretch),
}

impl StackEntry {
    fn stretch(&self) -> &Stretch {
        match self {
            Self::Child(_, _, stretch) | Self::Cut(_, stretch) => stretch,
        }
    }
}

struct Walk<'a, S: Affine, W, const D: usize> {
    tree: &'a FragmentTree<S>,
    facets: &'a [Facet],
    pitch: Pitch,
    ray: &'a Ray<D>,
    best: Option<(u32, Ratio)>,
    path: RayPath,
    watcher: &'a mut W,
}

impl<S: Cast<D> + Affine, W: Watcher<RayEvent>, const D: usize> Walk<'_, S, W, D> {
    fn run(&mut self) {
        let whole = Stretch {
            from: Ratio::ZERO,
            to: None,
        };
        let root = (!self.tree.nodes().is_empty()).then_some(NodeId::ROOT);
        let mut open = vec![StackEntry::Child(root, None, whole)];
        while let Some(next) = open.pop() {
            poll();
            let stretch = next.stretch();
            let late = self.best.is_some_and(|(_, at)| at <= stretch.from);
            if late || stretch.is_empty() {
                continue;
            }
            match next {
                StackEntry::Child(None, place, stretch) => self.stab(place, &stretch),
                StackEntry::Child(Some(node), _, stretch) => self.visit(node, stretch, &mut open),
                StackEntry::Cut(node, _) => self.test(node),
            }
        }
    }

    fn stab(&mut self, place: Option<(NodeId, Half)>, stretch: &Stretch) {
        self.path.leaves += 1;
        let (pitch, exponent) = (self.pitch, self.ray.exponent());
        self.watcher.notify(|| RayEvent::Leaf {
            place,
            from: parameter(pitch, &stretch.from, exponent),
            to: stretch.to.map(|to| parameter(pitch, &to, exponent)),
        });
    }

    fn visit(&mut self, number: NodeId, stretch: Stretch, open: &mut Vec<StackEntry>) {
        self.path.nodes += 1;
        let node = &self.tree.nodes()[number.index()];
        let crossing = Crossing::of::<S, D>(&node.hyperplane, self.ray);
        let (pitch, exponent) = (self.pitch, self.ray.exponent());
        let units = |at: Ratio| parameter(pitch, &at, exponent);
        self.watcher.notify(|| RayEvent::Visit {
            node: number,
            from: units(stretch.from),
            to: stretch.to.map(units),
            near: crossing.start,
            at: crossing.at.map(units),
        });
        let child = |half: Half, stretch| {
            let link = match half {
                Half::Minus => node.minus,
                Half::Plus => node.plus,
            };
            StackEntry::Child(link, Some((number, half)), stretch)
        };
        match (crossing.at, crossing.first) {
            (None, Some(half)) => open.push(child(half, stretch)),
            (None, None) => open.extend([
                child(Half::Plus, stretch),
                child(Half::Minus, stretch),
                StackEntry::Cut(number, stretch),
            ]),
            (Some(at), first) => {
                let first = first.unwrap_or(Half::Minus);
                let beyond = stretch.after(at);
                open.push(child(first.opposite(), beyond));
                if at >= stretch.from {
                    open.push(StackEntry::Cut(number, beyond));
                }
                open.push(child(first, stretch.before(at)));
            }
        }
    }

    fn test(&mut self, number: NodeId) {
        let node = &self.tree.nodes()[number.index()];
        let range = node.coplanar.start as usize..node.coplanar.end as usize;
        for fragment in &self.tree.fragments()[range] {
            let piece = fragment.piece.number;
            let at = meeting::<D>(&self.facets[piece as usize], self.ray);
            self.path.tests += 1;
            let (pitch, exponent) = (self.pitch, self.ray.exponent());
            self.watcher.notify(|| RayEvent::Test {
                node: number,
                piece,
                at: at.map(|at| parameter(pitch, &at, exponent)),
            });
            let Some(at) = at else {
                continue;
            };
            let better = |(kept, best): (u32, Ratio)| (at, piece) < (best, kept);
            if self.best.is_none_or(better) {
                self.best = Some((piece, at));
            }
        }
    }
}

/// The parameter at which a ray's line crosses a hyperplane, and the sides on which the ray and its line
/// start.
struct Crossing {
    /// The side of the hyperplane on which the ray starts.
    start: Side,
    /// The parameter at which the ray's line crosses the hyperplane; `None` if it is parallel.
    at: Option<Ratio>,
    /// The side that the ray's line comes from; `None` if it runs in the hyperplane.
    first: Option<Half>,
}

impl Crossing {
    fn of<S: Cast<D>, const D: usize>(cut: &S::Hyperplane, ray: &Ray<D>) -> Self {
        let (normal, offset) = S::coefficients(cut);
        let rise = |k: usize| Int::<2>::from_i128(normal[k]).mul_i128(ray.direction()[k]);
        let term = |k: usize| Int::<2>::from_i128(normal[k]).mul_i64(ray.origin()[k]);
        let slope: Int<4> = (0..D).fold(Int::ZERO, |sum, k| sum + rise(k));
        let value: Int<3> = (0..D).fold(offset, |sum, k| sum + term(k));
        let start = Side::from_sign(value.sign());
        let first = if slope.is_zero() {
            start
        } else {
            Side::from_sign(-slope.sign())
        };
        Self {
            start,
            at: (!slope.is_zero()).then(|| Ratio::new(-value, slope)),
            first: match first {
                Side::Minus => Some(Half::Minus),
                Side::Plus => Some(Half::Plus),
                Side::On => None,
            },
        }
    }
}

/// Returns the parameter at which a ray first meets a convex facet, taken as a fan of facets of `D` corners.
fn meeting<const D: usize>(facet: &Facet, ray: &Ray<D>) -> Option<Ratio> {
    let corner = |i: usize| -> [f64; D] { std::array::from_fn(|k| facet.corners[i][k] as f64) };
    let last = facet.corners.len();
    let parts = (D.max(1) - 1..last).map(|end| -> [[f64; D]; D] {
        std::array::from_fn(|i| match i {
            0 => corner(0),
            _ => corner(end + 1 + i - D),
        })
    });
    parts
        .filter_map(|part| meet(ray, &part))
        .map(|meeting| meeting.at)
        .min()
}
