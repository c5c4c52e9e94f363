//! Decides which faces stay, by the winding numbers in front of and behind them.

use smallvec::SmallVec;

use crate::geometry::side::Orientation;
use crate::merge::expression::Expression;
use crate::merge::profile::Declined;
use crate::merge::rule::Rule;

/// The winding number of each operand at one point.
pub(super) type Numbers = SmallVec<[i32; 2]>;

/// The winding numbers on both sides of a face or of a cell of a divided face.
#[derive(Clone, Debug)]
pub(super) struct Sides {
    pub(super) in_front: Numbers,
    pub(super) behind: Numbers,
}

/// The rule by which faces stay, and in which orientation.
#[derive(Debug)]
pub(super) struct KeepRule {
    /// The rule that says which winding numbers are inside an operand.
    rule: Rule,
    /// For each operand, whether its own pairs of faces were compared. Of any other operand, the space in front
    /// of each face is assumed to be outside, and the space behind it inside.
    resolved: SmallVec<[bool; 2]>,
    /// By the set of operands (as bits) that contain a point in front of a face, and the set that contains the
    /// point behind it: the operand whose face bounds the result, and its orientation.
    walls: Vec<Option<(usize, Orientation)>>,
    /// Whether points outside all operands are inside the result.
    outside: bool,
}

impl KeepRule {
    /// Makes the rule for an expression over operands of which none is resolved.
    pub(super) fn new(expression: &Expression, operands: usize, rule: Rule) -> Self {
        let sets = 0..1usize << operands;
        let word = |set: usize| move |k: u32| (set >> k & 1) as u64;
        let mut scratch = Vec::new();
        let mut value = |set: usize| expression.value(|k| word(set)(k) != 0, &mut scratch);
        let inside: Vec<bool> = sets.clone().map(&mut value).collect();
        let wall = |(front, behind): (usize, usize)| {
            let orientation = orientation_between(inside[front], inside[behind])?;
            let owners = expression.owners(word(behind), word(front));
            owners.first().map(|(k, _)| (*k as usize, orientation))
        };
        let pairs = sets.clone().flat_map(|f| sets.clone().map(move |b| (f, b)));
        Self {
            rule,
            resolved: SmallVec::from_elem(false, operands),
            walls: pairs.map(wall).collect(),
            outside: inside[0],
        }
    }

    /// Records that the own pairs of an operand's faces were compared.
    pub(super) fn resolve(&mut self, operand: usize) {
        self.resolved[operand] = true;
    }

    pub(super) fn is_resolved(&self, operand: usize) -> bool {
        self.resolved[operand]
    }

    /// Returns whether points far outside all operands are inside the result.
    pub(super) fn outside(&self) -> bool {
        self.outside
    }

    fn operands(&self) -> usize {
        self.resolved.len()
    }

    fn wall(&self, operand: usize, [in_front, behind]: [usize; 2]) -> Option<Orientation> {
        let wall = self.walls[in_front << self.operands() | behind];
        wall.filter(|(owner, _)| *owner == operand)
            .map(|(_, orientation)| orientation)
    }

    /// Returns true if it depends on winding numbers whether a face of this operand stays.
    pub(super) fn depends_on_numbers(&self, operand: usize) -> bool {
        let own = 1 << operand;
        let others = || (0..1 << self.operands()).filter(|set| set & own == 0);
        let first = self.wall(operand, [0, own]);
        let mut pairs =
            others().flat_map(|front| others().map(move |behind| [front, behind | own]));
        self.resolved[operand] || pairs.any(|sets| self.wall(operand, sets) != first)
    }

    /// Returns the orientation in which a face of an operand stays that no coplanar face covers, given the
    /// winding numbers in front of it; `None` if it does not stay.
    ///
    /// # Errors
    /// As for [`Self::between`].
    pub(super) fn at(
        &self,
        operand: usize,
        in_front: Numbers,
    ) -> Result<Option<Orientation>, Declined> {
        let mut behind = in_front.clone();
        behind[operand] += 1;
        self.between(operand, &Sides { in_front, behind })
    }

    /// Returns the orientation in which a face of an operand stays, given the winding numbers on both sides;
    /// `None` if it does not stay.
    ///
    /// # Errors
    /// `Overlap` if another operand that is not resolved has a number other than 0 and 1.
    pub(super) fn between(
        &self,
        operand: usize,
        sides: &Sides,
    ) -> Result<Option<Orientation>, Declined> {
        let sets = [&sides.in_front, &sides.behind].map(|numbers| self.set(operand, numbers));
        let [in_front, behind] = sets;
        Ok(self.wall(operand, [in_front?, behind?]))
    }

    /// Returns the set of operands, as bits, that contain a point with these winding numbers beside a face of
    /// `operand`.
    fn set(&self, operand: usize, numbers: &Numbers) -> Result<usize, Declined> {
        let mut set = 0;
        for (k, number) in numbers.iter().enumerate() {
            if k != operand && !self.resolved[k] && !(0..=1).contains(number) {
                return Err(Declined::Overlap(k));
            }
            set |= usize::from(self.rule.inside(*number)) << k;
        }
        Ok(set)
    }
}

/// Returns the orientation in which a face bounds the result, given whether the result is inside in front of
/// the face and behind it; `None` if both are equal.
fn orientation_between(in_front: bool, behind: bool) -> Option<Orientation> {
    (behind != in_front).then(|| Orientation::turned_around(in_front))
}
