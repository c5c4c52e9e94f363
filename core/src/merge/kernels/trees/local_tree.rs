//! The local autopartition of one operand inside a small cell.
//!
//! A transient BSP tree cut by the supporting planes of the operand's own fragments. Regions are labelled
//! with winding numbers by adjacency, which is correct for overlapping, nested and inverted boundaries too:
//! labels by plane sides would be correct for simple boundaries only.
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

/// A convex piece of boundary with its multiplicity.
///
/// The winding number on the minus side of the polygon's support exceeds the plus side's by
/// `weight`.
#[derive(Clone, Debug)]
pub struct Weighted {
    /// The piece.
    pub polygon: Polygon,
    /// The jump of the winding number.
    pub weight: i32,
}

/// A piece of a fragment and the winding numbers on its support's minus and plus sides.
#[derive(Debug)]
pub struct Sided {
    /// The piece.
    pub polygon: Polygon,
    /// The winding number on the minus side.
    pub minus: i32,
    /// The winding number on the plus side.
    pub plus: i32,
}

/// A leaf, by the index of its label.
#[derive(Clone, Copy, Debug)]
struct Region(u32);

impl Region {
    fn place(self) -> usize {
        self.0 as usize
    }
}

/// A subtree: a node, or a leaf.
#[derive(Clone, Copy, Debug)]
enum Child {
    Node(NodeId),
    Leaf(Region),
}

#[derive(Debug)]
struct LocalNode {
    cut: Arc<Plane>,
    children: [Child; 2],
    /// A box around all fragments in its region.
    extent: Extent,
}

/// A labelled autopartition.
#[derive(Debug)]
pub struct LocalTree {
    nodes: Vec<LocalNode>,
    labels: Vec<i32>,
}

/// A fragment or a piece of one during construction.
struct PendingFragment {
    fragment: Weighted,
    extent: Extent,
}

/// The fragments and pieces to distribute among nodes, which refer to them by index.
struct TreeBuilder {
    all: Vec<PendingFragment>,
    /// One fragment of each node's coplanar set, which relates the labels on both sides of the node.
    links: Vec<usize>,
    open: Vec<Task>,
}

struct Task {
    pieces: Vec<usize>,
    parent: Option<(NodeId, usize)>,
}

impl LocalTree {
    /// Builds the tree of disjoint fragments in a cell.
    ///
    /// `corner` is the cell's low corner in half steps, `label` the winding number there.
    pub fn build(fragments: Vec<Weighted>, corner: &Lattice, label: i32) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            labels: Vec::new(),
        };
        let mut builder = TreeBuilder::of(fragments);
        while let Some(task) = builder.open.pop() {
            poll();
            let child = if task.pieces.is_empty() {
                tree.labels.push(0);
                Child::Leaf(Region(as_number(tree.labels.len()) - 1))
            } else {
                tree.grow(task.pieces, &mut builder)
            };
            if let Some((node, side)) = task.parent {
                tree.nodes[node.place()].children[side] = child;
            }
        }
        tree.spread_labels(&builder, corner, label);
        tree
    }

    /// The tree of one region.
    pub fn uniform(label: i32) -> Self {
        Self {
            nodes: Vec::new(),
            labels: vec![label],
        }
    }

    /// The winding numbers of all regions.
    pub fn labels(&self) -> &[i32] {
        &self.labels
    }

    fn root(&self) -> Child {
        if self.nodes.is_empty() {
            Child::Leaf(Region(0))
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
            children: [Child::Leaf(Region(0)); 2],
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

    /// Labels the corner's region, then all others across the links.
    ///
    /// The links connect all regions: there is one for each node, between a region of its minus subtree and
    /// one of its plus subtree.
    fn spread_labels(&mut self, builder: &TreeBuilder, corner: &Lattice, label: i32) {
        let mut neighbours: Vec<Vec<(Region, i32)>> = vec![Vec::new(); self.labels.len()];
        for (node, link) in self.nodes.iter().zip(&builder.links) {
            poll();
            let Weighted { polygon, weight } = &builder.all[*link].fragment;
            let [below, above] = node.children.map(|child| self.leaf_beside(child, polygon));
            neighbours[below.place()].push((above, -weight));
            neighbours[above.place()].push((below, *weight));
        }
        let start = self.leaf_at(corner);
        let mut known = vec![false; self.labels.len()];
        known[start.place()] = true;
        self.labels[start.place()] = label;
        let mut open = vec![start];
        while let Some(leaf) = open.pop() {
            let here = self.labels[leaf.place()];
            for (next, change) in &neighbours[leaf.place()] {
                if !std::mem::replace(&mut known[next.place()], true) {
                    self.labels[next.place()] = here + change;
                    open.push(*next);
                }
            }
        }
    }

    /// The leaf of a subtree that a polygon borders or lies in, near its first corner.
    ///
    /// A point of the polygon near a corner, next to the edge that leaves it, lies in a plane only if the
    /// whole polygon does.
    fn leaf_beside(&self, from: Child, polygon: &Polygon) -> Region {
        let corners = polygon.corners();
        let nearest = [0, 1, corners.len() - 1].map(|i| &corners[i].at);
        let mut at = from;
        loop {
            poll();
            let node = match at {
                Child::Leaf(leaf) => return leaf,
                Child::Node(node) => &self.nodes[node.place()],
            };
            let sides = nearest.iter().map(|corner| corner.side_of(&node.cut));
            let side = sides.into_iter().find(|side| *side != Side::On);
            at = node.children[usize::from(side == Some(Side::Plus))];
        }
    }

    fn leaf_at(&self, corner: &Lattice) -> Region {
        let mut at = self.root();
        loop {
            match at {
                Child::Leaf(leaf) => return leaf,
                Child::Node(node) => {
                    let node = &self.nodes[node.place()];
                    at = node.children[usize::from(node.cut.side_of_corner(corner) == Half::Plus)];
                }
            }
        }
    }

    /// The winding number at a lattice point that lies on no fragment.
    pub fn label_at(&self, point: &Lattice) -> i32 {
        let mut at = self.root();
        loop {
            match at {
                Child::Leaf(leaf) => return self.labels[leaf.place()],
                Child::Node(node) => {
                    let node = &self.nodes[node.place()];
                    at = node.children[usize::from(node.cut.side_of_lattice(point) == Side::Plus)];
                }
            }
        }
    }

    /// Pushes a polygon down the tree; returns its pieces with the winding numbers on both sides.
    pub fn sides(&self, polygon: Polygon) -> Vec<Sided> {
        let mut found = Vec::new();
        let mut open = vec![(self.root(), polygon)];
        while let Some((at, polygon)) = open.pop() {
            poll();
            let (polygon, ended) = self.descend(at, polygon, &mut open);
            match ended {
                PathEnd::Within(leaf) => {
                    let label = self.labels[leaf.place()];
                    found.push(Sided {
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

    /// The pieces of a polygon in a node's cut: each side's label from that side's subtree.
    fn coplanar_sides(
        &self,
        node: &LocalNode,
        polygon: Polygon,
        orientation: Orientation,
        found: &mut Vec<Sided>,
    ) {
        for (piece, below) in self.labelled(node.children[0], polygon) {
            poll();
            for (polygon, above) in self.labelled(node.children[1], piece) {
                let (minus, plus) = match orientation {
                    Orientation::Same => (below, above),
                    Orientation::Opposite => (above, below),
                };
                found.push(Sided {
                    polygon,
                    minus,
                    plus,
                });
            }
        }
    }

    /// The pieces of a polygon by the leaves of a subtree; the polygon lies in none of its planes.
    fn labelled(&self, from: Child, polygon: Polygon) -> Vec<(Polygon, i32)> {
        let mut found = Vec::new();
        let mut open = vec![(from, polygon)];
        while let Some((at, polygon)) = open.pop() {
            poll();
            let (polygon, ended) = self.descend(at, polygon, &mut open);
            match ended {
                PathEnd::Within(leaf) => found.push((polygon, self.labels[leaf.place()])),
                // A polygon in a node's plane is no fragment of its subtrees.
                PathEnd::Coplanar(node, _) => open.push((node.children[0], polygon)),
            }
        }
        found
    }

    /// Pushes a polygon down a subtree until its labels are known; adds cut-off pieces to `open`.
    ///
    /// If no fragment of the subtree is near, the whole polygon has the labels of any leaf that it borders.
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
                Child::Node(node) => &self.nodes[node.place()],
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

/// Where the path of a polygon down a tree ends.
enum PathEnd<'t> {
    /// In a leaf, or in several with the same label.
    Within(Region),
    /// At a node in whose plane it lies.
    Coplanar(&'t LocalNode, Orientation),
}

impl TreeBuilder {
    fn of(fragments: Vec<Weighted>) -> Self {
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

    /// The pieces on either side of a plane, without those in it.
    fn divide(&mut self, pieces: &[usize], cut: &Arc<Plane>) -> [Vec<usize>; 2] {
        let (mut minus, mut plus) = (Vec::new(), Vec::new());
        for &piece in pieces {
            poll();
            let Weighted { polygon, weight } = &self.all[piece].fragment;
            if polygon.support().coincides(cut).is_some() {
                continue;
            }
            match polygon.split(cut) {
                PolygonSplit::Minus | PolygonSplit::Coplanar => minus.push(piece),
                PolygonSplit::Plus => plus.push(piece),
                PolygonSplit::Both(below, above) => {
                    let part = |polygon: Polygon| {
                        let weight = *weight;
                        PendingFragment::of(Weighted { polygon, weight })
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
    fn of(fragment: Weighted) -> Self {
        let extent = extent(&fragment.polygon);
        Self { fragment, extent }
    }
}

/// A box around a polygon.
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

    /// The faces of boxes, each with the weight of its box.
    fn tree(boxes: &[([Lattice; 2], i32)]) -> LocalTree {
        let mut fragments = Vec::new();
        let cell = Cell::around(&[0; 3], &[15; 3]);
        for ([low, high], weight) in boxes {
            let solid = cuboid(*low, *high);
            let source = solid.sources().get(Slot(0));
            let clipped = source
                .face_ids()
                .filter_map(|face| source.clip(face, &cell));
            fragments.extend(clipped.map(|polygon| Weighted {
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
        let inside = |s: &&Sided| s.minus == 1;
        assert!(sides.iter().any(|s| inside(&s)) && sides.iter().any(|s| s.minus == 0));
        let beyond = |s: &Sided| s.polygon.bounds().1[0] > 9.5;
        assert!(sides.iter().filter(inside).all(|s| !beyond(s)));
    }
}
