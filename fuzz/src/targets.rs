//! The targets. Each takes any bytes; it returns if the core did what it should, and panics if not.

use std::sync::atomic::AtomicBool;

use arbitrary::{Arbitrary, Unstructured};
use bspcsg::error::ErrorKind;
use bspcsg::extract::round;
use bspcsg::extract::snapshot::{Motion, Snapshot};
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::evaluate::evaluate as run;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::leaf::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::import as importing;
use bspcsg::query::classify::{classify, Location};
use bspcsg::query::measure;
use bspcsg::query::region::hyperplane::plane;
use bspcsg::query::region::section as sections;
use bspcsg::tree::solid::Solid;
use num_bigint::BigInt;

use crate::scene::{whole_units, Scene};
use crate::support::{
    applied, assert_same_triangles, combined, complement, double, is_empty, located, manifold_mesh,
    normalized, volume, Voxels,
};
use crate::winding::{winding, Place};

/// Any bytes as a snapshot: refused, or a solid that every question can be put to.
pub fn snapshot(data: &[u8]) {
    let Ok(stored) = Snapshot::from_bytes(data) else {
        return;
    };
    let Ok(solid) = stored.solid() else {
        return;
    };
    kept(&solid, "a snapshot");
    let _ = (
        round::mesh(&solid),
        measure::volume(&solid),
        measure::volume_rounded(&solid),
    );
    let _ = classify(&solid, &[[0; 3], [1, 2, 3], [20; 3]]);
    if let Ok(plane) = plane([1.0, 2.0, 3.0], 4.0, solid.pitch()) {
        let _ = sections::section(&solid, &plane);
    }
    let tool = importing::import(&BOX.0, &BOX.1, Some(solid.pitch()));
    let Ok(tool) = tool.map(|s| Solid::of_source(s.into(), true)) else {
        return;
    };
    let never = AtomicBool::new(false);
    let lines = vec![Term::Operand(0), Term::Operand(1), Term::Xor(vec![0, 1])];
    let terms = Expression::new(lines).expect("well formed");
    let Ok((result, _)) = run(&terms, &[solid, tool], &never) else {
        return;
    };
    let _ = (round::mesh(&result), Snapshot::of(&result).to_bytes());
}

/// The solid that is read from what was stored; stored again it gives the same bytes.
fn kept(solid: &Solid, context: &str) -> Solid {
    let stored = |solid: &Solid| Snapshot::of(solid).to_bytes().expect("bytes");
    let read = |bytes: &[u8]| Snapshot::from_bytes(bytes).and_then(|s| s.solid());
    let again = read(&stored(solid)).expect("what was written is read");
    let bytes = stored(&again);
    let third = read(&bytes).expect("what was written is read");
    assert_eq!(stored(&third), bytes, "stored twice: {context}");
    again
}

/// A tetrahedron that most snapshots of small solids meet.
const BOX: ([[f64; 3]; 4], [[i64; 3]; 4]) = (
    [
        [1.0, 1.0, 1.0],
        [30.0, 2.0, 1.0],
        [2.0, 31.0, 3.0],
        [3.0, 1.0, 29.0],
    ],
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
);

/// Triangles without order: taken if and only if they close, and then known point by point.
pub fn import(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok((vertices, faces)) = triangles(&mut u) else {
        return;
    };
    let doubles: Vec<[f64; 3]> = vertices.iter().map(|p| p.map(double)).collect();
    let found = importing::import(&doubles, &faces, Some(whole_units()));
    let count = i64::try_from(vertices.len()).expect("few");
    if faces.iter().flatten().any(|v| !(0..count).contains(v)) {
        let kind = found.expect_err("an index out of range").kind();
        assert_eq!(kind, ErrorKind::IndexOutOfRange);
        return;
    }
    let corner = |v: &i64| vertices[usize::try_from(*v).expect("in range")];
    let corners: Vec<[Lattice; 3]> = faces.iter().map(|f| f.each_ref().map(corner)).collect();
    let wide: Vec<[Lattice; 3]> = corners
        .iter()
        .filter(|c| !importing::is_flat(c))
        .copied()
        .collect();
    if !closes(&wide, &vertices) || wide.is_empty() {
        let kind = found.expect_err("open, or nothing at all").kind();
        assert!(
            matches!(kind, ErrorKind::NotClosed | ErrorKind::EmptyMesh),
            "{kind:?}"
        );
        return;
    }
    let source = found.expect("the surface closes");
    let solid = Solid::of_source(source.into(), false);
    let points: Vec<Lattice> = (0..8).filter_map(|_| any_point(&mut u).ok()).collect();
    for rule in [Rule::Positive, Rule::Nonzero, Rule::EvenOdd] {
        let reduced = normalized(&solid, rule);
        manifold_or_unbounded(&reduced, &format!("{rule:?} of {corners:?}"));
        for (point, found) in points.iter().zip(located(&reduced, &points)) {
            let Some(w) = winding(&wide, &Place::at(point)) else {
                continue;
            };
            let inside = rule.inside(w);
            let expected = if inside {
                Location::Inside
            } else {
                Location::Outside
            };
            assert_eq!(found, expected, "{point:?} under {rule:?} in {corners:?}");
        }
    }
}

type Triangles = (Vec<Lattice>, Vec<[i64; 3]>);

/// Small points and triangles over them; most often whole tetrahedra, of which some are damaged.
fn triangles(u: &mut Unstructured<'_>) -> arbitrary::Result<Triangles> {
    let vertices: Vec<Lattice> = (0..u.int_in_range(4..=8)?)
        .map(|_| any_point(u))
        .collect::<arbitrary::Result<_>>()?;
    let last = i64::try_from(vertices.len()).expect("few") - 1;
    let mut faces = Vec::new();
    for _ in 0..u.int_in_range(1..=3)? {
        let mut pick = || u.int_in_range(0..=last);
        let [a, b, c, d] = [pick()?, pick()?, pick()?, pick()?];
        faces.extend([[a, c, b], [a, b, d], [b, c, d], [c, a, d]]);
    }
    if u.ratio(1, 4)? {
        let place = u.choose_index(faces.len())?;
        match u.int_in_range(0..=3)? {
            0 => drop(faces.remove(place)),
            1 => faces[place].swap(0, 1),
            2 => faces.push(faces[place]),
            _ => faces[place][0] = u.int_in_range(-1..=last + 1)?,
        }
    }
    Ok((vertices, faces))
}

fn any_point(u: &mut Unstructured<'_>) -> arbitrary::Result<Lattice> {
    let mut next = || u.int_in_range(0..=6i64);
    Ok([next()?, next()?, next()?])
}

/// Whether the directed edges cancel, each divided at every vertex on it.
fn closes(faces: &[[Lattice; 3]], vertices: &[Lattice]) -> bool {
    let mut sums = std::collections::HashMap::new();
    for face in faces {
        for i in 0..3 {
            let (from, to) = (face[i], face[(i + 1) % 3]);
            let mut stops: Vec<Lattice> = vertices
                .iter()
                .copied()
                .filter(|p| is_between(&from, &to, p))
                .collect();
            stops.sort_by_key(|p| square(&from, p));
            stops.dedup();
            for pair in stops.windows(2) {
                let (low, high) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
                *sums.entry((low, high)).or_insert(0) += if low == pair[0] { 1 } else { -1 };
            }
        }
    }
    sums.values().all(|sum| *sum == 0)
}

fn square(a: &Lattice, b: &Lattice) -> i64 {
    (0..3).map(|i| (a[i] - b[i]).pow(2)).sum()
}

/// Whether a point lies on a segment, ends included.
fn is_between(from: &Lattice, to: &Lattice, p: &Lattice) -> bool {
    let along = [0, 1, 2].map(|i| to[i] - from[i]);
    let arm = [0, 1, 2].map(|i| p[i] - from[i]);
    let flat = [(1, 2), (2, 0), (0, 1)]
        .iter()
        .all(|(i, j)| along[*i] * arm[*j] == along[*j] * arm[*i]);
    let reach: i64 = (0..3).map(|i| along[i] * arm[i]).sum();
    flat && (0..=square(from, to)).contains(&reach)
}

/// Any lines as an expression over unions of unit cubes: refused, or right cube by cube.
pub fn program(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok(cubes) = u.arbitrary::<[u8; 3]>() else {
        return;
    };
    let Ok(terms) = any_terms(&mut u) else {
        return;
    };
    let names_earlier = terms
        .iter()
        .enumerate()
        .all(|(i, t)| arguments(t).iter().all(|a| (*a as usize) < i));
    let found = Expression::new(terms.clone());
    assert_eq!(
        found.is_ok(),
        names_earlier && !terms.is_empty(),
        "{terms:?}"
    );
    let Ok(expression) = found else {
        return;
    };
    let solids: Vec<Solid> = cubes
        .iter()
        .map(|bits| {
            Voxels {
                side: 2,
                bits: u32::from(*bits),
            }
            .solid(|p| p)
        })
        .collect();
    let value = run(&expression, &solids, &AtomicBool::new(false));
    if expression.operands().iter().any(|k| *k >= 3) {
        let kind = value.expect_err("an operand that is not there").kind();
        assert_eq!(kind, ErrorKind::Shape);
        return;
    }
    let (result, _) = value.expect("well formed");
    let word = |k: u32| u64::from(cubes[k as usize]);
    let expected = expression_value(&terms, word);
    let centres: Vec<Lattice> = (0..9i64)
        .map(|i| {
            if i == 8 {
                [9; 3]
            } else {
                [2 * (i % 2) + 1, 2 * (i / 2 % 2) + 1, 2 * (i / 4) + 1]
            }
        })
        .collect();
    for (i, found) in located(&result, &centres).into_iter().enumerate() {
        let inside = expected >> i & 1 == 1;
        assert_eq!(
            found == Location::Inside,
            inside,
            "cube {i} of {terms:?} over {cubes:?}"
        );
    }
    if expected >> 8 & 1 == 0 {
        let cubes = BigInt::from((expected & 0xff).count_ones() * 8);
        let exact = measure::volume(&result).expect("bounded");
        assert_eq!(exact.numerator, cubes * exact.denominator, "{terms:?}");
        manifold_mesh(&result, "cubes");
    }
}

/// The value for the eight cubes and, in the bits above, outside of them.
fn expression_value(terms: &[Term], operand: impl Fn(u32) -> u64) -> u64 {
    let mut values: Vec<u64> = Vec::new();
    for term in terms {
        let at = |k: &u32| values[*k as usize];
        values.push(match term {
            Term::Operand(k) => operand(*k),
            Term::Not(a) => !at(a),
            Term::And(list) => list.iter().fold(u64::MAX, |all, k| all & at(k)),
            Term::Or(list) => list.iter().fold(0, |all, k| all | at(k)),
            Term::Xor(list) => list.iter().fold(0, |all, k| all ^ at(k)),
        });
    }
    *values.last().expect("not empty")
}

fn any_terms(u: &mut Unstructured<'_>) -> arbitrary::Result<Vec<Term>> {
    let count = u.int_in_range(0..=12u32)?;
    (0..count)
        .map(|line| {
            let most = if u.ratio(1, 64)? {
                u32::MAX
            } else {
                line.saturating_sub(1)
            };
            let mut list = || -> arbitrary::Result<Vec<u32>> {
                (0..u.int_in_range(0..=3)?)
                    .map(|_| u.int_in_range(0..=most))
                    .collect()
            };
            let arguments = list()?;
            Ok(match (u.int_in_range(0..=4)?, arguments.first()) {
                (0, Some(first)) => Term::Not(*first),
                (1, _) => Term::And(arguments),
                (2, _) => Term::Or(arguments),
                (3, _) => Term::Xor(arguments),
                _ => Term::Operand(if u.ratio(1, 64)? {
                    u.arbitrary()?
                } else {
                    u.int_in_range(0..=2)?
                }),
            })
        })
        .collect()
}

fn arguments(term: &Term) -> &[u32] {
    match term {
        Term::Operand(_) => &[],
        Term::Not(a) => std::slice::from_ref(a),
        Term::And(list) | Term::Or(list) | Term::Xor(list) => list,
    }
}

/// A scene: points lie where their winding numbers say, volumes add up, meshes are closed.
pub fn evaluate(data: &[u8]) {
    let Ok(scene) = Scene::arbitrary(&mut Unstructured::new(data)) else {
        return;
    };
    let context = format!("{scene:?}");
    let result = scene.result();
    manifold_or_unbounded(&result, &context);
    assert_points(&scene, &result, &context);
    assert_same(&result, &step_by_step(&scene), &context);
    let solids = scene.solids();
    let [first, second] = [solids.first(), solids.last()].map(|s| s.expect("an operand").clone());
    assert_laws(
        &normalized(&first, Rule::Positive),
        &normalized(&second, Rule::Positive),
        &context,
    );
}

fn assert_points(scene: &Scene, result: &Solid, context: &str) {
    let reduced = normalized(result, Rule::Positive);
    manifold_or_unbounded(&reduced, context);
    for (point, found) in scene.points.iter().zip(located(&reduced, &scene.points)) {
        if let Some(expected) = scene.location(point) {
            assert_eq!(found, expected, "{point:?} in {context}");
        }
    }
}

/// The value of the expression with each line evaluated by itself.
fn step_by_step(scene: &Scene) -> Solid {
    let mut values = scene.solids();
    for line in &scene.lines {
        let value = combined(&values, vec![line.clone()]);
        values.push(value);
    }
    values.pop().expect("there are operands")
}

/// Inclusion and exclusion in exact volumes, and De Morgan.
fn assert_laws(a: &Solid, b: &Solid, context: &str) {
    let [union, common, less, either] = SetOp::ALL.map(|op| applied(op, a, b));
    let outside_both = applied(SetOp::Intersection, &complement(a), &complement(b));
    assert_same(&outside_both, &complement(&union), context);
    assert_same(&applied(SetOp::Union, &less, &common), a, context);
    assert_same(
        &applied(SetOp::Difference, &union, &common),
        &either,
        context,
    );
    if is_bounded(a) && is_bounded(b) {
        assert_eq!(
            volume(&union).plus(&volume(&common)),
            volume(a).plus(&volume(b)),
            "{context}"
        );
        assert_eq!(volume(&less).plus(&volume(&common)), volume(a), "{context}");
        assert_eq!(
            volume(&union).minus(&volume(&common)),
            volume(&either),
            "{context}"
        );
    }
}

/// No point is in one set and not in the other.
fn assert_same(a: &Solid, b: &Solid, context: &str) {
    let differs = applied(SetOp::SymmetricDifference, a, b);
    assert!(is_empty(&normalized(&differs, Rule::Positive)), "{context}");
}

fn is_bounded(solid: &Solid) -> bool {
    measure::volume(solid).is_ok()
}

/// The mesh is closed with one fan at each vertex, if there can be one.
fn manifold_or_unbounded(solid: &Solid, context: &str) -> bool {
    match round::mesh(solid) {
        Err(error) => {
            assert_eq!(error.kind(), ErrorKind::Unbounded, "{error} in {context}");
            false
        }
        Ok(_) => {
            manifold_mesh(solid, context);
            true
        }
    }
}

/// A scene's result: stored, moved and mirrored it stays the same, and its mesh makes it again.
pub fn extract(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok(scene) = Scene::arbitrary(&mut u) else {
        return;
    };
    let context = format!("{scene:?}");
    let result = normalized(&scene.result(), Rule::Positive);
    let again = kept(&result, &context);
    assert_same(&again, &result, &context);
    if !manifold_or_unbounded(&result, &context) {
        return;
    }
    assert_same_triangles(&again, &result, &context);
    assert_eq!(volume(&again), volume(&result), "{context}");
    let (Ok(turn), Ok(sign)) = (u.int_in_range(0..=2usize), u.int_in_range(0..=7usize)) else {
        return;
    };
    let axes = [0, 1, 2].map(|i| ((i + turn) % 3, if sign >> i & 1 == 1 { -1 } else { 1 }));
    let motion = Motion {
        axes,
        shift: [1, -2, 3],
        scale: 1,
    };
    let moved = Snapshot::of(&result).moved(&motion, whole_units());
    let Ok(image) = moved.and_then(|s| s.solid()) else {
        return;
    };
    manifold_mesh(&image, &context);
    assert_eq!(volume(&image), volume(&result), "{motion:?} of {context}");
    let points: Vec<Lattice> = scene.points.iter().map(|p| image_of(&motion, p)).collect();
    assert_eq!(
        located(&image, &points),
        located(&result, &scene.points),
        "{motion:?} of {context}"
    );
}

fn image_of(motion: &Motion, p: &Lattice) -> Lattice {
    [0, 1, 2].map(|i| p[motion.axes[i].0] * motion.axes[i].1 + motion.shift[i])
}

/// A scene cut by a plane: the section's edges balance, and wind around what lies just below.
pub fn section(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok((scene, normal, offset)) = cut_scene(&mut u) else {
        return;
    };
    let context = format!("{normal:?} at {offset} of {scene:?}");
    let result = normalized(&scene.result(), Rule::Positive);
    let cut = plane(normal.map(double), double(offset), whole_units());
    let edges = match cut.and_then(|cut| sections::section(&result, &cut)) {
        // Far out a plane, or where it cuts, may leave the lattice.
        Err(error) => {
            let known = matches!(error.kind(), ErrorKind::Unbounded | ErrorKind::TooLarge);
            return assert!(known, "{error} in {context}");
        }
        Ok(edges) => edges,
    };
    let mut balance = std::collections::HashMap::new();
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
    let below = [0, 1, 2].map(|k| if k == axis { i128::from(-sign) } else { 0 });
    let flat = |p: &Lattice| if sign > 0 { [p[i], p[j]] } else { [p[j], p[i]] };
    for point in &scene.points {
        let mut point = *point;
        point[axis] = at;
        let Some(turns) = turns_around(edges, &flat, flat(&point)) else {
            continue;
        };
        let place = Place::beside(&point, [below, [0; 3], [0; 3]]);
        let known: Option<Vec<bool>> = scene
            .operands
            .iter()
            .map(|o| o.known.holds(&place))
            .collect();
        if let Some(known) = known {
            assert_eq!(turns > 0, scene.value(&known), "{point:?} in {context}");
        }
    }
}

/// How often edges wind around a point of their plane; `None` if one passes within two steps.
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
