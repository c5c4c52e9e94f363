//! Sizes of all regions of a tree.

use super::node::FragmentTree;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// The size of a region, in lattice steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// Length, area or volume.
    pub volume: f64,
    /// Number of ends, perimeter or surface area.
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

/// The sizes of R(v) for each node, within the root's region.
///
/// # Exactness
/// Regions are divided exactly; only their sizes are doubles, from corners correct to a few units in the
/// last place.
///
/// # Cost
/// One division for each node.
pub fn measures<S: Affine>(tree: &FragmentTree<S>, whole: &Polytope<S>) -> Vec<Measure> {
    let mut found = vec![Measure::default(); tree.nodes().len()];
    let mut pending = Vec::new();
    if !found.is_empty() {
        pending.push((NodeId::ROOT, whole.clone()));
    }
    while let Some((number, region)) = pending.pop() {
        poll();
        found[number.place()] = Measure::of(&region);
        let node = &tree.nodes()[number.place()];
        if node.minus.is_none() && node.plus.is_none() {
            continue;
        }
        let [minus, plus] = region.divided(&node.hyperplane);
        pending.extend(node.minus.zip(minus));
        pending.extend(node.plus.zip(plus));
    }
    found
}
