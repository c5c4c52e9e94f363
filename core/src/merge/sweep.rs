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

/// Projections are widened by this share of the largest coordinate, far above their rounding.
const SLACK: f64 = 1e-14;

/// A sweep that compares more pairs for each element costs more than halving the cell.
const CROWDED: usize = 1024;

/// Calls `meet` for all pairs of different operands whose boxes overlap, the lower index first;
/// gives up with `None` where too many elements lie above each other on every line.
pub fn pairs(elements: &[Swept], mut meet: impl FnMut(usize, usize)) -> Option<()> {
    let mut left = elements.len() * CROWDED;
    let mut check = |i: usize, j: usize| {
        let (a, b) = (&elements[i], &elements[j]);
        let apart = (0..3).any(|k| a.low[k] > b.high[k] || b.low[k] > a.high[k]);
        if a.operand != b.operand && !apart {
            meet(i.min(j), i.max(j));
        }
        left = left.checked_sub(1)?;
        Some(())
    };
    if elements.len() <= FEW {
        for i in 0..elements.len() {
            (i + 1..elements.len()).try_for_each(|j| check(i, j))?;
        }
        return Some(());
    }
    let spans = best_spans(elements);
    let mut order: Vec<u32> = (0..elements.len() as u32).collect();
    order.sort_unstable_by(|a, b| {
        let low = |i: u32| spans[i as usize].0;
        low(*a).total_cmp(&low(*b)).then(a.cmp(b))
    });
    for (at, i) in order.iter().enumerate() {
        let high = spans[*i as usize].1;
        let near = order[at + 1..].iter();
        near.take_while(|j| spans[**j as usize].0 <= high)
            .try_for_each(|j| check(*i as usize, *j as usize))?;
    }
    Some(())
}

/// The elements' extents along the line on which they overlap least.
fn best_spans(elements: &[Swept]) -> Vec<(f64, f64)> {
    let axes = [0, 1, 2].map(|axis| {
        let span = |e: &Swept| (e.low[axis] as f64, e.high[axis] as f64);
        elements.iter().map(span).collect::<Vec<_>>()
    });
    let across = directions_across(elements)
        .into_iter()
        .filter_map(|d| projections(elements, &d));
    axes.into_iter()
        .chain(across)
        .map(|spans| (crowding(&spans), spans))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .map_or_else(Vec::new, |best| best.1)
}

/// The sum of extents relative to the whole: how many elements overlap at a point.
fn crowding(spans: &[(f64, f64)]) -> f64 {
    let low = spans.iter().fold(f64::INFINITY, |m, s| m.min(s.0));
    let high = spans.iter().fold(f64::NEG_INFINITY, |m, s| m.max(s.1));
    let sum: f64 = spans.iter().map(|s| s.1 - s.0).sum();
    sum / (high - low).max(1.0)
}

/// Two directions across the one in which the elements are long.
fn directions_across(elements: &[Swept]) -> Vec<[f64; 3]> {
    let mut long = [0.0f64; 3];
    for edge in elements
        .iter()
        .filter_map(|e| longest_edge(e.corners.as_ref()?))
    {
        let along: f64 = (0..3).map(|i| edge[i] * long[i]).sum();
        let sign = if along < 0.0 { -1.0 } else { 1.0 };
        (0..3).for_each(|i| long[i] += sign * edge[i]);
    }
    let Some(long) = unit(&long) else {
        return Vec::new();
    };
    let thin = (0..3).min_by(|i, j| long[*i].abs().total_cmp(&long[*j].abs()));
    let mut axis = [0.0; 3];
    axis[thin.unwrap_or(0)] = 1.0;
    let first = cross(&long, &axis);
    let second = cross(&long, &first);
    [first, second].iter().filter_map(unit).collect()
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
fn projections(elements: &[Swept], direction: &[f64; 3]) -> Option<Vec<(f64, f64)>> {
    elements
        .iter()
        .map(|e| {
            let corners = e.corners.as_ref()?;
            let at = corners.map(|p| (0..3).map(|i| p[i] * direction[i]).sum::<f64>());
            let size = corners.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
            let low = at[0].min(at[1]).min(at[2]) - size * SLACK - 1.0;
            Some((low, at[0].max(at[1]).max(at[2]) + size * SLACK + 1.0))
        })
        .collect()
}
