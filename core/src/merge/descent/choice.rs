//! The choice of cells: some are for a kernel, and others are halved.

use super::state::{within, State, States};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::merge::kernels::general::MAX_OPERANDS;

/// Lists that together hold at most this many elements are worked on by a leaf kernel, whatever
/// their position: local trees cost the square, smaller cells cost halvings and cut faces.
pub const MAX_ELEMENTS_PER_LEAF: usize = 32;

/// States that together hold at most this many are tried without local trees: in larger leaves the
/// next operation has more to do again, in smaller ones more faces are cut by walls.
const MAX_ELEMENTS_GENERAL: usize = 64;

/// The same, where no state is an operation's result, and the next operation may never come.
///
/// More are halved, to be shared among threads.
const MAX_ELEMENTS_FRESH: usize = 1 << 13;

/// The same, for results of groups of operands in one place: the only step that takes one of them
/// apart is the one that combines it with the other. Where they were halved, walls that both have
/// would meet in special ways in a larger cell, and each wall makes parts of faces.
const MAX_ELEMENTS_OF_GROUPS: usize = 1 << 13;

/// States that together hold at most this many for each operand are worked on at once, if all faces
/// are perpendicular to axes.
///
/// Few operands are as a rule a step of a chain: the next one cuts the leaf up again.
pub const MAX_ORTHOGONAL_PER_OPERAND: usize = 32;

/// More elements than this are halved even so, to be shared among threads.
pub const MAX_ELEMENTS_ORTHOGONAL: usize = 512;

/// Three halvings are one round of the axes.
const HALVINGS_PER_ROUND: u32 = 3;

/// A round should leave at most so many eighths of the elements in a part.
///
/// Of a surface it leaves a quarter, and half of what runs along a line. Layers thinner than the cell
/// stay together: halved on, each is listed in ever more cells, before one is as small as they are thin.
const MAX_EIGHTHS_LEFT: usize = 5;

/// Longer lists than this are halved on, stuck or not: the kernel's memory grows with their square, to
/// a gigabyte for two fans of needles around one corner.
///
/// Of many needles near a line nearly all run through each of the small cells along it, so halving them
/// on costs far more than the kernel.
pub const MAX_ELEMENTS_STUCK: usize = 1 << 14;

/// A kernel that refused a cell is asked again when one in so many elements is left: from `MAX_ELEMENTS_FRESH`
/// down to `MAX_ELEMENTS_PER_LEAF` at most three times in vain.
const RETRIED_IF_ONE_IN: usize = 8;

/// As few operands as this can be evaluated in groups, where no kernel takes all of them.
pub const MIN_OPERANDS_GROUPED: usize = 3;

/// A group of so few operands is evaluated at once: each partial result is a boundary to be cut
/// again, and of more operands most of what crosses lies inside of others.
pub const MAX_OPERANDS_AT_ONCE: usize = 8;

/// Operands in one place from which groups are evaluated before a kernel is asked: what is left
/// of a group's boundaries is less than all of them, and all of them cross each other.
const GROUPS_FROM: usize = 16;

/// The element count in the current round of three halvings.
#[derive(Clone, Copy)]
pub struct Round {
    depth: u32,
    start: usize,
    stuck: bool,
    /// The number of elements that the kernel for general position refused.
    refused: usize,
    /// True if operands are results of groups that the kernel did not refuse yet.
    groups: bool,
    /// True if the other half of the cell that was halved last is empty.
    empty_sibling: bool,
}

impl Round {
    /// Nothing was halved yet.
    pub const START: Self = Self {
        depth: 0,
        start: usize::MAX / 8,
        stuck: false,
        refused: usize::MAX,
        groups: false,
        empty_sibling: false,
    };

    /// The same, where operands are results of groups that were in one place.
    pub const OF_GROUPS: Self = Self {
        groups: true,
        ..Self::START
    };

    /// After a halving of a cell with so many elements that may separate them.
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

    /// After a halving of a cell with so many elements that only cuts off what is empty: it tells
    /// nothing about how the rest separates, if that is small.
    #[must_use]
    pub fn next_with_empty_sibling(self, cell: &Cell, extent: i64, total: usize) -> Self {
        let round = if fills(extent, cell) {
            self.next(total)
        } else {
            self
        };
        Self {
            empty_sibling: true,
            ..round
        }
    }

    /// Return whether the other half of the cell that was halved last is empty.
    pub fn has_empty_sibling(&self) -> bool {
        self.empty_sibling
    }

    /// Return whether the last three halvings left most elements in one part.
    pub fn kept_most(&self) -> bool {
        self.stuck
    }

    /// After the halvings that lead from a cell with so many elements, in a box so long, to one around
    /// all of them, or to the first one in between in which halving seems stuck; with that cell.
    pub fn inward(self, cell: Cell, inner: &Cell, extent: i64, total: usize) -> (Cell, Self) {
        let (mut cell, mut round) = (cell, self);
        while let Some(cut) = cell.cut().filter(|_| cell != *inner) {
            round = round.next_with_empty_sibling(&cell, extent, total);
            let lower = cell.half(cut, Half::Minus);
            cell = if lower.holds(inner) {
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

    /// The kernel for general position refused so many elements.
    pub fn refused(&mut self, total: usize) {
        if self.groups && total > MAX_ELEMENTS_GENERAL {
            self.groups = false;
        } else {
            self.refused = total;
        }
    }

    /// Return whether halving has stopped separating: a round kept most elements, and nearly all of
    /// them reach out of the cell, as around a vertex of many faces.
    pub fn is_stuck(&self, cell: &Cell, states: &States, total: usize) -> bool {
        let reaching = |s: &(u32, State)| match &s.1 {
            State::List(list) => list.reaching_out(cell),
            State::Constant(_) | State::Tree(_) | State::Bins(_) => 0,
        };
        self.stuck && states.iter().map(reaching).sum::<usize>() * 8 > total * 7
    }

    /// Return whether a cell of so many elements is for the kernel for general position.
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

/// The longest side of the box around what operands have in the cell; `None` if they have nothing.
pub fn extent(cell: &Cell, states: &States) -> Option<i64> {
    let present = states.iter().filter(|s| s.1.has_surface());
    let boxes = present.map(|s| within(cell, s.1.bounds(cell)));
    let joined = |[low, high]: [Lattice; 2], [least, most]: [Lattice; 2]| {
        [
            each_axis(|i| low[i].min(least[i])),
            each_axis(|i| high[i].max(most[i])),
        ]
    };
    boxes.reduce(joined).map(longest)
}

/// Return whether an occupied box is as large as its cell: it spans half of the cell or more, or is one
/// lattice point.
pub fn fills(extent: i64, cell: &Cell) -> bool {
    extent == 0 || 2 * extent >= longest([*cell.low(), cell.high()])
}

fn longest([low, high]: [Lattice; 2]) -> i64 {
    let [x, y, z] = each_axis(|i| high[i] - low[i]);
    x.max(y).max(z)
}

/// Return whether so many operands are in one place that no kernel should be asked.
pub fn is_overcrowded(cell: &Cell, states: &States) -> bool {
    states.len() >= GROUPS_FROM && is_crowded(cell, states)
}

/// Return whether operands are in one place: one of three pairs of them has boxes that overlap in
/// the cell, as far as a sample shows.
pub fn is_crowded(cell: &Cell, states: &States) -> bool {
    if states.len() < MIN_OPERANDS_GROUPED {
        return false;
    }
    let some = states.iter().step_by(states.len().div_ceil(MAX_OPERANDS));
    let boxes: Vec<[Lattice; 2]> = some.map(|s| within(cell, s.1.bounds(cell))).collect();
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
        // Beyond the cell it does not matter.
        assert!(!crowded(&Cell::around(&[0; 3], &[1; 3]), 3));
    }

    #[test]
    fn cells_are_filled_by_what_spans_half_of_them_or_is_one_point() {
        let states: States = vec![(0, State::Tree(cuboid([0; 3], [8; 3]).root().clone()))];
        let filled = |low: i64, high: i64| {
            let cell = Cell::around(&[low; 3], &[high; 3]);
            extent(&cell, &states).is_some_and(|extent| fills(extent, &cell))
        };
        assert!(filled(0, 15));
        assert!(!filled(0, 63));
        // A corner alone.
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
        round.refused(8);
        assert!(!suits(round));
    }
}
