//! The volumes and surfaces of all regions of a tree.

use super::node::FragmentTree;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// The volume and the surface of a region, in lattice steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// The length of the region in 1D, its area in 2D, its volume in 3D.
    pub volume: f64,
    /// The number of the region's ends in 1D, its perimeter in 2D, its surface area in 3D.
    pub surface: f64,
}

impl Measure {
    fn of<S: Affine>(region: &Polytope<S>) -> Self {
        Self {
            volume: region.volume(),
            surface: region.surface(),
        }
    }
}

/// The measures of each node's region, where `whole` is the region of the root.
///
/// # Exactness
/// Regions are divided exactly; only their measures are doubles, from corners that are correct to a few units
/// in the last place.
///
/// # Cost
/// One division of a region for each node.
pub fn measures<S: Affine>(tree: &FragmentTree<S>, whole: &Polytope<S>) -> Vec<Measure> {
    let mut found = vec![Measure::default(); tree.nodes().len()];
    let mut pending = Vec::new();
    if !found.is_empty() {
        pending.push((NodeId::ROOT, whole.clone()));
    }
    while let Some((number, region)) = pending.pop() {
        poll();
        found[number.index()] = Measure::of(&region);
        let node = &tree.nodes()[number.index()];
        if node.minus.is_none() && node.plus.is_none() {
            continue;
        }
        let [minus, plus] = region.divided(&node.hyperplane);
        pending.extend(node.minus.zip(minus));
        pending.extend(node.plus.zip(plus));
    }
    found
}
