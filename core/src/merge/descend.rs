//! One descent for a whole expression: operands are folded away cell by cell.
//!
//! # Source
//! Naylor, Amanatides, Thibault 1990 (merging: a leaf decides, a common cut is descended);
//! design review F12 (residual expressions), F14 (one hierarchy for all solids).

use std::borrow::Cow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::Arc;

use rayon::prelude::*;

use super::bins::Bins;
use super::expression::{Expression, Residual};
use super::join;
use super::leaf::{self, Rule};
use super::list::{List, PartRecord, Record, Sources};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::cell::{Cell, Cut};
use crate::mesh::tasks::{both, in_pool};
use crate::tree::node::{Branch, Node, Work};

/// Lists that together hold at most this many elements are worked on by a leaf kernel, whatever
/// their position: local trees cost the square, smaller cells cost halvings and cut faces.
pub const LEAF: usize = 32;

/// Lists that together hold at most this many are tried without local trees: in larger leaves the
/// next operation has more to do again, in smaller ones more faces are cut by walls.
const GENERAL: usize = 64;

/// The same, where no list is an operation's result, and the next operation may never come.
const FRESH: usize = 4 * GENERAL;

/// States that together hold at most this many for each operand are worked on at once, if all faces
/// are perpendicular to axes.
///
/// Few operands are as a rule a step of a chain: the next one cuts the leaf up again.
const ORTHOGONAL: usize = 32;

/// More elements than this are halved even so, to be shared among threads.
const CROWD: usize = 512;

/// Lists at least this long are worth a task of their own.
const TASK: usize = 512;

/// Three halvings, one round of the axes, should leave at most 7/8 of the elements in a child.
const ROUND: u32 = 3;

/// Longer lists than this are halved on, stuck or not: the kernel's cost grows with their square.
const STUCK: usize = 2048;

/// Deferred leaves at least this long are sorted into bins instead of being halved.
const MANY: usize = 1024;

/// With so few entries in a cell the bins give way to a list.
const FEW: usize = 2 * LEAF;

/// Counts of what an evaluation did.
#[derive(Debug, Default)]
pub struct Counters {
    /// Cells visited.
    pub cells: AtomicU64,
    /// Faces sorted into bins.
    pub binned: AtomicU64,
    /// Elements of lists that were halved, once for each halving.
    pub halved: AtomicU64,
    /// Cells worked on by the leaf kernel.
    pub leaves: AtomicU64,
    /// Elements in these.
    pub leaf_elements: AtomicU64,
}

impl Counters {
    /// The counts with their names.
    pub fn named(&self) -> [(&'static str, u64); 5] {
        [
            ("cells", &self.cells),
            ("binned", &self.binned),
            ("halved", &self.halved),
            ("kernels", &self.leaves),
            ("kernel_elements", &self.leaf_elements),
        ]
        .map(|(name, count)| (name, count.load(Ordering::Relaxed)))
    }
}

/// What all cells of an evaluation share.
#[derive(Debug)]
pub struct Descent<'a> {
    /// The sources of all operands.
    pub sources: &'a Sources,
    /// Which winding numbers of an operand are inside.
    pub rule: Rule,
    /// Whether a single operand's boundary is taken as it is, or made the reduced boundary.
    pub share: bool,
    /// Set from outside to stop.
    pub cancel: &'a AtomicBool,
    /// What was done.
    pub counters: Counters,
    /// For each operand whether a visited cell showed that it overlaps itself.
    pub overlaps: Vec<AtomicBool>,
}

/// What is known of an operand in a cell.
#[derive(Clone, Debug)]
enum State {
    /// One winding number.
    Constant(i32),
    /// A subtree whose cell lies in the cell.
    Tree(Branch),
    /// The elements that meet the cell.
    List(List),
    /// Many faces, of which those of the cell are found by its place.
    Bins(Arc<Bins>),
}

type States = Vec<(u32, State)>;

/// How the element count fared in the current round of three halvings.
#[derive(Clone, Copy)]
struct Round {
    depth: u32,
    start: usize,
    stuck: bool,
}

impl Round {
    fn next(self, total: usize) -> Self {
        if self.depth + 1 < ROUND {
            return Self {
                depth: self.depth + 1,
                ..self
            };
        }
        Self {
            depth: 0,
            start: total,
            stuck: total * 8 > self.start * 7,
        }
    }
}

impl<'a> Descent<'a> {
    /// A descent over this many operands.
    pub fn new(
        sources: &'a Sources,
        rule: Rule,
        share: bool,
        cancel: &'a AtomicBool,
        operands: usize,
    ) -> Self {
        Self {
            sources,
            rule,
            share,
            cancel,
            counters: Counters::default(),
            overlaps: (0..operands).map(|_| AtomicBool::new(false)).collect(),
        }
    }

    /// The operands that a visited cell showed to overlap themselves.
    pub fn overlapping(&self) -> Vec<usize> {
        let seen = |k: &usize| self.overlaps[*k].load(Ordering::Relaxed);
        (0..self.overlaps.len()).filter(seen).collect()
    }

    /// The value of an expression over solids, from their root branches.
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
        let round = Round {
            depth: 0,
            start: usize::MAX / 8,
            stuck: false,
        };
        let residual = if self.share || has_constant(&states) {
            self.residual(&expression, &states)
        } else {
            Residual::Open(Arc::new(expression))
        };
        let branch = self.resolve(cell, residual, states, round)?;
        Ok(match branch.constant() {
            Some(w) => Branch::uniform(branch.cell, w),
            None => Branch {
                outside: i32::from(outside),
                ..branch
            },
        })
    }

    fn residual(&self, expression: &Expression, states: &States) -> Residual {
        expression.residual(|k| match find(states, k) {
            Some(State::Constant(w)) => Some(self.rule.inside(*w)),
            _ => None,
        })
    }

    /// A cell below one in which several operands mattered.
    fn cell(
        &self,
        cell: Cell,
        expression: Arc<Expression>,
        mut states: States,
        round: Round,
    ) -> Result<Branch> {
        if self.cancel.load(Ordering::Relaxed) {
            return Err(Error::new(ErrorKind::Cancelled, "stopped"));
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

    fn resolve(
        &self,
        cell: Cell,
        residual: Residual,
        mut states: States,
        round: Round,
    ) -> Result<Branch> {
        match residual {
            Residual::Constant(v) => Ok(Branch::uniform(cell, i32::from(v))),
            Residual::Literal(k, negate) if self.share => {
                let at = states.iter().position(|s| s.0 == k).unwrap_or(0);
                Ok(states.swap_remove(at).1.shared(cell, negate, self.sources))
            }
            Residual::Literal(..) => Err(Error::internal("a literal where nothing is shared")),
            Residual::Open(expression) => {
                let support = expression.operands();
                states.retain(|s| support.binary_search(&s.0).is_ok());
                self.open_cell(cell, expression, states, round)
            }
        }
    }

    /// A cell in which the expression still depends on several operands.
    fn open_cell(
        &self,
        cell: Cell,
        expression: Arc<Expression>,
        states: States,
        round: Round,
    ) -> Result<Branch> {
        if let Some(inner) = nested(&cell, &states) {
            let outside = self.value_outside(&expression, &states);
            let branch = self.cell(inner, expression, states, round)?;
            return Ok(match branch.constant() {
                Some(w) if (w > 0) == outside => Branch::uniform(cell, w),
                _ => Branch {
                    outside: i32::from(outside),
                    ..branch
                },
            });
        }
        let opening: usize = states.iter().map(|s| s.1.len_to_open(&cell)).sum();
        let states = self.opened(&cell, states);
        let total: usize = states.iter().map(|s| s.1.len_in(&cell)).sum();
        if total <= (ORTHOGONAL * states.len()).min(CROWD) {
            if let Some(branch) = self.among_orthogonal(cell, &expression, &states, total) {
                return Ok(branch);
            }
        }
        let listed = states.iter().all(|s| matches!(s.1, State::List(_)));
        let stuck = listed && is_stuck(&cell, &states, round, total);
        let small = total <= LEAF || stuck && total <= STUCK;
        let Some(cut) = cell.cut().filter(|_| !(listed && small)) else {
            return Ok(self.leaf(cell, &expression, states, total));
        };
        // No level of bins suited these faces, so halving will not separate them either.
        let long = opening >= MANY;
        if listed && (long || stuck || total <= most_in_general_position(&states)) {
            if let Some(branch) = self.in_general_position(cell, &expression, &states, total) {
                return Ok(branch);
            }
        }
        self.halves(cell, cut, &expression, states, round.next(total), total)
    }

    /// The states with the leaves of this cell opened.
    fn opened(&self, cell: &Cell, states: States) -> States {
        let open = |(k, state): (u32, State)| (k, state.opened(cell, self));
        let heavy = |s: &(u32, State)| matches!(&s.1, State::Tree(b) if b.cell == *cell);
        let total = || {
            states
                .iter()
                .filter(|s| heavy(s))
                .map(|s| s.1.len_in(cell))
                .sum::<usize>()
        };
        if in_pool() && total() >= 8 * MANY {
            return states.into_par_iter().map(open).collect();
        }
        states.into_iter().map(open).collect()
    }

    fn value_outside(&self, expression: &Expression, states: &States) -> bool {
        let outside = |k: u32| match find(states, k) {
            Some(State::Tree(branch)) => self.rule.inside(branch.outside),
            _ => false,
        };
        expression.value(outside, &mut Vec::new())
    }

    fn halves(
        &self,
        cell: Cell,
        cut: Cut,
        expression: &Arc<Expression>,
        states: States,
        round: Round,
        total: usize,
    ) -> Result<Branch> {
        let halved = states.iter().map(|s| s.1.listed()).sum::<usize>();
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
        let half = |plus: bool, states: States| {
            self.cell(cell.half(cut, plus), Arc::clone(expression), states, round)
        };
        let (minus, plus) = both(total >= TASK, || half(false, below), || half(true, above));
        Ok(join::branch(cell, cut, minus?, plus?, self.sources))
    }

    fn count_leaf(&self, total: usize) {
        self.counters.leaves.fetch_add(1, Ordering::Relaxed);
        self.counters
            .leaf_elements
            .fetch_add(total as u64, Ordering::Relaxed);
    }

    /// The result in a cell of a few more elements, if nothing there is special.
    fn in_general_position(
        &self,
        cell: Cell,
        expression: &Expression,
        states: &States,
        total: usize,
    ) -> Option<Branch> {
        let lists: Vec<(u32, &List)> = states
            .iter()
            .filter_map(|(k, s)| match s {
                State::List(list) => Some((*k, list)),
                State::Constant(_) | State::Tree(_) | State::Bins(_) => None,
            })
            .collect();
        let node = leaf::in_general_position(&cell, expression, self.rule, &lists, self.sources)?;
        self.count_leaf(total);
        Some(branch_of(cell, node))
    }

    /// The result in a cell of which all faces are perpendicular to axes.
    fn among_orthogonal(
        &self,
        cell: Cell,
        expression: &Expression,
        states: &States,
        total: usize,
    ) -> Option<Branch> {
        if !states.iter().all(|s| s.1.is_orthogonal(self.sources)) {
            return None;
        }
        let lists = states.iter().map(|s| s.1.list_in(&cell, self.sources));
        let lists: Vec<Cow<List>> = lists.collect::<Option<_>>()?;
        let named = states.iter().map(|s| s.0).zip(&lists);
        let lists: Vec<(u32, &List)> = named.map(|(k, list)| (k, &**list)).collect();
        let node = leaf::among_orthogonal(&cell, expression, &lists, self.sources)?;
        self.count_leaf(total);
        Some(branch_of(cell, node))
    }

    fn leaf(&self, cell: Cell, expression: &Expression, states: States, total: usize) -> Branch {
        self.count_leaf(total);
        let lists = states
            .into_iter()
            .filter_map(|(k, s)| match s {
                State::List(list) => Some((k, list)),
                State::Constant(_) | State::Tree(_) | State::Bins(_) => None,
            })
            .collect();
        let node = leaf::evaluate(&cell, expression, self.rule, lists, self.sources, |k| {
            self.overlaps[k as usize].store(true, Ordering::Relaxed);
        });
        branch_of(cell, node)
    }
}

/// The longest lists that are tried without local trees.
fn most_in_general_position(states: &States) -> usize {
    let worked = |s: &(u32, State)| matches!(&s.1, State::List(list) if list.work() != Work::Given);
    if states.iter().any(worked) {
        GENERAL
    } else {
        FRESH
    }
}

fn branch_of(cell: Cell, node: Node) -> Branch {
    match node {
        Node::Leaf(w) => Branch::uniform(cell, w),
        node => Branch {
            cell,
            outside: 0,
            complement: false,
            node: Arc::new(node),
        },
    }
}

/// Whether halving has stopped separating: a round kept nearly all elements, and nearly all of them
/// reach out of the cell, as around a vertex of many faces.
fn is_stuck(cell: &Cell, states: &States, round: Round, total: usize) -> bool {
    let reaching = |s: &(u32, State)| match &s.1 {
        State::List(list) => list.reaching_out(cell),
        State::Constant(_) | State::Tree(_) | State::Bins(_) => 0,
    };
    round.stuck && states.iter().map(reaching).sum::<usize>() * 8 > total * 7
}

fn find(states: &States, operand: u32) -> Option<&State> {
    let at = states.binary_search_by_key(&operand, |s| s.0).ok()?;
    Some(&states[at].1)
}

/// The smallest cell around all operands' boundaries, if it is smaller than `cell`.
fn nested(cell: &Cell, states: &States) -> Option<Cell> {
    let mut inner: Option<Cell> = None;
    for (_, state) in states {
        match state {
            State::Tree(branch) if branch.cell != *cell => {
                inner = Some(inner.map_or(branch.cell, |c| c.join(&branch.cell)));
            }
            _ => return None,
        }
    }
    inner.filter(|c| c != cell)
}

fn has_constant(states: &States) -> bool {
    states.iter().any(|s| matches!(s.1, State::Constant(_)))
}

impl State {
    fn len_in(&self, cell: &Cell) -> usize {
        match self {
            Self::Constant(_) => 0,
            Self::Tree(branch) => match &*branch.node {
                Node::Deferred(leaf) => leaf.len(),
                Node::Cut(_) => TASK,
                Node::Leaf(_) => 0,
            },
            Self::List(list) => list.len(),
            Self::Bins(bins) => bins.len_in(cell),
        }
    }

    /// The number of elements in a deferred leaf of this very cell.
    fn len_to_open(&self, cell: &Cell) -> usize {
        match self {
            Self::Tree(branch) if branch.cell == *cell => match &*branch.node {
                Node::Deferred(leaf) => leaf.len(),
                Node::Cut(_) | Node::Leaf(_) => 0,
            },
            Self::Constant(_) | Self::Tree(_) | Self::List(_) | Self::Bins(_) => 0,
        }
    }

    /// The number of elements that halving the state would move.
    fn listed(&self) -> usize {
        match self {
            Self::List(list) => list.len(),
            Self::Constant(_) | Self::Tree(_) | Self::Bins(_) => 0,
        }
    }

    /// Whether all elements are known, and perpendicular to axes.
    fn is_orthogonal(&self, sources: &Sources) -> bool {
        match self {
            Self::List(list) => {
                let flat = |r: &Record| sources.get(r.slot()).is_orthogonal(r.face);
                let part =
                    |p: &PartRecord| p.element.part.source.is_orthogonal(p.element.part.face);
                list.records.iter().all(flat) && list.parts.iter().all(part)
            }
            Self::Tree(branch) => match &*branch.node {
                Node::Deferred(leaf) => leaf.is_orthogonal(),
                Node::Leaf(_) | Node::Cut(_) => false,
            },
            Self::Constant(_) | Self::Bins(_) => false,
        }
    }

    /// The elements as a list of the cell, if nothing reaches out of the part they are listed for.
    fn list_in(&self, cell: &Cell, sources: &Sources) -> Option<Cow<'_, List>> {
        match self {
            Self::List(list) => Some(Cow::Borrowed(list)),
            Self::Tree(branch) => List::lifted(branch, cell, sources).map(Cow::Owned),
            Self::Constant(_) | Self::Bins(_) => None,
        }
    }

    /// Becomes a constant if there is no boundary in the cell.
    fn settle(&mut self, cell: &Cell) {
        let constant = match self {
            Self::Constant(_) => None,
            Self::Tree(branch) => match (branch.constant(), &*branch.node) {
                (Some(w), _) => Some(w),
                (None, Node::Leaf(w)) if branch.cell == *cell => Some(branch.oriented(*w)),
                (None, _) => None,
            },
            Self::List(list) => list.is_empty().then_some(list.corner),
            Self::Bins(bins) => (bins.len_in(cell) == 0).then(|| bins.corner_of(cell)),
        };
        if let Some(w) = constant {
            *self = Self::Constant(w);
        }
    }

    /// The state with deferred leaves of this cell opened.
    fn opened(self, cell: &Cell, descent: &Descent) -> Self {
        match self {
            Self::Tree(branch) if branch.cell == *cell => opened_leaf(branch, descent),
            Self::Bins(bins) if !bins.divide(cell) || bins.len_in(cell) <= FEW => {
                opened_leaf(bins.branch_in(cell), descent)
            }
            other => other,
        }
    }

    /// The states in the two halves of the cell.
    fn divided(self, cell: &Cell, cut: Cut, sources: &Sources) -> (Self, Self) {
        match self {
            Self::Constant(w) => (Self::Constant(w), Self::Constant(w)),
            Self::List(list) => {
                let (minus, plus) = list.divide(cell, cut, sources);
                (Self::List(minus), Self::List(plus))
            }
            Self::Tree(branch) => divide_tree(branch, cell, cut),
            Self::Bins(bins) => (Self::Bins(Arc::clone(&bins)), Self::Bins(bins)),
        }
    }

    /// This operand, perhaps turned inside out, as the result in the cell.
    fn shared(self, cell: Cell, negate: bool, sources: &Sources) -> Branch {
        match self {
            Self::Constant(w) => Branch::uniform(cell, if negate { 1 - w } else { w }),
            Self::Tree(branch) if negate => branch.complemented(),
            Self::Tree(branch) => branch,
            Self::Bins(bins) => Self::Tree(bins.branch_in(&cell)).shared(cell, negate, sources),
            Self::List(list) => match list.close(negate, sources) {
                Node::Leaf(w) => Branch::uniform(cell, w),
                node => Branch {
                    cell,
                    outside: 0,
                    complement: false,
                    node: Arc::new(node),
                },
            },
        }
    }
}

/// A branch of the cell at hand; a deferred leaf becomes bins or a list.
fn opened_leaf(branch: Branch, descent: &Descent) -> State {
    let Node::Deferred(leaf) = &*branch.node else {
        return State::Tree(branch);
    };
    let bins = if leaf.len() >= MANY {
        Bins::new(&branch)
    } else {
        None
    };
    if let Some(bins) = bins {
        let count = leaf.len() as u64;
        descent.counters.binned.fetch_add(count, Ordering::Relaxed);
        return State::Bins(Arc::new(bins));
    }
    State::List(List::open(leaf, &branch, descent.sources))
}

fn divide_tree(branch: Branch, cell: &Cell, cut: Cut) -> (State, State) {
    if branch.cell == *cell {
        if let Node::Cut(halves) = &*branch.node {
            let [minus, plus] = &halves.children;
            return (
                State::Tree(branch.child(minus)),
                State::Tree(branch.child(plus)),
            );
        }
    }
    let around = State::Constant(branch.outside);
    if cell.half(cut, false).holds(&branch.cell) {
        (State::Tree(branch), around)
    } else {
        (around, State::Tree(branch))
    }
}
