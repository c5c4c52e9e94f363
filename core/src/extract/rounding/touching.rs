//! Finds vertices of a rounded mesh with equal doubles, at which surfaces touch.

use std::hash::BuildHasher;

use rustc_hash::{FxBuildHasher, FxHashSet as HashSet};

use crate::arith::convert::as_number;
use crate::extract::mesh::Corner;
use crate::geometry::doubles::{bit_key, Point};
use crate::interrupt::spend;
use crate::mesh::tasks::{each_chunk, CHUNK};

/// The bits of the three coordinates of a point, for comparing.
type Digits = [u64; 3];

/// Vertices with the same doubles as another vertex, by cause; each list ascends.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Touching {
    /// Vertices at points where at least one vertex was put by rounding, or by mending.
    pub rounded: Vec<u64>,
    /// Vertices at points where every vertex is given by an input.
    pub given: Vec<u64>,
}

/// Returns the used vertices with the same doubles as another one, except copies made by splitting a
/// contact.
///
/// Vertices without an entry in `corners` are copies that mending made. `is_given` is true for a vertex that
/// has the doubles of its input.
///
/// # Cost
/// Two passes over the vertices.
pub fn touching(
    vertices: &[Point],
    corners: &[Corner],
    is_used: impl Fn(u32) -> bool + Sync,
    is_given: impl Fn(u32) -> bool,
) -> Touching {
    let mut found = Touching::default();
    let corner = |v: u32| corners.get(v as usize);
    let mut candidates = candidates(vertices, is_used);
    candidates.sort_unstable();
    for group in candidates.chunk_by(|a, b| a.0 == b.0) {
        let first = corner(group[0].1);
        let is_split = first.is_some() && group.iter().all(|v| corner(v.1) == first);
        if group.len() == 1 || is_split {
            continue;
        }
        let list = if group.iter().all(|v| is_given(v.1)) {
            &mut found.given
        } else {
            &mut found.rounded
        };
        list.extend(group.iter().map(|v| u64::from(v.1)));
    }
    found.rounded.sort_unstable();
    found.given.sort_unstable();
    found
}

/// Returns the used vertices, each with the bits of its coordinates, that share their position with another
/// vertex; a small number of other vertices may be among them.
fn candidates(vertices: &[Point], is_used: impl Fn(u32) -> bool + Sync) -> Vec<(Digits, u32)> {
    let places = repeated(vertices);
    if places.is_empty() {
        return Vec::new();
    }
    let filter = Filter::of(&places);
    let found = each_chunk(vertices, |first, chunk| {
        let numbered = (as_number(first)..).zip(chunk.iter().map(bit_key));
        let is_there =
            |(_, place): &(u32, Digits)| filter.may_have(place) && places.contains(place);
        let found = numbered
            .filter(is_there)
            .filter(|(v, _)| is_used(*v))
            .map(|(v, place)| (place, v));
        found.collect::<Vec<(Digits, u32)>>()
    });
    found.concat()
}

/// Returns the points at which several vertices lie; a small number of other points may be among them.
fn repeated(vertices: &[Point]) -> HashSet<Digits> {
    let mut filter = Filter::for_places(vertices.len());
    let mut places = HashSet::default();
    for chunk in vertices.chunks(CHUNK) {
        spend(chunk.len());
        let placed = chunk.iter().map(bit_key);
        places.extend(placed.filter(|place| !filter.add(place)));
    }
    places
}

/// A bit table that rules out most points that are not in a set.
struct Filter {
    words: Vec<u64>,
    shift: u32,
}

impl Filter {
    /// The number of table bits per point in the set: one in this many points outside the set is not ruled
    /// out.
    const BITS_PER_PLACE: usize = 16;

    /// The number of bits in a word of the table.
    const WORD: u32 = u64::BITS;

    fn for_places(count: usize) -> Self {
        let bits = (Self::BITS_PER_PLACE * count)
            .next_power_of_two()
            .ilog2()
            .max(6);
        Self {
            words: vec![0; (1 << bits) / Self::WORD as usize],
            shift: u64::BITS - bits,
        }
    }

    fn of(places: &HashSet<Digits>) -> Self {
        let mut filter = Self::for_places(places.len());
        for place in places {
            filter.add(place);
        }
        filter
    }

    /// Adds a point; returns true if it was certainly not in the set.
    #[inline]
    fn add(&mut self, place: &Digits) -> bool {
        let (word, bit) = self.at(place);
        let is_new = self.words[word] & bit == 0;
        self.words[word] |= bit;
        is_new
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

    /// A hash by multiplication alone would give all these points one bit.
    #[test]
    fn short_coordinates_are_told_apart() {
        let line = || (0..16).map(f64::from);
        let square = || line().flat_map(|x| line().map(move |y| [x, y, 0.5]));
        let places: HashSet<Digits> = square().map(|p| bit_key(&p)).collect();
        let filter = Filter::of(&places);
        let taken: u32 = filter.words.iter().map(|word| word.count_ones()).sum();
        assert!(places.len() == 256 && taken > 200, "{taken}");
    }

    fn source(slot: u32, vertex: u32) -> Corner {
        Corner::Source(Slot(slot), VertexId(vertex))
    }

    fn found(vertices: &[(Point, Option<Corner>)]) -> [Vec<u64>; 2] {
        let places: Vec<Point> = vertices.iter().map(|v| v.0).collect();
        let corners: Vec<Corner> = vertices.iter().filter_map(|v| v.1).collect();
        let is_given = |v: u32| matches!(vertices[v as usize].1, Some(Corner::Source(..)));
        let found = touching(&places, &corners, |v| v != 1006, is_given);
        [found.rounded, found.given]
    }

    #[test]
    fn vertices_in_one_place_are_found_and_copies_of_one_are_not() {
        let many = (0..1000).map(|i| ([f64::from(i), 7.0, 7.0], Some(Corner::Point(i))));
        let zero = [0.0, -0.0, 0.0];
        let few = [
            // A constructed point and a vertex of an input.
            ([1.0, 2.0, 0.0], Some(Corner::Point(1000))),
            ([1.0, 2.0, 0.0], Some(source(0, 0))),
            // Two constructed points.
            (zero, Some(Corner::Point(1001))),
            (zero.map(|x| -x), Some(Corner::Point(1002))),
            // Copies of one point.
            ([5.0; 3], Some(Corner::Point(1003))),
            ([5.0; 3], Some(Corner::Point(1003))),
            // A point that no triangle uses.
            ([5.0; 3], Some(Corner::Point(1004))),
        ];
        let all: Vec<(Point, Option<Corner>)> = many.chain(few).collect();
        assert_eq!(found(&all), [vec![1000, 1001, 1002, 1003], vec![]]);
        assert_eq!(found(&all[..1001]), [Vec::<u64>::new(), Vec::new()]);
    }

    // Found: meshes touched themselves at vertices that an input has at equal coordinates without sharing
    // them, and no finding named them.
    #[test]
    fn vertices_that_an_input_has_in_one_place_are_found() {
        let pair = |x: f64, corners: [Corner; 2]| corners.map(|corner| ([x; 3], Some(corner)));
        let own = pair(6.0, [source(0, 1), source(0, 7)]);
        let split = pair(7.0, [source(0, 2); 2]);
        let cut = pair(8.0, [source(0, 3), Corner::Point(0)]);
        assert_eq!(found(&[own, split, cut].concat()), [vec![4, 5], vec![0, 1]]);
    }

    // Found: vertices that mending copied had equal doubles, and no finding named them.
    #[test]
    fn copies_that_mending_made_are_found() {
        let given = ([3.0; 3], Some(source(0, 0)));
        let copy = |x: f64| ([x; 3], None);
        assert_eq!(found(&[given, copy(3.0)]), [vec![0, 1], vec![]]);
        assert_eq!(found(&[given, copy(4.0), copy(4.0)]), [vec![1, 2], vec![]]);
        assert_eq!(found(&[given, copy(4.0)]), [Vec::<u64>::new(), Vec::new()]);
    }
}
