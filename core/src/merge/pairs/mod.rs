//! Pairs of elements of different operands that may meet.
//!
//! Space is halved while that separates boxes. Of crowds that it does not separate the pairs are
//! found by sweeps along the lines on which their elements overlap least.

mod boxes;
mod line;
mod rim;
mod sweep;

use std::cell::RefCell;

use crate::geometry::plane::Lattice;
use boxes::Space;
pub use boxes::{shift_of, Boxed};

/// An element as a sweep sees it: its operand, its box, and corners whose convex hull holds it.
#[derive(Clone, Debug)]
pub struct Swept {
    /// The operand.
    pub operand: usize,
    /// The lowest coordinates inside the cell, relative to its low corner.
    pub low: Lattice,
    /// The highest coordinates inside the cell, relative to its low corner.
    pub high: Lattice,
    /// Three corners of a triangle, relative to the same; nothing if only the box is known.
    pub corners: Option<[[f64; 3]; 3]>,
}

/// Calls `meet` for all pairs of different operands that may meet, the lower number first; gives up
/// with `None` where too many elements lie above each other along every line.
///
/// Elements of one operand follow each other; `swept` gives the element with a number.
pub fn pairs(
    elements: Vec<Boxed>,
    swept: impl Fn(u32) -> Swept,
    meet: impl FnMut(u32, u32),
) -> Option<()> {
    let meet = RefCell::new(meet);
    let found = |i: u32, j: u32| (meet.borrow_mut())(i, j);
    boxes::pairs(elements, found, |crowd, space| {
        let some: Vec<Swept> = crowd.iter().map(|e| swept(e.number)).collect();
        sweep::pairs(&some, |i, j| {
            let (a, b) = (&crowd[i], &crowd[j]);
            if space.owns(a, b) {
                found(a.number, b.number);
            }
        })
    })
}

/// As [`pairs`], for any number of operands with few elements each; never gives up.
///
/// # Cost
/// A crowd that halving does not separate is divided between two groups of operands again and
/// again, each swept against the other; where sweeps separate nothing either, all are compared.
pub fn pairs_of_many(
    elements: Vec<Boxed>,
    swept: impl Fn(u32) -> Swept,
    meet: impl FnMut(u32, u32),
) {
    let meet = RefCell::new(meet);
    let found = |i: u32, j: u32| (meet.borrow_mut())(i, j);
    boxes::pairs(elements, found, |crowd, space| {
        let mut open = vec![crowd];
        while let Some(crowd) = open.pop() {
            match middle(crowd).filter(|_| crowd.len() > boxes::SOME) {
                Some(at) => {
                    sweep_groups(crowd.split_at(at), space, &swept, found);
                    open.extend([&crowd[..at], &crowd[at..]]);
                }
                None => boxes::compare_all(crowd, space, &mut |i, j| found(i, j)),
            }
        }
        Some(())
    });
}

/// Calls `meet` for the pairs of an element of one group and one of another.
fn sweep_groups(
    (first, second): (&[Boxed], &[Boxed]),
    space: &Space,
    swept: &impl Fn(u32) -> Swept,
    meet: impl Fn(u32, u32),
) {
    let of = |operand: usize| {
        move |e: &Boxed| Swept {
            operand,
            ..swept(e.number)
        }
    };
    let some: Vec<Swept> = first
        .iter()
        .map(of(0))
        .chain(second.iter().map(of(1)))
        .collect();
    let element = |i: usize| first.get(i).unwrap_or_else(|| &second[i - first.len()]);
    let done = sweep::pairs(&some, |i, j| {
        let (a, b) = (element(i), element(j));
        if space.owns(a, b) {
            meet(a.number, b.number);
        }
    });
    if done.is_none() {
        boxes::compare_groups(first, second, space, meet);
    }
}

/// Where the operand begins that divides elements best; `None` if there is only one.
fn middle(crowd: &[Boxed]) -> Option<usize> {
    let begins = |at: &usize| crowd[at - 1].operand != crowd[*at].operand;
    let half = crowd.len() / 2;
    let after = (half.max(1)..crowd.len()).find(begins);
    after.or_else(|| (1..half).rev().find(begins))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::arith::convert::as_double;
    use crate::geometry::apart::pierces;
    use crate::geometry::axes::each_axis;

    /// More elements than this are swept along slanted lines, too.
    const MANY: usize = 512;

    const REACH: i64 = 2000;

    /// A triangle along a direction, within a few steps beside it.
    fn needle(along: Lattice) -> impl Strategy<Value = [Lattice; 3]> {
        let near = || [-99..=99i64, -99..=99i64, -99..=99i64];
        (near(), near(), near(), 0..=9i64).prop_map(move |(a, b, c, length)| {
            let far = each_axis(|i| b[i] + length * along[i]);
            [a, far, c]
        })
    }

    fn swept(operand: usize, corners: &[Lattice; 3]) -> Swept {
        let end = |i: usize, most: fn(i64, i64) -> i64| {
            corners.iter().map(|p| p[i]).reduce(most).unwrap_or(0)
        };
        Swept {
            operand,
            low: each_axis(|i| end(i, i64::min).max(-REACH)),
            high: each_axis(|i| end(i, i64::max).min(REACH)),
            corners: Some(corners.map(|p| p.map(as_double))),
        }
    }

    fn scene(operands: usize) -> impl Strategy<Value = Vec<(usize, [Lattice; 3])>> {
        let direction = || [-200..=200i64, -200..=200i64, -200..=200i64];
        let all = move |(a, b)| {
            let one = prop_oneof![needle(a), needle(b)].boxed();
            let sizes = prop_oneof![20..99usize, 99..MANY, MANY..MANY + 90];
            let some = move |size| proptest::collection::vec((0..operands, one.clone()), size);
            sizes.prop_flat_map(some)
        };
        let sorted = |mut scene: Vec<(usize, [Lattice; 3])>| {
            scene.sort_by_key(|e| e.0);
            scene
        };
        (direction(), direction())
            .prop_flat_map(all)
            .prop_map(sorted)
    }

    fn misses_nothing(scene: &[(usize, [Lattice; 3])]) -> bool {
        let elements: Vec<Swept> = scene.iter().map(|(k, t)| swept(*k, t)).collect();
        let mut found = std::collections::HashSet::new();
        let boxed = |(k, e): (u32, &Swept)| Boxed::new(e.operand, k, [&e.low, &e.high], 0);
        let boxes = (0..).zip(&elements).map(boxed).collect();
        let done = pairs(
            boxes,
            |k| elements[k as usize].clone(),
            |i, j| {
                found.insert((i as usize, j as usize));
            },
        );
        let meet = |i: usize, j: usize| {
            let (a, b) = (&scene[i], &scene[j]);
            a.0 != b.0 && (pierces(&a.1, &b.1) || pierces(&b.1, &a.1))
        };
        let rows = 0..scene.len();
        let mut all = rows.flat_map(|i| (i + 1..scene.len()).map(move |j| (i, j)));
        done.is_some() && all.all(|(i, j)| found.contains(&(i, j)) || !meet(i, j))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(40))]

        #[test]
        fn needles_of_two_operands_that_cross_are_found(scene in scene(2)) {
            prop_assert!(misses_nothing(&scene));
        }

        #[test]
        fn needles_of_several_operands_that_cross_are_found(scene in scene(4)) {
            prop_assert!(misses_nothing(&scene));
        }
    }
}
