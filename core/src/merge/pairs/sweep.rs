//! Finds pairs of elements whose extents overlap, by sweeps along lines.
//!
//! A line is a coordinate axis, or lies along or across the main direction of long elements: the boxes of
//! needles overlap, but rarely their projections on a line across them. Triangles around a common corner
//! overlap in every projection, but rarely as seen from that corner. In the plane of the two best lines, the
//! edges of triangles exclude further boxes.

use super::direction::{largest_coordinate, Span};
use super::line::{longest_edge, MeasuredLine, SLANTED_LINES_FROM};
use super::rim::{rims, HalfPlane};
use super::SweptElement;
use crate::arith::convert::as_double;
use crate::geometry::doubles::vector::dot;
use crate::interrupt::spend;
use crate::mesh::tasks::{each, WorkSize};

/// The most pairs that a sweep may compare, at about a nanosecond each; a longer sweep costs more than
/// halving the cell.
const MAX_PAIRS_SWEPT: f64 = 3e8;

/// The number of pairs of extents compared per unit of work, after which the program checks whether to stop.
const PAIRS_PER_UNIT: usize = 16;

/// Calls `report` for all pairs of elements (triangles or parts of faces) of different operands whose extents
/// overlap along every line, the lower index first. Returns `None`, before any call, if more than
/// `MAX_PAIRS_SWEPT` pairs would be compared.
pub fn pairs(elements: &[SweptElement], mut report: impl FnMut(usize, usize)) -> Option<()> {
    let groups = groups_by_length(elements);
    let sweeps = each(WorkSize::Task, groups.iter().collect(), |numbers| {
        Sweep::of(elements, numbers)
    });
    if sweeps.iter().map(Sweep::cost).sum::<f64>() > MAX_PAIRS_SWEPT {
        return None;
    }
    let found = each(WorkSize::Task, sweeps.iter().collect(), Sweep::run);
    found.into_iter().flatten().for_each(|(i, j)| report(i, j));
    Some(())
}

/// Returns groups of element indices to be swept separately: one group or, if two operands have many elements
/// (triangles or parts of faces), up to four groups, each with the long or the short elements of each
/// operand, because these suit different lines.
fn groups_by_length(elements: &[SweptElement]) -> Vec<Vec<usize>> {
    let own = elements[0].operand;
    let (ours, others): (Vec<usize>, Vec<usize>) =
        (0..elements.len()).partition(|i| elements[*i].operand == own);
    let alike = |k: &usize| elements[*k].operand == elements[others[0]].operand;
    if elements.len() <= SLANTED_LINES_FROM || others.is_empty() || !others.iter().all(alike) {
        return vec![(0..elements.len()).collect()];
    }
    let (ours, others) = (by_length(elements, ours), by_length(elements, others));
    let joint = |a: &Vec<usize>, b: &Vec<usize>| [a.as_slice(), b].concat();
    ours.iter()
        .flat_map(|a| others.iter().map(move |b| joint(a, b)))
        .collect()
}

/// Divides elements (triangles or parts of faces) into those at least half as long as the longest, and the
/// shorter ones; empty groups are left out.
fn by_length(elements: &[SweptElement], numbers: Vec<usize>) -> Vec<Vec<usize>> {
    let length = |i: &usize| {
        let edge = elements[*i].corners.as_ref().and_then(longest_edge);
        edge.map_or(0.0, |e| dot(&e, &e).sqrt())
    };
    let longest = numbers.iter().map(length).fold(0.0, f64::max);
    let (long, short): (Vec<usize>, Vec<usize>) = numbers
        .into_iter()
        .partition(|i| 2.0 * length(i) >= longest);
    [long, short]
        .into_iter()
        .filter(|group| !group.is_empty())
        .collect()
}

/// One sweep over triangles or parts of faces, by operand, sorted along the line on which they overlap least.
struct Sweep {
    operands: Vec<SortedElements>,
    size: usize,
    crowding: f64,
}

/// The elements (triangles or parts of faces) of one operand, sorted along the line on which the elements of
/// all operands overlap least.
struct SortedElements {
    /// The extents of the elements (triangles or parts of faces) along the line on which they overlap least.
    first: Vec<Span>,
    /// The extents of the elements (triangles or parts of faces) along the next best line.
    second: Vec<Span>,
    /// The extents of the elements (triangles or parts of faces) along each further line.
    others: Vec<Vec<Span>>,
    /// The three half-planes that bound each element (a triangle or part of a face) in the plane of the two
    /// best lines.
    rims: Vec<[HalfPlane; 3]>,
    numbers: Vec<usize>,
}

impl Sweep {
    fn of(elements: &[SweptElement], numbers: &[usize]) -> Self {
        let swept: Vec<&SweptElement> = numbers.iter().map(|i| &elements[*i]).collect();
        let mut lines = MeasuredLine::all(&swept);
        lines.sort_by(|a, b| a.crowding.total_cmp(&b.crowding));
        let first = lines.remove(0);
        let across = |line: &MeasuredLine| line.coordinate.is_across(&first.coordinate);
        let second = lines.remove(lines.iter().position(across).unwrap_or(0));
        let plane = [first.coordinate, second.coordinate];
        let size = largest_coordinate(&swept);
        let low = |i: &usize| first.spans[*i][0];
        let mut order: Vec<usize> = (0..numbers.len()).collect();
        order.sort_unstable_by(|a, b| {
            let operands = swept[*a].operand.cmp(&swept[*b].operand);
            operands.then(low(a).total_cmp(&low(b))).then(a.cmp(b))
        });
        let rim = |i: &usize| rims(swept[*i].corners.as_ref(), &plane, size);
        let sorted = |own: &[usize]| {
            let ordered =
                |line: &MeasuredLine| own.iter().map(|i| line.spans[*i]).collect::<Vec<Span>>();
            SortedElements {
                first: ordered(&first),
                second: ordered(&second),
                others: lines.iter().map(ordered).collect(),
                rims: own.iter().map(rim).collect(),
                numbers: own.iter().map(|i| numbers[*i]).collect(),
            }
        };
        let operands = order.chunk_by(|a, b| swept[*a].operand == swept[*b].operand);
        Self {
            operands: operands.map(sorted).collect(),
            size: numbers.len(),
            crowding: first.crowding,
        }
    }

    /// Returns the approximate number of pairs that the sweep compares.
    fn cost(&self) -> f64 {
        self.crowding * as_double(self.size)
    }

    /// Returns the pairs of elements (triangles or parts of faces) of different operands that may meet, the
    /// lower index first.
    fn run(&self) -> Vec<(usize, usize)> {
        let mut found = Vec::new();
        let mut report = |i: usize, j: usize| found.push((i.min(j), i.max(j)));
        for (k, sorted) in self.operands.iter().enumerate() {
            for other in &self.operands[k + 1..] {
                sorted.report_pairs_after(other, true, &mut report);
                other.report_pairs_after(sorted, false, &mut report);
            }
        }
        found
    }
}

impl SortedElements {
    /// Calls `report` for each element (a triangle or part of a face) and those overlapping elements of
    /// `other` that begin after it along the best line, or also at the same coordinate if `level` is true.
    fn report_pairs_after(&self, other: &Self, level: bool, report: &mut impl FnMut(usize, usize)) {
        let mut start = 0;
        for (at, [low, high]) in self.first.iter().enumerate() {
            let before = |span: &Span| span[0] < *low || !level && span[0] <= *low;
            start += other.first[start..].partition_point(before);
            let end = start + other.first[start..].partition_point(|span| span[0] <= *high);
            spend(1 + (end - start) / PAIRS_PER_UNIT);
            let [low, high] = self.second[at];
            for (next, span) in (start..end).zip(&other.second[start..end]) {
                if span[0] <= high && span[1] >= low && self.may_meet(at, other, next) {
                    report(self.numbers[at], other.numbers[next]);
                }
            }
        }
    }

    fn may_meet(&self, a: usize, other: &Self, b: usize) -> bool {
        let beyond = |one: &Self, i: usize, two: &Self, j: usize| {
            let spans = [two.first[j], two.second[j]];
            one.rims[i].iter().any(|rim| rim.excludes(&spans))
        };
        let overlap =
            |(one, two): (&Vec<Span>, &Vec<Span>)| one[a][0] <= two[b][1] && two[b][0] <= one[a][1];
        !beyond(self, a, other, b)
            && !beyond(other, b, self, a)
            && self.others.iter().zip(&other.others).all(overlap)
    }
}
