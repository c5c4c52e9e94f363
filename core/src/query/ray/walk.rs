//! From leaf to leaf along a ray, nearest first.
//!
//! # Source
//! Havran, Kopal, Bittner, Žára 1997, "Fast robust BSP tree traversal algorithm for ray tracing":
//! the order of children by the position of the cut in the ray's interval. Its singular cases (a
//! ray in a cut, a start in a cut, a cut at an interval's end) need no case of their own here:
//! every depth is taken with its error, and where the error leaves both children possible, both
//! are visited.
//!
//! # Bundles
//! Rays go one by one. On a sphere of 330 000 triangles a camera ray spends about half of its time
//! on the way to its leaf, a quarter on tests, a quarter on exact numbers: sharing the way within a
//! bundle could save no more than that half, less what mixed leaves cost.

use smallvec::SmallVec;

use super::filter::ROUNDING;
use super::line::Ray;
use super::node::{Cell, Content, Node};
use super::scene::Scene;

/// Relative error of the depth of a cut: a difference, a quotient of two rounded numbers and a
/// product, rounded.
const SLACK: f64 = 6.0 * ROUNDING;

type Open<'a, const D: usize> = (&'a Node<D>, f64, f64);

/// Visits the leaves that a ray meets, until one lies entirely beyond the limit.
///
/// `visit` gets the facets of a leaf and returns the depth beyond which nothing matters, in
/// lattice steps along the ray's main axis.
pub fn walk<const D: usize>(
    scene: &Scene<D>,
    ray: &Ray<D>,
    limit: f64,
    mut visit: impl FnMut(&[u32]) -> f64,
) {
    let mut limit = limit;
    let mut open: SmallVec<[Open<'_, D>; 64]> = SmallVec::new();
    open.extend(clip(ray, scene.cell()).map(|(from, to)| (scene.root(), from, to)));
    while let Some((node, from, to)) = open.pop() {
        if from > limit {
            continue;
        }
        let leaf = descend(scene, ray, (node, from, to), &mut open);
        if !leaf.is_empty() {
            limit = visit(leaf);
        }
    }
}

/// The nearest leaf below a node; what lies behind it is put on the stack.
#[inline]
fn descend<'a, const D: usize>(
    scene: &'a Scene<D>,
    ray: &Ray<D>,
    (mut node, from, mut to): Open<'a, D>,
    open: &mut SmallVec<[Open<'a, D>; 64]>,
) -> &'a [u32] {
    let near = &ray.near;
    loop {
        let (axis, at, children) = match node.content(scene.facets()) {
            Content::Leaf(facets) => return facets,
            Content::Cut { axis, at, children } => (usize::from(*axis), *at, children),
        };
        let gap = at - near.origin[axis];
        let inverse = near.inverse[axis];
        if inverse.is_infinite() {
            // The ray runs along the cut: on one side of it, or within it.
            if gap == 0.0 {
                open.push((&children[1], from, to));
            }
            node = &children[usize::from(gap < 0.0)];
            continue;
        }
        let depth = gap * inverse;
        let slack = depth.abs() * SLACK;
        let first = usize::from(inverse < 0.0);
        if depth + slack < from {
            node = &children[1 - first];
        } else {
            if depth - slack <= to {
                open.push((&children[1 - first], from.max(depth - slack), to));
                to = to.min(depth + slack);
            }
            node = &children[first];
        }
    }
}

/// The depths between which the ray may be in a box.
pub fn clip<const D: usize>(ray: &Ray<D>, cell: &Cell<D>) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0f64, f64::INFINITY);
    for k in 0..D {
        let gaps = [cell.low[k], cell.high[k]].map(|c| c - ray.near.origin[k]);
        let inverse = ray.near.inverse[k];
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
