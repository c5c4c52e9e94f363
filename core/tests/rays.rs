//! Compares ray casting with a test of every facet that uses neither trees nor filters.
#![allow(clippy::cast_precision_loss, clippy::float_cmp)]

use bspcsg::arith::bounds::COORDINATE_BITS;
use bspcsg::arith::Sign;
use bspcsg::mesh::grid::Pitch;
use bspcsg::query::ray::answer::hit;
use bspcsg::query::ray::batch::Rays;
use bspcsg::query::ray::facet::meet;
use bspcsg::query::ray::filter::{Filter, Probe};
use bspcsg::query::ray::first::{blocked, firsts, Query, Reach};
use bspcsg::query::ray::{bounds, Ratio, Ray, Scene};
use num_bigint::BigInt;
use proptest::prelude::*;

type Triangle = [[f64; 3]; 3];

const LIMIT: i64 = (1 << COORDINATE_BITS) - 1;

/// Coordinates of all magnitudes, often the extreme ones.
fn coordinate() -> impl Strategy<Value = i64> {
    prop_oneof![
        2 => Just(LIMIT),
        2 => Just(-LIMIT),
        4 => -4i64..=4,
        2 => -1_000_000i64..=1_000_000,
        1 => -LIMIT..=LIMIT,
    ]
}

fn point() -> impl Strategy<Value = [i64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

fn point_near(reach: i64) -> impl Strategy<Value = [i64; 3]> {
    [-reach..=reach, -reach..=reach, -reach..=reach]
}

fn wide_triangle(reach: i64) -> impl Strategy<Value = [[i64; 3]; 3]> {
    [point_near(reach), point_near(reach), point_near(reach)]
}

fn triangle() -> impl Strategy<Value = [[i64; 3]; 3]> {
    [point(), point(), point()]
}

fn doubles(t: &[[i64; 3]; 3]) -> Triangle {
    t.map(|p| p.map(|c| c as f64))
}

fn scene(triangles: &[[[i64; 3]; 3]]) -> Scene<3> {
    let facets: Vec<Triangle> = triangles.iter().map(doubles).collect();
    Scene::new(&facets, Some(Pitch::new(0).expect("ten to the zero"))).expect("lattice points")
}

fn big(x: i64) -> BigInt {
    BigInt::from(x)
}

/// The determinant det(a, b, c) of three rows.
fn determinant(rows: [[BigInt; 3]; 3]) -> BigInt {
    let [a, b, c] = rows;
    &a[0] * (&b[1] * &c[2] - &b[2] * &c[1])
        + &a[1] * (&b[2] * &c[0] - &b[0] * &c[2])
        + &a[2] * (&b[0] * &c[1] - &b[1] * &c[0])
}

fn to_big<const N: usize>(x: &bspcsg::arith::Int<N>) -> BigInt {
    let bytes: Vec<u8> = x.limbs().iter().flat_map(|l| l.to_le_bytes()).collect();
    BigInt::from_signed_bytes_le(&bytes)
}

#[test]
fn bounds_are_those_of_the_determinants() {
    let p = COORDINATE_BITS;
    assert_eq!(bounds::weight(p), 113 + 2 * (p + 1) + 2);
    assert_eq!(bounds::numerator(p), 3 * (p + 1) + 2);
    assert_eq!(
        bounds::comparison(p),
        3 * (p + 1) + 2 + 113 + 2 * (p + 1) + 4
    );
}

#[test]
fn order_of_fractions() {
    let third = Ratio::new(
        bspcsg::arith::Int::from_i64(-1),
        bspcsg::arith::Int::from_i64(-3),
    );
    assert!(Ratio::ZERO < third && third < Ratio::ONE);
    assert_eq!(third.to_f64(), 1.0 / 3.0);
    assert_eq!(third.scaled_to_f64(1), 10.0 / 3.0);
    assert_eq!(third.scaled_to_f64(-1), 1.0 / 30.0);
}

/// Long lists, which are divided by a sample, and one with equal centres of all boxes, whose sample gives no
/// cut.
#[test]
fn long_lists_do_not_show() {
    let mut state = 1u64;
    let mut next = |reach: i64| {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        (state >> 33).cast_signed() % reach
    };
    let spread: Vec<[[i64; 3]; 3]> = (0..20_000)
        .map(|_| {
            let at = [next(1000), next(1000), next(10)];
            std::array::from_fn(|_| at.map(|c| c + next(20)))
        })
        .collect();
    let around: Vec<[[i64; 3]; 3]> = (1..20_000)
        .map(|k| [[-k, -k, -k], [k, k, k], [k, -k, 0]])
        .collect();
    for triangles in [spread, around] {
        let scene = scene(&triangles);
        for _ in 0..20 {
            let ends = [[next(900), next(900), -50], [next(900), next(900), 60]];
            let ray = Ray::between(ends[0], &ends[1]).expect("two points");
            let met = (0u32..).zip(scene.facets());
            let met = met.filter_map(|(i, f)| Some((meet(&ray, f)?.at, i))).min();
            let found = Query::new(&scene, &ray).first().map(|found| found.facet);
            assert_eq!(found, met.map(|m| m.1));
        }
    }
}

#[test]
fn a_ray_through_the_common_vertex_of_many_names_the_first() {
    let fan: Vec<[[i64; 3]; 3]> = (0..6)
        .map(|k| [[0, 0, 0], [10, k, 3], [10, k + 1, 3]])
        .rev()
        .collect();
    let scene = scene(&fan);
    let ray = Ray::new([-5, 0, 0], &[1.0, 0.0, 0.0]).expect("a direction");
    let found = Query::new(&scene, &ray).first().expect("a hit");
    assert_eq!((found.facet, found.meeting.at.to_f64()), (0, 5.0));
    assert_eq!(Query::new(&scene, &ray).all().len(), 6);
}

proptest! {
    /// Certain answers of doubles are right, and where doubles doubt, integers decide as big integers do.
    #[test]
    fn the_filter_never_errs(
        t in triangle(), origin in point(), aim in 0usize..4, free in point(), nudge in -1i64..=1
    ) {
        let mut target = if aim < 3 { t[aim] } else { free };
        target[0] = (target[0] + nudge).clamp(-LIMIT, LIMIT);
        prop_assume!(target != origin);
        let ray = Ray::between(origin, &target).expect("two points");
        let facet = doubles(&t);
        let scene = scene(&[t]);
        prop_assume!(!scene.facets().is_empty());
        let exact = meet(&ray, &facet);
        let cell = scene.cell();
        match Filter::new(&ray, &cell.low, &cell.high).probe(&facet) {
            Probe::Miss => prop_assert!(exact.is_none()),
            Probe::Doubt => {}
            Probe::Hit(depth) => {
                let meeting = exact.clone().expect("doubles were certain of a hit");
                prop_assert!(meeting.weights.iter().all(|w| !w.is_zero()));
                let lead = ray.direction().iter().map(|d| d.unsigned_abs()).max().unwrap_or(0);
                let z = meeting.at.to_f64() * lead as f64;
                let slack = z * 1e-15;
                prop_assert!(depth.low() - slack <= z && z <= depth.high() + slack);
            }
        }
        let relative = |p: [i64; 3]| [0, 1, 2].map(|k| big(p[k]) - big(origin[k]));
        let d = relative(target);
        let v = t.map(relative);
        let weight = |i: usize| {
            let mut rows = v.clone();
            rows[i] = d.clone();
            determinant(rows)
        };
        let weights = [0, 1, 2].map(weight);
        let sum: BigInt = weights.iter().sum();
        let zero = BigInt::from(0);
        if sum != zero {
            let sign = if sum > zero { big(1) } else { big(-1) };
            let height = determinant(v.clone()) * &sign;
            let hit = height >= zero && weights.iter().all(|w| w * &sign >= zero);
            prop_assert_eq!(exact.is_some(), hit);
            if let Some(meeting) = exact {
                let (n, m) = (to_big(meeting.at.numerator()), to_big(meeting.at.denominator()));
                prop_assert_eq!(n * &sum * &sign, height * m);
            }
        }
    }

    // Found: bundles of rays over trees and boxes coupled.
    /// Rays in a bundle find what each finds alone, and what testing every facet gives.
    #[test]
    fn bundles_do_not_show(
        shape in prop::collection::vec(point_near(40), 20..120),
        eye in point_near(200),
        step in [-3i64..=3, -3i64..=3, -3i64..=3],
        aim in point_near(60),
        far in prop_oneof![Just(1i64), Just(1 << 20), Just(1 << 44)],
    ) {
        let near = |p: [i64; 3], d: [i64; 3]| [0, 1, 2].map(|k| (p[k] + d[k]) * far);
        let small = (0i64..).zip(&shape).map(|(i, p)| {
            [near(*p, [0; 3]), near(*p, [3, i % 3, 1]), near(*p, [1, 2, i % 5])]
        });
        let triangles: Vec<[[i64; 3]; 3]> = small.collect();
        let scene = scene(&triangles);
        let rays: Vec<Ray<3>> = (0..40i64)
            .filter_map(|i| Ray::between(eye, &near(aim, step.map(|s| s * i))).ok())
            .collect();
        let found = firsts(&scene, &rays, |_, found| found.map(|f| f.facet));
        for (ray, found) in rays.iter().zip(found) {
            let met = (0u32..).zip(scene.facets()).filter_map(|(i, f)| Some((meet(ray, f)?.at, i)));
            prop_assert_eq!(found, met.min().map(|m| m.1));
        }
        let blocked = blocked(&scene, &rays, |_| Reach::Target);
        let alone = rays.iter().map(|ray| Query::new(&scene, ray).occluded(Reach::Target));
        prop_assert_eq!(&blocked, &alone.collect::<Vec<_>>());
    }

    /// Leading bits give the same hit as wide integers, for numbers of any width.
    #[test]
    fn narrow_integers_do_not_show(
        triangle in prop_oneof![triangle(), wide_triangle(1 << 30), wide_triangle(1 << 41)],
        origin in prop_oneof![point(), point_near(1 << 33)],
        weights in [1i64..1000, 0i64..1000, 0i64..1000],
        bend in prop::array::uniform3(-1.0f64..1.0),
        pitch in prop_oneof![Just(-22i64), Just(-9), Just(0), Just(5), Just(22)],
    ) {
        let pitch = Pitch::new(pitch).expect("in range");
        let corners = triangle.map(|corner| corner.map(|c| pitch.coordinate(c)));
        let scene = Scene::new(&[corners], Some(pitch)).expect("fits");
        let sum: i64 = weights.iter().sum();
        let aim = |k: usize| (0..3).map(|i| corners[i][k] * weights[i] as f64).sum::<f64>();
        let from = origin.map(|c| pitch.coordinate(c));
        let along = |k: usize| (aim(k) / sum as f64 - from[k]) * (1.0 + bend[k] * 1e-9);
        let heads = [0, 1, 2].map(along);
        let rays = Rays { origins: &from, heads: &heads };
        let Ok(ray) = Ray::new(scene.snap(&from).expect("fits"), &heads) else {
            return Ok(());
        };
        let expected = Query::new(&scene, &ray).first().map(|found| hit(&scene, &ray, &found));
        let found = rays.first(&scene).expect("a ray");
        prop_assert_eq!(format!("{:?}", &found[0]), format!("{:?}", &expected));
        let facet = expected.map_or(-1, |hit| i64::from(hit.number));
        prop_assert_eq!(rays.facets(&scene).expect("a ray"), vec![facet]);
    }

    /// The tree changes no answer: first hits, all hits and shadows are what testing every facet gives.
    #[test]
    fn trees_do_not_show(
        small in prop::collection::vec([[-9i64..=9, -9i64..=9, -9i64..=9],
            [-9i64..=9, -9i64..=9, -9i64..=9], [-9i64..=9, -9i64..=9, -9i64..=9]], 1..40),
        origin in [-12i64..=12, -12i64..=12, -12i64..=12],
        target in [-12i64..=12, -12i64..=12, -12i64..=12],
    ) {
        prop_assume!(origin != target);
        let scene = scene(&small);
        let ray = Ray::between(origin, &target).expect("two points");
        let mut expected: Vec<(Ratio, u32)> = (0u32..)
            .zip(scene.facets())
            .filter_map(|(i, f)| Some((meet(&ray, f)?.at, i)))
            .collect();
        expected.sort();
        let query = Query::new(&scene, &ray);
        prop_assert_eq!(query.first().map(|f| f.facet), expected.first().map(|e| e.1));
        let all: Vec<u32> = query.all().iter().map(|f| f.facet).collect();
        let order: Vec<u32> = expected.iter().map(|e| e.1).collect();
        prop_assert_eq!(all, order);
        let before = |f: &Triangle| {
            meet(&ray, f).is_some_and(|m| m.at < Ratio::ONE && m.until.sign() == Sign::Positive)
        };
        prop_assert_eq!(query.occluded(Reach::Target), scene.facets().iter().any(before));
    }
}
