//! Decides which faces stay, by the winding numbers in front of and behind them.

use super::faces::CellNumbers;
use crate::geometry::side::Orientation;
use crate::merge::expression::Expression;
use crate::merge::profile::Declined;
use crate::merge::rule::Rule;

/// The rule by which faces stay, and in which orientation, given winding numbers in front of and behind them.
#[derive(Debug)]
pub(super) enum KeepRule {
    /// For two operands: a face of one stays by the winding numbers of the other.
    Pair(PairTable),
    /// For a mesh united with itself: a face stays by the mesh's own winding numbers.
    Single(Rule),
}

/// A table of which faces of two operands stay, and in which orientation.
#[derive(Debug)]
pub(super) struct PairTable {
    /// The orientation in which a face stays, by its operand, by whether its front is inside the other
    /// operand, and by whether its back is. Of coinciding faces of both operands, only one stays.
    of: [[[Option<Orientation>; 2]; 2]; 2],
    /// Whether points outside both operands are inside the result.
    outside: bool,
}

impl PairTable {
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
            orientation_between(value(in_front), value(behind)).filter(|_| owns)
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

/// Returns the orientation in which a face bounds the result, given whether the result is inside in front of
/// the face and behind it; `None` if both are equal.
fn orientation_between(in_front: bool, behind: bool) -> Option<Orientation> {
    (behind != in_front).then(|| Orientation::turned_around(in_front))
}

impl KeepRule {
    /// Makes the rule for an expression over two operands.
    pub(super) fn of(expression: &Expression) -> Self {
        Self::Pair(PairTable::of(expression))
    }

    /// Returns whether points far outside all meshes are inside the result.
    pub(super) fn outside(&self) -> bool {
        match self {
            Self::Pair(pair) => pair.outside,
            Self::Single(_) => false,
        }
    }

    /// Returns true if it depends on winding numbers whether a face of this operand stays.
    pub(super) fn is_divided(&self, operand: usize) -> bool {
        match self {
            Self::Pair(PairTable { of, .. }) => {
                let first = of[operand][0][0];
                of[operand].as_flattened().iter().any(|k| *k != first)
            }
            Self::Single(_) => true,
        }
    }

    /// Returns the orientation in which a face stays that no coplanar face covers, given the winding number
    /// in front of it; `None` if it does not stay.
    ///
    /// # Errors
    /// `Overlap` if the other operand's winding number is neither 0 nor 1.
    pub(super) fn at(
        &self,
        operand: usize,
        in_front: i32,
    ) -> Result<Option<Orientation>, Declined> {
        match self {
            Self::Pair(pair) => pair.at(operand, [in_front; 2]),
            Self::Single(rule) => Ok(orientation_between(
                rule.inside(in_front),
                rule.inside(in_front + 1),
            )),
        }
    }

    /// Returns the orientation in which a cell of a divided face stays, given the winding number in front of
    /// the face's first cell; `None` if it does not stay.
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
                let stays = orientation_between(rule.inside(in_front), rule.inside(behind + 1));
                Ok(stays.filter(|_| !cell.is_of_earlier))
            }
        }
    }
}
