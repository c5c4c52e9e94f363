//! Pairs of elements of different operands that may meet, by a sweep along a line.
//!
//! The line is a coordinate axis, or one across the direction in which most elements are long:
//! needles overlap in every box, but hardly in a projection across them.

use crate::geometry::plane::Lattice;

/// An element as the sweep sees it: its operand, its box, and corners whose convex hull holds it.
#[derive(Clone, Debug)]
pub struct Swept {
    /// The operand.
    pub operand: usize,
    /// The lowest coordinates inside the cell.
    pub low: Lattice,
    /// The highest coordinates inside the cell.
    pub high: Lattice,
    /// Three corners of a triangle, relative to the cell; nothing if only the box is known.
    pub corners: Option<[[f64; 3]; 3]>,
}

/// Up to this many elements are compared all with all.
const FEW: usize = 48;

/// Among fewer elements than this other lines than the axes are not worth finding.
const MANY: usize = 512;

/// Projections are widened by this share of the largest coordinate, far above their rounding.
const SLACK: f64 = 1e-14;

/// A sweep that compares more pairs, at about a nanosecond each, costs more than halving the cell.
const CROWDED: f64 = 3e8;

/// Lowest and highest place along a line.
type Span = [f64; 2];

/// Calls `meet` for all pairs of different operands whose extents overlap along every line, the
/// lower index first; gives up with `None` where too many elements lie above each other on each.
pub fn pairs(elements: &[Swept], mut meet: impl FnMut(usize, usize)) -> Option<()> {
    if elements.len() > FEW {
        return Sweep::of(elements).run(meet);
    }
    for (i, a) in elements.iter().enumerate() {
        for (j, b) in elements.iter().enumerate().skip(i + 1) {
            let apart = || (0..3).any(|k| a.low[k] > b.high[k] || b.low[k] > a.high[k]);
            if a.operand != b.operand && !apart() {
                meet(i, j);
            }
        }
    }
    Some(())
}

/// The elements in their order along the line on which they overlap least.
struct Sweep {
    /// Along that line.
    first: Vec<Span>,
    /// Along the next best line.
    second: Vec<Span>,
    /// Along the others.
    others: Vec<Vec<Span>>,
    operands: Vec<usize>,
    numbers: Vec<usize>,
    crowding: f64,
}

impl Sweep {
    fn of(elements: &[Swept]) -> Self {
        let axes = [0, 1, 2].map(|axis| {
            let span = |e: &Swept| [e.low[axis] as f64, e.high[axis] as f64];
            elements.iter().map(span).collect::<Vec<Span>>()
        });
        let directions = if elements.len() > MANY {
            directions_across(elements)
        } else {
            Vec::new()
        };
        let across = directions.iter().filter_map(|d| projections(elements, d));
        let mut lines: Vec<(f64, Vec<Span>)> = axes
            .into_iter()
            .chain(across)
            .map(|spans| (crowding(&spans), spans))
            .collect();
        lines.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut numbers: Vec<usize> = (0..elements.len()).collect();
        let low = |i: usize| lines[0].1[i][0];
        numbers.sort_unstable_by(|a, b| low(*a).total_cmp(&low(*b)).then(a.cmp(b)));
        let crowding = lines[0].0;
        let mut ordered = lines
            .iter()
            .map(|line| numbers.iter().map(|i| line.1[*i]).collect::<Vec<Span>>());
        Self {
            first: ordered.next().unwrap_or_default(),
            second: ordered.next().unwrap_or_default(),
            others: ordered.collect(),
            operands: numbers.iter().map(|i| elements[*i].operand).collect(),
            numbers,
            crowding,
        }
    }

    fn run(&self, mut meet: impl FnMut(usize, usize)) -> Option<()> {
        let count = self.numbers.len();
        if self.crowding * count as f64 > CROWDED {
            return None;
        }
        for at in 0..count {
            let [_, high] = self.first[at];
            let end = at + 1 + self.first[at + 1..].partition_point(|span| span[0] <= high);
            let [low, high] = self.second[at];
            for (next, span) in (at + 1..end).zip(&self.second[at + 1..end]) {
                if span[0] <= high && span[1] >= low && self.may_meet(at, next) {
                    let (i, j) = (self.numbers[at], self.numbers[next]);
                    meet(i.min(j), i.max(j));
                }
            }
        }
        Some(())
    }

    fn may_meet(&self, a: usize, b: usize) -> bool {
        let overlap = |line: &Vec<Span>| line[a][0] <= line[b][1] && line[b][0] <= line[a][1];
        self.operands[a] != self.operands[b] && self.others.iter().all(overlap)
    }
}

/// The sum of extents relative to the whole: how many elements overlap at a point.
fn crowding(spans: &[Span]) -> f64 {
    let low = spans.iter().fold(f64::INFINITY, |m, s| m.min(s[0]));
    let high = spans.iter().fold(f64::NEG_INFINITY, |m, s| m.max(s[1]));
    let sum: f64 = spans.iter().map(|s| s[1] - s[0]).sum();
    sum / (high - low).max(1.0)
}

/// Directions across the one in which the elements are long: across that of all, and across those
/// of the first operand and of the others at once.
fn directions_across(elements: &[Swept]) -> Vec<[f64; 3]> {
    let own = elements.first().map_or(0, |e| e.operand);
    let (first, others): (Vec<&Swept>, Vec<&Swept>) =
        elements.iter().partition(|e| e.operand == own);
    let (long, [a, b]) = (
        direction_along(elements.iter()),
        [first, others].map(|part| direction_along(part.into_iter())),
    );
    let Some(long) = long else {
        return Vec::new();
    };
    let thin = (0..3).min_by(|i, j| long[*i].abs().total_cmp(&long[*j].abs()));
    let mut axis = [0.0; 3];
    axis[thin.unwrap_or(0)] = 1.0;
    let any = cross(&long, &axis);
    let both = a.zip(b).map(|(a, b)| cross(&a, &b));
    [Some(any), Some(cross(&long, &any)), both]
        .iter()
        .flatten()
        .filter_map(unit)
        .collect()
}

/// The direction in which elements are long.
fn direction_along<'a>(elements: impl Iterator<Item = &'a Swept>) -> Option<[f64; 3]> {
    let mut long = [0.0f64; 3];
    for edge in elements.filter_map(|e| longest_edge(e.corners.as_ref()?)) {
        let along: f64 = (0..3).map(|i| edge[i] * long[i]).sum();
        let sign = if along < 0.0 { -1.0 } else { 1.0 };
        (0..3).for_each(|i| long[i] += sign * edge[i]);
    }
    unit(&long)
}

fn longest_edge(corners: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
    let edge = |i: usize| {
        let (a, b) = (&corners[i], &corners[(i + 1) % 3]);
        [0, 1, 2].map(|k| b[k] - a[k])
    };
    let size = |e: &[f64; 3]| e.iter().map(|x| x * x).sum::<f64>();
    (0..3).map(edge).max_by(|a, b| size(a).total_cmp(&size(b)))
}

fn unit(v: &[f64; 3]) -> Option<[f64; 3]> {
    let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    (size > 0.0 && size.is_finite()).then(|| v.map(|x| x / size))
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The extents along a direction, widened by their rounding; `None` if an element has no corners.
fn projections(elements: &[Swept], direction: &[f64; 3]) -> Option<Vec<Span>> {
    elements
        .iter()
        .map(|e| {
            let corners = e.corners.as_ref()?;
            let at = corners.map(|p| (0..3).map(|i| p[i] * direction[i]).sum::<f64>());
            let size = corners.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
            let low = at[0].min(at[1]).min(at[2]) - size * SLACK - 1.0;
            Some([low, at[0].max(at[1]).max(at[2]) + size * SLACK + 1.0])
        })
        .collect()
}
