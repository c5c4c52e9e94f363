//! Disjoint sets of numbers: what is connected with what.

use crate::arith::convert::as_number;

/// Numbers from 0 on in sets, each set named by its least.
///
/// # Source
/// Tarjan, van Leeuwen, *Worst-case analysis of set union algorithms*, 1984: linking by index, and
/// ways that are halved.
///
/// # Example
/// ```
/// use bspcsg::mesh::disjoint::DisjointSets;
///
/// let mut sets = DisjointSets::of_one(4);
/// sets.join(3, 1);
/// assert_eq!([0, 1, 2, 3].map(|k| sets.least(k)), [0, 1, 2, 1]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct DisjointSets {
    lower: Vec<u32>,
}

impl DisjointSets {
    /// So many numbers, each in a set of its own.
    pub fn of_one(count: usize) -> Self {
        Self {
            lower: (0..as_number(count)).collect(),
        }
    }

    /// No numbers yet, and room for some.
    pub fn with_capacity(count: usize) -> Self {
        Self {
            lower: Vec::with_capacity(count),
        }
    }

    /// The number after the last.
    pub fn end(&self) -> u32 {
        as_number(self.lower.len())
    }

    /// Adds the number after the last, in a set of its own.
    pub fn push(&mut self) -> u32 {
        let next = self.end();
        self.lower.push(next);
        next
    }

    /// The least number of a set; the way there is halved for the next question.
    #[inline]
    pub fn least(&mut self, number: u32) -> u32 {
        let mut at = number as usize;
        while self.lower[at] as usize != at {
            self.lower[at] = self.lower[self.lower[at] as usize];
            at = self.lower[at] as usize;
        }
        as_number(at)
    }

    /// Makes two sets one.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.least(a), self.least(b));
        self.join_named(a, b);
    }

    /// Makes two sets one, given by their names, and returns that one's.
    #[inline]
    pub fn join_named(&mut self, a: u32, b: u32) -> u32 {
        let least = a.min(b);
        self.lower[a.max(b) as usize] = least;
        least
    }
}
