//! Operands in one place, evaluated in groups: the boundary of a group's result is smaller than all its
//! operands' boundaries, which all cross each other.

use std::sync::atomic::Ordering;
use std::sync::Arc;

use super::choice::{Round, MAX_OPERANDS_AT_ONCE};
use super::descend::{both_in_turn, Descent, Visited};
use super::state::{worth, State, States};
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::merge::expression::{Expression, Parted};
use crate::tree::node::Branch;

/// The most levels of groups: 2³² operands in halves, and as many levels of alternating operations.
const MAX_DEPTH: u32 = 64;

impl Descent<'_> {
    /// The expression split in two, if results of operations need not be reduced.
    pub(super) fn parted(&self, expression: &Expression) -> Option<Parted> {
        expression.parted().filter(|_| self.share)
    }

    /// The result in a cell from two groups of operands.
    pub(super) fn grouped(
        &self,
        cell: Cell,
        parted: Parted,
        states: States,
        depth: u32,
    ) -> Visited {
        poll();
        if parted.takes_one_by_one() {
            return self.folded(cell, parted, states, depth);
        }
        let total: usize = states.iter().map(|s| s.1.len_in(&cell)).sum();
        let operands = parted.operands();
        let [first, second] = parted.divide(states);
        let [left, right] = parted.halves;
        let results = both_in_turn(
            worth(total),
            || self.group(cell, &left, first, depth),
            || self.group(cell, &right, second, depth),
        )?;
        let [ours, theirs] = &operands;
        self.united(cell, parted.whole, results.into(), [ours, theirs])
    }

    /// The result in a cell, one operand after another; a loop, since there may be many.
    fn folded(&self, cell: Cell, mut parted: Parted, states: States, depth: u32) -> Visited {
        let mut first = states;
        let mut steps = Vec::new();
        let left = loop {
            poll();
            let last;
            [first, last] = parted.divide(first);
            let [left, right] = parted.halves;
            steps.push((right, last, parted.whole));
            let next = left.parted().filter(Parted::takes_one_by_one);
            match next.filter(|_| first.len() > MAX_OPERANDS_AT_ONCE) {
                Some(next) => parted = next,
                None => break left,
            }
        };
        let mut ours = left.operands();
        let mut result = self.group(cell, &left, first, depth)?;
        for (right, last, whole) in steps.into_iter().rev() {
            let theirs = right.operands();
            let next = self.group(cell, &right, last, depth)?;
            result = self.united(cell, whole, [result, next], [&ours, &theirs])?;
            ours.extend(theirs);
        }
        Ok(result)
    }

    /// The result in a cell from two groups' results.
    fn united(
        &self,
        cell: Cell,
        whole: Expression,
        results: [Branch; 2],
        operands: [&[u32]; 2],
    ) -> Visited {
        let states: States = (0..).zip(results.map(State::Tree)).collect();
        let pair = Self::new(self.sources, self.rule, self.share, states.len());
        let result = pair.cell(cell, Arc::new(whole), states, Round::OF_GROUPS);
        self.counters.add(&pair.counters);
        for (group, overlaps) in operands.iter().zip(&pair.overlaps) {
            if overlaps.load(Ordering::Relaxed) {
                self.note_overlaps(group)?;
            }
        }
        result
    }

    /// The result of a group of operands in a cell.
    fn group(&self, cell: Cell, expression: &Expression, states: States, depth: u32) -> Visited {
        if states.len() > MAX_OPERANDS_AT_ONCE
            && depth < MAX_DEPTH
            && let Some(parted) = expression.parted()
        {
            return self.grouped(cell, parted, states, depth + 1);
        }
        let residual = expression.residual(|_| None);
        self.resolve(cell, residual, states, Round::START)
    }
}
