//! Finds the pairs of elements (triangles or parts of faces) of different operands that may meet.
//!
//! Space is halved as long as this separates boxes. The elements that remain, mostly needles, are clipped to
//! smaller cells.

mod boxes;
mod clip;
mod fragments;

use crate::geometry::doubles::Triangle;
use crate::geometry::plane::Lattice;
use boxes::{compare_all, crowded};
pub use boxes::{shift_of, BoxedElement, ElementsInBox};
use fragments::Crowd;

/// An element (a triangle or a part of a face) with its bounds: its box, and a triangle that contains it.
#[derive(Clone, Debug)]
pub struct BoundedElement {
    /// The index of the operand that the triangle or part belongs to.
    pub operand: usize,
    /// The lowest coordinate on each axis of the triangle or part inside the cell, relative to the cell's low
    /// corner; rounded down.
    pub low: Lattice,
    /// The highest coordinate on each axis of the triangle or part inside the cell, relative to the cell's
    /// low corner; rounded down.
    pub high: Lattice,
    /// The corners of a triangle that contains the element, relative to the cell's low corner; `None` if only
    /// the box is known.
    pub corners: Option<Triangle>,
}

/// Calls `report` for all pairs of elements of different operands that may meet, the lower number first; stops
/// and returns `None` if `report` does.
///
/// Elements must be numbered and grouped by operand; `bounded` returns the element with a number. `report` may be
/// called several times for a pair.
///
/// # Example
/// ```
/// use bspcsg::merge::pairs::{pairs, BoxedElement, ElementsInBox, BoundedElement};
///
/// let boxes = [(0, [0; 3], [2; 3]), (1, [1; 3], [3; 3]), (1, [8; 3], [9; 3])];
/// let boxed = |(number, (operand, low, high)): (u32, &(usize, _, _))| {
///     BoxedElement::new(*operand, number, [low, high], 0)
/// };
/// let bounded = |number: u32| {
///     let (operand, low, high) = boxes[number as usize];
///     BoundedElement { operand, low, high, corners: None }
/// };
/// let mut found = Vec::new();
/// let all = ElementsInBox::of((0..).zip(&boxes).map(boxed).collect(), 0);
/// pairs(all, bounded, |a, b| {
///     found.push([a, b]);
///     Some(())
/// });
/// assert_eq!(found, [[0, 1]]);
/// ```
pub fn pairs(
    part: ElementsInBox,
    bounded: impl Fn(u32) -> BoundedElement,
    mut report: impl FnMut(u32, u32) -> Option<()>,
) -> Option<()> {
    let crowd = crowded(part, &mut report)?;
    if crowd.is_empty() {
        return Some(());
    }
    let bounded: Vec<BoundedElement> = crowd.iter().map(|e| bounded(e.number)).collect();
    Crowd::of(&bounded).try_for_each(|cell| {
        compare_all(&cell.elements, &cell.half_open_box, |a, b| {
            let [a, b] = [a, b].map(|e| &crowd[e.number as usize]);
            if a.overlaps(b) {
                report(a.number, b.number)
            } else {
                Some(())
            }
        })
    })
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use proptest::prelude::*;

    use super::*;
    use crate::arith::convert::{as_double, as_whole};
    use crate::geometry::apart::pierces;
    use crate::geometry::axes::each_axis;

    /// More elements than are compared all with all.
    const MANY: usize = 512;

    const REACH: i64 = 2000;

    /// A triangle with one corner at `apex`; the two others are near the end of the direction `along`.
    fn sector(apex: Lattice, along: Lattice) -> impl Strategy<Value = [Lattice; 3]> {
        let near = || [-300..=300i64, -300..=300i64, -300..=300i64];
        (near(), near()).prop_map(move |(a, b)| {
            let far = |p: Lattice| each_axis(|i| apex[i] + 7 * along[i] + p[i]);
            [apex, far(a), far(b)]
        })
    }

    /// Two fans of triangles with apexes at or near each other; a common apex lies just outside the cell.
    fn fans() -> impl Strategy<Value = Scene> {
        let place = || [-9..=9i64, -9..=9i64, -9..=9i64];
        let direction = || [50..=200i64, -200..=200i64, -200..=200i64];
        let all = (place(), place(), any::<bool>(), direction(), direction());
        all.prop_flat_map(|(a, by, same, u, v)| {
            let b = if same { a } else { each_axis(|i| a[i] + by[i]) };
            let fan = |k: usize, apex, along| {
                let some = proptest::collection::vec(sector(apex, along), 300..MANY);
                some.prop_map(move |fan| fan.into_iter().map(|t| (k, t)).collect::<Vec<_>>())
            };
            let floor = if same { a[0] + 1 } else { -REACH };
            (fan(0, a, u), fan(1, b, v)).prop_map(move |(a, b)| Scene {
                triangles: [a, b].concat(),
                floor,
                reach: REACH,
            })
        })
    }

    /// A long thin triangle along a direction.
    fn needle(along: Lattice) -> impl Strategy<Value = [Lattice; 3]> {
        let near = || [-99..=99i64, -99..=99i64, -99..=99i64];
        (near(), near(), near(), 0..=9i64).prop_map(move |(a, b, c, length)| {
            let far = each_axis(|i| b[i] + length * along[i]);
            [a, far, c]
        })
    }

    /// Triangles with their operands, and the ends of the cell: its lowest x coordinate, and the largest
    /// absolute value of other coordinates.
    #[derive(Clone, Debug)]
    struct Scene {
        triangles: Vec<(usize, [Lattice; 3])>,
        floor: i64,
        reach: i64,
    }

    fn bounded(operand: usize, corners: &[Lattice; 3], scene: &Scene) -> BoundedElement {
        let end = |i: usize, most: fn(i64, i64) -> i64| {
            corners.iter().map(|p| p[i]).reduce(most).unwrap_or(0)
        };
        BoundedElement {
            operand,
            low: each_axis(|i| end(i, i64::min).max([scene.floor, -scene.reach, -scene.reach][i])),
            high: each_axis(|i| end(i, i64::max).min(scene.reach)),
            corners: Some(corners.map(|p| p.map(as_double))),
        }
    }

    fn scene(operands: usize) -> impl Strategy<Value = Scene> {
        let direction = || [-200..=200i64, -200..=200i64, -200..=200i64];
        let all = move |(a, b)| {
            let one = prop_oneof![needle(a), needle(b)].boxed();
            let sizes = prop_oneof![20..99usize, 99..MANY, MANY..MANY + 90];
            let some = move |size| proptest::collection::vec((0..operands, one.clone()), size);
            sizes.prop_flat_map(some)
        };
        let sorted = |mut triangles: Vec<(usize, [Lattice; 3])>| {
            triangles.sort_by_key(|e| e.0);
            Scene {
                triangles,
                floor: -REACH,
                reach: REACH,
            }
        };
        (direction(), direction())
            .prop_flat_map(all)
            .prop_map(sorted)
    }

    /// Returns the pairs that `pairs` finds, the lower number first.
    fn found(scene: &Scene) -> HashSet<(usize, usize)> {
        let triangles = scene.triangles.iter();
        let elements: Vec<BoundedElement> = triangles.map(|(k, t)| bounded(*k, t, scene)).collect();
        let boxed =
            |(k, e): (u32, &BoundedElement)| BoxedElement::new(e.operand, k, [&e.low, &e.high], 0);
        let boxes = (0..).zip(&elements).map(boxed).collect();
        let mut found = HashSet::new();
        let one = |k: u32| elements[k as usize].clone();
        pairs(ElementsInBox::of(boxes, 0), one, |i, j| {
            assert!(i < j);
            found.insert((i as usize, j as usize));
            Some(())
        });
        found
    }

    /// Returns true if all pairs of triangles of different operands that cross are found.
    fn misses_nothing(scene: &Scene) -> bool {
        let found = found(scene);
        let report = |i: usize, j: usize| {
            let (a, b) = (&scene.triangles[i], &scene.triangles[j]);
            a.0 != b.0 && (pierces(&a.1, &b.1) || pierces(&b.1, &a.1))
        };
        let rows = 0..scene.triangles.len();
        let mut all = rows.flat_map(|i| (i + 1..scene.triangles.len()).map(move |j| (i, j)));
        all.all(|(i, j)| found.contains(&(i, j)) || !report(i, j))
    }

    /// The wall of a slanted rod: needles from each point of a circle to the same point at the other end.
    fn rod(operand: usize, sides: u32, turn: f64, along: Lattice) -> Vec<(usize, [Lattice; 3])> {
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * (f64::from(k) + turn) / f64::from(sides);
            let (y, x) = angle.sin_cos();
            [x, y, -x - y].map(|x| as_whole((x * 1e5).round()))
        };
        let needle = |k: u32| {
            let far = corner(k);
            let far = each_axis(|i| far[i] + along[i]);
            (operand, [corner(k), corner(k + 1), far])
        };
        (0..sides).map(needle).collect()
    }

    /// Two nearly parallel rods at an angle to all axes.
    #[test]
    fn needles_side_by_side_meet_few_others() {
        let pairs = |sides: u32| {
            let along = [
                [40_000_000, 30_000_000, 50_000_000],
                [40_000_000, 30_010_000, 50_000_000],
            ];
            let rods = [rod(0, sides, 0.0, along[0]), rod(1, sides, 0.5, along[1])];
            let reach = 100_000_000;
            found(&Scene {
                triangles: rods.concat(),
                floor: -reach,
                reach,
            })
            .len()
        };
        let (half, whole) = (pairs(1000), pairs(2000));
        assert!(whole < 3 * half && whole < 50 * 2000, "{half} {whole}");
    }

    /// Two bundles of needles across each other, all inside one step of the boxes' coordinates.
    #[test]
    fn needles_smaller_than_a_step_are_found() {
        let needle = |number: u32| {
            let at = 0.2 + 0.003 * f64::from(number % 200);
            let corners = [[0.1, at, 0.4], [0.9, at, 0.5], [0.9, at, 0.6]];
            let corners = if number < 200 {
                corners
            } else {
                corners.map(|[x, y, z]| [y, x, 1.0 - z])
            };
            BoundedElement {
                operand: usize::from(number >= 200),
                low: [0; 3],
                high: [0; 3],
                corners: Some(corners),
            }
        };
        let boxed = |k: u32| {
            let e = needle(k);
            BoxedElement::new(e.operand, k, [&e.low, &e.high], 0)
        };
        let mut found = HashSet::new();
        pairs(
            ElementsInBox::of((0..400).map(boxed).collect(), 0),
            needle,
            |i, j| {
                found.insert((i, j));
                Some(())
            },
        );
        // Where the second bundle is below a needle of the first one, they need not be found.
        let cross = |i: u32, j: u32| {
            let height = |x: f64| 0.4 + 0.1 * (x - 0.1) / 0.8..=0.4 + 0.2 * (x - 0.1) / 0.8;
            let [y, x] = [i, j - 200].map(|k| 0.2 + 0.003 * f64::from(k));
            let (first, second) = (height(x), height(y));
            *first.end() >= 1.0 - second.end() && 1.0 - second.start() >= *first.start()
        };
        let all = (0..200).flat_map(|i| (200..400).map(move |j| (i, j)));
        let all: Vec<(u32, u32)> = all.filter(|(i, j)| cross(*i, *j)).collect();
        assert!(all.len() > 1000 && all.iter().all(|pair| found.contains(pair)));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn needles_of_two_operands_that_cross_are_found(scene in scene(2)) {
            prop_assert!(misses_nothing(&scene));
        }

        #[test]
        fn triangles_of_two_fans_that_cross_are_found(scene in fans()) {
            prop_assert!(misses_nothing(&scene));
        }

        #[test]
        fn needles_of_several_operands_that_cross_are_found(scene in scene(4)) {
            prop_assert!(misses_nothing(&scene));
        }

        #[test]
        fn needles_of_many_operands_that_cross_are_found(scene in scene(200)) {
            prop_assert!(misses_nothing(&scene));
        }
    }
}
