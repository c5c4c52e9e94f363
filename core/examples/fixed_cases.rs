//! Fixed cases whose instructions are counted: `fixed_cases CASE`, one of [`CASES`].
//!
//! Everything runs on the main thread, inside [`measured`], so that a profiler that counts only within this
//! function counts neither the making of the meshes nor idle threads.

#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;
use std::sync::Arc;

use bspcsg::extract::rounding::round;
use bspcsg::geometry::spaces::dim3::Dim3;
use bspcsg::merge::evaluate::evaluate;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::import::import;
use bspcsg::query::measure::volume_rounded;
use bspcsg::query::ray::batch::Rays;
use bspcsg::query::ray::Scene;
use bspcsg::query::stab::batch::test_rays;
use bspcsg::query::stab::node::Growth;
use bspcsg::query::stab::StabTree;
use bspcsg::tree::solid::Solid;

use support::{applied, normalized, Numbers, Shape};

/// The number of lattice steps in a unit of these models.
const UNIT: i64 = 1_000_000_000;

/// A mesh as arrays, as a caller passes it.
struct Arrays {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[i64; 3]>,
}

/// The cases: the name of each, and a function that makes its meshes and runs the measured work.
const CASES: [(&str, fn()); 12] = [
    ("pair", || {
        let [a, b] = spheres(6);
        measured(|| pair(SetOp::Difference, &a, &b));
    }),
    ("small", || {
        let [a, b] = spheres(2);
        pair(SetOp::Difference, &a, &b);
        measured(|| pair(SetOp::Difference, &a, &b));
    }),
    ("cubes", || {
        let [a, b] = [0, UNIT / 2].map(|at| arrays(&Shape::cuboid([at; 3], [at + UNIT; 3])));
        pair(SetOp::Union, &a, &b);
        measured(|| pair(SetOp::Union, &a, &b));
    }),
    ("built", || {
        let [a, b] = spheres(6).map(|mesh| built(&mesh));
        measured(|| triangles(&applied(SetOp::Difference, &a, &b)));
    }),
    ("needles", || {
        let [a, b] = bundles(40);
        measured(|| triangles(&applied(SetOp::Difference, &a, &b)));
    }),
    ("overlap", || {
        let balls = places(30).map(|at| sphere(at, 0.2, 1));
        let one = balls.reduce(Shape::with).expect("some balls").unchecked();
        measured(|| triangles(&normalized(&one, Rule::Positive)));
    }),
    ("chain", || {
        let block = Shape::cuboid([0; 3], [UNIT; 3]);
        let balls = places(200).map(|at| sphere(at, 0.03, 1));
        let tools: Vec<Solid> = balls.map(|s| s.solid()).collect();
        measured(|| chain(block.solid(), &tools));
    }),
    ("holes", || {
        let plate = Shape::cuboid([0; 3], [8 * UNIT, 8 * UNIT, UNIT]).solid();
        let tools: Vec<Solid> = (0..64).map(hole).collect();
        measured(|| chain(plate, &tools));
    }),
    ("expression", || {
        let boxes = places(64).map(|low| Shape::cuboid(low, low.map(|c| c + UNIT / 8)));
        let solids: Vec<Solid> = boxes.map(|s| s.solid()).collect();
        measured(|| expression(&solids));
    }),
    ("crowd", || {
        let balls = places(24).map(|at| sphere(at.map(|c| c / 10), 1.0, 0));
        let solids: Vec<Solid> = balls.map(|s| s.solid()).collect();
        measured(|| expression(&solids));
    }),
    ("rays", || {
        let scene = scene(6);
        let [origins, directions] = camera(256);
        measured(|| hits(&scene, &origins, &directions));
    }),
    ("visits", || {
        let tree = StabTree::<Dim3, 3>::new(scene(3), Growth::Visits(16), None);
        let tree = tree.expect("facets on the lattice");
        let [origins, directions] = camera(64);
        measured(|| visits(&tree, &origins, &directions));
    }),
];

fn main() {
    let asked = std::env::args().nth(1).unwrap_or_default();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
    let started = alone.use_current_thread().build_global();
    started.expect("no pool before this one");
    let Some((_, case)) = CASES.iter().find(|(name, _)| *name == asked) else {
        let names = CASES.map(|(name, _)| name).join(", ");
        eprintln!("fixed_cases: name a case: {names}");
        std::process::exit(2);
    };
    case();
}

/// Runs the work whose instructions are counted.
#[inline(never)]
fn measured(work: impl FnOnce() -> usize) {
    let triangles = work();
    println!("{}", black_box(triangles));
}

/// Two spheres that cross: icosahedra whose triangles were divided in four `levels` times.
fn spheres(levels: u32) -> [Arrays; 2] {
    let places = [[0; 3], [700_000_001, 500_000_003, 500_000_009]];
    places.map(|at| arrays(&sphere(at, 1.0, levels)))
}

fn sphere(at: [i64; 3], radius: f64, levels: u32) -> Shape {
    #[allow(clippy::cast_precision_loss, reason = "a power of ten")]
    let steps = radius * UNIT as f64;
    Shape::sphere(at, steps, levels)
}

fn places(count: usize) -> impl Iterator<Item = [i64; 3]> {
    let mut numbers = Numbers::new(7);
    (0..count).map(move |_| numbers.point(UNIT))
}

fn arrays(shape: &Shape) -> Arrays {
    let pitch = Pitch::DEFAULT;
    let doubles = |p: &[i64; 3]| p.map(|c| support::double(c) * 10f64.powi(pitch_exponent(pitch)));
    Arrays {
        vertices: shape.vertices.iter().map(doubles).collect(),
        faces: shape.faces.clone(),
    }
}

fn pitch_exponent(pitch: Pitch) -> i32 {
    i32::try_from(pitch.exponent()).expect("a small exponent")
}

/// Applies an operation to two meshes, from arrays to arrays; returns the number of triangles.
fn pair(op: SetOp, a: &Arrays, b: &Arrays) -> usize {
    let [a, b] = [a, b].map(built);
    triangles(&applied(op, &a, &b))
}

fn built(mesh: &Arrays) -> Solid {
    let source = import(&mesh.vertices, &mesh.faces, None).expect("a closed mesh");
    Solid::of_source(Arc::new(source), false)
}

/// Two bundles of thin tetrahedra side by side, the second one step along them: the long sides of both lie
/// in the same planes.
fn bundles(count: i64) -> [Solid; 2] {
    let along = [[UNIT / 20, 0, 0], [0, UNIT / 20, 0], [0, 0, 20 * UNIT]];
    [0, 1].map(|step| {
        let needle = |k| {
            let [x, y, z] = [k % 7, k / 7, k].map(|c| c * UNIT / 8 + k);
            let at = [x, y, z + step];
            let corner = |by: &[i64; 3]| [0, 1, 2].map(|i| at[i] + by[i]);
            let corners = [at, corner(&along[0]), corner(&along[1]), corner(&along[2])];
            Shape::tetrahedron(corners).expect("a corner that stands out")
        };
        let all = (0..count).map(needle).reduce(Shape::with);
        all.expect("some needles").unchecked()
    })
}

/// One of 64 boxes that pass through a plate, eight in each row.
fn hole(number: i64) -> Solid {
    let low = [number % 8 * UNIT, number / 8 * UNIT, -UNIT].map(|c| c + UNIT / 4);
    let high = [low[0] + UNIT / 2, low[1] + UNIT / 2, 2 * UNIT];
    Shape::cuboid(low, high).solid()
}

/// Subtracts tools one after another, and computes the volume after each from sums cached in the nodes.
fn chain(block: Solid, tools: &[Solid]) -> usize {
    let mut solid = block;
    for tool in tools {
        solid = applied(SetOp::Difference, &solid, tool);
        black_box(volume_rounded(&solid));
    }
    triangles(&solid)
}

/// The facets of a unit sphere as a scene for rays.
fn scene(levels: u32) -> Scene<3> {
    let ball = arrays(&sphere([0; 3], 1.0, levels));
    let corner = |v: i64| ball.vertices[usize::try_from(v).expect("a vertex")];
    let facets: Vec<_> = ball.faces.iter().map(|face| face.map(corner)).collect();
    Scene::new(&facets, None).expect("facets on the lattice")
}

/// The rays of an eye that sees the unit sphere, `width` in each row: origins and directions.
fn camera(width: i32) -> [Vec<f64>; 2] {
    let across = |pixel: i32| f64::from(2 * pixel + 1 - width) / f64::from(width);
    let pixels = (0..width).flat_map(|y| (0..width).map(move |x| [x, y]));
    let directions = pixels.flat_map(|[x, y]| [across(x) / 2.7, across(y) / 2.7, -1.0]);
    let directions: Vec<f64> = directions.collect();
    let origins = [0.0, 0.0, 3.0].repeat(directions.len() / 3);
    [origins, directions]
}

/// The number of rays that hit a facet; the boxes are divided on the way.
fn hits(scene: &Scene<3>, origins: &[f64], heads: &[f64]) -> usize {
    let found = Rays { origins, heads }.first(scene).expect("good rays");
    found.iter().flatten().count()
}

/// The number of rays that hit a facet, in a tree that grows with them.
fn visits(tree: &StabTree<Dim3, 3>, origins: &[f64], directions: &[f64]) -> usize {
    let (found, _) = test_rays(tree, origins, directions).expect("good rays");
    found.iter().flatten().count()
}

/// Unites many solids in one expression; returns the number of triangles.
fn expression(solids: &[Solid]) -> usize {
    let count = u32::try_from(solids.len()).expect("few");
    let operands = (0..count).map(Term::Operand);
    let terms = operands.chain([Term::Or((0..count).collect())]).collect();
    let expression = Expression::new(terms).expect("well formed");
    let done = evaluate(&expression, solids);
    triangles(&done.expect("evaluates").0)
}

fn triangles(solid: &Solid) -> usize {
    round::mesh(solid).expect("bounded").triangles.len()
}
