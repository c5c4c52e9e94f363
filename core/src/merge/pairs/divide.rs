//! Divides crowds of many operands between two groups with different directions.

use super::boxes::Boxed;
use super::line::direction_along;
use super::Swept;
use crate::arith::convert::as_double;
use crate::geometry::doubles::vector::{cross, dot};

/// Two groups of a crowd's operands.
pub struct Groups {
    /// The elements, grouped by operand.
    pub elements: Vec<Boxed>,
    /// The index at which the second group begins.
    pub middle: usize,
}

/// An operand's elements, and the sine of the angle between their direction and that of the largest
/// operand.
struct Run<'a> {
    elements: &'a [Boxed],
    bend: f64,
}

/// Divides a crowd between groups of about equal size where the directions of long operands differ most;
/// `None` if there is only one operand.
///
/// So bundles of needles are separated before they are divided themselves: two bundles at an angle have few
/// pairs seen along the line across both, and one bundle seen along itself.
pub fn divided(crowd: &[Boxed], swept: impl Fn(&Boxed) -> Swept) -> Option<Groups> {
    let mut runs = runs(crowd, swept);
    runs.sort_by(|a, b| a.bend.total_cmp(&b.bend));
    let (count, middle) = division(&runs, crowd.len())?;
    let (first, second) = runs.split_at(count);
    let all = first.iter().chain(second).flat_map(|run| run.elements);
    Some(Groups {
        elements: all.copied().collect(),
        middle,
    })
}

fn runs(crowd: &[Boxed], swept: impl Fn(&Boxed) -> Swept) -> Vec<Run<'_>> {
    let long = |run: &[Boxed]| {
        let swept: Vec<Swept> = run.iter().map(&swept).collect();
        direction_along(&swept.iter().collect::<Vec<_>>())
    };
    let chunks = crowd.chunk_by(|a, b| a.operand == b.operand);
    let runs: Vec<_> = chunks.map(|run| (run, long(run))).collect();
    // The first of equal ones.
    let largest = runs.iter().rev().max_by_key(|(run, _)| run.len());
    let straight = largest.and_then(|(_, long)| *long);
    let bend = |long: Option<[f64; 3]>| {
        let across = long.zip(straight).map(|(u, v)| cross(&u, &v));
        across.map_or(0.0, |across| dot(&across, &across).sqrt())
    };
    let with_bend = |(elements, long)| Run {
        elements,
        bend: bend(long),
    };
    runs.into_iter().map(with_bend).collect()
}

/// The number of runs before the best division, and the number of their elements.
fn division(runs: &[Run], size: usize) -> Option<(usize, usize)> {
    let ends = runs.iter().scan(0, |end, run| {
        *end += run.elements.len();
        Some(*end)
    });
    let score = |(count, end): (usize, usize)| {
        let smaller = end.min(size - end);
        let jump = runs[count].bend - runs[count - 1].bend;
        // Groups of less than a quarter would need too many divisions.
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

    /// A needle at a height, by its direction.
    fn needle(at: u32, along: Lattice) -> [Lattice; 3] {
        let low = [0, 0, i64::from(at)];
        [[0; 3], [0, 1, 1], along].map(|by| [0, 1, 2].map(|i| low[i] + by[i]))
    }

    #[test]
    fn bundles_at_an_angle_come_apart() {
        // Operands of one bundle alternate with those of the other.
        let along = |at: u32| [[9000, 10, 0], [9000, -10, 0]][at as usize / 10 % 2];
        let swept = |at: u32| {
            let corners = needle(at, along(at));
            let end = |most: fn(i64, i64) -> i64| {
                [0, 1, 2].map(|i| most(corners[0][i], most(corners[1][i], corners[2][i])))
            };
            Swept {
                operand: at as usize / 10,
                low: end(i64::min),
                high: end(i64::max),
                corners: Some(corners.map(|p| p.map(as_double))),
            }
        };
        let boxed = |at: u32| {
            let e = swept(at);
            Boxed::new(e.operand, at, [&e.low, &e.high], 0)
        };
        let crowd: Vec<Boxed> = (0..200).map(boxed).collect();
        let groups = divided(&crowd, |e| swept(e.number)).expect("twenty operands");
        let (first, second) = groups.elements.split_at(groups.middle);
        assert_eq!((first.len(), second.len()), (100, 100));
        let bundle = |e: &Boxed| e.operand % 2;
        assert!(first.iter().all(|e| bundle(e) == bundle(&first[0])));
        assert!(second.iter().all(|e| bundle(e) != bundle(&first[0])));
        assert!(divided(&crowd[..10], |e| swept(e.number)).is_none());
    }
}
