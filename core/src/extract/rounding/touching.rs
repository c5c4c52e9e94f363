//! Vertices that rounding puts in one place, where surfaces then touch.

use std::hash::BuildHasher;

use rustc_hash::{FxBuildHasher, FxHashSet as HashSet};

use crate::arith::convert::as_number;
use crate::extract::mesh::Corner;
use crate::geometry::doubles::{digits, Point};
use crate::mesh::tasks::each_chunk;

/// The digits of a place.
type Digits = [u64; 3];

/// The vertices in use, ascending, that have the place of another although they are other points.
///
/// Inputs are welded, so that one of such vertices is a constructed point.
///
/// # Cost
/// A pass over the vertices, if any is constructed.
pub fn touching(
    vertices: &[Point],
    corners: &[Corner],
    is_used: impl Fn(u32) -> bool + Sync,
) -> Vec<u64> {
    let placed = || vertices.iter().map(digits).zip(corners);
    let constructed = placed().filter(|(_, c)| matches!(c, Corner::Point(_)));
    let places: HashSet<Digits> = constructed.map(|(place, _)| place).collect();
    if places.is_empty() {
        return Vec::new();
    }
    let filter = Filter::of(&places);
    let candidates = each_chunk(&vertices[..corners.len()], |first, chunk| {
        let numbered = (as_number(first)..).zip(chunk.iter().map(digits));
        let is_there =
            |(_, place): &(u32, Digits)| filter.may_have(place) && places.contains(place);
        let found = numbered
            .filter(is_there)
            .filter(|(v, _)| is_used(*v))
            .map(|(v, place)| (place, v));
        found.collect::<Vec<(Digits, u32)>>()
    });
    let mut candidates = candidates.concat();
    candidates.sort_unstable();
    let corner = |v: u32| corners[v as usize];
    let groups = candidates.chunk_by(|a, b| a.0 == b.0);
    let several = groups.filter(|group| group.iter().any(|v| corner(v.1) != corner(group[0].1)));
    let mut found: Vec<u64> = several.flatten().map(|v| u64::from(v.1)).collect();
    found.sort_unstable();
    found
}

/// Bits by which most places are told not to be in a set.
struct Filter {
    words: Vec<u64>,
    shift: u32,
}

impl Filter {
    /// Bits for each place in the set: one in so many others looks as if it were there.
    const ROOM: usize = 16;

    /// The places in a word.
    const WORD: u32 = u64::BITS;

    fn of(places: &HashSet<Digits>) -> Self {
        let bits = (Self::ROOM * places.len())
            .next_power_of_two()
            .ilog2()
            .max(6);
        let mut filter = Self {
            words: vec![0; (1 << bits) / Self::WORD as usize],
            shift: u64::BITS - bits,
        };
        for place in places {
            let (word, bit) = filter.at(place);
            filter.words[word] |= bit;
        }
        filter
    }

    #[inline]
    fn may_have(&self, place: &Digits) -> bool {
        let (word, bit) = self.at(place);
        self.words[word] & bit != 0
    }

    #[allow(
        clippy::cast_possible_truncation,
        reason = "the number of a word is below the number of words"
    )]
    fn at(&self, place: &Digits) -> (usize, u64) {
        let number = FxBuildHasher.hash_one(place) >> self.shift;
        let (word, bit) = (
            number / u64::from(Self::WORD),
            number % u64::from(Self::WORD),
        );
        (word as usize, 1 << bit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::handle::{Slot, VertexId};

    /// A product hash alone gives all of them one bit.
    #[test]
    fn short_coordinates_are_told_apart() {
        let line = || (0..16).map(f64::from);
        let square = || line().flat_map(|x| line().map(move |y| [x, y, 0.5]));
        let places: HashSet<Digits> = square().map(|p| digits(&p)).collect();
        let filter = Filter::of(&places);
        let taken: u32 = filter.words.iter().map(|word| word.count_ones()).sum();
        assert!(places.len() == 256 && taken > 200, "{taken}");
    }

    #[test]
    fn other_points_in_one_place_are_found_and_copies_of_one_are_not() {
        let source = |slot: u32, vertex: u32| Corner::Source(Slot(slot), VertexId(vertex));
        let one = [1.0, 2.0, 0.0];
        let zero = [0.0, -0.0, 0.0];
        let many = (0..1000).map(|i| ([f64::from(i), 7.0, 7.0], Corner::Point(i)));
        let few = [
            // A point and a vertex of an input.
            (one, Corner::Point(1000)),
            (one, source(0, 0)),
            // Two points.
            (zero, Corner::Point(1001)),
            (zero.map(|x| -x), Corner::Point(1002)),
            // Copies of one.
            ([5.0; 3], Corner::Point(1003)),
            ([5.0; 3], Corner::Point(1003)),
            // No constructed ones.
            ([6.0; 3], source(0, 1)),
            ([6.0; 3], source(1, 1)),
        ];
        let (vertices, corners): (Vec<Point>, Vec<Corner>) = many.chain(few).unzip();
        let found = touching(&vertices, &corners, |_| true);
        assert_eq!(found, [1000, 1001, 1002, 1003]);
        assert_eq!(touching(&vertices, &corners, |v| v != 1003), found[..2]);
        assert!(touching(&vertices[1006..], &corners[1006..], |_| true).is_empty());
    }
}
