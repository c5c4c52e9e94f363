//! Evaluates a whole expression in one descent through cells; operands without surface in a cell drop out.
//!
//! # Source
//! Naylor, Amanatides, Thibault 1990 (merging: a leaf decides, a common cut is descended). The page
//! `docs/design/descent.md` describes the algorithm.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

use rayon::prelude::*;

use super::choice::{
    extent, is_crowded, is_overcrowded, Round, MAX_ELEMENTS_ORTHOGONAL, MAX_ELEMENTS_PER_LEAF,
    MAX_ELEMENTS_STUCK, MAX_ORTHOGONAL_PER_OPERAND,
};
use super::counters::Counters;
use super::join;
use super::state::{
    find, has_constant, has_surface, smaller_cell, work_size, State, States, BINS_FROM,
};
use super::twins::{self, TwinTable};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::cell::{Cell, Cut};
use crate::geometry::side::Half;
use crate::interrupt::{carried, poll};
use crate::merge::expression::Expression;
use crate::merge::kernels::general::GeneralPosition;
use crate::merge::kernels::orthogonal::Orthogonal;
use crate::merge::kernels::problem::{CellProblem, Kernel, ListedOperand};
use crate::merge::kernels::ALL;
use crate::merge::lists::list::Sources;
use crate::merge::residual::Residual;
use crate::merge::rule::Rule;
use crate::mesh::tasks::{both, in_pool, WorkSize};
use crate::tree::node::Branch;

/// The reason why a descent ended before all cells were visited.
pub(super) enum DescentEnd {
    /// An error occurred.
    Failed(Error),
    /// The operand with this index overlaps itself and has to be united with itself first.
    Overlap(u32),
    /// The descent had already ended in an earlier cell.
    Cancelled,
}

impl From<Error> for DescentEnd {
    fn from(error: Error) -> Self {
        Self::Failed(error)
    }
}

/// The result in a cell, or the reason why the descent ended.
pub(super) type CellResult = std::result::Result<Branch, DescentEnd>;

/// Computes two results, in parallel if `work_size` says so; the second is cancelled if the first ends the
/// descent before the second begins.
pub(super) fn both_in_turn(
    work_size: WorkSize,
    first: impl FnOnce() -> CellResult + Send,
    second: impl FnOnce() -> CellResult + Send,
) -> std::result::Result<(Branch, Branch), DescentEnd> {
    let ended = AtomicBool::new(false);
    let first = || {
        let visited = first();
        ended.store(visited.is_err(), Ordering::Relaxed);
        visited
    };
    let second = || {
        if ended.load(Ordering::Relaxed) {
            return Err(DescentEnd::Cancelled);
        }
        second()
    };
    let (first, second) = both(work_size, first, second);
    Ok((first?, second?))
}

/// The data of one descent, shared by all its cells.
#[derive(Debug)]
pub struct Descent<'a> {
    /// The meshes and half-spaces of all operands.
    pub sources: &'a Sources,
    /// The rule that says which winding numbers of an operand are inside.
    pub rule: Rule,
    /// True if a cell in which one operand alone matters takes its boundary unchanged; false if every cell
    /// with surface is solved, to unite a solid with itself.
    pub shares_boundaries: bool,
    /// Counts of the cells visited, faces sorted and cells solved by kernels.
    pub counters: Counters,
    /// For each operand, whether a visited cell showed that it, or the result of a group of operands with it,
    /// overlaps itself.
    pub overlaps: Vec<AtomicBool>,
    /// The indices of the operands not known to be free of self-overlaps. If one overlaps itself, the caller
    /// unites it with itself and evaluates the expression again.
    pub doubted: Vec<usize>,
    /// True if the descent ends as soon as an operand not known to be free of self-overlaps turns out to
    /// overlap itself.
    ends_at_first: bool,
}

impl<'a> Descent<'a> {
    /// Makes a descent over this many operands; `shares_boundaries` says whether a single operand's boundary
    /// is taken unchanged.
    pub fn new(sources: &'a Sources, rule: Rule, shares_boundaries: bool, operands: usize) -> Self {
        Self {
            sources,
            rule,
            shares_boundaries,
            counters: Counters::default(),
            overlaps: (0..operands).map(|_| AtomicBool::new(false)).collect(),
            doubted: Vec::new(),
            ends_at_first: false,
        }
    }

    /// Sets the operands not known to be free of self-overlaps; if `ends_at_first` is true, the first of
    /// them, in the order of cells, that turns out to overlap itself ends the descent.
    #[must_use]
    pub fn with_doubted(self, doubted: Vec<usize>, ends_at_first: bool) -> Self {
        Self {
            doubted,
            ends_at_first,
            ..self
        }
    }

    /// Returns true if all operands that were not known to be free of self-overlaps now are known to overlap
    /// themselves, so that the result will not be used; always false if the first of them ends the descent.
    fn is_moot(&self) -> bool {
        let seen = |k: &usize| self.overlaps[*k].load(Ordering::Relaxed);
        // An impatient descent needs the first such operand in the order of cells, whatever other threads
        // found.
        !self.ends_at_first && !self.doubted.is_empty() && self.doubted.iter().all(seen)
    }

    /// Returns the indices of the operands that overlap themselves in a visited cell, or that are in a group
    /// whose result does.
    pub fn overlapping(&self) -> Vec<usize> {
        let seen = |k: &usize| self.overlaps[*k].load(Ordering::Relaxed);
        (0..self.overlaps.len()).filter(seen).collect()
    }

    /// Evaluates an expression over solids, given by their root branches, and returns the root of the result.
    pub fn run(&self, expression: Expression, roots: Vec<Branch>) -> Result<Branch> {
        let cell = roots.iter().map(|r| r.cell).reduce(|a, b| a.join(&b));
        let Some(cell) = cell else {
            let text = "the expression has no operands";
            return Err(Error::new(ErrorKind::Shape, text));
        };
        let mut scratch = Vec::new();
        let outside = expression.value(
            |k| self.rule.inside(roots[k as usize].outside),
            &mut scratch,
        );
        let mut states: States = (0u32..).zip(roots.into_iter().map(State::Tree)).collect();
        for (_, state) in &mut states {
            state.settle(&cell);
        }
        let round = Round::START;
        let residual = if self.shares_boundaries || has_constant(&states) {
            self.residual(&expression, &states)
        } else {
            Residual::Open(Arc::new(expression))
        };
        let branch = match self.resolve(cell, residual, states, round) {
            Ok(branch) => branch,
            Err(DescentEnd::Failed(error)) => return Err(error),
            Err(DescentEnd::Overlap(operand)) => return Ok(self.placeholder_for(operand, cell)),
            Err(DescentEnd::Cancelled) => {
                return Err(Error::internal("an end with nothing before it"))
            }
        };
        Ok(match branch.constant() {
            Some(w) => Branch::uniform(branch.cell, w),
            None => join::surround_cell(cell, branch, i32::from(outside)),
        })
    }

    /// Returns a placeholder for the result of a descent that ended because `operand` overlaps itself; marks
    /// only this operand as overlapping, because what other threads found depends on timing.
    fn placeholder_for(&self, operand: u32, cell: Cell) -> Branch {
        for (k, seen) in (0..).zip(&self.overlaps) {
            seen.store(k == operand, Ordering::Relaxed);
        }
        Branch::uniform(cell, 0)
    }

    fn residual(&self, expression: &Expression, states: &States) -> Residual {
        expression.residual(|k| match find(states, k) {
            Some(State::Constant(w)) => Some(self.rule.inside(*w)),
            _ => None,
        })
    }

    /// Visits a half of a cell in which several operands matter, and returns the result there.
    pub(super) fn visit_cell(
        &self,
        cell: Cell,
        expression: Arc<Expression>,
        mut states: States,
        round: Round,
    ) -> CellResult {
        poll();
        if self.is_moot() {
            return Ok(Branch::uniform(cell, 0));
        }
        self.counters.cells.fetch_add(1, Ordering::Relaxed);
        for (_, state) in &mut states {
            state.settle(&cell);
        }
        let residual = if has_constant(&states) {
            self.residual(&expression, &states)
        } else {
            Residual::Open(expression)
        };
        self.resolve(cell, residual, states, round)
    }

    pub(super) fn resolve(
        &self,
        cell: Cell,
        residual: Residual,
        mut states: States,
        round: Round,
    ) -> CellResult {
        let residual = match residual {
            Residual::Open(open) => match self.twins_if_shared(|| twins::of_one_node(&states)) {
                Some(firsts) => open.where_equal(|k| firsts.of(k)),
                None => Residual::Open(open),
            },
            known => known,
        };
        match residual {
            Residual::Constant(v) => Ok(Branch::uniform(cell, i32::from(v))),
            Residual::Literal(k, negate) if self.shares_boundaries => {
                let at = states.iter().position(|s| s.0 == k).unwrap_or(0);
                Ok(states.swap_remove(at).1.shared(cell, negate, self.sources))
            }
            Residual::Literal(..) => {
                Err(Error::internal("a literal where nothing is shared").into())
            }
            Residual::Open(expression) => {
                let support = expression.operands();
                states.retain(|s| support.binary_search(&s.0).is_ok());
                self.open_cell(cell, expression, states, round)
            }
        }
    }

    /// Returns the operands that are equal in a cell, if a single operand's boundary may be taken unchanged;
    /// otherwise `None`.
    fn twins_if_shared(&self, found: impl FnOnce() -> Option<TwinTable>) -> Option<TwinTable> {
        self.shares_boundaries.then(found).flatten()
    }

    /// Solves or divides a cell in which the expression depends on several operands.
    fn open_cell(
        &self,
        cell: Cell,
        expression: Arc<Expression>,
        states: States,
        round: Round,
    ) -> CellResult {
        if let Some(inner) = smaller_cell(&cell, &states, round.has_empty_sibling()) {
            return self.visit_inner_cell(cell, inner, expression, states, round);
        }
        let opening: usize = states.iter().map(|s| s.1.len_to_open(&cell)).sum();
        let states = self.with_open_leaves(&cell, states, opening);
        self.record_overlaps_at_corner(&states)?;
        let total: usize = states.iter().map(|s| s.1.len_in(&cell)).sum();
        let mut round = round;
        let stuck = round.is_stuck(&cell, &states, total);
        let listed = states.iter().all(|s| matches!(s.1, State::List(_)));
        let small = total <= MAX_ELEMENTS_PER_LEAF || stuck && total <= MAX_ELEMENTS_STUCK;
        let Some(cut) = cell.cut().filter(|_| !(listed && small)) else {
            let solved = self.solve_with(cell, &expression, &states, total, &ALL)?;
            return Ok(solved.ok_or_else(|| Error::internal("a small cell that no kernel takes"))?);
        };
        let flat = || states.iter().all(|s| s.1.is_orthogonal(self.sources));
        if total <= (MAX_ORTHOGONAL_PER_OPERAND * states.len()).min(MAX_ELEMENTS_ORTHOGONAL)
            && flat()
            && let Some(branch) =
                self.solve_with(cell, &expression, &states, total, &[&Orthogonal])?
        {
            return Ok(branch);
        }
        if is_overcrowded(&cell, &states)
            && let Some(parted) = self.split(&expression)
        {
            return self.grouped(cell, parted, states, 0);
        }
        // No level of bins separated these faces, so halving will not separate them, either.
        let long = listed && opening >= BINS_FROM;
        if long || listed && stuck || round.suits_general_position(&states, total) {
            if let Some(branch) =
                self.solve_with(cell, &expression, &states, total, &[&GeneralPosition])?
            {
                return Ok(branch);
            }
            round.record_refusal(total);
            if is_crowded(&cell, &states)
                && let Some(parted) = self.split(&expression)
            {
                return self.grouped(cell, parted, states, 0);
            }
        }
        self.visit_halves(cell, cut, &expression, states, round, total)
    }

    /// Returns the result in a cell by visiting the smaller cell `inner`, which contains all operands'
    /// boundaries.
    fn visit_inner_cell(
        &self,
        cell: Cell,
        mut inner: Cell,
        expression: Arc<Expression>,
        mut states: States,
        mut round: Round,
    ) -> CellResult {
        if let Some(extent) = extent(&cell, &states).filter(|_| round.has_empty_sibling()) {
            let total: usize = states.iter().map(|s| s.1.len_in(&cell)).sum();
            (inner, round) = round.halved_to(cell, &inner, extent, total);
        }
        let outside = self.value_outside(&cell, &inner, &expression, &states);
        for (_, state) in &mut states {
            state.shrink(&inner, self.sources);
        }
        let branch = self.visit_cell(inner, expression, states, round)?;
        Ok(match branch.constant() {
            Some(w) if (w > 0) == outside => Branch::uniform(cell, w),
            _ => join::surround_cell(inner, branch, i32::from(outside)),
        })
    }

    /// Returns whether the expression's value is inside in `cell` outside the smaller cell `inner`, which
    /// contains all operands' boundaries.
    fn value_outside(
        &self,
        cell: &Cell,
        inner: &Cell,
        expression: &Expression,
        states: &States,
    ) -> bool {
        let outside = |k: u32| match find(states, k) {
            Some(State::Tree(branch)) => self.rule.inside(branch.outside),
            Some(State::List(list)) => {
                self.rule
                    .inside(list.winding_number_outside(cell, inner, self.sources))
            }
            _ => false,
        };
        expression.value(outside, &mut Vec::new())
    }

    /// Records that operands overlap themselves. If `ends_at_first` is set and one of these operands was
    /// doubted (not known to be free of self-overlaps), returns the error that ends the descent.
    pub(super) fn record_overlaps(&self, operands: &[u32]) -> std::result::Result<(), DescentEnd> {
        for k in operands {
            self.overlaps[*k as usize].store(true, Ordering::Relaxed);
        }
        let is_doubted = |k: &&u32| self.doubted.contains(&(**k as usize));
        match operands.iter().find(is_doubted) {
            Some(k) if self.ends_at_first => Err(DescentEnd::Overlap(*k)),
            _ => Ok(()),
        }
    }

    /// Records as overlapping the operands whose winding number at the cell's corner is neither 0 nor 1.
    fn record_overlaps_at_corner(&self, states: &States) -> std::result::Result<(), DescentEnd> {
        let winds = |s: &&(u32, State)| match &s.1 {
            State::List(list) => !(0..=1).contains(&list.corner),
            State::Constant(_) | State::Tree(_) | State::Bins(_) => false,
        };
        let found: Vec<u32> = states.iter().filter(winds).map(|s| s.0).collect();
        self.record_overlaps(&found)
    }

    /// Opens each operand's deferred leaf of exactly this cell as a list or as bins; `opening` is the number
    /// of elements (faces or parts of faces) in these leaves.
    fn with_open_leaves(&self, cell: &Cell, states: States, opening: usize) -> States {
        let open =
            |(k, state): (u32, State)| (k, state.opened(cell, self.sources, &self.counters.binned));
        if in_pool() && opening >= 8 * BINS_FROM {
            return states.into_par_iter().map(carried(open)).collect();
        }
        states.into_iter().map(open).collect()
    }

    fn visit_halves(
        &self,
        cell: Cell,
        cut: Cut,
        expression: &Arc<Expression>,
        states: States,
        round: Round,
        total: usize,
    ) -> CellResult {
        let halved = states.iter().map(|s| s.1.listed_len()).sum::<usize>();
        self.counters
            .halved
            .fetch_add(halved as u64, Ordering::Relaxed);
        let mut below = Vec::with_capacity(states.len());
        let mut above = Vec::with_capacity(states.len());
        for (k, state) in states {
            let (minus, plus) = state.divided(&cell, cut, self.sources);
            below.push((k, minus));
            above.push((k, plus));
        }
        let remaining = match [&below, &above].map(has_surface) {
            [true, true] => None,
            [true, false] => extent(&cell, &below),
            [false, _] => extent(&cell, &above),
        };
        let round = remaining.map_or_else(
            || round.next(total),
            |extent| round.next_with_empty_sibling(&cell, extent, total),
        );
        let visit = |half: Half, states: States| {
            self.visit_cell(cell.half(cut, half), Arc::clone(expression), states, round)
        };
        let (minus, plus) = both_in_turn(
            work_size(total),
            || visit(Half::Minus, below),
            || visit(Half::Plus, above),
        )?;
        Ok(join::branch(cell, cut, minus, plus, self.sources))
    }

    /// Lists the elements (faces or parts of faces) of all operands in the cell; `None` if an operand's
    /// elements cannot be listed.
    fn list_operands<'s>(&self, cell: &Cell, states: &'s States) -> Option<Vec<ListedOperand<'s>>> {
        let listed = |(number, state): &'s (u32, State)| {
            let (number, list) = (*number, state.list_in(cell, self.sources)?);
            Some(ListedOperand { number, list })
        };
        states.iter().map(listed).collect()
    }

    /// Returns the result of the first kernel that does not refuse the cell, after equal operands became one.
    /// `None` if all kernels refuse, or if an operand's elements (faces or parts of faces) cannot be listed.
    fn solve_with(
        &self,
        cell: Cell,
        expression: &Expression,
        states: &States,
        total: usize,
        kernels: &[&dyn Kernel],
    ) -> std::result::Result<Option<Branch>, DescentEnd> {
        let Some(mut operands) = self.list_operands(&cell, states) else {
            return Ok(None);
        };
        let Some(firsts) = self.twins_if_shared(|| twins::of_one_boundary(&operands, self.sources))
        else {
            return self.run_kernels(kernels, cell, expression, operands, total);
        };
        match expression.where_equal(|k| firsts.of(k)) {
            Residual::Constant(v) => Ok(Some(Branch::uniform(cell, i32::from(v)))),
            Residual::Literal(k, negate) => {
                let alone = find(states, k).cloned();
                Ok(alone.map(|state| state.shared(cell, negate, self.sources)))
            }
            Residual::Open(left) => {
                let support = left.operands();
                operands.retain(|l| support.binary_search(&l.number).is_ok());
                self.run_kernels(kernels, cell, &left, operands, total)
            }
        }
    }

    /// Returns the result, for listed operands, of the first kernel that does not refuse the cell; `None` if
    /// all do.
    fn run_kernels(
        &self,
        kernels: &[&dyn Kernel],
        cell: Cell,
        expression: &Expression,
        operands: Vec<ListedOperand>,
        total: usize,
    ) -> std::result::Result<Option<Branch>, DescentEnd> {
        let problem = CellProblem {
            cell: &cell,
            expression,
            rule: self.rule,
            operands,
            sources: self.sources,
        };
        let mut overlapping = Vec::new();
        let node = problem.solve_by(kernels, &self.counters.kernels, &mut overlapping);
        self.record_overlaps(&overlapping)?;
        Ok(node.map(|node| {
            self.counters.count_leaf(total);
            Branch::of_node(cell, node)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_whole;
    use crate::geometry::plane::Lattice;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both, cuboid, cuboids, pyramid};
    use crate::tree::node::Node;
    use crate::tree::solid::Solid;

    fn run(
        solids: &[Solid; 2],
        combined: fn(Vec<u32>) -> Term,
    ) -> (Branch, [(&'static str, u64); 5]) {
        let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
        let descent = Descent::new(&sources, Rule::Positive, true, 2);
        let roots = solids.iter().map(|s| s.root().clone()).collect();
        let root = descent.run(both(combined), roots).expect("not stopped");
        (root, descent.counters.named())
    }

    #[test]
    fn what_is_far_apart_is_shared_and_costs_no_kernel() {
        // Each row has more faces than a kernel solves in any case.
        let row = |first: i64| cuboids((0..4).map(|i| [1, 3].map(|c| [first + c + 4 * i; 3])));
        let solids = [row(0), row(64)];
        let (common, _) = run(&solids, Term::And);
        assert_eq!(common.constant(), Some(0));
        let (union, counters) = run(&solids, Term::Or);
        assert!(matches!(*union.node, Node::Cut(_)));
        assert_eq!(counters[3], ("kernels", 0));
    }

    #[test]
    fn what_is_the_same_costs_no_kernel() {
        let row = |count: i64| cuboids((0..count).map(|i| [1, 3].map(|c| [c + 4 * i; 3])));
        let few = run(&[row(40), row(41)], Term::Xor);
        let many = run(&[row(400), row(401)], Term::Xor);
        assert!(many.1[3].1 <= few.1[3].1 + 2, "{:?} {:?}", many.1, few.1);
    }

    #[test]
    fn what_crosses_is_for_a_kernel() {
        let solids = [cuboid([1; 3], [9; 3]), cuboid([5; 3], [13; 3])];
        let (_, counters) = run(&solids, Term::Or);
        assert!(counters[3].0 == "kernels" && counters[3].1 >= 1);
    }

    #[test]
    fn around_a_shared_corner_halving_soon_ends() {
        // Above the apex, halving only cuts off empty space.
        let cone = |width: f64, depth: f64| {
            let corner = |k: u32| {
                let (y, x) = (std::f64::consts::TAU * f64::from(k) / 24.0).sin_cos();
                [width * x, depth * y, -1e12].map(|c| as_whole(c.round()))
            };
            pyramid([0; 3], &(0..24).map(corner).collect::<Vec<_>>())
        };
        let solids = [cone(9e11, 5e11), cone(5e11, 9e11)];
        let (_, counters) = run(&solids, Term::And);
        assert!(counters[0].1 < 200, "{} cells", counters[0].1);
    }

    #[test]
    fn a_descent_ends_where_all_that_is_doubted_overlaps_itself() {
        // Each operand is a row of pairs of boxes that cross each other.
        let pair = |low: Lattice| [0, 2].map(|by| [0, 5].map(|size| low.map(|x| x + by + size)));
        let row = |first: i64| cuboids((0..64).flat_map(|i| pair([first + 9 * i, first, first])));
        let solids = [row(0), row(1)];
        let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
        let cells = |doubted: Vec<usize>| {
            let descent =
                Descent::new(&sources, Rule::Positive, true, 2).with_doubted(doubted, false);
            let roots = solids.iter().map(|s| s.root().clone()).collect();
            descent.run(both(Term::Or), roots).expect("not stopped");
            assert_eq!(descent.overlapping(), [0, 1]);
            descent.counters.named()[0].1
        };
        assert!(4 * cells(vec![0, 1]) < cells(Vec::new()));
    }

    #[test]
    fn the_first_that_overlaps_itself_ends_an_impatient_descent() {
        // No faces of nested boxes meet, so the winding number at a corner of a cell reveals the overlap.
        let smaller_cell = |first: i64| {
            let shells = (0..8).map(move |i| [[first + i; 3], [first + 99 - i; 3]]);
            cuboids(shells)
        };
        let solids = [smaller_cell(0), smaller_cell(50)];
        let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
        let seen = || {
            let descent = Descent::new(&sources, Rule::Positive, true, 2);
            let descent = descent.with_doubted(vec![0, 1], true);
            let roots = solids.iter().map(|s| s.root().clone()).collect();
            let root = descent.run(both(Term::Or), roots).expect("not stopped");
            assert_eq!(root.constant(), Some(0));
            descent.overlapping()
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
        assert_eq!(seen(), [0]);
        assert_eq!(pool.expect("two threads").install(seen), [0]);
    }
}
