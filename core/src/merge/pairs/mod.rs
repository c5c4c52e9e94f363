//! Finds the pairs of elements (triangles or parts of faces) of different operands that may meet.
//!
//! Space is halved as long as this separates boxes. Elements of the crowds that remain are separated by
//! clipping them to smaller cells, and by sweeps along the lines on which they overlap least.

mod boxes;
mod clip;
mod direction;
mod divide;
mod fragments;
mod line;
mod rim;
mod sweep;
mod view;

use std::cell::{Cell, RefCell};

use crate::geometry::plane::Lattice;
use boxes::without_repetition;
pub use boxes::{shift_of, BoxedElement, ElementsInBox};
use divide::{divided, Groups};
use fragments::{Crowd, Fragments};
use view::share_corner;

/// An element (a triangle or a part of a face) for a sweep: its operand, its box, and three corners whose
/// convex hull contains it.
#[derive(Clone, Debug)]
pub struct SweptElement {
    /// The index of the operand that the triangle or part belongs to.
    pub operand: usize,
    /// The lowest coordinate on each axis of the triangle or part inside the cell, relative to the cell's low
    /// corner.
    pub low: Lattice,
    /// The highest coordinate on each axis of the triangle or part inside the cell, relative to the cell's
    /// low corner.
    pub high: Lattice,
    /// The corners of a triangle that contains the part of the face, relative to the cell's low corner;
    /// `None` if only the box is known.
    pub corners: Option<[[f64; 3]; 3]>,
}

/// Calls `report` for all pairs of elements (triangles or parts of faces) of different operands that may
/// meet, the lower number first. Returns `None` if `report` does, if too many elements overlap along every
/// line, or if elements of different operands in a crowd share a corner.
///
/// Elements must be grouped by operand; `swept` returns the element with a number.
pub fn pairs(
    elements: Vec<BoxedElement>,
    swept: impl Fn(u32) -> SweptElement,
    report: impl FnMut(u32, u32) -> Option<()>,
) -> Option<()> {
    let report = RefCell::new(report);
    let found = |i: u32, j: u32| (report.borrow_mut())(i, j);
    boxes::pairs(
        ElementsInBox::of(elements, 0),
        found,
        |crowd, half_open_box| {
            let some: Vec<SweptElement> = crowd.iter().map(|e| swept(e.number)).collect();
            if share_corner(&some) {
                return None;
            }
            let goes_on = Cell::new(true);
            sweep::pairs(&some, |i, j| {
                let (a, b) = (&crowd[i], &crowd[j]);
                if goes_on.get() && half_open_box.pair_belongs(a, b) {
                    goes_on.set(found(a.number, b.number).is_some());
                }
            })?;
            goes_on.get().then_some(())
        },
    )
}

/// Calls `report` for all pairs of elements (triangles or parts of faces) of different operands that may
/// meet, where many operands have few elements each. Returns `None` only if `report` does.
///
/// `report` may be called several times for a pair.
///
/// # Cost
/// Elements that halving does not separate are clipped to smaller cells as long as these separate them. The
/// others are divided between two groups of operands repeatedly, each swept against the other; if sweeps
/// separate nothing, either, all pairs are compared.
///
/// # Example
/// ```
/// use bspcsg::merge::pairs::{pairs_of_many, BoxedElement, ElementsInBox, SweptElement};
///
/// let boxes = [(0, [0; 3], [2; 3]), (1, [1; 3], [3; 3]), (1, [8; 3], [9; 3])];
/// let boxed = |(number, (operand, low, high)): (u32, &(usize, _, _))| {
///     BoxedElement::new(*operand, number, [low, high], 0)
/// };
/// let swept = |number: u32| {
///     let (operand, low, high) = boxes[number as usize];
///     SweptElement { operand, low, high, corners: None }
/// };
/// let mut found = Vec::new();
/// let all = ElementsInBox::of((0..).zip(&boxes).map(boxed).collect(), 0);
/// pairs_of_many(all, swept, |a, b| {
///     found.push([a, b]);
///     Some(())
/// });
/// assert_eq!(found, [[0, 1]]);
/// ```
pub fn pairs_of_many(
    part: ElementsInBox,
    swept: impl Fn(u32) -> SweptElement,
    report: impl FnMut(u32, u32) -> Option<()>,
) -> Option<()> {
    let report = RefCell::new(report);
    let found = |i: u32, j: u32| (report.borrow_mut())(i, j);
    let shift = part.shift();
    let mut crowded = Vec::new();
    boxes::pairs(part, found, |crowd, _| {
        crowded.extend_from_slice(crowd);
        Some(())
    })?;
    // Fragments of two elements may meet elsewhere than at the low corner of the boxes' intersection, so all
    // crowds are searched together.
    let crowded = without_repetition(crowded);
    let all: Vec<SweptElement> = crowded.iter().map(|e| swept(e.number)).collect();
    let report = |a: &BoxedElement, b: &BoxedElement| {
        let [a, b] = [a, b].map(|e| crowded[e.number as usize].number);
        found(a, b)
    };
    let mut cells = Crowd::of(&crowded, &all, shift);
    cells.try_for_each(|cell| compare(cell, |e| swept_as(e, &all, shift), report))
}

/// Returns the fragment of an element (a triangle or part of a face), clipped to a cell, as an element for a
/// sweep; `shift` bits were dropped from its box.
fn swept_as(fragment: &BoxedElement, all: &[SweptElement], shift: u32) -> SweptElement {
    let (low, high) = fragment.ends();
    SweptElement {
        low: low.map(|x| i64::from(x) << shift),
        high: high.map(|x| (i64::from(x) + 1) << shift),
        ..all[fragment.number as usize].clone()
    }
}

/// Calls `report` for the pairs of fragments of different operands in a cell that may meet; stops and returns
/// `None` if `report` does.
fn compare(
    cell: Fragments,
    swept: impl Fn(&BoxedElement) -> SweptElement,
    report: impl Fn(&BoxedElement, &BoxedElement) -> Option<()>,
) -> Option<()> {
    let mut open = vec![cell.elements];
    while let Some(crowd) = open.pop() {
        let groups =
            (crowd.len() > boxes::MAX_COMPARED_UNSEPARATED).then(|| divided(&crowd, &swept));
        if let Some(Groups { elements, middle }) = groups.flatten() {
            let (first, second) = elements.split_at(middle);
            sweep_groups((first, second), &swept, &report)?;
            open.extend([first.to_vec(), second.to_vec()]);
        } else {
            boxes::compare_all(&crowd, &cell.half_open_box, &report)?;
        }
    }
    Some(())
}

/// Calls `report` for the pairs of an element (a triangle or part of a face) of the first group and one of
/// the second that may meet; stops and returns `None` if `report` does.
fn sweep_groups(
    (first, second): (&[BoxedElement], &[BoxedElement]),
    swept: &impl Fn(&BoxedElement) -> SweptElement,
    report: &impl Fn(&BoxedElement, &BoxedElement) -> Option<()>,
) -> Option<()> {
    let goes_on = Cell::new(true);
    let report = |a: &BoxedElement, b: &BoxedElement| {
        if goes_on.get() {
            goes_on.set(report(a, b).is_some());
        }
    };
    let of = |operand: usize| {
        move |e: &BoxedElement| SweptElement {
            operand,
            ..swept(e)
        }
    };
    let some: Vec<SweptElement> = first
        .iter()
        .map(of(0))
        .chain(second.iter().map(of(1)))
        .collect();
    let element = |i: usize| first.get(i).unwrap_or_else(|| &second[i - first.len()]);
    let done = sweep::pairs(&some, |i, j| report(element(i), element(j)));
    if done.is_none() {
        boxes::compare_groups(first, second, report);
    }
    goes_on.get().then_some(())
}

#[cfg(test)]
mod tests {
    use std::collections::{HashMap, HashSet};

    use proptest::prelude::*;

    use super::*;
    use crate::arith::convert::as_double;
    use crate::geometry::apart::pierces;
    use crate::geometry::axes::each_axis;

    /// The number of elements (triangles or parts of faces) above which slanted lines are swept, too.
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

    /// Triangles with their operands, and the lowest x coordinate of the cell.
    #[derive(Clone, Debug)]
    struct Scene {
        triangles: Vec<(usize, [Lattice; 3])>,
        floor: i64,
    }

    fn swept(operand: usize, corners: &[Lattice; 3], floor: i64) -> SweptElement {
        let end = |i: usize, most: fn(i64, i64) -> i64| {
            corners.iter().map(|p| p[i]).reduce(most).unwrap_or(0)
        };
        SweptElement {
            operand,
            low: each_axis(|i| end(i, i64::min).max([floor, -REACH, -REACH][i])),
            high: each_axis(|i| end(i, i64::max).min(REACH)),
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
            }
        };
        (direction(), direction())
            .prop_flat_map(all)
            .prop_map(sorted)
    }

    /// Returns the pairs that `pairs` finds, the lower number first; `None` if it gives up.
    fn found(scene: &Scene) -> Option<HashSet<(usize, usize)>> {
        let triangles = scene.triangles.iter();
        let elements: Vec<SweptElement> =
            triangles.map(|(k, t)| swept(*k, t, scene.floor)).collect();
        let mut found = HashSet::new();
        let boxed =
            |(k, e): (u32, &SweptElement)| BoxedElement::new(e.operand, k, [&e.low, &e.high], 0);
        let boxes = (0..).zip(&elements).map(boxed).collect();
        let one = |k: u32| elements[k as usize].clone();
        pairs(boxes, one, |i, j| {
            found.insert((i as usize, j as usize));
            Some(())
        })?;
        Some(found)
    }

    /// Returns true if triangles of different operands share a corner inside the cell.
    fn touch(scene: &Scene) -> bool {
        let mut owners = HashMap::new();
        let corners = scene.triangles.iter().flat_map(|(k, t)| t.map(|p| (*k, p)));
        let mut counted = corners.filter(|(_, p)| p[0] >= scene.floor);
        counted.any(|(k, p)| *owners.entry(p).or_insert(k) != k)
    }

    /// Returns the pairs that `pairs_of_many` finds, the lower number first.
    fn found_of_many(scene: &Scene) -> HashSet<(usize, usize)> {
        let triangles = scene.triangles.iter();
        let elements: Vec<SweptElement> =
            triangles.map(|(k, t)| swept(*k, t, scene.floor)).collect();
        let boxed =
            |(k, e): (u32, &SweptElement)| BoxedElement::new(e.operand, k, [&e.low, &e.high], 0);
        let boxes = (0..).zip(&elements).map(boxed).collect();
        let mut found = HashSet::new();
        let one = |k: u32| elements[k as usize].clone();
        pairs_of_many(ElementsInBox::of(boxes, 0), one, |i, j| {
            found.insert((i.min(j) as usize, i.max(j) as usize));
            Some(())
        });
        found
    }

    fn misses_nothing(scene: &Scene) -> bool {
        found(scene).map_or_else(|| touch(scene), |found| holds_all(scene, &found))
    }

    /// Returns true if all pairs of triangles of different operands that cross are in `found`.
    fn holds_all(scene: &Scene, found: &HashSet<(usize, usize)>) -> bool {
        let report = |i: usize, j: usize| {
            let (a, b) = (&scene.triangles[i], &scene.triangles[j]);
            a.0 != b.0 && (pierces(&a.1, &b.1) || pierces(&b.1, &a.1))
        };
        let rows = 0..scene.triangles.len();
        let mut all = rows.flat_map(|i| (i + 1..scene.triangles.len()).map(move |j| (i, j)));
        all.all(|(i, j)| found.contains(&(i, j)) || !report(i, j))
    }

    /// The lateral triangles of a cone over a polygon with `sides` corners.
    fn cone(operand: usize, sides: u32, apex: Lattice) -> Vec<(usize, [Lattice; 3])> {
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
            let (y, x) = angle.sin_cos();
            [x, y].map(|x| crate::arith::convert::as_whole((x * 900.0).round()))
        };
        let place = |k: u32| {
            let [x, y] = corner(k);
            [apex[0] + x, apex[1] + y, apex[2] + 1800]
        };
        let side = |k: u32| (operand, [apex, place(k), place((k + 1) % sides)]);
        (0..sides).map(side).collect()
    }

    /// Two cones; the apex of the second is `by`, and the apex of the first is the origin.
    fn cones(sides: [u32; 2], by: Lattice) -> Scene {
        let triangles = [cone(0, sides[0], [0; 3]), cone(1, sides[1], by)].concat();
        Scene {
            triangles,
            floor: -REACH,
        }
    }

    #[test]
    fn sides_of_cones_meet_few_others() {
        let sides = 1000;
        let found = found(&cones([sides; 2], [30, 50, 80])).expect("the apexes differ");
        assert!(found.len() < 20 * sides as usize, "{} pairs", found.len());
    }

    #[test]
    fn a_crowd_around_a_common_corner_is_given_up() {
        assert!(found(&cones([1000, 999], [0; 3])).is_none());
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
            prop_assert!(holds_all(&scene, &found_of_many(&scene)));
        }
    }
}
