//! A tree of boxes around triangles, and a search for the pairs of triangles of two such trees that may meet.
//!
//! Boxes are sorted along a space-filling curve and grouped by four, level by level. At the leaves, slabs in
//! six diagonal directions separate triangles whose boxes meet.
//!
//! # Source
//! Morton 1966 (the curve).

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::slabs::Slabs;
use crate::geometry::doubles::{Point, Triangle};
use crate::interrupt::{poll, spend};
use crate::mesh::tasks::{each, WorkSize};

/// The number of children of a node of the tree.
const CHILDREN_PER_NODE: usize = 4;

/// The number of steps of the space-filling curve along each axis, numbered by ten bits.
const CURVE_STEPS: u16 = 1 << 10;

/// The least number of pairs of nodes into which the search is split, to share it among threads.
const MIN_TASKS: usize = 64;

/// The least number of pairs in a full block, which is processed at once.
const PAIRS_PER_BLOCK: usize = 1 << 9;

/// A box in single precision, rounded outwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundedBox {
    pub(super) low: [f32; 3],
    pub(super) high: [f32; 3],
}

/// The boxes of triangles in the order of a space-filling curve, and levels of boxes around every four boxes
/// of the level below.
#[derive(Debug)]
pub(super) struct BoxTree {
    bounds: Vec<RoundedBox>,
    slabs: Vec<Slabs>,
    /// The levels from the lowest to the root.
    levels: Vec<Vec<RoundedBox>>,
}

/// A node of a tree of boxes: its level, and its index in this level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Node {
    level: usize,
    index: usize,
}

/// Returns a number in single precision that is at most x: the margin exceeds the rounding.
#[allow(clippy::cast_possible_truncation, reason = "rounded down on purpose")]
fn rounded_down(x: f64) -> f32 {
    (x - x.abs() * f64::from(f32::EPSILON)) as f32
}

fn rounded_up(x: f64) -> f32 {
    -rounded_down(-x)
}

impl RoundedBox {
    const NOTHING: Self = Self {
        low: [f32::INFINITY; 3],
        high: [f32::NEG_INFINITY; 3],
    };

    /// Returns the box from a low to a high corner, rounded outwards.
    pub(super) fn between(low: &Point, high: &Point) -> Self {
        Self {
            low: low.map(rounded_down),
            high: high.map(rounded_up),
        }
    }

    /// Returns the box around a triangle, rounded outwards.
    pub(super) fn around([a, b, c]: &Triangle) -> Self {
        let low = each_axis(|i| a[i].min(b[i]).min(c[i]));
        Self::between(&low, &each_axis(|i| a[i].max(b[i]).max(c[i])))
    }

    #[inline]
    pub(super) fn meets(&self, other: &Self) -> bool {
        let along = |i: usize| self.low[i] <= other.high[i] && other.low[i] <= self.high[i];
        along(0) & along(1) & along(2)
    }

    fn joined(&self, other: &Self) -> Self {
        Self {
            low: each_axis(|i| self.low[i].min(other.low[i])),
            high: each_axis(|i| self.high[i].max(other.high[i])),
        }
    }

    fn around_all(boxes: &[Self]) -> Self {
        boxes.iter().fold(Self::NOTHING, |all, one| all.joined(one))
    }

    fn extent_sum(&self) -> f32 {
        (0..3).map(|i| self.high[i] - self.low[i]).sum()
    }
}

/// Returns the indices of triangles in the order of their boxes' centres along a space-filling curve.
pub(super) fn order(triangles: &[Triangle]) -> Vec<u32> {
    let bounds: Vec<RoundedBox> = triangles.iter().map(RoundedBox::around).collect();
    let all = RoundedBox::around_all(&bounds);
    let scale = each_axis(|i| {
        let width = 2.0 * (all.high[i] - all.low[i]);
        f32::from(CURVE_STEPS - 1) / width.max(f32::MIN_POSITIVE)
    });
    spend(triangles.len());
    let number = |b: &RoundedBox| {
        let step = |i: usize| (b.low[i] + b.high[i] - 2.0 * all.low[i]) * scale[i];
        (0..3).fold(0, |all, i| all | spread_bits(along_curve(step(i))) << i)
    };
    let mut keys: Vec<u64> = (0u64..)
        .zip(&bounds)
        .map(|(i, b)| u64::from(number(b)) << 32 | i)
        .collect();
    keys.sort_unstable();
    keys.into_iter().map(low_half).collect()
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a step along the curve, clamped"
)]
fn along_curve(step: f32) -> u32 {
    (step as u32).min(u32::from(CURVE_STEPS) - 1)
}

#[allow(clippy::cast_possible_truncation, reason = "the lower half is meant")]
fn low_half(key: u64) -> u32 {
    key as u32
}

/// Spreads the ten low bits of x, with two zero bits after each.
fn spread_bits(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

impl BoxTree {
    /// Makes the tree of triangles, which must be sorted along a space-filling curve.
    pub(super) fn new(triangles: &[Triangle]) -> Self {
        spend(triangles.len());
        let bounds: Vec<RoundedBox> = triangles.iter().map(RoundedBox::around).collect();
        let mut levels = Vec::new();
        let mut below = &bounds;
        while below.len() > 1 || levels.is_empty() {
            levels.push(
                below
                    .chunks(CHILDREN_PER_NODE)
                    .map(RoundedBox::around_all)
                    .collect(),
            );
            below = &levels[levels.len() - 1];
        }
        Self {
            bounds,
            slabs: Vec::new(),
            levels,
        }
    }

    /// Adds the slabs of the triangles (the intervals that they cover along diagonals), which a search for
    /// pairs needs; both trees must use the same origin.
    pub(super) fn with_slabs(self, triangles: &[Triangle], origin: &Point) -> Self {
        let slabs = triangles.iter().map(|t| Slabs::of(t, origin)).collect();
        Self { slabs, ..self }
    }

    fn root(&self) -> Node {
        let level = self.levels.len() - 1;
        Node { level, index: 0 }
    }

    fn at(&self, node: Node) -> &RoundedBox {
        &self.levels[node.level][node.index]
    }

    fn children(&self, node: Node) -> impl Iterator<Item = Node> + use<> {
        let level = node.level - 1;
        let end = (CHILDREN_PER_NODE * (node.index + 1)).min(self.levels[level].len());
        (CHILDREN_PER_NODE * node.index..end).map(move |index| Node { level, index })
    }

    /// Returns the indices of the triangles' boxes in a node of the lowest level.
    fn leaves(&self, node: Node) -> std::ops::Range<usize> {
        CHILDREN_PER_NODE * node.index
            ..(CHILDREN_PER_NODE * (node.index + 1)).min(self.bounds.len())
    }

    /// Calls `visit` with the index of each triangle's box that meets `bounds`.
    pub(super) fn each_meeting(&self, bounds: &RoundedBox, mut visit: impl FnMut(usize)) {
        let mut open = if self.bounds.is_empty() {
            Vec::new()
        } else {
            vec![self.root()]
        };
        while let Some(node) = open.pop() {
            poll();
            if node.level == 0 {
                let met = |i: &usize| self.bounds[*i].meets(bounds);
                self.leaves(node).filter(met).for_each(&mut visit);
            } else {
                let met = |n: &Node| self.at(*n).meets(bounds);
                open.extend(self.children(node).filter(met));
            }
        }
    }

    /// Calls `visit` with blocks of pairs of triangles, one index in each tree, whose boxes and slabs meet; if
    /// the trees are one and the same, each pair of different triangles occurs once. Returns the results in an
    /// order that depends only on the trees, or the first error, which ends a task early.
    pub(super) fn each_block<T: Send, E: Send>(
        &self,
        other: &Self,
        work_size: WorkSize,
        visit: impl Fn(&[[u32; 2]]) -> Result<T, E> + Sync + Send,
    ) -> Result<Vec<T>, E> {
        if self.bounds.is_empty() || other.bounds.is_empty() {
            return Ok(Vec::new());
        }
        let found = each(work_size, self.start_pairs(other), |start| {
            self.blocks_below(other, start, &visit)
        });
        let found: Result<Vec<Vec<T>>, E> = found.into_iter().collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// Returns pairs of nodes that contain all pairs of triangles to be found: at least `MIN_TASKS`, if the
    /// trees have so many pairs.
    fn start_pairs(&self, other: &Self) -> Vec<[Node; 2]> {
        let mut open = vec![[self.root(), other.root()]];
        while open.len() < MIN_TASKS && open.iter().any(|p| p[0].level + p[1].level > 0) {
            let mut next = Vec::with_capacity(CHILDREN_PER_NODE * open.len());
            for pair in open {
                self.push_child_pairs(other, pair, &mut next);
            }
            if next.is_empty() {
                return next;
            }
            open = next;
        }
        open
    }

    /// Replaces the larger node of a pair by its children, and adds to `found` the pairs whose boxes meet.
    fn push_child_pairs(&self, other: &Self, [a, b]: [Node; 2], found: &mut Vec<[Node; 2]>) {
        let (ours, theirs) = (self.at(a), other.at(b));
        if a.level == 0 && b.level == 0 {
            found.push([a, b]);
        } else if self.is_one_node(other, [a, b]) {
            for (i, child) in self.children(a).enumerate() {
                let others = self.children(a).skip(i);
                let met = others.filter(|n| self.at(child).meets(self.at(*n)));
                found.extend(met.map(|n| [child, n]));
            }
        } else if b.level > a.level || b.level == a.level && theirs.extent_sum() > ours.extent_sum()
        {
            let met = other.children(b).filter(|n| ours.meets(other.at(*n)));
            found.extend(met.map(|n| [a, n]));
        } else {
            let met = self.children(a).filter(|n| theirs.meets(self.at(*n)));
            found.extend(met.map(|n| [n, b]));
        }
    }

    /// Returns true if both nodes are the same node of one tree.
    fn is_one_node(&self, other: &Self, [a, b]: [Node; 2]) -> bool {
        std::ptr::eq(self, other) && a == b
    }

    fn blocks_below<T, E>(
        &self,
        other: &Self,
        start: [Node; 2],
        visit: impl Fn(&[[u32; 2]]) -> Result<T, E>,
    ) -> Result<Vec<T>, E> {
        let (mut open, mut pairs, mut found) = (vec![start], Vec::new(), Vec::new());
        while let Some([a, b]) = open.pop() {
            poll();
            if a.level == 0 && b.level == 0 {
                self.pairs_of_leaves(other, [a, b], &mut pairs);
            } else {
                self.push_child_pairs(other, [a, b], &mut open);
            }
            if pairs.len() >= PAIRS_PER_BLOCK || open.is_empty() {
                found.push(visit(&pairs)?);
                pairs.clear();
            }
        }
        Ok(found)
    }

    fn pairs_of_leaves(&self, other: &Self, [a, b]: [Node; 2], found: &mut Vec<[u32; 2]>) {
        let theirs = other.at(b);
        let is_one = self.is_one_node(other, [a, b]);
        for i in self.leaves(a).filter(|i| self.bounds[*i].meets(theirs)) {
            for j in other.leaves(b).filter(|j| !is_one || i < *j) {
                if self.bounds[i].meets(&other.bounds[j]) && !self.slabs[i].miss(&other.slabs[j]) {
                    found.push([as_number(i), as_number(j)]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(count: u32, seed: u32) -> Vec<Triangle> {
        let next = |k: u32| f64::from((seed + k).wrapping_mul(2_654_435_761) >> 20);
        let triangle = |t: u32| {
            let at = [next(12 * t), next(12 * t + 1), next(12 * t + 2)];
            [0, 1, 2].map(|c| each_axis(|i| at[i] + next(12 * t + 3 + 3 * c + as_number(i)) / 9.0))
        };
        let given: Vec<Triangle> = (0..count).map(triangle).collect();
        order(&given).iter().map(|i| given[*i as usize]).collect()
    }

    #[test]
    fn pairs_are_those_that_comparing_all_finds() {
        for (count, others) in [(0, 3), (1, 1), (3, 70), (200, 300)] {
            let (a, b) = (triangles(count, 1), triangles(others, 77));
            let [ours, theirs] = [&a, &b].map(|t| BoxTree::new(t).with_slabs(t, &[0.0; 3]));
            let visit = |pairs: &[[u32; 2]]| Ok::<_, ()>(pairs.to_vec());
            let found = ours.each_block(&theirs, WorkSize::Nothing, visit);
            let mut found = found.expect("no error").concat();
            found.sort_unstable();
            let met = |i: usize, j: usize| {
                let boxes = ours.bounds[i].meets(&theirs.bounds[j]);
                boxes && !ours.slabs[i].miss(&theirs.slabs[j])
            };
            let all = (0..a.len()).flat_map(|i| (0..b.len()).map(move |j| (i, j)));
            let all = all.filter(|(i, j)| met(*i, *j));
            let all: Vec<[u32; 2]> = all.map(|(i, j)| [as_number(i), as_number(j)]).collect();
            assert_eq!(found, all);
        }
    }

    #[test]
    fn a_tree_compared_with_itself_has_each_pair_once() {
        for count in [1, 4, 5, 90, 400] {
            let tree = triangles(count, 5);
            let tree = BoxTree::new(&tree).with_slabs(&tree, &[0.0; 3]);
            let visit = |pairs: &[[u32; 2]]| Ok::<_, ()>(pairs.to_vec());
            let found = tree.each_block(&tree, WorkSize::Nothing, visit);
            let mut found = found.expect("no error").concat();
            for pair in &mut found {
                pair.sort_unstable();
            }
            found.sort_unstable();
            let met = |i: usize, j: usize| {
                tree.bounds[i].meets(&tree.bounds[j]) && !tree.slabs[i].miss(&tree.slabs[j])
            };
            let count = count as usize;
            let all = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
            let all = all.filter(|(i, j)| met(*i, *j));
            let all: Vec<[u32; 2]> = all.map(|(i, j)| [as_number(i), as_number(j)]).collect();
            assert_eq!(found, all);
        }
    }

    #[test]
    fn boxes_are_rounded_outwards() {
        let x = f64::from(1 << 30) + 0.5;
        let bounds = RoundedBox::between(&[x; 3], &[x; 3]);
        assert!(f64::from(bounds.low[0]) < x && f64::from(bounds.high[0]) > x);
    }
}
