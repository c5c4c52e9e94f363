//! Joins the results of the two halves of a cell.

use std::sync::Arc;

use crate::geometry::cell::{Cell, Cut};
use crate::geometry::outline::{cancel, OutlineEdge};
use crate::geometry::side::{Half, Orientation};
use crate::geometry::winding::crossing::{plane_change, triangle_change, Segment};
use crate::interrupt::poll;
use crate::merge::kernels::kept::is_whole;
use crate::merge::lists::list::Sources;
use crate::mesh::cached::Cached;
use crate::mesh::handle::FaceId;
use crate::mesh::source::{Shape, Source};
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node};

/// The most faces that two deferred leaves together may list in order to become one leaf.
///
/// This is half the number of elements (faces or parts of faces) of a cell that a kernel solves, so that a
/// joined leaf is not split again at once.
pub const MAX_FACES_JOINED: usize = 16;

/// Returns the branch for a cell from the branches of its two halves.
///
/// If one half is uniform and the other half has the same value around its own cell, the other half's branch
/// stands for both (path compression). The values may differ, because a face may lie in a slab between two
/// uniform halves.
pub fn branch(cell: Cell, cut: Cut, minus: Branch, plus: Branch, sources: &Sources) -> Branch {
    let fits = |w: i32, other: &Branch, half: Half| {
        other.cell == cell.half(cut, half) || is_same(w, other.outside)
    };
    match (minus.constant(), plus.constant()) {
        (Some(w), Some(v)) if is_same(w, v) => Branch::uniform(cell, w),
        (Some(w), None) if fits(w, &plus, Half::Plus) => Branch { outside: w, ..plus },
        (None, Some(w)) if fits(w, &minus, Half::Minus) => Branch {
            outside: w,
            ..minus
        },
        _ => {
            let node = joined(&cell, cut, &minus, &plus, sources);
            divided(cell, minus, plus, node)
        }
    }
}

/// Returns the branch for a cell in which `branch` lies, with the winding number `outside` around it.
///
/// Usually `branch` has the same value around its own cell. It differs if an unbounded surface crosses the
/// border of both cells; then the result is a cut.
pub fn surround_cell(cell: Cell, branch: Branch, outside: i32) -> Branch {
    let cut = cell
        .cut()
        .filter(|_| branch.cell != cell && !is_same(branch.outside, outside));
    let Some(cut) = cut else {
        return Branch { outside, ..branch };
    };
    let [minus, plus] = Half::BOTH.map(|half| {
        let half = cell.half(cut, half);
        if half.contains(&branch.cell) {
            branch.clone()
        } else {
            Branch::uniform(half, branch.outside)
        }
    });
    Branch {
        outside,
        ..divided(cell, minus, plus, None)
    }
}

/// Returns true if two winding numbers are both inside (positive) or both outside.
fn is_same(w: i32, v: i32) -> bool {
    (w > 0) == (v > 0)
}

/// Returns the branch of a cell whose node is `joined`, or a cut into the two halves if that is `None`.
fn divided(cell: Cell, minus: Branch, plus: Branch, joined: Option<Node>) -> Branch {
    Branch {
        cell,
        outside: minus.outside,
        complement: false,
        node: Arc::new(joined.unwrap_or_else(|| Node::cut(minus, plus))),
    }
}

/// Joins two halves into one deferred leaf; `None` unless both list few faces, all of them whole, and agree
/// on winding numbers.
fn joined(cell: &Cell, cut: Cut, minus: &Branch, plus: &Branch, sources: &Sources) -> Option<Node> {
    let (a, b) = (small_leaf(minus)?, small_leaf(plus)?);
    if a.len() + b.len() > 2 * MAX_FACES_JOINED {
        return None;
    }
    let mut faces = listed_faces(minus, a);
    for element in listed_faces(plus, b) {
        poll();
        match faces.iter_mut().find(|f| f.same_as(&element)) {
            Some(known) => known.touching |= element.touching,
            None => faces.push(element),
        }
    }
    if faces.len() > MAX_FACES_JOINED {
        return None;
    }
    let halves = [
        (minus, a, cell.half(cut, Half::Minus)),
        (plus, b, cell.half(cut, Half::Plus)),
    ];
    let mut held = Vec::with_capacity(faces.len());
    for face in faces {
        poll();
        match face.share_in_cell(cell, &halves) {
            ShareInCell::All => held.push(face),
            ShareInCell::Nothing => {}
            ShareInCell::Part => return None,
        }
    }
    let mut faces = held;
    faces.sort_by_key(|f| (sources.slot(&f.source), f.orientation, f.touching, f.face));
    let corner = corner_of(minus, a, cell);
    let plus_corner = corner_of(plus, b, &halves[1].2);
    if plus_corner != corner + change_along_edge(&faces, cell, cut) {
        return None;
    }
    Some(Node::Deferred(DeferredLeaf {
        groups: grouped(faces),
        parts: Vec::new(),
        corner,
        by_kernel: a.by_kernel || b.by_kernel,
        share: Cached::new(),
    }))
}

/// Returns the winding number at the low corner of `cell`, in which the branch lies.
fn corner_of(branch: &Branch, leaf: &DeferredLeaf, cell: &Cell) -> i32 {
    if branch.cell.low() == cell.low() {
        branch.oriented(leaf.corner)
    } else {
        branch.outside
    }
}

/// Returns the change of the winding number from the cell's low corner to the low corner of its plus half.
///
/// An operand's unchanged boundary may have winding numbers above 1 where a kernel's result has 1. Leaves
/// that disagree across the cut must not be joined.
fn change_along_edge(faces: &[OrientedListedFace], cell: &Cell, cut: Cut) -> i32 {
    let segment = Segment {
        from: cell.corner(),
        axis: cut.axis,
        to: 2 * cut.at - 1,
    };
    let across = |f: &OrientedListedFace| match f.source.shape() {
        Shape::Mesh(mesh) => triangle_change(&mesh.corners(f.face), &segment),
        Shape::HalfSpace(plane) => plane_change(plane, &segment),
    };
    faces.iter().map(|f| f.orientation.signed(across(f))).sum()
}

fn small_leaf(branch: &Branch) -> Option<&DeferredLeaf> {
    match &*branch.node {
        Node::Deferred(leaf) if leaf.parts.is_empty() && leaf.len() <= MAX_FACES_JOINED => {
            Some(leaf)
        }
        _ => None,
    }
}

struct OrientedListedFace {
    touching: bool,
    source: Arc<Source>,
    orientation: Orientation,
    face: FaceId,
}

fn listed_faces(branch: &Branch, leaf: &DeferredLeaf) -> Vec<OrientedListedFace> {
    let entry = |g: &FaceGroup, face: &FaceId| OrientedListedFace {
        touching: g.touching,
        source: Arc::clone(&g.source),
        orientation: g.orientation.turned_if(branch.complement),
        face: *face,
    };
    leaf.groups
        .iter()
        .flat_map(|g| g.faces.iter().map(move |f| entry(g, f)))
        .collect()
}

impl OrientedListedFace {
    fn same_as(&self, other: &Self) -> bool {
        self.face == other.face
            && self.orientation == other.orientation
            && Arc::ptr_eq(&self.source, &other.source)
    }

    fn is_in(&self, branch: &Branch, leaf: &DeferredLeaf) -> bool {
        leaf.groups.iter().any(|g| {
            g.orientation.turned_if(branch.complement) == self.orientation
                && Arc::ptr_eq(&g.source, &self.source)
                && g.faces.binary_search(&self.face).is_ok()
        })
    }

    /// Returns how much of the face's part inside `cell` is listed as surface in the two halves.
    fn share_in_cell(
        &self,
        cell: &Cell,
        halves: &[(&Branch, &DeferredLeaf, Cell); 2],
    ) -> ShareInCell {
        let (low, high) = self.source.face_box(self.face);
        let holders: Vec<_> = halves
            .iter()
            .filter(|(branch, leaf, _)| self.is_in(branch, leaf))
            .collect();
        let enclosed = holders.iter().any(|h| h.0.cell.contains_box(&low, &high));
        if enclosed || holders.iter().filter(|h| h.0.cell == h.2).count() == 2 {
            return ShareInCell::All;
        }
        let clipped = holders
            .iter()
            .filter_map(|h| self.source.clip(self.face, &h.0.cell));
        let edges: Vec<OutlineEdge> = clipped
            .flat_map(|p| OutlineEdge::edges_of(&p).collect::<Vec<_>>())
            .collect();
        if edges.is_empty() {
            ShareInCell::Nothing
        } else if is_whole(&cancel(edges), &self.source, self.face, cell) {
            ShareInCell::All
        } else {
            ShareInCell::Part
        }
    }
}

/// The share of a face inside a cell that bounds the solid: all, a part, or nothing.
enum ShareInCell {
    All,
    Part,
    Nothing,
}

fn grouped(faces: Vec<OrientedListedFace>) -> Vec<FaceGroup> {
    let mut groups: Vec<FaceGroup> = Vec::new();
    for f in faces {
        poll();
        match groups.last_mut() {
            Some(g)
                if Arc::ptr_eq(&g.source, &f.source)
                    && g.orientation == f.orientation
                    && g.touching == f.touching =>
            {
                g.faces.push(f.face);
            }
            _ => groups.push(FaceGroup {
                touching: f.touching,
                source: f.source,
                orientation: f.orientation,
                faces: vec![f.face],
            }),
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::lists::list::List;
    use crate::merge::scenes::{counts, cuboid, Shared};

    #[test]
    fn halves_of_few_faces_become_one_leaf_again() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let cut = scene.cell.cut().expect("more than one point");
        let (minus, plus) = scene.lists[0]
            .clone()
            .divide(&scene.cell, cut, &scene.sources);
        let leaf = |half, list: List| {
            let node = list.close(false, &scene.sources);
            Branch::of_node(scene.cell.half(cut, half), node)
        };
        let halves = [leaf(Half::Minus, minus), leaf(Half::Plus, plus)];
        let [minus, plus] = halves;
        let whole = branch(scene.cell, cut, minus, plus, &scene.sources);
        assert_eq!((whole.cell, counts(&whole.node)), (scene.cell, (12, 0)));
    }

    #[test]
    fn uniform_halves_are_left_out_where_nothing_changes() {
        let scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let cell = Cell::around(&[0; 3], &[15; 3]);
        let cut = cell.cut().expect("more than one point");
        let around = |w: i32| Branch::uniform(cell.half(cut, Half::Plus), w);
        let inner = Branch::of_node(
            scene.cell,
            scene.lists[0].clone().close(false, &scene.sources),
        );
        let kept = branch(cell, cut, inner.clone(), around(0), &scene.sources);
        assert_eq!(kept.cell, scene.cell);
        let divided = branch(cell, cut, inner, around(1), &scene.sources);
        assert_eq!(divided.cell, cell);
        assert!(matches!(*divided.node, Node::Cut(_)));
    }
}
