//! Boolean expressions over solids, as lists of lines.

use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::interrupt::poll;

/// One line of an expression; arguments are indices of earlier lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Term {
    /// The operand with this index among the solids.
    Operand(u32),
    /// The complement of the value of the line with this index.
    Not(u32),
    /// The intersection of the values of lines, given by their indices.
    And(Vec<u32>),
    /// The union of the values of lines, given by their indices.
    Or(Vec<u32>),
    /// The symmetric difference of the values of lines, given by their indices.
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

    /// Returns the same operation with other lines as arguments, if it takes a list of lines.
    fn with(&self, list: Vec<u32>) -> Self {
        match self {
            Self::And(_) => Self::And(list),
            Self::Or(_) => Self::Or(list),
            Self::Xor(_) => Self::Xor(list),
            Self::Operand(_) | Self::Not(_) => self.clone(),
        }
    }
}

/// A Boolean expression as lines that refer to earlier lines only; the last line is its value.
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

/// An expression split into two smaller ones of which it is the union, intersection or symmetric difference,
/// or the complement of that.
#[derive(Debug)]
pub struct SplitExpression {
    /// The two smaller expressions; they have no operand in common.
    pub halves: [Expression; 2],
    /// The expression that combines the two smaller ones: `halves[0]` is operand 0 and `halves[1]` is operand
    /// 1.
    pub whole: Expression,
}

impl SplitExpression {
    /// Returns the ascending operand indices of each of the two smaller expressions.
    pub fn operands(&self) -> [Vec<u32>; 2] {
        self.halves.each_ref().map(Expression::operands)
    }

    /// Divides pairs of an operand index and a value into the pairs for operands of `halves[0]` and the pairs
    /// for operands of `halves[1]`.
    pub fn divide<T>(&self, entries: Vec<(u32, T)>) -> [Vec<(u32, T)>; 2] {
        let [ours, _] = self.operands();
        let is_ours = |entry: &(u32, T)| ours.binary_search(&entry.0).is_ok();
        entries.into_iter().partition::<Vec<_>, _>(is_ours).into()
    }

    /// Returns true if the split expression is a symmetric difference; then `halves[1]` is its last argument
    /// alone.
    pub fn takes_one_by_one(&self) -> bool {
        self.whole
            .terms
            .iter()
            .any(|term| matches!(term, Term::Xor(_)))
    }
}

impl Expression {
    /// Makes an expression of lines; an error if there are none, or if one refers to itself or to a later
    /// line.
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

    /// Returns the indices of all operands that occur, ascending and without repetition.
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

    /// Splits the arguments of the last operation into two expressions with about half of the operands each;
    /// of a symmetric difference, the last argument becomes an expression alone. `None` if the last operation
    /// has fewer than two arguments, or if an operand would occur in both expressions.
    pub fn split(&self) -> Option<SplitExpression> {
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
        Some(SplitExpression { halves, whole })
    }

    /// Returns for each line how often operands occur in it once earlier lines are substituted; at least 1.
    fn sizes(&self) -> Vec<usize> {
        let mut sizes: Vec<usize> = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let below = term.arguments().iter().map(|a| sizes[*a as usize]);
            let size = below.fold(0, usize::saturating_add);
            sizes.push(size.max(1));
        }
        sizes
    }

    /// Returns the expression whose last line is the operation of line `top` with only these arguments; a
    /// single argument stands for itself.
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

    /// Returns whether a point is inside the expression's value, given by `operand` whether it is inside each
    /// operand; `scratch` is working memory.
    pub fn value(&self, operand: impl Fn(u32) -> bool, scratch: &mut Vec<u64>) -> bool {
        let word = |k: u32| if operand(k) { u64::MAX } else { 0 };
        self.words(word, scratch) != 0
    }

    /// Returns the expression's values for 64 points at once, one in each bit; `operand` returns an operand's
    /// 64 values, and `scratch` is working memory.
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

    /// Returns whose faces bound the expression's value at 64 points at once, as pairs of an operand index
    /// and the bits of its points. `behind` and `in_front` return an operand's values just behind and in
    /// front of these points, one in each bit.
    ///
    /// If several operands have a face at a point, the owner is the one whose face would remain if the lines
    /// were evaluated one by one: of a union or an intersection it is the first argument whose value changes
    /// there, of a symmetric difference the last one.
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
        let mut owned = vec![0; changes.len()];
        owned[changes.len() - 1] = changes[changes.len() - 1];
        let mut owners = Vec::new();
        for (i, term) in self.terms.iter().enumerate().rev() {
            let found = owned[i];
            match term {
                Term::Operand(k) if found != 0 => owners.push((*k, found)),
                Term::Xor(list) => assign_owners(found, list.iter().rev(), &changes, &mut owned),
                _ => assign_owners(found, term.arguments().iter(), &changes, &mut owned),
            }
        }
        owners
    }
}

/// Marks for each point (a bit of `points`) the first of `lines` whose value changes there, as the line that
/// owns the face.
fn assign_owners<'a>(
    points: u64,
    lines: impl Iterator<Item = &'a u32>,
    changes: &[u64],
    owned: &mut [u64],
) {
    let mut open = points;
    for line in lines.map(|line| *line as usize) {
        owned[line] |= open & changes[line];
        open &= !changes[line];
    }
}

/// Returns only the lines on which the last line depends, with their arguments renumbered.
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
