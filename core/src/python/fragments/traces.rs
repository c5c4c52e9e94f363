//! Converts traces of fragment trees to plain tuples.

use super::convert::cut_row;
use super::facet_tree::sign;
use crate::geometry::side::Half;
use crate::query::path::RayEvent;
use crate::tree::fragments::{Candidate, Division, Reason};

/// A node's number, its parent or −1, its side of the parent's cut, its depth, the row of its cut, and the
/// reason for the cut.
type Place = (u32, i64, i8, u32, [i64; 2], &'static str);

/// A candidate for a cut: its piece; the numbers of pieces on the minus side, on the plus side and on both
/// sides; its score.
pub type CandidateRow = (u32, u32, u32, u32, f64);

/// A division: the node; the candidates for the cut; lists of the pieces in the region, on the minus side, on
/// the plus side, split by the cut, and in the cut.
pub type DivisionRow = (Place, Vec<CandidateRow>, [Vec<u32>; 5]);

/// An event of a ray: kind, node, piece, side; the parameters of entering, leaving and crossing.
pub type EventRow = (
    &'static str,
    i64,
    i64,
    i8,
    Option<f64>,
    Option<f64>,
    Option<f64>,
);

pub fn division_row(division: Division) -> DivisionRow {
    let (parent, side) = match division.place {
        None => (-1, 0),
        Some((parent, Half::Minus)) => (i64::from(parent), -1),
        Some((parent, Half::Plus)) => (i64::from(parent), 1),
    };
    let place = (
        division.node.0,
        parent,
        side,
        division.depth,
        cut_row(division.cut),
        reason(division.reason),
    );
    let candidates = division.candidates.iter().map(candidate_row).collect();
    let lists = [
        division.pieces,
        division.minus,
        division.plus,
        division.split,
        division.coplanar,
    ];
    (place, candidates, lists)
}

pub fn candidate_row(candidate: &Candidate) -> CandidateRow {
    let Candidate {
        piece,
        minus,
        plus,
        splits,
        score,
    } = *candidate;
    (piece, minus, plus, splits, score)
}

fn reason(reason: Reason) -> &'static str {
    match reason {
        Reason::First => "first",
        Reason::Random => "random",
        Reason::LeastSplits => "least-splits",
        Reason::Balanced => "balanced",
        Reason::Weighted => "weighted",
        Reason::LeastCost => "least-cost",
        Reason::Median => "median",
        Reason::Given => "given",
        Reason::Asked => "asked",
        Reason::Ends => "end-points",
    }
}

pub fn event_row(event: &RayEvent) -> EventRow {
    match *event {
        RayEvent::Visit {
            node,
            from,
            to,
            near,
            at,
        } => ("visit", node.into(), -1, sign(near), Some(from), to, at),
        RayEvent::Test { node, piece, at } => {
            ("test", node.into(), piece.into(), 0, None, None, at)
        }
        RayEvent::Leaf { place, from, to } => {
            let (node, side) = match place {
                None => (-1, 0),
                Some((node, Half::Minus)) => (node.into(), -1),
                Some((node, Half::Plus)) => (node.into(), 1),
            };
            ("leaf", node, -1, side, Some(from), to, None)
        }
    }
}
