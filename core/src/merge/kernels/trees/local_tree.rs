//! A partition tree of one operand inside a small cell, cut by the planes of the operand's own faces.
//!
//! The tree exists only while its cell is solved. Winding numbers spread from region to region across the
//! fragments between them. This is correct for overlapping, nested and inverted boundaries, too; labels by
//! the sides of planes would be correct for simple boundaries only.
//!
//! # Source
//! Thibault and Naylor 1987 (construction, classification).

use std::sync::Arc;

use crate::arith::convert::as_number;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Polygon, PolygonSplit};
use crate::geometry::side::{Half, Orientation, Side};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A convex piece of an operand's boundary, with the jump of the winding number across it.
///
/// The winding number on the minus side of the polygon's plane exceeds the number on its plus side by
/// `weight`.
#[derive(Clone, Debug)]
pub struct WeightedPolygon {
    /// The polygon of the piece.
    pub polygon: Polygon,
    /// The winding number on the minus side of the polygon's plane, minus the number on its plus side.
    pub weight: i32,
}

/// A part of a polygon, and the winding numbers of an operand on the minus and the plus side of its plane.
#[derive(Debug)]
pub struct LabelledPolygon {
    /// The polygon of the labelled part.
    pub polygon: Polygon,
    /// The winding number on the minus side of the polygon's plane.
    pub minus: i32,
    /// The winding number on the plus side of the polygon's plane.
    pub plus: i32,
}

/// A region (leaf) of the tree, by the index of its winding number.
#[derive(Clone, Copy, Debug)]
struct LeafIndex(u32);

impl LeafIndex {
    fn index(self) -> usize {
        self.0 as usize
    }
}

/// A subtree: an inner node, or a region.
#[derive(Clone, Copy, Debug)]
enum Child {
    Node(NodeId),
    Leaf(LeafIndex),
}

#[derive(Debug)]
struct LocalNode {
    cut: Arc<Plane>,
    children: [Child; 2],
    /// A box around all fragments in the node's region.
    extent: Extent,
}

/// A partition tree of one operand in a small cell; each region has a winding number.
#[derive(Debug)]
pub struct LocalTree {
    nodes: Vec<LocalNode>,
    labels: Vec<i32>,
}

/// A fragment of an operand's boundary, or a piece of it, while the tree is built.
struct PendingFragment {
    fragment: WeightedPolygon,
    extent: Extent,
}

/// The fragments of an operand's boundary and their pieces while the tree is built; tasks refer to them by
/// index.
struct TreeBuilder {
    all: Vec<PendingFragment>,
    /// For each node one fragment in its plane, which relates the winding numbers on both sides of the node.
    links: Vec<usize>,
    open: Vec<Task>,
}

struct Task {
    pieces: Vec<usize>,
    parent: Option<(NodeId, usize)>,
}

impl LocalTree {
    /// Builds the tree of fragments in a cell, no two of which overlap.
    ///
    /// `corner` is the cell's low corner in half lattice steps, and `label` the winding number there.
    pub fn build(fragments: Vec<WeightedPolygon>, corner: &Lattice, label: i32) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            labels: Vec::new(),
        };
        let mut builder = TreeBuilder::of(fragments);
        while let Some(task) = builder.open.pop() {
            poll();
            let child = if task.pieces.is_empty() {
                tree.labels.push(0);
                Child::Leaf(LeafIndex(as_number(tree.labels.len()) - 1))
            } else {
                tree.grow(task.pieces, &mut builder)
            };
            if let Some((node, side)) = task.parent {
                tree.nodes[node.index()].children[side] = child;
            }
        }
        tree.spread_labels(&builder, corner, label);
        tree
    }

    /// Makes a tree of one region with this winding number.
    pub fn uniform(label: i32) -> Self {
        Self {
            nodes: Vec::new(),
            labels: vec![label],
        }
    }

    /// Returns the winding numbers of all regions.
    pub fn labels(&self) -> &[i32] {
        &self.labels
    }

    fn root(&self) -> Child {
        if self.nodes.is_empty() {
            Child::Leaf(LeafIndex(0))
        } else {
            Child::Node(NodeId::ROOT)
        }
    }

    fn grow(&mut self, mut pieces: Vec<usize>, builder: &mut TreeBuilder) -> Child {
        let node = NodeId::of(self.nodes.len());
        let extents = pieces.iter().map(|piece| builder.all[*piece].extent);
        let extent = extents.reduce(|a, b| a.joined(&b));
        let pivot = pieces.swap_remove(pieces.len() / 2);
        let cut = Arc::clone(builder.all[pivot].fragment.polygon.support());
        let [minus, plus] = builder.divide(&pieces, &cut);
        builder.links.push(pivot);
        self.nodes.push(LocalNode {
            cut,
            children: [Child::Leaf(LeafIndex(0)); 2],
            extent: extent.unwrap_or(builder.all[pivot].extent),
        });
        for (side, pieces) in [(1, plus), (0, minus)] {
            builder.open.push(Task {
                pieces,
                parent: Some((node, side)),
            });
        }
        Child::Node(node)
    }

    /// Labels the region at the cell's corner with its winding number, then all other regions across the
    /// links.
    ///
    /// A link is a fragment in a node's plane, between a region of the minus subtree and one of the plus
    /// subtree. There is one for each node, so the links connect all regions.
    fn spread_labels(&mut self, builder: &TreeBuilder, corner: &Lattice, label: i32) {
        let mut neighbours: Vec<Vec<(LeafIndex, i32)>> = vec![Vec::new(); self.labels.len()];
        for (node, link) in self.nodes.iter().zip(&builder.links) {
            poll();
            let WeightedPolygon { polygon, weight } = &builder.all[*link].fragment;
            let [below, above] = node.children.map(|child| self.leaf_beside(child, polygon));
            neighbours[below.index()].push((above, -weight));
            neighbours[above.index()].push((below, *weight));
        }
        let start = self.leaf_at(corner);
        let mut known = vec![false; self.labels.len()];
        known[start.index()] = true;
        self.labels[start.index()] = label;
        let mut open = vec![start];
        while let Some(leaf) = open.pop() {
            let here = self.labels[leaf.index()];
            for (next, change) in &neighbours[leaf.index()] {
                if !std::mem::replace(&mut known[next.index()], true) {
                    self.labels[next.index()] = here + change;
                    open.push(*next);
                }
            }
        }
    }

    /// Returns the region of a subtree in which a polygon lies, or on whose border it lies, near its first
    /// corner.
    ///
    /// A point of the polygon near a corner, next to the edge that leaves it, lies in a plane only if the
    /// whole polygon does.
    fn leaf_beside(&self, from: Child, polygon: &Polygon) -> LeafIndex {
        let corners = polygon.corners();
        let nearest = [0, 1, corners.len() - 1].map(|i| &corners[i].at);
        let mut at = from;
        loop {
            poll();
            let node = match at {
                Child::Leaf(leaf) => return leaf,
                Child::Node(node) => &self.nodes[node.index()],
            };
            let sides = nearest.iter().map(|corner| corner.side_of(&node.cut));
            let side = sides.into_iter().find(|side| *side != Side::On);
            at = node.children[usize::from(side == Some(Side::Plus))];
        }
    }

    fn leaf_at(&self, corner: &Lattice) -> LeafIndex {
        let mut at = self.root();
        loop {
            match at {
                Child::Leaf(leaf) => return leaf,
                Child::Node(node) => {
                    let node = &self.nodes[node.index()];
                    at = node.children[usize::from(node.cut.side_of_corner(corner) == Half::Plus)];
                }
            }
        }
    }

    /// Returns the winding number at a lattice point that lies on no fragment.
    pub fn label_at(&self, point: &Lattice) -> i32 {
        let mut at = self.root();
        loop {
            match at {
                Child::Leaf(leaf) => return self.labels[leaf.index()],
                Child::Node(node) => {
                    let node = &self.nodes[node.index()];
                    at = node.children[usize::from(node.cut.side_of_lattice(point) == Side::Plus)];
                }
            }
        }
    }

    /// Cuts a polygon where winding numbers change, and returns its pieces with the winding numbers on both
    /// sides.
    pub fn sides(&self, polygon: Polygon) -> Vec<LabelledPolygon> {
        let mut found = Vec::new();
        let mut open = vec![(self.root(), polygon)];
        while let Some((at, polygon)) = open.pop() {
            poll();
            let (polygon, ended) = self.descend(at, polygon, &mut open);
            match ended {
                PathEnd::Within(leaf) => {
                    let label = self.labels[leaf.index()];
                    found.push(LabelledPolygon {
                        polygon,
                        minus: label,
                        plus: label,
                    });
                }
                PathEnd::Coplanar(node, orientation) => {
                    self.coplanar_sides(node, polygon, orientation, &mut found);
                }
            }
        }
        found
    }

    /// Adds the pieces of a polygon that lies in a node's plane: the winding number on each side comes from
    /// the subtree of this side.
    fn coplanar_sides(
        &self,
        node: &LocalNode,
        polygon: Polygon,
        orientation: Orientation,
        found: &mut Vec<LabelledPolygon>,
    ) {
        for (piece, below) in self.labelled(node.children[0], polygon) {
            poll();
            for (polygon, above) in self.labelled(node.children[1], piece) {
                let (minus, plus) = match orientation {
                    Orientation::Same => (below, above),
                    Orientation::Opposite => (above, below),
                };
                found.push(LabelledPolygon {
                    polygon,
                    minus,
                    plus,
                });
            }
        }
    }

    /// Returns the pieces into which the regions of a subtree divide a polygon, with the winding number
    /// around each; no fragment of the subtree lies in the polygon's plane.
    fn labelled(&self, from: Child, polygon: Polygon) -> Vec<(Polygon, i32)> {
        let mut found = Vec::new();
        let mut open = vec![(from, polygon)];
        while let Some((at, polygon)) = open.pop() {
            poll();
            let (polygon, ended) = self.descend(at, polygon, &mut open);
            match ended {
                PathEnd::Within(leaf) => found.push((polygon, self.labels[leaf.index()])),
                // A polygon in a node's plane is no fragment of its subtrees.
                PathEnd::Coplanar(node, _) => open.push((node.children[0], polygon)),
            }
        }
        found
    }

    /// Pushes a polygon down a subtree until the winding numbers beside it are known. Returns the remaining
    /// polygon and the end of its path; pieces cut off are added to `open`.
    ///
    /// If no fragment of the subtree is near the polygon, the number of any region that it borders holds for
    /// all of it.
    fn descend(
        &self,
        from: Child,
        polygon: Polygon,
        open: &mut Vec<(Child, Polygon)>,
    ) -> (Polygon, PathEnd<'_>) {
        let (mut at, mut polygon) = (from, polygon);
        let mut extent = extent(&polygon);
        loop {
            poll();
            let node = match at {
                Child::Leaf(leaf) => return (polygon, PathEnd::Within(leaf)),
                Child::Node(node) => &self.nodes[node.index()],
            };
            if extent.misses(&node.extent) {
                let leaf = self.leaf_beside(at, &polygon);
                return (polygon, PathEnd::Within(leaf));
            }
            if let Some(orientation) = polygon.support().coincides(&node.cut) {
                return (polygon, PathEnd::Coplanar(node, orientation));
            }
            at = match polygon.split(&node.cut) {
                PolygonSplit::Minus | PolygonSplit::Coplanar => node.children[0],
                PolygonSplit::Plus => node.children[1],
                PolygonSplit::Both(minus, plus) => {
                    open.push((node.children[1], plus));
                    polygon = minus;
                    extent = self::extent(&polygon);
                    node.children[0]
                }
            };
        }
    }
}

/// The end of the path of a polygon down a tree.
enum PathEnd<'t> {
    /// The polygon lies in this region, or in several with the same winding number.
    Within(LeafIndex),
    /// The polygon lies in the plane of this node, in this orientation.
    Coplanar(&'t LocalNode, Orientation),
}

impl TreeBuilder {
    fn of(fragments: Vec<WeightedPolygon>) -> Self {
        let all: Vec<PendingFragment> = fragments.into_iter().map(PendingFragment::of).collect();
        let first = Task {
            pieces: (0..all.len()).collect(),
            parent: None,
        };
        Self {
            all,
            links: Vec::new(),
            open: vec![first],
        }
    }

    /// Divides fragments of an operand's boundary by a plane and returns their pieces on the minus and on the
    /// plus side, without fragments that lie in the plane.
    fn divide(&mut self, pieces: &[usize], cut: &Arc<Plane>) -> [Vec<usize>; 2] {
        let (mut minus, mut plus) = (Vec::new(), Vec::new());
        for &piece in pieces {
            poll();
            let WeightedPolygon { polygon, weight } = &self.all[piece].fragment;
            if polygon.support().coincides(cut).is_some() {
                continue;
            }
            match polygon.split(cut) {
                PolygonSplit::Minus | PolygonSplit::Coplanar => minus.push(piece),
                PolygonSplit::Plus => plus.push(piece),
                PolygonSplit::Both(below, above) => {
                    let part = |polygon: Polygon| {
                        let weight = *weight;
                        PendingFragment::of(WeightedPolygon { polygon, weight })
                    };
                    let (below, above) = (part(below), part(above));
                    minus.push(piece);
                    plus.push(self.all.len());
                    self.all[piece] = below;
                    self.all.push(above);
                }
            }
        }
        [minus, plus]
    }
}

impl PendingFragment {
    fn of(fragment: WeightedPolygon) -> Self {
        let extent = extent(&fragment.polygon);
        Self { fragment, extent }
    }
}

/// Returns a box around a polygon, rounded outwards.
pub(super) fn extent(polygon: &Polygon) -> Extent {
    let (low, high) = polygon.bounds();
    Extent { low, high }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::cell::Cell;
    use crate::merge::scenes::{cuboid, triangle};
    use crate::mesh::handle::Slot;

    /// Returns the tree of the faces of boxes, each with the weight of its box.
    fn tree(boxes: &[([Lattice; 2], i32)]) -> LocalTree {
        let mut fragments = Vec::new();
        let cell = Cell::around(&[0; 3], &[15; 3]);
        for ([low, high], weight) in boxes {
            let solid = cuboid(*low, *high);
            let source = solid.sources().get(Slot(0));
            let clipped = source
                .face_ids()
                .filter_map(|face| source.clip(face, &cell));
            fragments.extend(clipped.map(|polygon| WeightedPolygon {
                polygon,
                weight: *weight,
            }));
        }
        LocalTree::build(fragments, &cell.corner(), 0)
    }

    #[test]
    fn boxes_in_boxes_count_and_holes_take_away() {
        let (outer, inner) = ([[1; 3], [9; 3]], [[3; 3], [6; 3]]);
        let labels = |weight| {
            let tree = tree(&[(outer, 1), (inner, weight)]);
            [[0; 3], [2; 3], [4; 3]].map(|p| tree.label_at(&p))
        };
        assert_eq!(labels(1), [0, 1, 2]);
        assert_eq!(labels(-1), [0, 1, 0]);
    }

    #[test]
    fn a_polygon_is_cut_where_labels_change() {
        let tree = tree(&[([[1; 3], [9; 3]], 1)]);
        let across = triangle([[2, 2, 5], [14, 2, 5], [2, 4, 5]]);
        let sides = tree.sides(across);
        assert!(sides.iter().all(|s| s.minus == s.plus));
        let inside = |s: &&LabelledPolygon| s.minus == 1;
        assert!(sides.iter().any(|s| inside(&s)) && sides.iter().any(|s| s.minus == 0));
        let beyond = |s: &LabelledPolygon| s.polygon.bounds().1[0] > 9.5;
        assert!(sides.iter().filter(inside).all(|s| !beyond(s)));
    }
}
