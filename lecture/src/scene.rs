//! Facets, their partition tree, and all that the page draws of it.

use bspcsg::error::{Error, ErrorKind, Result};
use bspcsg::geometry::side::{Half, Side, Split};
use bspcsg::geometry::spaces::affine::{Affine, Polytope, Viewpoint};
use bspcsg::mesh::facets::{facets, Facet, Lenience};
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::handle::NodeId;
use bspcsg::query::path::{cast_ray, RayEvent, RayPath};
use bspcsg::query::ray::Ray;
use bspcsg::query::stab::Cast;
use bspcsg::tree::fragments::{
    back_to_front, build, measures, sides, FragmentTree, Node, NodeCut, Piece, Plan, Policy, Sample,
};
use serde::Serialize;

use crate::units::{lattice, on_page, snapped, PITCH};

/// A list of facets in the order in which they become pivots, and the tree of that order.
pub struct Scene<S: Affine> {
    facets: Vec<Facet>,
    whole: Polytope<S>,
    tree: FragmentTree<S>,
}

/// A part of a facet.
#[derive(Serialize)]
pub struct Part {
    facet: u32,
    corners: Vec<[f64; 3]>,
}

/// A region as the corners of its walls.
pub type Walls = Vec<Vec<[f64; 3]>>;

/// A node with what was in its region when it was divided.
#[derive(Serialize)]
pub struct NodeView {
    pivot: u32,
    hyperplane: [f64; 4],
    parent: Option<NodeId>,
    /// The side of the parent, −1 or 1; 0 for the root.
    side: i8,
    depth: u32,
    children: [Option<NodeId>; 2],
    /// The hyperplane inside the region.
    span: Vec<[f64; 3]>,
    /// The two parts of the region.
    halves: [Walls; 2],
    /// The region's share of the root's.
    share: f64,
    /// The parts that lay in the region, in the order of the pivots.
    list: Vec<Part>,
    /// The parts in the hyperplane.
    coplanar: Vec<Part>,
    /// The facets that the hyperplane cut.
    cut: Vec<u32>,
}

/// A tree as the page draws it.
#[derive(Serialize)]
pub struct View {
    whole: Walls,
    nodes: Vec<NodeView>,
    fragments: usize,
    cuts: usize,
    depth: u32,
    /// Σ over all nodes of the share of their regions: C(T) for points spread evenly.
    cost: f64,
}

/// The tree of a policy.
#[derive(Serialize)]
pub struct PolicyView {
    name: &'static str,
    fragments: usize,
    depth: u32,
    cost: f64,
    leaves: Vec<LeafView>,
    /// Pivots and the parts of their hyperplanes inside the regions.
    spans: Vec<(u32, Vec<[f64; 3]>)>,
}

#[derive(Serialize)]
struct LeafView {
    walls: Walls,
    depth: u32,
}

/// The trees that many random orders made of the same facets.
#[derive(Serialize)]
pub struct Orders {
    /// Fragments, order by order.
    fragments: Vec<usize>,
    /// For each facet and each other how often its hyperplane cut that, row by row.
    cuts: Vec<u32>,
}

impl<S: Affine> Scene<S> {
    /// The tree of facets in the order given; `room` holds the lowest and the highest corner.
    pub fn new(flat: &[f64], offsets: &[i64], room: &[f64]) -> Result<Self> {
        let corners = lattice(flat, S::DIM);
        let facets = facets(S::DIM, &corners, offsets, Lenience::default())?;
        let whole = room_of(room)?;
        let tree = build(pieces::<S>(&facets)?, plan(Policy::First))?;
        Ok(Self {
            facets,
            whole,
            tree,
        })
    }

    /// All nodes.
    pub fn view(&self) -> View {
        let nodes = self.node_views();
        View {
            whole: walls(&self.whole),
            fragments: self.tree.fragments().len(),
            cuts: self.tree.crossings().len(),
            depth: self
                .tree
                .nodes()
                .iter()
                .map(|n| n.depth + 1)
                .max()
                .unwrap_or(0),
            cost: nodes.iter().map(|n| n.share).sum(),
            nodes,
        }
    }

    fn node_views(&self) -> Vec<NodeView> {
        let sizes = measures(&self.tree, &self.whole);
        let room = self.whole.volume();
        let lists = self.lists();
        let each = self
            .tree
            .nodes()
            .iter()
            .zip(sizes)
            .zip(lists)
            .zip(NodeId::all());
        each.map(|(((node, size), list), number)| {
            self.node_view(node, number, size.volume / room, &list)
        })
        .collect()
    }

    fn node_view(&self, node: &Node<S>, number: NodeId, share: f64, list: &[Piece<S>]) -> NodeView {
        let region = self.tree.region(number, &self.whole);
        let cut = &node.hyperplane;
        let span = region.as_ref().and_then(|r| r.span(cut));
        let halves = region.map_or([None, None], |r| r.divided(cut));
        let range = node.coplanar.start as usize..node.coplanar.end as usize;
        let coplanar = &self.tree.fragments()[range];
        let crossed = self.tree.crossings().iter().filter(|c| c.node == number);
        NodeView {
            pivot: match node.cut {
                NodeCut::Pivot(piece) => self.facets[piece as usize].source,
                NodeCut::Axis { .. } | NodeCut::Own(_) => u32::MAX,
            },
            hyperplane: on_page_plane::<S>(cut),
            parent: node.parent.map(|(above, _)| above),
            side: node.parent.map_or(0, |(_, half)| sign(half)),
            depth: node.depth,
            children: [node.minus, node.plus],
            span: span.as_ref().map_or_else(Vec::new, corners::<S>),
            halves: halves.map(|half| half.as_ref().map_or_else(Vec::new, walls)),
            share,
            list: list.iter().map(|p| self.part(p)).collect(),
            coplanar: coplanar.iter().map(|f| self.part(&f.piece)).collect(),
            cut: crossed
                .map(|c| self.facets[c.piece as usize].source)
                .collect(),
        }
    }

    fn part(&self, piece: &Piece<S>) -> Part {
        Part {
            facet: self.facets[piece.number as usize].source,
            corners: corners::<S>(&piece.fragment),
        }
    }

    /// Return what lay in each node's region before it was divided.
    fn lists(&self) -> Vec<Vec<Piece<S>>> {
        let nodes = self.tree.nodes();
        let mut lists = vec![Vec::new(); nodes.len()];
        if let Some(first) = lists.first_mut() {
            *first = pieces::<S>(&self.facets).unwrap_or_default();
        }
        // In preorder a list is complete before its node's turn comes.
        for (number, node) in nodes.iter().enumerate() {
            for piece in lists[number].clone() {
                let [minus, plus] = parted(&piece, &node.hyperplane);
                for (part, child) in [(minus, node.minus), (plus, node.plus)] {
                    if let (Some(part), Some(child)) = (part, child) {
                        lists[child.index()].push(part);
                    }
                }
            }
        }
        lists
    }

    /// The nodes from the farthest to the nearest, and the side of each on which the eye is.
    pub fn order(&self, eye: [f64; 3]) -> (Vec<NodeId>, Vec<i8>) {
        let eye = Viewpoint::point(&eye, -PITCH);
        let sides = sides(&self.tree, &eye).into_iter().map(|side| match side {
            Side::Minus => -1,
            Side::On => 0,
            Side::Plus => 1,
        });
        (back_to_front(&self.tree, &eye), sides.collect())
    }

    /// Builds the tree of as many random orders.
    pub fn orders(&self, trials: u32, seed: u64) -> Result<Orders> {
        let count = self.facets.len();
        let mut found = Orders {
            fragments: Vec::new(),
            cuts: vec![0; count * count],
        };
        for trial in 0..u64::from(trials) {
            let policy = Policy::Random(seed.wrapping_add(trial));
            let tree = build(pieces::<S>(&self.facets)?, plan(policy))?;
            found.fragments.push(tree.fragments().len());
            for (cutter, cut) in pairs(&tree) {
                found.cuts[cutter * count + cut] += 1;
            }
        }
        Ok(found)
    }

    /// Return the number of the tree's fragments.
    pub fn fragments(&self) -> usize {
        self.tree.fragments().len()
    }

    /// The way of a ray, near side first.
    pub fn shoot<const D: usize>(
        &self,
        from: &[f64],
        towards: &[f64],
    ) -> Result<(RayPath, Vec<RayEvent>)>
    where
        S: Cast<D>,
    {
        let coordinate = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
        let origin = std::array::from_fn(|k| snapped(coordinate(from, k)));
        let ray = Ray::new(origin, &std::array::from_fn(|k| coordinate(towards, k)))?;
        let mut events = Vec::new();
        let path = cast_ray(
            &self.tree,
            &self.facets,
            Pitch::new(PITCH)?,
            &ray,
            &mut events,
        );
        Ok((path, events))
    }

    /// The trees of the policies, each over the facets in the order given.
    pub fn policies(&self, seed: u64) -> Result<Vec<PolicyView>> {
        let all = Sample(self.facets.len());
        let policies = [
            ("first", Policy::First),
            ("random", Policy::Random(seed)),
            ("least-splits", Policy::LeastSplits(all)),
            ("balanced", Policy::Balanced(all)),
            ("least-cost", Policy::LeastCost(all)),
        ];
        let made = policies.into_iter().map(|(name, policy)| {
            let plan = Plan::Policy {
                policy,
                top: None,
                region: Some(self.whole.clone()),
            };
            let tree = build(pieces::<S>(&self.facets)?, plan)?;
            Ok(self.policy_view(name, &tree))
        });
        made.collect()
    }

    fn policy_view(&self, name: &'static str, tree: &FragmentTree<S>) -> PolicyView {
        let room = self.whole.volume();
        let sizes = measures(tree, &self.whole);
        let mut view = PolicyView {
            name,
            fragments: tree.fragments().len(),
            depth: tree.nodes().iter().map(|n| n.depth + 1).max().unwrap_or(0),
            cost: sizes.iter().map(|size| size.volume / room).sum(),
            leaves: Vec::new(),
            spans: Vec::new(),
        };
        for (node, number) in tree.nodes().iter().zip(NodeId::all()) {
            let Some(region) = tree.region(number, &self.whole) else {
                continue;
            };
            if let (NodeCut::Pivot(pivot), Some(span)) = (node.cut, region.span(&node.hyperplane)) {
                view.spans.push((pivot, corners::<S>(&span)));
            }
            let halves = region.divided(&node.hyperplane);
            for (half, child) in halves.iter().zip([node.minus, node.plus]) {
                if let (Some(half), None) = (half, child) {
                    let walls = walls(half);
                    let depth = node.depth + 1;
                    view.leaves.push(LeafView { walls, depth });
                }
            }
        }
        view
    }

    /// The facets' corners, for what else is made of them.
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }
}

/// List who cut whom, each pair once, however many parts were cut.
fn pairs<S: Affine>(tree: &FragmentTree<S>) -> Vec<(usize, usize)> {
    let mut found: Vec<_> = tree
        .crossings()
        .iter()
        .filter_map(|crossing| match tree.nodes()[crossing.node.index()].cut {
            NodeCut::Pivot(cutter) => Some((cutter as usize, crossing.piece as usize)),
            NodeCut::Axis { .. } | NodeCut::Own(_) => None,
        })
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

fn plan<S: Affine>(policy: Policy) -> Plan<S> {
    Plan::Policy {
        policy,
        top: None,
        region: None,
    }
}

fn pieces<S: Affine>(facets: &[Facet]) -> Result<Vec<Piece<S>>> {
    let piece = |(facet, number): (&Facet, u32)| {
        let flat = || Error::new(ErrorKind::Degenerate, "a facet has no extent");
        let fragment = S::fragment(&facet.corners).ok_or_else(flat)?;
        Ok(Piece { fragment, number })
    };
    facets.iter().zip(0..).map(piece).collect()
}

fn parted<S: Affine>(piece: &Piece<S>, cut: &S::Hyperplane) -> [Option<Piece<S>>; 2] {
    let number = piece.number;
    let part = |fragment| Some(Piece { fragment, number });
    match S::split(&piece.fragment, cut) {
        Split::Minus => [Some(piece.clone()), None],
        Split::Plus => [None, Some(piece.clone())],
        Split::Both { minus, plus } => [part(minus), part(plus)],
        Split::Coplanar(_) => [None, None],
    }
}

fn sign(half: Half) -> i8 {
    match half {
        Half::Minus => -1,
        Half::Plus => 1,
    }
}

/// A fragment's corners on the page.
pub fn corners<S: Affine>(piece: &S::Fragment) -> Vec<[f64; 3]> {
    S::corners(piece).into_iter().map(on_page).collect()
}

/// A region's walls on the page.
pub fn walls<S: Affine>(region: &Polytope<S>) -> Walls {
    region.walls().iter().map(corners::<S>).collect()
}

/// Coefficients n, d of n·x + d = 0 on the page, n of length one.
pub fn on_page_plane<S: Affine>(cut: &S::Hyperplane) -> [f64; 4] {
    let [a, b, c, d] = S::approx(cut);
    let length = (a * a + b * b + c * c).sqrt();
    [
        a / length,
        b / length,
        c / length,
        on_page([d / length; 3])[0],
    ]
}

/// The region between the lowest and the highest corner of the room.
pub fn room_of<S: Affine>(room: &[f64]) -> Result<Polytope<S>> {
    let wrong = || Error::new(ErrorKind::Shape, "the room needs two corners, apart");
    let ends = lattice(room, S::DIM);
    let [low, high] = ends.as_slice() else {
        return Err(wrong());
    };
    Polytope::cuboid(low, high).ok_or_else(wrong)
}
