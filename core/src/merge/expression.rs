//! Boolean expressions over operands.

use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::poll;

/// One line of an expression; numbers refer to earlier lines.
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

    /// The same term with other arguments.
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
/// use bspcsg::merge::expression::{Expression, Term};
/// use bspcsg::merge::residual::Residual;
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
    pub(super) terms: Vec<Term>,
}

/// An expression split in two: the union, intersection or symmetric difference of two others.
#[derive(Debug)]
pub struct Parted {
    /// The two others; they have no operand in common.
    pub halves: [Expression; 2],
    /// The expression that combines them, the first as operand 0 and the second as operand 1.
    pub whole: Expression,
}

impl Parted {
    /// The operands of the two others.
    pub fn operands(&self) -> [Vec<u32>; 2] {
        self.halves.each_ref().map(Expression::operands)
    }

    /// The entries for operands of the first, and of the second.
    pub fn divide<T>(&self, entries: Vec<(u32, T)>) -> [Vec<(u32, T)>; 2] {
        let [ours, _] = self.operands();
        let is_ours = |entry: &(u32, T)| ours.binary_search(&entry.0).is_ok();
        entries.into_iter().partition::<Vec<_>, _>(is_ours).into()
    }

    /// Return whether the second is one argument of a symmetric difference.
    pub fn takes_one_by_one(&self) -> bool {
        self.whole
            .terms
            .iter()
            .any(|term| matches!(term, Term::Xor(_)))
    }
}

impl Expression {
    /// An expression; lines may refer to earlier lines only.
    pub fn new(terms: Vec<Term>) -> Result<Self> {
        for (i, term) in terms.iter().enumerate() {
            poll();
            if term.arguments().iter().any(|a| *a as usize >= i) {
                let text =
                    format!("line {i} of the expression refers to a line that is not before it");
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

    /// The expression split in two, each with about half of the operands; for a symmetric difference the
    /// second is the last argument alone. `None` if its value depends on one line, or operands occur in
    /// both.
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
        let most = arguments.len() - 1;
        let split = match &self.terms[top] {
            Term::Xor(_) => most,
            _ => arguments.iter().take_while(in_first).count().clamp(1, most),
        };
        let (first, second) = arguments.split_at(split);
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

    /// For each line, how often it refers to operands, directly or through other lines.
    fn sizes(&self) -> Vec<usize> {
        let mut sizes: Vec<usize> = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let below = term.arguments().iter().map(|a| sizes[*a as usize]);
            let size = below.fold(0, usize::saturating_add);
            sizes.push(size.max(1));
        }
        sizes
    }

    /// The expression of line `top` restricted to some of its arguments.
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

    /// The values for 64 cases at once, one in each bit of a word.
    pub fn words(&self, operand: impl Fn(u32) -> u64, scratch: &mut Vec<u64>) -> u64 {
        self.words_of_lines(operand, scratch);
        scratch.last().copied().unwrap_or(0)
    }

    fn words_of_lines(&self, operand: impl Fn(u32) -> u64, words: &mut Vec<u64>) {
        words.clear();
        for term in &self.terms {
            let at = |i: &u32| words[*i as usize];
            let word = match term {
                Term::Operand(k) => operand(*k),
                Term::Not(a) => !at(a),
                Term::And(list) => list.iter().fold(u64::MAX, |all, i| all & at(i)),
                Term::Or(list) => list.iter().fold(0, |all, i| all | at(i)),
                Term::Xor(list) => list.iter().fold(0, |all, i| all ^ at(i)),
            };
            words.push(word);
        }
    }

    /// The operands that bound the value at 64 places at once, given the operands' values on the two sides;
    /// each bit of a word is one place.
    ///
    /// These operands' faces would remain if the lines were evaluated one by one: where the value of a
    /// union or an intersection changes, the first argument that changes gives its face; for a symmetric
    /// difference, the last one.
    ///
    /// ```
    /// use bspcsg::merge::expression::{Expression, Term};
    ///
    /// // (a ∪ b) ∩ c, where a ends and b begins.
    /// let [a, b, c] = [0, 1, 2].map(Term::Operand);
    /// let both = Expression::new(vec![a, b, Term::Or(vec![0, 1]), c, Term::And(vec![2, 3])])?;
    /// let behind = |k: u32| [1, 0, 1][k as usize];
    /// let in_front = |k: u32| [0, 1, 0][k as usize];
    /// assert_eq!(both.owners(behind, in_front), [(2, 1)]);
    /// # Ok::<(), bspcsg::error::Error>(())
    /// ```
    pub fn owners(
        &self,
        behind: impl Fn(u32) -> u64,
        in_front: impl Fn(u32) -> u64,
    ) -> Vec<(u32, u64)> {
        let (mut changes, mut others) = (Vec::new(), Vec::new());
        self.words_of_lines(behind, &mut changes);
        self.words_of_lines(in_front, &mut others);
        changes.iter_mut().zip(&others).for_each(|(c, o)| *c ^= o);
        let mut asked = vec![0; changes.len()];
        asked[changes.len() - 1] = changes[changes.len() - 1];
        let mut owners = Vec::new();
        for (i, term) in self.terms.iter().enumerate().rev() {
            let found = asked[i];
            match term {
                Term::Operand(k) if found != 0 => owners.push((*k, found)),
                Term::Xor(list) => ask(found, list.iter().rev(), &changes, &mut asked),
                _ => ask(found, term.arguments().iter(), &changes, &mut asked),
            }
        }
        owners
    }
}

/// Ask the first of some lines that changes at a place for its owner there.
fn ask<'a>(places: u64, lines: impl Iterator<Item = &'a u32>, changes: &[u64], asked: &mut [u64]) {
    let mut open = places;
    for line in lines.map(|line| *line as usize) {
        asked[line] |= open & changes[line];
        open &= !changes[line];
    }
}

/// The lines that the last one depends on.
pub(super) fn only_needed(terms: Vec<Term>) -> Vec<Term> {
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
    fn words_hold_64_places_at_once() {
        let terms = vec![Term::Operand(0), Term::Operand(1), Term::Xor(vec![0, 1])];
        let differ = Expression::new(terms).expect("well formed");
        let word = |k: u32| [0b0011, 0b0101][k as usize];
        assert_eq!(differ.words(word, &mut Vec::new()), 0b0110);
    }
}
