//! The local autopartition of one operand inside a small cell.
//!
//! A transient BSP tree cut by the supporting planes of the operand's own fragments. Regions are
//! labelled with winding numbers by adjacency, so that overlapping, nested and inverted boundaries
//! are labelled rightly too: labels by plane sides would hold for simple boundaries only.
//!
//! # Source
//! Thibault and Naylor 1987 (construction, classification).

use std::sync::Arc;

use crate::arith::convert::as_number;
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

/// A leaf by the place of its label.
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
}

/// A labelled autopartition.
#[derive(Debug)]
pub struct LocalTree {
    nodes: Vec<LocalNode>,
    labels: Vec<i32>,
}

/// One fragment of a node's coplanar set: it ties the labels on both sides of the node together.
struct Link {
    polygon: Polygon,
    weight: i32,
}

struct Task {
    pieces: Vec<Weighted>,
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
        let mut links = Vec::new();
        let mut open = vec![Task {
            pieces: fragments,
            parent: None,
        }];
        while let Some(task) = open.pop() {
            poll();
            let child = if task.pieces.is_empty() {
                tree.labels.push(0);
                Child::Leaf(Region(as_number(tree.labels.len()) - 1))
            } else {
                tree.grow(task.pieces, &mut links, &mut open)
            };
            if let Some((node, side)) = task.parent {
                tree.nodes[node.place()].children[side] = child;
            }
        }
        tree.spread_labels(links, corner, label);
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

    fn grow(
        &mut self,
        mut pieces: Vec<Weighted>,
        links: &mut Vec<Link>,
        open: &mut Vec<Task>,
    ) -> Child {
        let node = NodeId::of(self.nodes.len());
        let pivot = pieces.swap_remove(pieces.len() / 2);
        let cut = Arc::clone(pivot.polygon.support());
        let (mut minus, mut plus) = (Vec::new(), Vec::new());
        for piece in pieces {
            if piece.polygon.support().coincides(&cut).is_none() {
                divide(piece, &cut, &mut minus, &mut plus);
            }
        }
        links.push(Link {
            polygon: pivot.polygon,
            weight: pivot.weight,
        });
        self.nodes.push(LocalNode {
            cut,
            children: [Child::Leaf(Region(0)); 2],
        });
        open.push(Task {
            pieces: plus,
            parent: Some((node, 1)),
        });
        open.push(Task {
            pieces: minus,
            parent: Some((node, 0)),
        });
        Child::Node(node)
    }

    /// Labels the corner's region, then every other one across the links.
    ///
    /// The links connect all regions: each ties a region of a node's minus subtree to one of its
    /// plus subtree, and there is one link for every node.
    fn spread_labels(&mut self, links: Vec<Link>, corner: &Lattice, label: i32) {
        let mut neighbours: Vec<Vec<(Region, i32)>> = vec![Vec::new(); self.labels.len()];
        for (node, link) in links.into_iter().enumerate() {
            poll();
            let [minus, plus] = self.nodes[node].children;
            let (below, polygon) = self.any_leaf(minus, link.polygon);
            let (above, _) = self.any_leaf(plus, polygon);
            neighbours[below.place()].push((above, -link.weight));
            neighbours[above.place()].push((below, link.weight));
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

    /// A leaf that some piece of the polygon borders or lies in, and that piece.
    fn any_leaf(&self, from: Child, polygon: Polygon) -> (Region, Polygon) {
        let (mut at, mut polygon) = (from, polygon);
        loop {
            poll();
            let node = match at {
                Child::Leaf(leaf) => return (leaf, polygon),
                Child::Node(node) => &self.nodes[node.place()],
            };
            at = match polygon.split(&node.cut) {
                PolygonSplit::Plus => node.children[1],
                PolygonSplit::Minus | PolygonSplit::Coplanar => node.children[0],
                PolygonSplit::Both(minus, _) => {
                    polygon = minus;
                    node.children[0]
                }
            };
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

    /// Pushes a polygon down the tree: its pieces with the winding numbers on both sides.
    pub fn sides(&self, polygon: Polygon) -> Vec<Sided> {
        let mut found = Vec::new();
        let mut open = vec![(self.root(), polygon)];
        while let Some((at, polygon)) = open.pop() {
            poll();
            let node = match at {
                Child::Leaf(leaf) => {
                    let label = self.labels[leaf.place()];
                    found.push(Sided {
                        polygon,
                        minus: label,
                        plus: label,
                    });
                    continue;
                }
                Child::Node(node) => &self.nodes[node.place()],
            };
            if let Some(orientation) = polygon.support().coincides(&node.cut) {
                self.coplanar_sides(node, polygon, orientation, &mut found);
            } else {
                descend(polygon, node, &mut open);
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

    /// The pieces of a polygon by the leaves of a subtree whose planes it does not lie in.
    fn labelled(&self, from: Child, polygon: Polygon) -> Vec<(Polygon, i32)> {
        let mut found = Vec::new();
        let mut open = vec![(from, polygon)];
        while let Some((at, polygon)) = open.pop() {
            match at {
                Child::Leaf(leaf) => found.push((polygon, self.labels[leaf.place()])),
                Child::Node(node) => descend(polygon, &self.nodes[node.place()], &mut open),
            }
        }
        found
    }
}

fn descend(polygon: Polygon, node: &LocalNode, open: &mut Vec<(Child, Polygon)>) {
    poll();
    match polygon.split(&node.cut) {
        PolygonSplit::Minus | PolygonSplit::Coplanar => open.push((node.children[0], polygon)),
        PolygonSplit::Plus => open.push((node.children[1], polygon)),
        PolygonSplit::Both(minus, plus) => {
            open.push((node.children[1], plus));
            open.push((node.children[0], minus));
        }
    }
}

fn divide(piece: Weighted, cut: &Arc<Plane>, minus: &mut Vec<Weighted>, plus: &mut Vec<Weighted>) {
    poll();
    let weight = piece.weight;
    match piece.polygon.split(cut) {
        PolygonSplit::Minus | PolygonSplit::Coplanar => minus.push(piece),
        PolygonSplit::Plus => plus.push(piece),
        PolygonSplit::Both(below, above) => {
            minus.push(Weighted {
                polygon: below,
                weight,
            });
            plus.push(Weighted {
                polygon: above,
                weight,
            });
        }
    }
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
