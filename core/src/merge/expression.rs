//! Boolean expressions over operands, and what is left of them once some operands are known.

use std::sync::Arc;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::poll;

/// One line of an expression; numbers name earlier lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Term {
    /// An operand, by its number.
    Operand(u32),
    /// The complement of a line.
    Not(u32),
    /// The intersection of lines.
    And(Vec<u32>),
    /// The union of lines.
    Or(Vec<u32>),
    /// The symmetric difference of lines.
    Xor(Vec<u32>),
}

impl Term {
    fn arguments(&self) -> &[u32] {
        match self {
            Self::Operand(_) => &[],
            Self::Not(a) => std::slice::from_ref(a),
            Self::And(list) | Self::Or(list) | Self::Xor(list) => list,
        }
    }

    /// The same with other arguments.
    fn with(&self, list: Vec<u32>) -> Self {
        match self {
            Self::And(_) => Self::And(list),
            Self::Or(_) => Self::Or(list),
            Self::Xor(_) => Self::Xor(list),
            Self::Operand(_) | Self::Not(_) => self.clone(),
        }
    }
}

/// An expression as topologically ordered lines; the last one is its value.
///
/// # Example
/// ```
/// use bspcsg::merge::expression::{Expression, Residual, Term};
///
/// // a − b: operands 0 and 1, the complement of line 1, the intersection of lines 0 and 2.
/// let [a, b] = [Term::Operand(0), Term::Operand(1)];
/// let difference = Expression::new(vec![a, b, Term::Not(1), Term::And(vec![0, 2])])?;
/// // Inside b nothing is left, and outside of b it is a.
/// let inside = difference.residual(|operand| (operand == 1).then_some(true));
/// assert!(matches!(inside, Residual::Constant(false)));
/// let outside = difference.residual(|operand| (operand == 1).then_some(false));
/// assert!(matches!(outside, Residual::Literal(0, false)));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression {
    terms: Vec<Term>,
}

/// An expression after some of its operands have become constant.
#[derive(Clone, Debug)]
pub enum Residual {
    /// Inside or outside, whatever the unknown operands are.
    Constant(bool),
    /// One operand, or its complement.
    Literal(u32, bool),
    /// More than one operand matters.
    Open(Arc<Expression>),
}

/// A simplified line: a value, or a line of the new expression and whether to negate it.
#[derive(Clone, Copy)]
enum Known {
    Value(bool),
    Line(u32, bool),
}

/// An expression taken apart: the union, intersection or symmetric difference of two others.
#[derive(Debug)]
pub struct Parted {
    /// The two others; they have no operand in common.
    pub halves: [Expression; 2],
    /// The expression that they make, the first as operand 0 and the second as operand 1.
    pub whole: Expression,
}

impl Expression {
    /// An expression; every line may name earlier lines only.
    pub fn new(terms: Vec<Term>) -> Result<Self> {
        for (i, term) in terms.iter().enumerate() {
            poll();
            if term.arguments().iter().any(|a| *a as usize >= i) {
                let text = format!("line {i} of the expression names a line that is not before it");
                return Err(Error::at(ErrorKind::Shape, vec![i as u64], text));
            }
        }
        if terms.is_empty() {
            return Err(Error::new(ErrorKind::Shape, "the expression has no lines"));
        }
        Ok(Self { terms })
    }

    /// The operands named, ascending.
    pub fn operands(&self) -> Vec<u32> {
        let mut list: Vec<u32> = self
            .terms
            .iter()
            .filter_map(|t| match t {
                Term::Operand(k) => Some(*k),
                _ => None,
            })
            .collect();
        list.sort_unstable();
        list.dedup();
        list
    }

    /// The same set, where of the operands of one list that stand for one set only the first is
    /// named: `first` maps an operand to the first that is equal. `None` if nothing changes.
    ///
    /// ```
    /// use bspcsg::merge::expression::{Expression, Residual, Term};
    ///
    /// let [a, b, c] = [0, 1, 2].map(Term::Operand);
    /// let union = Expression::new(vec![a, b, c, Term::Or(vec![0, 1, 2])])?;
    /// let merged = union.merged(|k| k.min(1)).expect("operand 2 is operand 1");
    /// assert!(matches!(merged.residual(|k| (k == 0).then_some(false)), Residual::Literal(1, false)));
    /// # Ok::<(), bspcsg::error::Error>(())
    /// ```
    pub fn merged(&self, first: impl Fn(u32) -> u32) -> Option<Self> {
        let mut terms: Vec<Term> = Vec::with_capacity(self.terms.len());
        let mut image = Vec::with_capacity(self.terms.len());
        let mut changed = false;
        for term in &self.terms {
            let term = renumbered(term.clone(), &image);
            let list = merged_list(&term, &mut terms, &first);
            changed |= list.is_some();
            terms.push(list.map_or_else(|| term.clone(), |list| term.with(list)));
            image.push(as_number(terms.len()) - 1);
        }
        changed.then_some(Self { terms })
    }

    /// The rest of the expression where some operands are equal: `first` maps each to the one that stands
    /// for it.
    ///
    /// ```
    /// use bspcsg::merge::expression::{Expression, Residual, Term};
    ///
    /// let [a, b] = [0, 1].map(Term::Operand);
    /// let difference = Expression::new(vec![a, b, Term::Not(1), Term::And(vec![0, 2])])?;
    /// assert!(matches!(difference.where_equal(|_| 0), Residual::Constant(false)));
    /// # Ok::<(), bspcsg::error::Error>(())
    /// ```
    pub fn where_equal(&self, first: impl Fn(u32) -> u32) -> Residual {
        // Lists that name one line twice fold.
        let mut lines: HashMap<u32, u32> = HashMap::default();
        let mut terms: Vec<Term> = Vec::with_capacity(self.terms.len());
        let mut image = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let next = as_number(terms.len());
            let line = match term {
                Term::Operand(k) => *lines.entry(first(*k)).or_insert(next),
                _ => next,
            };
            if line == next {
                terms.push(match term {
                    Term::Operand(k) => Term::Operand(first(*k)),
                    _ => renumbered(term.clone(), &image),
                });
            }
            image.push(line);
        }
        terms.truncate(image.last().map_or(0, |last| *last as usize + 1));
        let merged = Self { terms };
        match merged.operands().as_slice() {
            [alone] => merged.of_one(*alone),
            _ => merged.residual(|_| None),
        }
    }

    /// The rest of an expression that names one operand only.
    fn of_one(&self, operand: u32) -> Residual {
        let mut scratch = Vec::new();
        let [outside, inside] = [false, true].map(|inside| self.value(|_| inside, &mut scratch));
        if outside == inside {
            Residual::Constant(inside)
        } else {
            Residual::Literal(operand, outside)
        }
    }

    /// The expression as one of two others, each with about half of the operands; `None` if its
    /// value is made from one line, or operands occur in both.
    pub fn parted(&self) -> Option<Parted> {
        let mut top = self.terms.len() - 1;
        let mut negate = false;
        while let Term::Not(line) = &self.terms[top] {
            top = *line as usize;
            negate = !negate;
        }
        let arguments = self.terms[top].arguments();
        if arguments.len() < 2 {
            return None;
        }
        let sizes = self.sizes();
        let all = arguments.iter().map(|a| sizes[*a as usize]);
        let half = all.fold(0, usize::saturating_add) / 2;
        let mut sum = 0usize;
        let in_first = |line: &&u32| {
            sum = sizes[**line as usize].saturating_add(sum);
            sum <= half
        };
        let split = arguments.iter().take_while(in_first).count().max(1);
        let (first, second) = arguments.split_at(split.min(arguments.len() - 1));
        let halves = [self.of(first, top), self.of(second, top)];
        let [ours, theirs] = halves.each_ref().map(Self::operands);
        if ours.iter().any(|k| theirs.binary_search(k).is_ok()) {
            return None;
        }
        let mut terms = vec![Term::Operand(0), Term::Operand(1)];
        terms.push(self.terms[top].with(vec![0, 1]));
        if negate {
            terms.push(Term::Not(2));
        }
        let whole = Self { terms };
        Some(Parted { halves, whole })
    }

    /// For each line how often it names operands, itself or by other lines.
    fn sizes(&self) -> Vec<usize> {
        let mut sizes: Vec<usize> = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let below = term.arguments().iter().map(|a| sizes[*a as usize]);
            let size = below.fold(0, usize::saturating_add);
            sizes.push(size.max(1));
        }
        sizes
    }

    /// The expression that the line `top` would be with only some of its arguments.
    fn of(&self, arguments: &[u32], top: usize) -> Self {
        let mut terms = self.terms[..top].to_vec();
        let last = if let [line] = arguments {
            *line
        } else {
            terms.push(self.terms[top].with(arguments.to_vec()));
            as_number(top)
        };
        terms.truncate(last as usize + 1);
        Self {
            terms: only_needed(terms),
        }
    }

    /// The value for known operands.
    pub fn value(&self, operand: impl Fn(u32) -> bool, scratch: &mut Vec<u64>) -> bool {
        let word = |k: u32| if operand(k) { u64::MAX } else { 0 };
        self.words(word, scratch) != 0
    }

    /// The values for 64 cases at once: a bit of each word is one case.
    pub fn words(&self, operand: impl Fn(u32) -> u64, scratch: &mut Vec<u64>) -> u64 {
        scratch.clear();
        for term in &self.terms {
            let at = |i: &u32| scratch[*i as usize];
            let word = match term {
                Term::Operand(k) => operand(*k),
                Term::Not(a) => !at(a),
                Term::And(list) => list.iter().fold(u64::MAX, |all, i| all & at(i)),
                Term::Or(list) => list.iter().fold(0, |all, i| all | at(i)),
                Term::Xor(list) => list.iter().fold(0, |all, i| all ^ at(i)),
            };
            scratch.push(word);
        }
        scratch.last().copied().unwrap_or(0)
    }

    /// Puts in what is known and folds constants.
    pub fn residual(&self, known: impl Fn(u32) -> Option<bool>) -> Residual {
        let mut folded = Vec::with_capacity(self.terms.len());
        let mut terms = Vec::new();
        for term in &self.terms {
            let line = fold(term, &folded, &known, &mut terms);
            folded.push(line);
        }
        match folded.last() {
            None => Residual::Constant(false),
            Some(Known::Value(v)) => Residual::Constant(*v),
            Some(Known::Line(line, negate)) => close(terms, *line, *negate),
        }
    }
}

fn fold(
    term: &Term,
    folded: &[Known],
    known: &impl Fn(u32) -> Option<bool>,
    terms: &mut Vec<Term>,
) -> Known {
    match term {
        Term::Operand(k) => match known(*k) {
            Some(v) => Known::Value(v),
            None => append(terms, Term::Operand(*k)),
        },
        Term::Not(a) => match folded[*a as usize] {
            Known::Value(v) => Known::Value(!v),
            Known::Line(line, negate) => Known::Line(line, !negate),
        },
        Term::And(list) => fold_list(list, folded, false, terms),
        Term::Or(list) => fold_list(list, folded, true, terms),
        Term::Xor(list) => fold_xor(list, folded, terms),
    }
}

/// A list that names the line of the first of equal operands for each of them, and in unions and
/// intersections only once; `None` if no two are equal. Complements of these lines may be added.
fn merged_list(
    term: &Term,
    terms: &mut Vec<Term>,
    first: &impl Fn(u32) -> u32,
) -> Option<Vec<u32>> {
    let (Term::And(list) | Term::Or(list) | Term::Xor(list)) = term else {
        return None;
    };
    let counts_all = matches!(term, Term::Xor(_));
    let mut lines: HashMap<u32, u32> = HashMap::default();
    let mut named: HashSet<(u32, bool)> = HashSet::default();
    let mut merged = Vec::with_capacity(list.len());
    let mut changed = false;
    for line in list {
        let Some((operand, at, negate)) = literal(terms, *line) else {
            merged.push(*line);
            continue;
        };
        let twin = *lines.entry(first(operand)).or_insert(at);
        changed |= twin != at;
        if named.insert((twin, negate)) || counts_all {
            merged.push(if twin == at {
                *line
            } else {
                signed(twin, negate, terms)
            });
        }
    }
    changed.then_some(merged)
}

/// The operand that a line names, itself or as its complement; the operand's line, and whether it
/// is the complement.
fn literal(terms: &[Term], line: u32) -> Option<(u32, u32, bool)> {
    match &terms[line as usize] {
        Term::Operand(k) => Some((*k, line, false)),
        Term::Not(at) => match &terms[*at as usize] {
            Term::Operand(k) => Some((*k, *at, true)),
            _ => None,
        },
        _ => None,
    }
}

fn append(terms: &mut Vec<Term>, term: Term) -> Known {
    terms.push(term);
    Known::Line(as_number(terms.len()) - 1, false)
}

/// Lists up to this length are searched for equal and opposite lines; longer ones would cost n².
const SHORT: usize = 64;

/// Folds a union (`absorbing` is true) or an intersection (`absorbing` is false).
fn fold_list(list: &[u32], folded: &[Known], absorbing: bool, terms: &mut Vec<Term>) -> Known {
    let short = list.len() <= SHORT;
    let mut open: Vec<(u32, bool)> = Vec::new();
    for i in list {
        match folded[*i as usize] {
            Known::Value(v) if v == absorbing => return Known::Value(absorbing),
            Known::Value(_) => {}
            Known::Line(line, negate) => {
                if short && open.contains(&(line, !negate)) {
                    return Known::Value(absorbing);
                }
                if !(short && open.contains(&(line, negate))) {
                    open.push((line, negate));
                }
            }
        }
    }
    match open.as_slice() {
        [] => Known::Value(!absorbing),
        [(line, negate)] => Known::Line(*line, *negate),
        _ => {
            let lines = positive(&open, terms);
            append(
                terms,
                if absorbing {
                    Term::Or(lines)
                } else {
                    Term::And(lines)
                },
            )
        }
    }
}

fn fold_xor(list: &[u32], folded: &[Known], terms: &mut Vec<Term>) -> Known {
    let mut parity = false;
    let mut open: Vec<u32> = Vec::new();
    for i in list {
        match folded[*i as usize] {
            Known::Value(v) => parity ^= v,
            Known::Line(line, negate) => {
                parity ^= negate;
                if let Some(twin) = open.iter().position(|l| *l == line) {
                    open.remove(twin);
                } else {
                    open.push(line);
                }
            }
        }
    }
    match open.as_slice() {
        [] => Known::Value(parity),
        [line] => Known::Line(*line, parity),
        _ => match append(terms, Term::Xor(open)) {
            Known::Line(line, _) => Known::Line(line, parity),
            value @ Known::Value(_) => value,
        },
    }
}

fn positive(open: &[(u32, bool)], terms: &mut Vec<Term>) -> Vec<u32> {
    let lines = open.iter();
    lines.map(|(line, no)| signed(*line, *no, terms)).collect()
}

/// A line, or a new one for its complement.
fn signed(line: u32, negate: bool, terms: &mut Vec<Term>) -> u32 {
    if !negate {
        return line;
    }
    terms.push(Term::Not(line));
    as_number(terms.len()) - 1
}

/// Keeps the lines the value depends on.
fn close(mut terms: Vec<Term>, line: u32, negate: bool) -> Residual {
    if let Term::Operand(k) = terms[line as usize] {
        return Residual::Literal(k, negate);
    }
    terms.truncate(line as usize + 1);
    if negate {
        terms.push(Term::Not(line));
    }
    let terms = only_needed(terms);
    Residual::Open(Arc::new(Expression { terms }))
}

/// The lines that the last one depends on.
fn only_needed(terms: Vec<Term>) -> Vec<Term> {
    let mut needed = vec![false; terms.len()];
    needed[terms.len() - 1] = true;
    for i in (0..terms.len()).rev().filter(|i| *i < terms.len()) {
        if needed[i] {
            terms[i]
                .arguments()
                .iter()
                .for_each(|a| needed[*a as usize] = true);
        }
    }
    let mut image = vec![0u32; terms.len()];
    let mut kept = Vec::new();
    for (i, term) in terms.into_iter().enumerate().filter(|(i, _)| needed[*i]) {
        image[i] = as_number(kept.len());
        kept.push(renumbered(term, &image));
    }
    kept
}

fn renumbered(term: Term, image: &[u32]) -> Term {
    let list = |l: Vec<u32>| l.into_iter().map(|i| image[i as usize]).collect();
    match term {
        Term::Operand(k) => Term::Operand(k),
        Term::Not(a) => Term::Not(image[a as usize]),
        Term::And(l) => Term::And(list(l)),
        Term::Or(l) => Term::Or(list(l)),
        Term::Xor(l) => Term::Xor(list(l)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_folds_away() {
        let terms = vec![Term::Operand(0), Term::Operand(1), Term::And(vec![0, 1])];
        let both = Expression::new(terms).expect("well formed");
        let with_first = |value: bool| both.residual(|k| (k == 0).then_some(value));
        assert!(matches!(with_first(false), Residual::Constant(false)));
        assert!(matches!(with_first(true), Residual::Literal(1, false)));
        assert!(matches!(both.residual(|_| None), Residual::Open(_)));
    }

    #[test]
    fn equal_operands_fold_away() {
        let [a, b, c] = [0, 1, 2].map(Term::Operand);
        // (a ∪ c) − b, (a ∩ c) ∪ b, and a ⊖ c ⊖ b, where b is a.
        let cases = [
            (
                vec![Term::Or(vec![0, 2]), Term::Not(1), Term::And(vec![3, 4])],
                None,
            ),
            (vec![Term::And(vec![0, 2]), Term::Or(vec![3, 1])], None),
            (vec![Term::Xor(vec![0, 2, 1])], Some(2)),
        ];
        for (rest, alone) in cases {
            let terms = [vec![a.clone(), b.clone(), c.clone()], rest].concat();
            let whole = Expression::new(terms).expect("an expression");
            let left = whole.where_equal(|k| if k == 1 { 0 } else { k });
            let scratch = &mut Vec::new();
            for bits in 0..4u32 {
                let holds = |k: u32| bits >> (k / 2) & 1 == 1;
                let value = match &left {
                    Residual::Constant(value) => *value,
                    Residual::Literal(k, negate) => holds(*k) != *negate,
                    Residual::Open(left) => left.value(holds, scratch),
                };
                assert_eq!(value, whole.value(holds, scratch));
            }
            let found = match left {
                Residual::Literal(k, false) => Some(k),
                _ => None,
            };
            assert_eq!(found, alone);
        }
        let same = Expression::new(vec![
            a.clone(),
            b,
            c,
            Term::Or(vec![0, 1]),
            Term::And(vec![3, 2]),
        ]);
        let all = same.expect("an expression").where_equal(|_| 0);
        assert!(matches!(all, Residual::Literal(0, false)));
        let alone = Expression::new(vec![a])
            .expect("an expression")
            .where_equal(|_| 0);
        assert!(matches!(alone, Residual::Literal(0, false)));
    }

    #[test]
    fn words_hold_64_places_at_once() {
        let terms = vec![Term::Operand(0), Term::Operand(1), Term::Xor(vec![0, 1])];
        let differ = Expression::new(terms).expect("well formed");
        let word = |k: u32| [0b0011, 0b0101][k as usize];
        assert_eq!(differ.words(word, &mut Vec::new()), 0b0110);
    }
}
