//! Simplifies expressions of which operands are constant, or equal to each other.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use super::expression::{only_needed, Expression, Term};
use crate::arith::convert::as_number;

/// An expression that was simplified because operands are constant or equal.
#[derive(Clone, Debug)]
pub enum Residual {
    /// The value is inside (true) or outside (false), whatever the remaining operands are.
    Constant(bool),
    /// The value is the operand with this index, complemented if the flag is true.
    Literal(u32, bool),
    /// The value depends on at least two operands.
    Open(Arc<Expression>),
}

/// The simplified value of a line: a constant, or the index of a line of the new expression and whether to
/// negate it.
#[derive(Clone, Copy)]
enum FoldedLine {
    Value(bool),
    Line(u32, bool),
}

impl Expression {
    /// Simplifies the expression for operands that are constant; `known` returns an operand's value, or
    /// `None`.
    pub fn residual(&self, known: impl Fn(u32) -> Option<bool>) -> Residual {
        self.folded(known, |folding, operand| {
            folding.append(Term::Operand(operand))
        })
    }

    /// Simplifies the expression for operands that are constant; `known` returns an operand's value, or
    /// `None`, and then `add` appends a line for the operand and returns its index.
    fn folded(
        &self,
        known: impl Fn(u32) -> Option<bool>,
        mut add: impl FnMut(&mut Folding, u32) -> u32,
    ) -> Residual {
        let mut folding = Folding::of(self.terms.len());
        for term in &self.terms {
            let line = match term {
                Term::Operand(k) => match known(*k) {
                    Some(v) => FoldedLine::Value(v),
                    None => FoldedLine::Line(add(&mut folding, *k), false),
                },
                Term::Not(a) => folding.folded[*a as usize].negated(),
                Term::And(list) => folding.list(list, false),
                Term::Or(list) => folding.list(list, true),
                Term::Xor(list) => folding.xor(list),
            };
            folding.folded.push(line);
        }
        folding.close()
    }

    /// Returns an expression for the same set if operands are equal: `first` maps each operand index to the
    /// index of the first operand equal to it. No union or intersection names two equal operands.
    ///
    /// ```
    /// use bspcsg::merge::expression::{Expression, Term};
    ///
    /// let [a, b, c] = [0, 1, 2].map(Term::Operand);
    /// let union = Expression::new(vec![a, b, c, Term::Or(vec![0, 1, 2])])?;
    /// assert_eq!(union.merged(|k| k.min(1)).operands(), [0, 1]);
    /// # Ok::<(), bspcsg::error::Error>(())
    /// ```
    #[must_use]
    pub fn merged(&self, first: impl Fn(u32) -> u32) -> Self {
        let terms = match self.where_equal(|k| Twin::of(first(k))) {
            Residual::Constant(false) => vec![Term::Or(Vec::new())],
            Residual::Constant(true) => vec![Term::And(Vec::new())],
            Residual::Literal(k, false) => vec![Term::Operand(k)],
            Residual::Literal(k, true) => vec![Term::Operand(k), Term::Not(0)],
            Residual::Open(left) => return Arc::unwrap_or_clone(left),
        };
        Self { terms }
    }

    /// Simplifies the expression for operands that are equal sets; `twin` returns the first operand equal to
    /// each.
    ///
    /// Folds equal arguments of one line. Different lines may still name equal operands, because their faces
    /// differ, and which faces bound the result depends on the other operands ([`Self::owners`]).
    ///
    /// ```
    /// use bspcsg::merge::expression::{Expression, Term};
    /// use bspcsg::merge::residual::{Residual, Twin};
    ///
    /// let [a, b] = [0, 1].map(Term::Operand);
    /// let difference = Expression::new(vec![a, b, Term::Not(1), Term::And(vec![0, 2])])?;
    /// let nothing = difference.where_equal(|_| Twin::of(0));
    /// assert!(matches!(nothing, Residual::Constant(false)));
    /// # Ok::<(), bspcsg::error::Error>(())
    /// ```
    pub fn where_equal(&self, twin: impl Fn(u32) -> Twin) -> Residual {
        let mut firsts: HashMap<u32, u32> = HashMap::default();
        let mut same: HashMap<u32, u32> = HashMap::default();
        let add = |folding: &mut Folding, operand| {
            let twin = twin(operand);
            if let Some(line) = same.get(&twin.first).filter(|_| twin.is_same_source) {
                return *line;
            }
            let line = folding.append(Term::Operand(operand));
            folding.lines[line as usize].twin = *firsts.entry(twin.first).or_insert(line);
            if twin.is_same_source {
                same.insert(twin.first, line);
            }
            line
        };
        self.folded(|_| None, add)
    }
}

/// The first operand of an expression that is the same set as a given operand.
#[derive(Clone, Copy, Debug)]
pub struct Twin {
    /// The index of the first operand that is the same set.
    pub first: u32,
    /// True if both operands list the same face numbers of one source; false if their faces only coincide.
    pub is_same_source: bool,
}

impl Twin {
    /// Makes a twin (the first operand that is the same set as a given operand) whose faces come from another
    /// source.
    pub fn of(first: u32) -> Self {
        Self {
            first,
            is_same_source: false,
        }
    }
}

impl FoldedLine {
    fn negated(self) -> Self {
        match self {
            Self::Value(v) => Self::Value(!v),
            Self::Line(line, negate) => Self::Line(line, !negate),
        }
    }
}

/// The state while an expression is simplified line by line.
struct Folding {
    /// The simplified value of each line of the old expression.
    folded: Vec<FoldedLine>,
    /// The lines of the new expression.
    terms: Vec<Term>,
    /// For each line of the new expression, which lines are equal to it.
    lines: Vec<Line>,
}

/// Which other lines are equal to a line of the new expression.
#[derive(Clone, Copy)]
struct Line {
    /// The index of the first line known to be equal to this one.
    twin: u32,
    /// Whether the list of arguments being simplified has named this line, and its complement.
    is_named: [bool; 2],
}

impl Folding {
    /// Makes an empty state with room for `count` lines.
    fn of(count: usize) -> Self {
        Self {
            folded: Vec::with_capacity(count),
            terms: Vec::with_capacity(count),
            lines: Vec::with_capacity(count),
        }
    }

    fn append(&mut self, term: Term) -> u32 {
        let twin = as_number(self.terms.len());
        self.terms.push(term);
        self.lines.push(Line {
            twin,
            is_named: [false; 2],
        });
        twin
    }

    fn twin(&self, line: u32) -> usize {
        self.lines[line as usize].twin as usize
    }

    /// Simplifies a union (`absorbing` is true) or an intersection (`absorbing` is false) of the lines in
    /// `list`.
    fn list(&mut self, list: &[u32], absorbing: bool) -> FoldedLine {
        let Some(open) = self.open(list, absorbing) else {
            return FoldedLine::Value(absorbing);
        };
        match open.as_slice() {
            [] => FoldedLine::Value(!absorbing),
            [(line, negate)] => FoldedLine::Line(*line, *negate),
            _ => {
                let signed = |(line, negate): (u32, bool)| self.signed(line, negate);
                let lines = open.into_iter().map(signed).collect();
                let term = if absorbing {
                    Term::Or(lines)
                } else {
                    Term::And(lines)
                };
                FoldedLine::Line(self.append(term), false)
            }
        }
    }

    /// Returns the arguments of a union or intersection that are not constant, without repetition, as lines
    /// and whether to negate them; `None` if a constant or two opposite lines decide the value.
    fn open(&mut self, list: &[u32], absorbing: bool) -> Option<Vec<(u32, bool)>> {
        let mut open: Vec<(u32, bool)> = Vec::new();
        let mut is_decided = false;
        for i in list {
            match self.folded[*i as usize] {
                FoldedLine::Value(v) => is_decided |= v == absorbing,
                FoldedLine::Line(line, negate) => {
                    let twin = self.twin(line);
                    let named = &mut self.lines[twin].is_named;
                    is_decided |= named[usize::from(!negate)];
                    if !std::mem::replace(&mut named[usize::from(negate)], true) {
                        open.push((line, negate));
                    }
                }
            }
            if is_decided {
                break;
            }
        }
        for (line, _) in &open {
            let twin = self.twin(*line);
            self.lines[twin].is_named = [false; 2];
        }
        (!is_decided).then_some(open)
    }

    /// Simplifies a symmetric difference of the lines in `list`, in which equal lines cancel each other.
    fn xor(&mut self, list: &[u32]) -> FoldedLine {
        let mut parity = false;
        let mut lines: Vec<u32> = Vec::new();
        for i in list {
            match self.folded[*i as usize] {
                FoldedLine::Value(v) => parity ^= v,
                FoldedLine::Line(line, negate) => {
                    parity ^= negate;
                    *self.is_odd(line) ^= true;
                    lines.push(line);
                }
            }
        }
        let mut open: Vec<u32> = Vec::new();
        for line in lines.into_iter().rev() {
            if std::mem::take(self.is_odd(line)) {
                open.push(line);
            }
        }
        open.reverse();
        match open.as_slice() {
            [] => FoldedLine::Value(parity),
            [line] => FoldedLine::Line(*line, parity),
            _ => FoldedLine::Line(self.append(Term::Xor(open)), parity),
        }
    }

    /// Returns the flag that is true while a symmetric difference has named an odd number of lines equal to
    /// `line`.
    fn is_odd(&mut self, line: u32) -> &mut bool {
        let twin = self.twin(line);
        &mut self.lines[twin].is_named[0]
    }

    /// Returns the index of a line, or of a new line for its complement if `negate` is true.
    fn signed(&mut self, line: u32, negate: bool) -> u32 {
        if negate {
            self.append(Term::Not(line))
        } else {
            line
        }
    }

    fn close(self) -> Residual {
        match self.folded.last() {
            None => Residual::Constant(false),
            Some(FoldedLine::Value(v)) => Residual::Constant(*v),
            Some(FoldedLine::Line(line, negate)) => close(self.terms, *line, *negate),
        }
    }
}

/// Returns the simplified expression whose value is the given line, complemented if `negate` is true.
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
        // In each case b equals a: (a ∪ c) − b, (a ∩ c) ∪ b, a ⊖ c ⊖ b, and a ⊖ c ⊖ b ⊖ a ⊖ c.
        let cases = [
            (
                vec![Term::Or(vec![0, 2]), Term::Not(1), Term::And(vec![3, 4])],
                None,
            ),
            (vec![Term::And(vec![0, 2]), Term::Or(vec![3, 1])], None),
            (vec![Term::Xor(vec![0, 2, 1])], Some(2)),
            (vec![Term::Xor(vec![0, 2, 1, 0, 2])], Some(0)),
        ];
        for (rest, alone) in cases {
            let terms = [vec![a.clone(), b.clone(), c.clone()], rest].concat();
            let whole = Expression::new(terms).expect("an expression");
            let left = whole.where_equal(|k| Twin::of(if k == 1 { 0 } else { k }));
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
        let all = same.expect("an expression").where_equal(|_| Twin::of(0));
        assert!(matches!(all, Residual::Literal(0, false)));
        let alone = Expression::new(vec![a])
            .expect("an expression")
            .where_equal(|_| Twin::of(0));
        assert!(matches!(alone, Residual::Literal(0, false)));
    }
}
