//! The tree that counts: visits of nodes, hits of facets, and divisions where rays go.

use bspcsg::error::Result;
use bspcsg::geometry::spaces::affine::Polytope;
use bspcsg::geometry::spaces::dim2::{Dim2, Segment2};
use bspcsg::geometry::spaces::space::Space;
use bspcsg::mesh::grid::Pitch;
use bspcsg::query::ray::answer::hit;
use bspcsg::query::ray::{Ray, Scene};
use bspcsg::query::stab::node::Growth;
use bspcsg::query::stab::tree::StabTree;
use bspcsg::query::stab::Cast;
use serde::Serialize;
use serde_json::Value;

use crate::scene::{corners, room_of, walls, Walls};
use crate::units::{snapped, PITCH};

/// Nodes at which a complete tree is given up.
const MOST_NODES: usize = 1 << 14;

/// A self-organising tree over segments.
pub struct Growing {
    segments: Vec<Segment2>,
    whole: Polytope<Dim2>,
    tree: StabTree<Dim2, 2>,
}

/// A node as the page draws it.
#[derive(Serialize)]
pub struct NodeView {
    /// T(v).
    visits: u64,
    depth: u32,
    region: Walls,
    /// L(v) or S(v) with T(p); counters of facets in cuts are zero.
    facets: Vec<[u64; 2]>,
    /// The children of a node with a cut, minus first.
    children: Option<[usize; 2]>,
    span: Vec<[f64; 3]>,
}

/// The first facet that a ray met, and its cost.
#[derive(Serialize)]
pub struct Shot {
    facet: Option<u32>,
    point: Option<[f64; 2]>,
    nodes: u32,
    leaves: u32,
    tests: u32,
}

impl Growing {
    /// One leaf with all segments, divided after more than `threshold` visits; complete from the
    /// start, in the order of the hits given, without one.
    pub fn new(flat: &[f64], room: &[f64], threshold: Option<u64>, hits: &[u64]) -> Result<Self> {
        let facets: Vec<[[f64; 2]; 2]> = flat
            .chunks_exact(4)
            .map(|s| [[s[0], s[1]], [s[2], s[3]]])
            .collect();
        let segments = facets
            .iter()
            .map(|ends| <Dim2 as Cast<2>>::fragment(&ends.map(|p| p.map(snapped))));
        let segments = segments.collect::<Result<Vec<_>>>()?;
        let scene = Scene::new(&facets, Some(Pitch::new(PITCH)?))?;
        let growth = threshold.map_or(Growth::Never, Growth::Visits);
        let mut tree = StabTree::new(scene, growth, (!hits.is_empty()).then_some(hits))?;
        if threshold.is_none() {
            tree.complete(MOST_NODES)?;
        }
        Ok(Self {
            segments,
            whole: room_of(room)?,
            tree,
        })
    }

    /// Tests a ray, counts, and divides what is due.
    pub fn shoot(&mut self, from: [f64; 2], towards: [f64; 2]) -> Result<Shot> {
        let ray = Ray::new(from.map(snapped), &towards)?;
        let (found, trace) = self.tree.test_ray(&ray);
        let hit = found.map(|f| hit(self.tree.scene(), &ray, &f));
        Ok(Shot {
            facet: hit.as_ref().map(|h| h.number),
            point: hit.as_ref().map(|h| h.point),
            nodes: trace.nodes,
            leaves: trace.leaves,
            tests: trace.tests,
        })
    }

    /// All nodes in the order in which they were made.
    pub fn view(&self) -> Vec<NodeView> {
        let record = serde_json::to_value(self.tree.record()).unwrap_or_default();
        let nodes = record["nodes"].as_array().map_or(&[][..], Vec::as_slice);
        let mut regions: Vec<Option<(Polytope<Dim2>, u32)>> = vec![None; nodes.len()];
        if let Some(root) = regions.first_mut() {
            *root = Some((self.whole.clone(), 0));
        }
        let mut views = Vec::with_capacity(nodes.len());
        // Children are made after their parents.
        for (number, node) in nodes.iter().enumerate() {
            let place = regions[number].take();
            views.push(self.node_view(node, place, &mut regions));
        }
        views
    }

    fn node_view(
        &self,
        node: &Value,
        place: Option<(Polytope<Dim2>, u32)>,
        regions: &mut [Option<(Polytope<Dim2>, u32)>],
    ) -> NodeView {
        let (region, depth) = place.map_or((None, 0), |(r, d)| (Some(r), d));
        let mut view = NodeView {
            visits: node["visits"].as_u64().unwrap_or(0),
            depth,
            region: region.as_ref().map_or_else(Vec::new, walls),
            facets: Vec::new(),
            children: None,
            span: Vec::new(),
        };
        let number = |value: &Value| value.as_u64().unwrap_or(0);
        if let Some(list) = node["content"]["Leaf"].as_array() {
            let pair = |entry: &Value| [number(&entry[0]), number(&entry[1])];
            view.facets = list.iter().map(pair).collect();
        } else if let Some(facets) = node["content"]["Cut"][0].as_array() {
            view.facets = facets.iter().map(|f| [number(f), 0]).collect();
            let first = usize::try_from(number(&node["content"]["Cut"][1])).unwrap_or(0);
            view.children = Some([first, first + 1]);
            let pivot = usize::try_from(view.facets[0][0]).unwrap_or(0);
            let cut = Dim2::hyperplane(&self.segments[pivot]);
            if let Some(region) = region {
                view.span = region
                    .span(cut)
                    .as_ref()
                    .map_or_else(Vec::new, corners::<Dim2>);
                let halves = region.divided(cut);
                for (k, half) in halves.into_iter().enumerate() {
                    regions[first + k] = half.map(|half| (half, depth + 1));
                }
            }
        }
        view
    }
}
