//! Any triangles as a mesh.

use std::collections::HashMap;

use arbitrary::Unstructured;
use bspcsg::error::ErrorKind;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::rule::Rule;
use bspcsg::mesh::import as importing;
use bspcsg::query::classify::Location;
use bspcsg::tree::solid::Solid;

use super::super::scene::whole_units;
use super::super::support::{double, located, normalized, wanted};
use super::super::winding::winding;
use super::super::winding::Place;
use super::checks::manifold_or_unbounded;

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
            let inside = wanted(rule, w);
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

/// Return whether the directed edges cancel, each divided at every vertex on it.
fn closes(faces: &[[Lattice; 3]], vertices: &[Lattice]) -> bool {
    let mut sums = HashMap::new();
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

/// Return whether a point lies on a segment, ends included.
fn is_between(from: &Lattice, to: &Lattice, p: &Lattice) -> bool {
    let along = [0, 1, 2].map(|i| to[i] - from[i]);
    let arm = [0, 1, 2].map(|i| p[i] - from[i]);
    let flat = [(1, 2), (2, 0), (0, 1)]
        .iter()
        .all(|(i, j)| along[*i] * arm[*j] == along[*j] * arm[*i]);
    let reach: i64 = (0..3).map(|i| along[i] * arm[i]).sum();
    flat && (0..=square(from, to)).contains(&reach)
}
