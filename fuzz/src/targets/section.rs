//! Scenes, cut by planes.

use std::collections::HashMap;

use arbitrary::{Arbitrary, Unstructured};
use bspcsg::error::ErrorKind;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::rule::Rule;
use bspcsg::query::region::hyperplane::plane;
use bspcsg::query::region::section::Sections;

use super::super::scene::plane_numbers;
use super::super::scene::Scene;
use super::super::support::normalized;
use super::super::winding::Place;

/// Steps beyond which nothing is rounded to a point.
const SMALL: i64 = 2;

/// A scene cut by a plane: the section's edges balance, and wind around what lies just below.
pub fn section(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok((scene, normal, offset)) = cut_scene(&mut u) else {
        return;
    };
    let context = format!("{normal:?} at {offset} of {scene:?}");
    let result = normalized(&scene.result(), Rule::Positive);
    let (numbers, constant) = plane_numbers(normal, offset);
    let cut = plane(numbers, &constant);
    let edges = match cut.and_then(|cut| Sections::of(&result)?.by(&cut)) {
        // Far out a plane, or where it cuts, may leave the lattice.
        Err(error) => {
            let known = matches!(error.kind(), ErrorKind::Unbounded | ErrorKind::TooLarge);
            return assert!(known, "{error} in {context}");
        }
        Ok(edges) => edges,
    };
    let mut balance = HashMap::new();
    for [from, to] in &edges {
        *balance.entry(*from).or_insert(0) += 1;
        *balance.entry(*to).or_insert(0) -= 1;
    }
    assert!(balance.values().all(|b| *b == 0), "{context}");
    if let Some(axis) = (0..3).find(|i| normal[(i + 1) % 3] == 0 && normal[(i + 2) % 3] == 0) {
        let at = offset / normal[axis];
        if at * normal[axis] == offset {
            assert_inside_section(&scene, &edges, axis, normal[axis].signum(), at, &context);
        }
    }
}

fn cut_scene(u: &mut Unstructured<'_>) -> arbitrary::Result<(Scene, [i64; 3], i64)> {
    let scene = Scene::arbitrary(u)?;
    let axis = u.int_in_range(0..=2usize)?;
    let mut normal = [0; 3];
    normal[axis] = if u.arbitrary()? { 1 } else { -1 };
    if u.ratio(1, 3)? {
        normal[(axis + 1) % 3] = u.int_in_range(-3..=3)?;
        normal[(axis + 2) % 3] = u.int_in_range(-3..=3)?;
    }
    let through = u.choose(&scene.points)?;
    let offset = (0..3).map(|i| normal[i] * through[i]).sum();
    Ok((scene, normal, offset))
}

/// Points of a plane across an axis, clear of the section's rounded edges, against what is below.
fn assert_inside_section(
    scene: &Scene,
    edges: &[[Lattice; 2]],
    axis: usize,
    sign: i64,
    at: i64,
    context: &str,
) {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let along = |axis: usize, step: i128| [0, 1, 2].map(|k| if k == axis { step } else { 0 });
    // Aside first: below a lowest or highest point the section is empty however near it is.
    let steps = [along(i, 1), along(j, 1), along(axis, i128::from(-sign))];
    let flat = |p: &Lattice| if sign > 0 { [p[i], p[j]] } else { [p[j], p[i]] };
    for point in &scene.points {
        let mut point = *point;
        point[axis] = at;
        let Some(turns) = turns_around(edges, flat, flat(&point)) else {
            continue;
        };
        let inside_beside = |point: &Lattice, steps| holds(scene, &Place::beside(point, steps));
        let inside = |point: &Lattice| inside_beside(point, steps);
        let Some(expected) = inside(&point) else {
            continue;
        };
        let found = turns > 0;
        // What is smaller than a step is rounded to a point, of which no edge is left: each way it ends
        // within two steps, and others may begin behind it.
        let ends = |k: usize, sign: i64| {
            (0..=SMALL).any(|n| {
                let at = [0, 1, 2].map(|l| point[l] + if l == k { sign * n } else { 0 });
                let sides: &[i64] = if n == 0 { &[sign] } else { &[-1, 1] };
                sides.iter().any(|side| {
                    let aside = steps.map(|step| {
                        if step[k] == 0 {
                            step
                        } else {
                            along(k, i128::from(*side))
                        }
                    });
                    inside_beside(&at, aside) == Some(found)
                })
            })
        };
        let lost = || [i, j].iter().all(|k| ends(*k, -1) && ends(*k, 1));
        assert!(found == expected || lost(), "{point:?} in {context}");
    }
}

/// Return whether a place is inside, if it can be told.
fn holds(scene: &Scene, place: &Place) -> Option<bool> {
    let operands = scene.operands.iter();
    let known: Option<Vec<bool>> = operands.map(|o| o.known.holds(place)).collect();
    known.map(|inside| scene.value(&inside))
}

/// Count how often edges wind around a point of their plane; `None` if one passes within two steps.
fn turns_around(
    edges: &[[Lattice; 2]],
    flat: impl Fn(&Lattice) -> [i64; 2],
    [x, y]: [i64; 2],
) -> Option<i32> {
    let mut turns = 0;
    for edge in edges {
        let [[ax, ay], [bx, by]] = edge.each_ref().map(&flat);
        let (u, v) = (i128::from(bx - ax), i128::from(by - ay));
        let area = u * i128::from(y - ay) - v * i128::from(x - ax);
        let near = area.pow(2) <= 4 * (u * u + v * v);
        let clear_x = x > ax.max(bx) + 2 || x < ax.min(bx) - 2;
        let clear_y = y > ay.max(by) + 2 || y < ay.min(by) - 2;
        if near && !clear_x && !clear_y {
            return None;
        }
        if (ay <= y) != (by <= y) && (area > 0) == (by > ay) {
            turns += if by > ay { 1 } else { -1 };
        }
    }
    Some(turns)
}
