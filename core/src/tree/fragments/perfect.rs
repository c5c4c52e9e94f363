//! Perfect autopartitions: trees of supporting hyperplanes that cut no piece.
//!
//! Deciding whether one exists is NP-hard, so this is an exhaustive search with a limit. A hyperplane that
//! cuts nothing is not always a good choice: it may be the only one that could separate other pieces later.
//! So the search tries every such pivot, and caches the result for each set of pieces.
//!
//! # Source
//! de Berg, Khosravi, "Finding perfect auto-partitions is NP-hard", 2008.

use rustc_hash::FxHashMap;

use super::node::{NodeCut, Piece};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::Split;
use crate::geometry::spaces::affine::Affine;
use crate::interrupt::poll;

/// The largest number of pieces (convex parts of facets) for the exhaustive search, which caches up to 2^24
/// sets.
pub const PERFECT_LIMIT: usize = 24;

/// For the hyperplane of one piece (a convex part of a facet), three bit sets of pieces: those on its minus
/// side, on its plus side, and those it cuts.
#[derive(Clone, Copy, Debug, Default)]
struct Sides {
    minus: u32,
    plus: u32,
    split: u32,
}

/// The cuts, in preorder, of a tree of supporting hyperplanes that cuts no piece (a convex part of a facet);
/// `None` if there is no such tree.
///
/// # Errors
/// `TooMany` if there are more than [`PERFECT_LIMIT`] pieces.
pub fn perfect<S: Affine>(pieces: &[Piece<S>]) -> Result<Option<Vec<NodeCut>>> {
    if pieces.len() > PERFECT_LIMIT {
        let text = format!(
            "the search for a perfect autopartition takes at most {PERFECT_LIMIT} facets, not {}; \
             build the tree with a policy instead",
            pieces.len()
        );
        return Err(Error::new(ErrorKind::TooMany, text));
    }
    let mut search = Search {
        sides: pieces.iter().map(|p| sides_of(p, pieces)).collect(),
        pivots: FxHashMap::default(),
    };
    let all = (0..pieces.len()).fold(0, |set, i| set | 1 << i);
    if !search.decide(all) {
        return Ok(None);
    }
    let cut = |bit: usize| NodeCut::Pivot(pieces[bit].number);
    Ok(Some(search.preorder(all).into_iter().map(cut).collect()))
}

fn sides_of<S: Affine>(pivot: &Piece<S>, pieces: &[Piece<S>]) -> Sides {
    let cut = S::hyperplane(&pivot.fragment);
    let mut sides = Sides::default();
    for (i, piece) in pieces.iter().enumerate() {
        poll();
        match S::relation(&piece.fragment, cut) {
            Split::Minus => sides.minus |= 1 << i,
            Split::Plus => sides.plus |= 1 << i,
            Split::Both { .. } => sides.split |= 1 << i,
            Split::Coplanar(_) => {}
        }
    }
    sides
}

struct Search {
    sides: Vec<Sides>,
    /// For each decided set of pieces (convex parts of facets), a pivot (the piece whose hyperplane divides
    /// first) that leads to a tree which cuts no piece, or `None` if there is no such tree.
    pivots: FxHashMap<u32, Option<usize>>,
}

impl Search {
    /// Return whether a set of pieces (convex parts of facets) has a tree that cuts none of them; recurses at
    /// most as deep as the set has pieces.
    fn decide(&mut self, set: u32) -> bool {
        if set == 0 {
            return true;
        }
        if let Some(known) = self.pivots.get(&set) {
            return known.is_some();
        }
        let pivot = members(set).find(|&bit| {
            let Sides { minus, plus, split } = self.sides[bit];
            set & split == 0 && self.decide(set & minus) && self.decide(set & plus)
        });
        self.pivots.insert(set, pivot);
        pivot.is_some()
    }

    fn preorder(&self, all: u32) -> Vec<usize> {
        let mut order = Vec::new();
        let mut pending = vec![all];
        while let Some(set) = pending.pop() {
            poll();
            if let Some(&Some(pivot)) = self.pivots.get(&set) {
                order.push(pivot);
                pending.extend([set & self.sides[pivot].plus, set & self.sides[pivot].minus]);
            }
        }
        order
    }
}

fn members(set: u32) -> impl Iterator<Item = usize> {
    (0..PERFECT_LIMIT).filter(move |bit| set >> bit & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spaces::dim2::Dim2;

    fn segments(ends: &[[i64; 4]]) -> Vec<Piece<Dim2>> {
        let piece = |(number, [a, b, c, d]): (u32, &[i64; 4])| Piece {
            fragment: Dim2::fragment(&[[*a, *b, 0], [*c, *d, 0]]).unwrap(),
            number,
        };
        (0..).zip(ends).map(piece).collect()
    }

    #[test]
    fn a_pinwheel_has_none() {
        // The line of each segment cuts the next segment.
        let wheel = [
            [-1, -3, -1, 1],
            [-3, 1, 1, 1],
            [1, 3, 1, -1],
            [3, -1, -1, -1],
        ];
        assert!(perfect(&segments(&wheel)).unwrap().is_none());
        assert!(perfect(&segments(&wheel[..3])).unwrap().is_some());
    }

    #[test]
    fn parallel_segments_have_one_and_too_many_are_refused() {
        let rows: Vec<[i64; 4]> = (0..25).map(|y| [0, y, 9, y]).collect();
        let found = perfect(&segments(&rows[..24])).unwrap().unwrap();
        assert_eq!(found.len(), 24);
        let refused = perfect(&segments(&rows)).unwrap_err();
        assert_eq!(refused.kind(), ErrorKind::TooMany);
    }

    #[test]
    fn no_pieces_have_an_empty_one() {
        assert_eq!(perfect(&segments(&[])).unwrap(), Some(Vec::new()));
    }
}
