//! Times of the kernel's steps: predicates, in integers and doubles, splits, the leaf merge, and
//! extraction.

#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;
use std::sync::Arc;

use bspcsg::extract::rounding::round;
use bspcsg::geometry::doubles::extent::Extent;
use bspcsg::geometry::doubles::meeting::meeting;
use bspcsg::geometry::doubles::Triangle;
use bspcsg::geometry::plane::{Lattice, Plane};
use bspcsg::geometry::polygon::{straddle, Polygon};
use bspcsg::geometry::spaces::dim3::Dim3;
use bspcsg::geometry::vertex::Vertex;
use bspcsg::merge::{split_tree, SetOp};
use bspcsg::mesh::triangles::TriangleMesh;
use bspcsg::tree::partition::{autopartition, Facet, Label, PivotPolicy};
use criterion::{criterion_group, criterion_main, BatchSize, Criterion};

use support::{applied, Numbers, Shape};

/// Reach of random coordinates: 30 bits, as those of a part of a metre in steps of a nanometre.
const REACH: i64 = 1 << 30;

/// Random inputs that a predicate is asked about in turn, so that branches cannot be learned.
const COUNT: usize = 1024;

fn plane(numbers: &mut Numbers) -> Arc<Plane> {
    loop {
        let [a, b, c] = [0; 3].map(|_| numbers.point(REACH));
        if let Some(plane) = Plane::through(&a, &b, &c) {
            return Arc::new(plane);
        }
    }
}

fn many<T>(mut make: impl FnMut(&mut Numbers) -> T) -> Vec<T> {
    let mut numbers = Numbers::new(1);
    (0..COUNT).map(|_| make(&mut numbers)).collect()
}

fn meet(numbers: &mut Numbers) -> Vertex {
    loop {
        let [a, b, c] = [0; 3].map(|_| plane(numbers));
        if let Some(vertex) = Vertex::meet(&a, &b, &c) {
            return vertex;
        }
    }
}

/// A triangle near others: in a tilted plane but for rounding, or anywhere.
#[allow(clippy::cast_precision_loss, reason = "31 bits")]
fn triangle(numbers: &mut Numbers, is_in_plane: bool) -> Triangle {
    [0; 3].map(|_| {
        let [x, y, z] = numbers.point(REACH).map(|c| c as f64 / REACH as f64);
        [x, y, if is_in_plane { 0.3 * x + 0.7 * y } else { z }]
    })
}

/// Comparisons of boxes and of triangles, of which `extract::rounding::mend` bounds the number.
fn triangles_in_doubles(c: &mut Criterion) {
    let mut group = c.benchmark_group("triangles in doubles");
    for (name, is_in_plane) in [("anywhere", false), ("in a plane but for rounding", true)] {
        let triangles = many(|n| triangle(n, is_in_plane));
        let extents: Vec<Extent> = triangles.iter().map(Extent::of).collect();
        let mut turn = (0..COUNT - 1).cycle();
        let mut next = move || turn.next().unwrap_or(0);
        group.bench_function(format!("boxes, {name}"), |b| {
            b.iter(|| {
                let k = next();
                black_box(&extents[k]).misses(&extents[k + 1])
            });
        });
        group.bench_function(format!("meeting, {name}"), |b| {
            b.iter(|| {
                let k = next();
                meeting(black_box(&triangles[k]), &triangles[k + 1])
            });
        });
    }
    group.finish();
}

fn predicates(c: &mut Criterion) {
    let mut group = c.benchmark_group("predicates");
    let planes = many(plane);
    let points: Vec<Lattice> = many(|n| n.point(REACH));
    let meets = many(meet);
    // Each point against a plane through it: the filter says nothing, and the exact test decides.
    let through = many(|n| loop {
        let [a, b, c] = [0; 3].map(|_| n.point(REACH));
        if let Some(plane) = Plane::through(&a, &b, &c) {
            break (plane, Vertex::lattice(a));
        }
    });
    let mut turn = (0..COUNT).cycle();
    let mut next = move || turn.next().unwrap_or(0);
    group.bench_function("plane through three points", |b| {
        b.iter(|| {
            let k = next();
            Plane::through(
                &points[k],
                &points[(k + 1) % COUNT],
                &points[(k + 2) % COUNT],
            )
        });
    });
    group.bench_function("lattice point against a plane", |b| {
        b.iter(|| {
            let k = next();
            planes[k].side_of_lattice(black_box(&points[k]))
        });
    });
    group.bench_function("meet of three planes", |b| {
        b.iter(|| {
            let k = next();
            Vertex::meet(
                &planes[k],
                &planes[(k + 1) % COUNT],
                &planes[(k + 2) % COUNT],
            )
        });
    });
    group.bench_function("meet of three planes against a fourth", |b| {
        b.iter(|| {
            let k = next();
            meets[k].side_of(black_box(&planes[k]))
        });
    });
    group.bench_function("point in the plane", |b| {
        b.iter(|| {
            let (plane, point) = &through[next()];
            point.side_of(black_box(plane))
        });
    });
    group.finish();
}

fn splits(c: &mut Criterion) {
    let mut group = c.benchmark_group("split");
    let cut = Arc::new(Plane::axis_cut(0, REACH | 1));
    let crossed = many(|n| loop {
        let points = [0; 3].map(|_| n.point(REACH));
        let sides = points.map(|p| cut.side_of_lattice(&p));
        let support = Plane::through(&points[0], &points[1], &points[2]);
        if let (Some(support), (true, true)) = (support, straddle(&sides)) {
            break Polygon::triangle(&points, Arc::new(support));
        }
    });
    let mut turn = (0..COUNT).cycle();
    group.bench_function("triangle that the plane crosses", |b| {
        b.iter(|| turn.next().map(|k| crossed[k].split(black_box(&cut))));
    });
    let source = Shape::sphere([0; 3], 1e9, 1).source();
    let cell = source.mesh().and_then(TriangleMesh::bounds);
    let (low, high) = cell.expect("a sphere has bounds");
    let frame = bspcsg::geometry::cell::Cell::around(&low, &high);
    let facets = source.face_ids().filter_map(|face| {
        let fragment = source.clip(face, &frame)?;
        Some(Facet {
            fragment,
            source: u64::from(face.0),
        })
    });
    let policy = PivotPolicy::Random(1);
    let built = autopartition::<Dim3>(facets.collect(), frame, Label::Out, policy);
    let tree = built.expect("a sphere").tree;
    let across = Arc::new(
        Plane::through(&[1, 2, 3], &[1 << 28, 5, -7], &[3, 1 << 28, 11]).expect("a plane"),
    );
    let span = Polygon::span(&across, &frame).expect("it crosses");
    group.bench_function("tree of a sphere of 80 triangles", |b| {
        b.iter(|| split_tree(&tree, black_box(&span)));
    });
    group.finish();
}

fn leaf_merge(c: &mut Criterion) {
    let mut group = c.benchmark_group("leaf merge");
    let mut numbers = Numbers::new(3);
    let pairs: Vec<_> = (0..64)
        .map(|_| [0; 2].map(|_| Shape::any_tetrahedron(&mut numbers, REACH).solid()))
        .collect();
    let mut turn = (0..pairs.len()).cycle();
    for (name, op) in [("union", SetOp::Union), ("difference", SetOp::Difference)] {
        group.bench_function(format!("{name} of two tetrahedra"), |b| {
            b.iter(|| turn.next().map(|k| applied(op, &pairs[k][0], &pairs[k][1])));
        });
    }
    group.finish();
}

fn extraction(c: &mut Criterion) {
    let mut group = c.benchmark_group("extraction");
    let [a, b] = [[0; 3], [7 << 26, 5 << 26, 3 << 26]].map(|at| Shape::sphere(at, 1e9, 4).solid());
    let difference = applied(SetOp::Difference, &a, &b);
    group.sample_size(20);
    group.bench_function("mesh of a difference of spheres of 5 120 triangles", |b| {
        b.iter(|| round::mesh(black_box(&difference)));
    });
    group.bench_function("evaluation of that difference", |b2| {
        b2.iter_batched(
            || (a.clone(), b.clone()),
            |(a, b)| applied(SetOp::Difference, &a, &b),
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

// The macro makes a public function without documentation.
#[allow(missing_docs)]
mod group {
    use super::{
        criterion_group, extraction, leaf_merge, predicates, splits, triangles_in_doubles,
    };

    criterion_group!(
        kernel,
        predicates,
        triangles_in_doubles,
        splits,
        leaf_merge,
        extraction
    );
}
criterion_main!(group::kernel);
