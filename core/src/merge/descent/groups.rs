//! Evaluates many overlapping operands in groups: the boundary of a group's result is smaller than the
//! boundaries of its operands, which all cross each other.

use std::sync::atomic::Ordering;
use std::sync::Arc;

use super::choice::{Round, MAX_OPERANDS_AT_ONCE};
use super::descend::{both_in_turn, CellResult, Descent};
use super::state::{work_size, State, States};
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::merge::expression::{Expression, SplitExpression};
use crate::tree::node::Branch;

/// The most nested levels of groups: 32 for halving 2³² operands, and 32 for changes of the operation.
const MAX_DEPTH: u32 = 64;

impl Descent<'_> {
    /// Splits the expression into two groups of operands; `None` if it cannot be split, or if this descent
    /// unites a solid with itself.
    pub(super) fn split(&self, expression: &Expression) -> Option<SplitExpression> {
        expression.split().filter(|_| self.shares_boundaries)
    }

    /// Returns the result in a cell by evaluating two groups of operands and combining their results; `depth`
    /// is the number of enclosing groups.
    pub(super) fn grouped(
        &self,
        cell: Cell,
        parted: SplitExpression,
        states: States,
        depth: u32,
    ) -> CellResult {
        poll();
        if parted.takes_one_by_one() {
            return self.folded(cell, parted, states, depth);
        }
        let total: usize = states.iter().map(|s| s.1.len_in(&cell)).sum();
        let operands = parted.operands();
        let [first, second] = parted.divide(states);
        let [left, right] = parted.halves;
        let results = both_in_turn(
            work_size(total),
            || self.group(cell, &left, first, depth),
            || self.group(cell, &right, second, depth),
        )?;
        let [ours, theirs] = &operands;
        self.united(cell, parted.whole, results.into(), [ours, theirs])
    }

    /// Returns the result of a symmetric difference in a cell by adding its operands one after another; a
    /// loop, because there may be too many for recursion.
    fn folded(
        &self,
        cell: Cell,
        mut parted: SplitExpression,
        states: States,
        depth: u32,
    ) -> CellResult {
        let mut first = states;
        let mut steps = Vec::new();
        let left = loop {
            poll();
            let last;
            [first, last] = parted.divide(first);
            let [left, right] = parted.halves;
            steps.push((right, last, parted.whole));
            let next = left.split().filter(SplitExpression::takes_one_by_one);
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

    /// Combines the results of two groups in a cell by the expression `whole`; `operands` are the operands of
    /// each group.
    fn united(
        &self,
        cell: Cell,
        whole: Expression,
        results: [Branch; 2],
        operands: [&[u32]; 2],
    ) -> CellResult {
        let states: States = (0..).zip(results.map(State::Tree)).collect();
        let pair = Self::new(
            self.sources,
            self.rule,
            self.shares_boundaries,
            states.len(),
        );
        let result = pair.visit_cell(cell, Arc::new(whole), states, Round::OF_GROUPS);
        self.counters.add(&pair.counters);
        for (group, overlaps) in operands.iter().zip(&pair.overlaps) {
            if overlaps.load(Ordering::Relaxed) {
                self.record_overlaps(group)?;
            }
        }
        result
    }

    /// Returns the result of one group of operands in a cell; splits it further if it has more than
    /// `MAX_OPERANDS_AT_ONCE` operands.
    fn group(&self, cell: Cell, expression: &Expression, states: States, depth: u32) -> CellResult {
        if states.len() > MAX_OPERANDS_AT_ONCE
            && depth < MAX_DEPTH
            && let Some(parted) = expression.split()
        {
            return self.grouped(cell, parted, states, depth + 1);
        }
        let residual = expression.residual(|_| None);
        self.resolve(cell, residual, states, Round::START)
    }
}
