//! The segments in which faces of two operands cross, and the points at their ends.

use std::sync::atomic::{AtomicUsize, Ordering};

use rustc_hash::FxHashMap as HashMap;

use super::candidates::{Candidates, Operand};
use super::contact::{contact, Contact, End};
use super::triangulation::Special;
use crate::arith::convert::as_number;
use crate::geometry::doubles::Facing;
use crate::interrupt::{poll, spend};
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::Worth;

/// Pairs for each candidate beyond which faces are crowded: boxes do not tell needles apart, and the
/// sweeps of the descent do.
const PAIRS_FOR_EACH: usize = 24;

/// A point in which an edge of one operand goes through a face of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Crossing {
    /// The operand that the edge is of.
    pub(super) of: usize,
    /// The ends of the edge, the lower number first.
    pub(super) edge: [VertexId; 2],
    /// The face, by its number among the other operand's candidates.
    pub(super) face: u32,
}

/// A segment in a face. In front of the face, what is behind the other face lies on its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// The face, by its number among the candidates.
    pub(super) face: u32,
    /// The face of the other operand, the same way.
    pub(super) other: u32,
    /// The points at the ends.
    pub(super) ends: [u32; 2],
}

/// Where two operands cross.
#[derive(Debug, Default)]
pub(super) struct Segments {
    /// The points, each once.
    pub(super) points: Vec<Crossing>,
    /// The segments by operand, those of a face one after the other.
    pub(super) of: [Vec<Segment>; 2],
}

/// Two candidates that cross, and the ends of the segment as the first one has it.
struct Met {
    pair: [u32; 2],
    ends: [End; 2],
}

/// The segments of all pairs.
///
/// # Errors
/// `Special` if faces meet in another way than that edges go through faces, or are crowded.
pub(super) fn segments(
    operands: &[Operand; 2],
    candidates: &[Candidates; 2],
    worth: Worth,
) -> Result<Segments, Special> {
    let faces: usize = candidates.iter().map(|c| c.faces.len()).sum();
    let left = AtomicUsize::new(PAIRS_FOR_EACH * faces);
    let visit = |block: &[[u32; 2]]| {
        let take = |left: usize| left.checked_sub(block.len());
        left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
            .map_err(|_| Special)?;
        met(candidates, block).inspect_err(|_| left.store(0, Ordering::Relaxed))
    };
    let [first, second] = candidates;
    let met = first.tree.each_block(&second.tree, worth, visit)?;
    Ok(numbered(operands, candidates, met))
}

fn met(candidates: &[Candidates; 2], pairs: &[[u32; 2]]) -> Result<Vec<Met>, Special> {
    spend(pairs.len());
    let mut found = Vec::new();
    for run in pairs.chunk_by(|p, q| p[0] == q[0]) {
        let first = Facing::of(&candidates[0].triangles[run[0][0] as usize]);
        for pair in run {
            let second = Facing::of(&candidates[1].triangles[pair[1] as usize]);
            match contact(&first, &second) {
                Contact::Apart => {}
                Contact::Crossing(ends) => found.push(Met { pair: *pair, ends }),
                Contact::Special => return Err(Special),
            }
        }
    }
    Ok(found)
}

/// Gives each point one number: both faces at an edge find it.
fn numbered(operands: &[Operand; 2], candidates: &[Candidates; 2], met: Vec<Vec<Met>>) -> Segments {
    let mut segments = Segments::default();
    let mut numbers: HashMap<Crossing, u32> = HashMap::default();
    for Met { pair, ends } in met.into_iter().flatten() {
        poll();
        let ends = ends.map(|end| {
            let corners = candidates[end.of].corners(operands[end.of].mesh, pair[end.of]);
            let [a, b] = end.edge.map(|i| corners[i]);
            let crossing = Crossing {
                of: end.of,
                edge: [a.min(b), a.max(b)],
                face: pair[1 - end.of],
            };
            *numbers.entry(crossing).or_insert_with(|| {
                segments.points.push(crossing);
                as_number(segments.points.len() - 1)
            })
        });
        for (k, ends) in [ends, [ends[1], ends[0]]].into_iter().enumerate() {
            let (face, other) = (pair[k], pair[1 - k]);
            segments.of[k].push(Segment { face, other, ends });
        }
    }
    for list in &mut segments.of {
        list.sort_unstable_by_key(|s| (s.face, s.other));
    }
    segments
}
