//! Which faces stay, by the winding numbers in front of and behind them.

use super::faces::CellNumbers;
use crate::geometry::side::Orientation;
use crate::merge::expression::Expression;
use crate::merge::profile::Declined;
use crate::merge::rule::Rule;

/// The orientation in which faces stay, by the numbers of the mesh they are compared with.
#[derive(Debug)]
pub(super) enum KeepRule {
    /// For two operands, by the other one's numbers.
    Pair(Pair),
    /// For a mesh compared with itself, by its own numbers.
    Single(Rule),
}

/// Which faces of two operands stay.
#[derive(Debug)]
pub(super) struct Pair {
    /// By operand, and by whether the front and the back of a face are inside the other one. Of faces in
    /// one plane, only the owner's stays.
    of: [[[Option<Orientation>; 2]; 2]; 2],
    /// The value outside both operands.
    outside: bool,
}

impl Pair {
    fn of(expression: &Expression) -> Self {
        let mut scratch = Vec::new();
        let mut value = |inside: [bool; 2]| expression.value(|k| inside[k as usize], &mut scratch);
        let mut stays = |operand: usize, in_front: bool, behind: bool| {
            let inside = |own: bool, other: bool| {
                let mut inside = [other; 2];
                inside[operand] = own;
                inside
            };
            let (in_front, behind) = (inside(false, in_front), inside(true, behind));
            let word = |inside: [bool; 2], k: u32| u64::from(inside[k as usize]);
            let owners = expression.owners(|k| word(behind, k), |k| word(in_front, k));
            let owns = owners.iter().any(|(k, _)| *k as usize == operand);
            between(value(in_front), value(behind)).filter(|_| owns)
        };
        let of = [0, 1].map(|operand| {
            [false, true].map(|front| [false, true].map(|behind| stays(operand, front, behind)))
        });
        let outside = value([false; 2]);
        Self { of, outside }
    }

    fn at(&self, operand: usize, numbers: [i32; 2]) -> Result<Option<Orientation>, Declined> {
        let [in_front, behind] = numbers.map(usize::try_from);
        let by_front = in_front.ok().and_then(|n| self.of[operand].get(n));
        let stays = by_front.and_then(|b| b.get(behind.ok()?));
        stays.copied().ok_or(Declined::Overlap(1 - operand))
    }
}

/// The orientation of a face, by whether its front and its back are inside.
fn between(in_front: bool, behind: bool) -> Option<Orientation> {
    (behind != in_front).then(|| Orientation::turned_around(in_front))
}

impl KeepRule {
    /// The rule for the value of an expression over two operands.
    pub(super) fn of(expression: &Expression) -> Self {
        Self::Pair(Pair::of(expression))
    }

    /// The value far outside.
    pub(super) fn outside(&self) -> bool {
        match self {
            Self::Pair(pair) => pair.outside,
            Self::Single(_) => false,
        }
    }

    /// Return whether the fate of an operand's faces depends on winding numbers.
    pub(super) fn is_divided(&self, operand: usize) -> bool {
        match self {
            Self::Pair(Pair { of, .. }) => {
                let first = of[operand][0][0];
                of[operand].as_flattened().iter().any(|k| *k != first)
            }
            Self::Single(_) => true,
        }
    }

    /// The orientation in which an uncovered face stays, by the number in front of it.
    ///
    /// # Errors
    /// `Overlap` where the other operand's winding number is neither 0 nor 1.
    pub(super) fn at(
        &self,
        operand: usize,
        in_front: i32,
    ) -> Result<Option<Orientation>, Declined> {
        match self {
            Self::Pair(pair) => pair.at(operand, [in_front; 2]),
            Self::Single(rule) => Ok(between(rule.inside(in_front), rule.inside(in_front + 1))),
        }
    }

    /// The orientation for a cell of a face, given the number in front of the face's first cell.
    ///
    /// # Errors
    /// As for [`Self::at`], and where two faces of the other operand cover the cell.
    pub(super) fn of_cell(
        &self,
        operand: usize,
        cell: &CellNumbers,
        first: i32,
    ) -> Result<Option<Orientation>, Declined> {
        let in_front = first + cell.in_front;
        let behind = in_front + cell.behind;
        match self {
            Self::Pair(_) if cell.covers > 1 => Err(Declined::Overlap(1 - operand)),
            Self::Pair(pair) => pair.at(operand, [in_front, behind]),
            Self::Single(rule) => {
                let stays = between(rule.inside(in_front), rule.inside(behind + 1));
                Ok(stays.filter(|_| !cell.is_of_earlier))
            }
        }
    }
}
