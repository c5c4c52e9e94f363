//! Divides the elements of many operands between two groups with different directions.

use super::boxes::BoxedElement;
use super::line::direction_along;
use super::SweptElement;
use crate::arith::convert::as_double;
use crate::geometry::doubles::vector::{cross, dot};

/// The elements (triangles or parts of faces) of many operands, divided into two groups of operands.
pub struct Groups {
    /// The elements (triangles or parts of faces) of both groups, sorted by operand.
    pub elements: Vec<BoxedElement>,
    /// The index at which the second group begins.
    pub middle: usize,
}

/// The elements (triangles or parts of faces) of one operand, and the sine of the angle between their main
/// direction and the main direction of the operand with the most elements.
struct OperandElements<'a> {
    elements: &'a [BoxedElement],
    angle_sine: f64,
}

/// Divides elements (triangles or parts of faces), sorted by operand, into two groups of operands where the
/// operands' main directions differ most, preferring groups of similar size. `None` if there is only one
/// operand.
///
/// So bundles of parallel needles are separated from each other first: a sweep along the line across both
/// directions finds few pairs between two bundles, and the projection along a bundle finds few within it.
pub fn divided(
    crowd: &[BoxedElement],
    swept: impl Fn(&BoxedElement) -> SweptElement,
) -> Option<Groups> {
    let mut runs = runs(crowd, swept);
    runs.sort_by(|a, b| a.angle_sine.total_cmp(&b.angle_sine));
    let (count, middle) = division(&runs, crowd.len())?;
    let (first, second) = runs.split_at(count);
    let all = first.iter().chain(second).flat_map(|run| run.elements);
    Some(Groups {
        elements: all.copied().collect(),
        middle,
    })
}

fn runs(
    crowd: &[BoxedElement],
    swept: impl Fn(&BoxedElement) -> SweptElement,
) -> Vec<OperandElements<'_>> {
    let long = |run: &[BoxedElement]| {
        let swept: Vec<SweptElement> = run.iter().map(&swept).collect();
        direction_along(&swept.iter().collect::<Vec<_>>())
    };
    let chunks = crowd.chunk_by(|a, b| a.operand == b.operand);
    let runs: Vec<_> = chunks.map(|run| (run, long(run))).collect();
    // Of operands with equally many elements, the first is taken.
    let largest = runs.iter().rev().max_by_key(|(run, _)| run.len());
    let straight = largest.and_then(|(_, long)| *long);
    let angle_sine = |long: Option<[f64; 3]>| {
        let across = long.zip(straight).map(|(u, v)| cross(&u, &v));
        across.map_or(0.0, |across| dot(&across, &across).sqrt())
    };
    let with_bend = |(elements, long)| OperandElements {
        elements,
        angle_sine: angle_sine(long),
    };
    runs.into_iter().map(with_bend).collect()
}

/// Returns how many operands come before the best division, and how many elements (triangles or parts of
/// faces) these have; `None` if there is only one operand.
fn division(runs: &[OperandElements], size: usize) -> Option<(usize, usize)> {
    let ends = runs.iter().scan(0, |end, run| {
        *end += run.elements.len();
        Some(*end)
    });
    let score = |(count, end): (usize, usize)| {
        let smaller = end.min(size - end);
        let jump = runs[count].angle_sine - runs[count - 1].angle_sine;
        // Groups with less than a quarter of the elements would need too many divisions.
        let jump = if 4 * smaller < size { 0.0 } else { jump };
        (jump * as_double(smaller), smaller)
    };
    let divisions = (1..runs.len()).zip(ends);
    divisions.max_by(|a, b| {
        let (a, b) = (score(*a), score(*b));
        a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Lattice;

    /// A needle in the direction `along`, at the height `at`.
    fn needle(at: u32, along: Lattice) -> [Lattice; 3] {
        let low = [0, 0, i64::from(at)];
        [[0; 3], [0, 1, 1], along].map(|by| [0, 1, 2].map(|i| low[i] + by[i]))
    }

    #[test]
    fn bundles_at_an_angle_come_apart() {
        // Operands of one bundle alternate with operands of the other bundle.
        let along = |at: u32| [[9000, 10, 0], [9000, -10, 0]][at as usize / 10 % 2];
        let swept = |at: u32| {
            let corners = needle(at, along(at));
            let end = |most: fn(i64, i64) -> i64| {
                [0, 1, 2].map(|i| most(corners[0][i], most(corners[1][i], corners[2][i])))
            };
            SweptElement {
                operand: at as usize / 10,
                low: end(i64::min),
                high: end(i64::max),
                corners: Some(corners.map(|p| p.map(as_double))),
            }
        };
        let boxed = |at: u32| {
            let e = swept(at);
            BoxedElement::new(e.operand, at, [&e.low, &e.high], 0)
        };
        let crowd: Vec<BoxedElement> = (0..200).map(boxed).collect();
        let groups = divided(&crowd, |e| swept(e.number)).expect("twenty operands");
        let (first, second) = groups.elements.split_at(groups.middle);
        assert_eq!((first.len(), second.len()), (100, 100));
        let bundle = |e: &BoxedElement| e.operand % 2;
        assert!(first.iter().all(|e| bundle(e) == bundle(&first[0])));
        assert!(second.iter().all(|e| bundle(e) != bundle(&first[0])));
        assert!(divided(&crowd[..10], |e| swept(e.number)).is_none());
    }
}
