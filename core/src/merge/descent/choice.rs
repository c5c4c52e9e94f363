//! Decides which cells of the descent a kernel solves, and which are halved.

use super::state::{clipped_to_cell, State, States};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::merge::kernels::general::MAX_OPERANDS;

/// The most elements (faces or parts of faces) of a cell that kernels solve in any case. The cost of local
/// trees is the square of this number; smaller cells cost more halvings and cut faces.
pub const MAX_ELEMENTS_PER_LEAF: usize = 32;

/// The most elements (faces or parts of faces) of a cell for which the kernel for general position is asked.
/// With a larger number the next operation has to process larger leaves again; with a smaller one, cell walls
/// cut more faces.
const MAX_ELEMENTS_GENERAL: usize = 64;

/// The most elements (faces or parts of faces) of a cell for which the kernel for general position is asked
/// if no operand is the result of an operation; then there may be no next operation, either.
///
/// Cells with more elements are halved, so that threads share the work.
const MAX_ELEMENTS_FRESH: usize = 1 << 13;

/// The most elements (faces or parts of faces) of a cell for which the kernel for general position is asked
/// if the operands are results of groups of overlapping operands. No later step divides these results again.
/// If their cells had been halved before, faces cut at the same walls would meet in degenerate positions.
const MAX_ELEMENTS_OF_GROUPS: usize = 1 << 13;

/// The most elements (faces or parts of faces) for each operand of a cell that the orthogonal kernel solves,
/// if all faces are perpendicular to axes.
///
/// An expression of few operands is usually a step of a chain, and the next step cuts the leaf again; so its
/// leaves should be small.
pub const MAX_ORTHOGONAL_PER_OPERAND: usize = 32;

/// The most elements (faces or parts of faces) of a cell for which the orthogonal kernel is asked, whatever
/// the number of operands; larger cells are halved, so that threads share the work.
pub const MAX_ELEMENTS_ORTHOGONAL: usize = 512;

/// The number of halvings in a round: one for each axis.
const HALVINGS_PER_ROUND: u32 = 3;

/// The most eighths of the elements (faces or parts of faces) that a round of three halvings may leave in one
/// part; if more are left, halving separates too little.
///
/// A round leaves a quarter of a surface, and half of the elements along a line. Layers thinner than the cell
/// stay together: halving would list each of them in ever more cells, until a cell is as small as the layers
/// are thin.
const MAX_EIGHTHS_LEFT: usize = 5;

/// The most elements (faces or parts of faces) of a cell that kernels solve because halving no longer
/// separates them. The kernel's memory grows with the square of their number, to a gigabyte for two fans of
/// needles (long thin triangles) around one corner.
///
/// Nearly all of many needles near a line run through each of the small cells along it, so halving costs far
/// more than the kernel.
pub const MAX_ELEMENTS_STUCK: usize = 1 << 14;

/// After the kernel for general position refused a cell, it is asked again about a smaller cell only when at
/// most one in this many of the elements (faces or parts of faces) is left. So from `MAX_ELEMENTS_FRESH` down
/// to `MAX_ELEMENTS_PER_LEAF` elements at most three requests are in vain.
const RETRIED_IF_ONE_IN: usize = 8;

/// The least number of operands that can be evaluated in groups, if no kernel solves all of them at once.
pub const MIN_OPERANDS_GROUPED: usize = 3;

/// The most operands that are evaluated at once, not in groups. Smaller groups give more partial results,
/// which are cut again; in larger groups most faces that cross lie inside other operands.
pub const MAX_OPERANDS_AT_ONCE: usize = 8;

/// The number of operands with overlapping boxes from which on groups are evaluated before a kernel is asked:
/// the boundary of a group's result is smaller than the operands' boundaries, which all cross each other.
const GROUPS_FROM: usize = 16;

/// A record of halving a cell: how well the current and the last round of three halvings separate elements
/// (faces or parts of faces), and which kernels have refused.
#[derive(Clone, Copy)]
pub struct Round {
    depth: u32,
    start: usize,
    stuck: bool,
    /// The number of elements (faces or parts of faces) of the last cell that the kernel for general position
    /// refused.
    refused: usize,
    /// True if the operands are results of groups, and the kernel for general position has not refused them
    /// yet.
    groups: bool,
    /// True if the other half of the last halved cell is empty.
    empty_sibling: bool,
}

impl Round {
    /// The record before the first halving.
    pub const START: Self = Self {
        depth: 0,
        start: usize::MAX / 8,
        stuck: false,
        refused: usize::MAX,
        groups: false,
        empty_sibling: false,
    };

    /// The record before the first halving if the operands are results of groups of overlapping operands.
    pub const OF_GROUPS: Self = Self {
        groups: true,
        ..Self::START
    };

    /// Returns this record, updated for one more halving, of a cell with `total` elements (faces or parts of
    /// faces).
    #[must_use]
    pub fn next(self, total: usize) -> Self {
        if self.depth + 1 < HALVINGS_PER_ROUND {
            return Self {
                depth: self.depth + 1,
                empty_sibling: false,
                ..self
            };
        }
        Self {
            depth: 0,
            start: total,
            stuck: total * 8 > self.start * MAX_EIGHTHS_LEFT,
            empty_sibling: false,
            ..self
        }
    }

    /// Returns this record, updated for a halving in which one half of `cell` is empty and the other half has
    /// all `total` elements (faces or parts of faces). The halving counts as separating nothing only if the
    /// elements' box, whose longest side is `extent`, spans half of the cell or is a point: otherwise smaller
    /// cells may still separate the elements.
    #[must_use]
    pub fn next_with_empty_sibling(self, cell: &Cell, extent: i64, total: usize) -> Self {
        let round = if fills_half_of(extent, cell) {
            self.next(total)
        } else {
            self
        };
        Self {
            empty_sibling: true,
            ..round
        }
    }

    /// Returns true if the other half of the last halved cell is empty.
    pub fn has_empty_sibling(&self) -> bool {
        self.empty_sibling
    }

    /// Returns true if the last full round of three halvings left more than `MAX_EIGHTHS_LEFT` eighths of the
    /// elements (faces or parts of faces) in one part.
    pub fn separates_badly(&self) -> bool {
        self.stuck
    }

    /// Performs the halvings from `cell` to `inner`, which contains all elements (faces or parts of faces),
    /// and ends early at a cell in which halving seems stuck. Returns the last cell and the updated record of
    /// halvings. The cell has `total` elements in a box whose longest side is `extent`.
    pub fn halved_to(self, cell: Cell, inner: &Cell, extent: i64, total: usize) -> (Cell, Self) {
        let (mut cell, mut round) = (cell, self);
        while let Some(cut) = cell.cut().filter(|_| cell != *inner) {
            round = round.next_with_empty_sibling(&cell, extent, total);
            let lower = cell.half(cut, Half::Minus);
            cell = if lower.contains(inner) {
                lower
            } else {
                cell.half(cut, Half::Plus)
            };
            if round.stuck {
                break;
            }
        }
        let empty_sibling = false;
        (
            cell,
            Self {
                empty_sibling,
                ..round
            },
        )
    }

    /// Records that the kernel for general position refused a cell with `total` elements (faces or parts of
    /// faces).
    pub fn record_refusal(&mut self, total: usize) {
        if self.groups && total > MAX_ELEMENTS_GENERAL {
            self.groups = false;
        } else {
            self.refused = total;
        }
    }

    /// Returns true if halving no longer separates elements (faces or parts of faces): the last round left
    /// most of them in one part, and more than 7/8 of the `total` reach out of the cell, as around a vertex
    /// of many faces.
    pub fn is_stuck(&self, cell: &Cell, states: &States, total: usize) -> bool {
        let reaching = |s: &(u32, State)| match &s.1 {
            State::List(list) => list.count_reaching_out(cell),
            State::Constant(_) | State::Tree(_) | State::Bins(_) => 0,
        };
        self.stuck && states.iter().map(reaching).sum::<usize>() * 8 > total * 7
    }

    /// Returns true if the kernel for general position should be asked about a cell with `total` elements
    /// (faces or parts of faces): it has at most `MAX_OPERANDS` operands, at most `MAX_ELEMENTS_FRESH`,
    /// `MAX_ELEMENTS_OF_GROUPS` or `MAX_ELEMENTS_GENERAL` elements, depending on where the operands come
    /// from, and at most 1/`RETRIED_IF_ONE_IN` of the elements of the cell that the kernel last refused.
    pub fn suits_general_position(&self, states: &States, total: usize) -> bool {
        if states.len() > MAX_OPERANDS || total > self.refused / RETRIED_IF_ONE_IN {
            return false;
        }
        if states.iter().all(|s| s.1.is_given()) {
            return total <= MAX_ELEMENTS_FRESH;
        }
        if self.groups {
            return total <= MAX_ELEMENTS_OF_GROUPS && states.iter().all(|s| s.1.is_undivided());
        }
        total <= MAX_ELEMENTS_GENERAL && states.iter().all(|s| matches!(s.1, State::List(_)))
    }
}

/// Returns the longest side, in lattice steps, of the box around all operands' surfaces in the cell; `None`
/// if no operand has surface there.
pub fn extent(cell: &Cell, states: &States) -> Option<i64> {
    let present = states.iter().filter(|s| s.1.has_surface());
    let boxes = present.map(|s| clipped_to_cell(cell, s.1.bounds(cell)));
    let joined = |[low, high]: [Lattice; 2], [least, most]: [Lattice; 2]| {
        [
            each_axis(|i| low[i].min(least[i])),
            each_axis(|i| high[i].max(most[i])),
        ]
    };
    boxes.reduce(joined).map(longest)
}

/// Returns true if a box whose longest side is `extent` spans at least half of the longest side of its cell,
/// or is a single lattice point.
pub fn fills_half_of(extent: i64, cell: &Cell) -> bool {
    extent == 0 || 2 * extent >= longest([*cell.low(), cell.high()])
}

fn longest([low, high]: [Lattice; 2]) -> i64 {
    let [x, y, z] = each_axis(|i| high[i] - low[i]);
    x.max(y).max(z)
}

/// Returns true if the cell has at least `GROUPS_FROM` operands, whose boxes overlap so often that groups of
/// operands are evaluated before a kernel is asked.
pub fn is_overcrowded(cell: &Cell, states: &States) -> bool {
    states.len() >= GROUPS_FROM && is_crowded(cell, states)
}

/// Returns true if at least `MIN_OPERANDS_GROUPED` operands matter in the cell, and more than a third of the
/// pairs in a sample of them have boxes that overlap there.
pub fn is_crowded(cell: &Cell, states: &States) -> bool {
    if states.len() < MIN_OPERANDS_GROUPED {
        return false;
    }
    let some = states.iter().step_by(states.len().div_ceil(MAX_OPERANDS));
    let boxes: Vec<[Lattice; 2]> = some
        .map(|s| clipped_to_cell(cell, s.1.bounds(cell)))
        .collect();
    let overlap =
        |[a, b]: &[Lattice; 2], [c, d]: &[Lattice; 2]| (0..3).all(|i| a[i] <= d[i] && c[i] <= b[i]);
    let partners = |i: usize| boxes[..i].iter().filter(|b| overlap(b, &boxes[i])).count();
    let overlaps: usize = (1..boxes.len()).map(partners).sum();
    overlaps * 6 > boxes.len() * (boxes.len() - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{crossing, cuboid};

    #[test]
    fn operands_are_in_one_place_if_their_boxes_overlap_in_the_cell() {
        let cell = Cell::around(&[0; 3], &[63; 3]);
        let crowded = |cell: &Cell, step: i64| {
            let solid = |k: i64| cuboid([1 + step * k; 3], [9 + step * k; 3]);
            let tree = |k: i64| State::Tree(solid(k).root().clone());
            let states: States = (0..).zip((0..5).map(tree)).collect();
            is_crowded(cell, &states)
        };
        assert!(crowded(&cell, 1));
        assert!(!crowded(&cell, 10));
        // Boxes that overlap outside the cell do not count.
        assert!(!crowded(&Cell::around(&[0; 3], &[1; 3]), 3));
    }

    #[test]
    fn cells_are_filled_by_what_spans_half_of_them_or_is_one_point() {
        let states: States = vec![(0, State::Tree(cuboid([0; 3], [8; 3]).root().clone()))];
        let filled = |low: i64, high: i64| {
            let cell = Cell::around(&[low; 3], &[high; 3]);
            extent(&cell, &states).is_some_and(|extent| fills_half_of(extent, &cell))
        };
        assert!(filled(0, 15));
        assert!(!filled(0, 63));
        // Only a corner of the box lies in the cell.
        assert!(filled(8, 15));
    }

    #[test]
    fn three_halvings_that_keep_most_elements_are_stuck() {
        let after = |round: Round, total| (0..HALVINGS_PER_ROUND).fold(round, |r, _| r.next(total));
        let first = after(Round::START, 100);
        assert!(!first.stuck);
        assert!(after(first, 70).stuck);
        assert!(!after(first, 50).stuck);
    }

    #[test]
    fn a_kernel_that_refused_is_asked_again_when_few_elements_are_left() {
        let scene = crossing();
        let listed = scene.lists.iter().cloned().map(State::List);
        let states: States = (0..).zip(listed).collect();
        let suits = |round: Round| round.suits_general_position(&states, 8);
        let mut round = Round::START;
        assert!(suits(round));
        round.record_refusal(8);
        assert!(!suits(round));
    }
}
