//! Visits blocks along rays, nearest first.
//!
//! A bundle of rays descends as one beam; its rays are tested one by one only at blocks. The order of blocks
//! affects how early a walk ends, but not the hits.

use smallvec::SmallVec;

use super::block::Block;
use super::bundle::Bundle;
use super::cell::Cell;
use super::filter::ROUNDING;
use super::line::Ray;
use super::scene::Scene;
use super::treelet::{Child, Treelet, CHILDREN_PER_NODE};
use crate::mesh::handle::NodeId;

/// The relative error of the depth of a plane: a difference, a quotient of two rounded numbers and a
/// product.
const SLACK: f64 = 8.0 * ROUNDING;

/// A child of a node that is still to be visited, and the distance at which the beam enters its box.
#[derive(Clone, Copy)]
struct Open<'a, const D: usize> {
    from: f32,
    node: NodeId,
    lane: u32,
    treelet: &'a Treelet<D>,
}

/// The number of neighbouring rays that may descend together.
const RAYS_PER_BUNDLE: usize = 16;

/// The largest distance between rays that descend together, in mean extents of facets.
const MAX_BUNDLE_WIDTH: f64 = 8.0;

type Stack<'a, const D: usize> = SmallVec<[Open<'a, D>; 64]>;

/// Visits the blocks of facets that rays meet, the nearest of each ray first, until all other blocks of a ray
/// are farther than its limit.
///
/// `depth` gives the limit of a ray, in lattice steps along its main axis. `visit` gets the number of a ray
/// and a block, and returns the new limit.
pub fn walk<const D: usize>(
    scene: &Scene<D>,
    rays: &[Ray<D>],
    depth: impl Fn(usize) -> f64,
    mut visit: impl FnMut(usize, &Block<D>) -> f64,
) {
    let (frame, width) = (scene.frame(), scene.mean_facet_size() * MAX_BUNDLE_WIDTH);
    for (number, rays) in rays.chunks(RAYS_PER_BUNDLE).enumerate() {
        let first = number * RAYS_PER_BUNDLE;
        if rays.len() > 1 {
            let depth = |i| depth(first + i);
            if let Some(mut bundle) = Bundle::<D, RAYS_PER_BUNDLE>::of(rays, frame, width, depth) {
                descend(scene, &mut bundle, |i, block| visit(first + i, block));
                continue;
            }
        }
        for (i, ray) in rays.iter().enumerate() {
            let ray = std::slice::from_ref(ray);
            let depth = |_| depth(first + i);
            if let Some(mut alone) = Bundle::<D, 1>::of(ray, frame, width, depth) {
                descend(scene, &mut alone, |_, block| visit(first + i, block));
            }
        }
    }
}

/// Visits the blocks that one bundle of rays meets.
fn descend<const D: usize, const N: usize>(
    scene: &Scene<D>,
    bundle: &mut Bundle<D, N>,
    mut visit: impl FnMut(usize, &Block<D>) -> f64,
) {
    let mut open: Stack<'_, D> = SmallVec::new();
    let mut limit = bundle.limit();
    enter(
        bundle,
        scene.root().treelet(scene.facets()),
        NodeId::ROOT,
        limit,
        &mut open,
    );
    while let Some(Open {
        from,
        node,
        lane,
        treelet,
    }) = open.pop()
    {
        if from > limit {
            continue;
        }
        let wide = &treelet.nodes[node.index()];
        match wide.children[lane as usize] {
            Child::None => {}
            Child::Node(below) => enter(bundle, treelet, below, limit, &mut open),
            Child::Deferred(below) => {
                let below = treelet.deferred[below as usize].treelet(scene.facets());
                enter(bundle, below, NodeId::ROOT, limit, &mut open);
            }
            Child::Block(number) => {
                let block = &treelet.blocks[number as usize];
                if N == 1 {
                    let depth = visit(0, block);
                    bundle.set_limit(0, depth);
                } else {
                    let entering = bundle.entering(wide, lane as usize);
                    for (ray, enters) in entering.into_iter().enumerate() {
                        if enters {
                            let depth = visit(ray, block);
                            bundle.set_limit(ray, depth);
                        }
                    }
                }
                limit = bundle.limit();
            }
        }
    }
}

/// Pushes the children of a node that the beam enters, the nearest last.
#[inline]
fn enter<'a, const D: usize, const N: usize>(
    bundle: &Bundle<D, N>,
    treelet: &'a Treelet<D>,
    node: NodeId,
    limit: f32,
    open: &mut Stack<'a, D>,
) {
    let Some(wide) = treelet.nodes.get(node.index()) else {
        return;
    };
    let (from, enters) = bundle.enters(wide, limit);
    let base = open.len();
    for lane in 0..CHILDREN_PER_NODE {
        if !enters[lane] {
            continue;
        }
        let new = Open {
            from: from[lane],
            node,
            lane: lane as u32,
            treelet,
        };
        open.push(new);
        let mut at = open.len() - 1;
        while at > base && open[at - 1].from < new.from {
            open[at] = open[at - 1];
            at -= 1;
        }
        open[at] = new;
    }
}

/// Returns the depths between which a ray may be in a box; `None` if it misses the box.
pub fn clip<const D: usize>(ray: &Ray<D>, cell: &Cell<D>) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, f64::INFINITY);
    for k in 0..D {
        let gaps = [cell.low[k], cell.high[k]].map(|c| c - ray.near.origin[k]);
        let inverse = 1.0 / (ray.near.shear[k] * ray.near.heading);
        if inverse.is_infinite() {
            if gaps[0] > 0.0 || gaps[1] < 0.0 {
                return None;
            }
            continue;
        }
        let ends = gaps.map(|gap| gap * inverse);
        let slack = ends.map(|end| end.abs() * SLACK);
        let enter = (ends[0] - slack[0]).min(ends[1] - slack[1]);
        let leave = (ends[0] + slack[0]).max(ends[1] + slack[1]);
        (from, to) = (from.max(enter), to.min(leave));
    }
    (from <= to).then_some((from, to))
}
