//! Disjoint sets of the integers from 0 on, for connected components.

use super::handle::VertexId;
use crate::arith::convert::as_number;
use crate::interrupt::spend;

/// The integers from 0 on, divided into disjoint sets; the least integer of a set is its name.
///
/// # Source
/// Tarjan, van Leeuwen, *Worst-case analysis of set union algorithms*, 1984: linking by index, and path
/// halving.
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
    /// The integers below `count`, each in a set of its own.
    pub fn of_one(count: usize) -> Self {
        Self {
            lower: (0..as_number(count)).collect(),
        }
    }

    /// Disjoint sets of the vertex numbers below `count`; vertices that triangles connect are in one set.
    ///
    /// A first pass links each vertex to a small vertex number of its triangles. Usually this already leads
    /// to the least number of the set, so that the second pass joins few sets.
    ///
    /// # Example
    /// ```
    /// use bspcsg::mesh::disjoint::DisjointSets;
    /// use bspcsg::mesh::handle::VertexId;
    ///
    /// let triangles = VertexId::rows([[5, 1, 2], [0, 3, 4], [2, 1, 6]]);
    /// let mut sets = DisjointSets::of_triangles(7, &triangles);
    /// assert_eq!([2, 4, 6].map(|v| sets.least(v)), [1, 0, 1]);
    /// ```
    pub fn of_triangles(count: usize, triangles: &[[VertexId; 3]]) -> Self {
        let mut sets = Self::of_one(count);
        spend(triangles.len());
        for corners in triangles {
            let least = sets.least_of_corners(corners);
            for v in corners {
                sets.lower[v.index()] = least;
            }
        }
        sets.flatten();
        spend(triangles.len());
        for corners @ [a, b, c] in triangles {
            let least = sets.least_of_corners(corners);
            if corners.iter().any(|v| sets.lower[v.index()] != least) {
                sets.join(a.0, b.0);
                sets.join(a.0, c.0);
            }
        }
        sets.flatten();
        sets
    }

    /// The least of the numbers to which the three vertices of a triangle are linked.
    #[inline]
    fn least_of_corners(&self, [a, b, c]: &[VertexId; 3]) -> u32 {
        let lower = |v: &VertexId| self.lower[v.index()];
        lower(a).min(lower(b)).min(lower(c))
    }

    /// Links each number directly to the least number of its set. Numbers are linked to lower numbers, which
    /// this pass handles first.
    fn flatten(&mut self) {
        for at in 0..self.lower.len() {
            self.lower[at] = self.lower[self.lower[at] as usize];
        }
    }

    /// An empty collection of sets, with memory reserved for `count` integers.
    pub fn with_capacity(count: usize) -> Self {
        Self {
            lower: Vec::with_capacity(count),
        }
    }

    /// The number of integers in all sets, which is also the next integer to add.
    pub fn end(&self) -> u32 {
        as_number(self.lower.len())
    }

    /// Adds the next integer, in a set of its own, and returns it.
    pub fn push(&mut self) -> u32 {
        let next = self.end();
        self.lower.push(next);
        next
    }

    /// The least number of the set that contains `number`; halves the path to it for later calls.
    #[inline]
    pub fn least(&mut self, number: u32) -> u32 {
        let mut at = number as usize;
        while self.lower[at] as usize != at {
            self.lower[at] = self.lower[self.lower[at] as usize];
            at = self.lower[at] as usize;
        }
        as_number(at)
    }

    /// Joins the sets that contain two numbers.
    #[inline]
    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.least(a), self.least(b));
        self.join_named(a, b);
    }

    /// Joins two sets, given by their least numbers, and returns the least number of the union.
    #[inline]
    pub fn join_named(&mut self, a: u32, b: u32) -> u32 {
        let least = a.min(b);
        self.lower[a.max(b) as usize] = least;
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn triangles_connect_as_their_edges_do(
            rows in prop::collection::vec(prop::array::uniform3(0u32..40), 0..30),
        ) {
            let triangles = VertexId::rows(rows.clone());
            let mut found = DisjointSets::of_triangles(40, &triangles);
            let mut expected = DisjointSets::of_one(40);
            for [a, b, c] in rows {
                expected.join(a, b);
                expected.join(b, c);
            }
            for v in 0..40 {
                prop_assert_eq!(found.least(v), expected.least(v));
            }
        }
    }
}
