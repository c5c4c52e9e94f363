//! Five fixed cases for counting instructions: `fixed_cases pair|small|cubes|chain|expression`.
//!
//! Everything happens on the main thread, inside [`measured`], so that a profiler which counts
//! within that function alone sees neither the making of the meshes nor idle threads.

#[path = "../tests/support/mod.rs"]
mod support;

use std::hint::black_box;
use std::sync::Arc;

use bspcsg::extract::rounding::round;
use bspcsg::merge::evaluate::evaluate;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::import::import;
use bspcsg::query::measure::volume_rounded;
use bspcsg::tree::solid::Solid;

use support::{applied, Numbers, Shape};

/// Lattice steps to a unit of these models.
const UNIT: i64 = 1_000_000_000;

/// A mesh as a caller has it.
struct Arrays {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[i64; 3]>,
}

fn main() {
    let case = std::env::args().nth(1).unwrap_or_default();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
    let started = alone.use_current_thread().build_global();
    started.expect("no pool before this one");
    match case.as_str() {
        "pair" => {
            let [a, b] = spheres(6);
            measured(|| pair(SetOp::Difference, &a, &b));
        }
        "small" => {
            let [a, b] = spheres(2);
            pair(SetOp::Difference, &a, &b);
            measured(|| pair(SetOp::Difference, &a, &b));
        }
        "cubes" => {
            let [a, b] = [0, UNIT / 2].map(|at| arrays(&Shape::cuboid([at; 3], [at + UNIT; 3])));
            pair(SetOp::Union, &a, &b);
            measured(|| pair(SetOp::Union, &a, &b));
        }
        "chain" => {
            let block = Shape::cuboid([0; 3], [UNIT; 3]);
            let balls = places(200).map(|at| sphere(at, 0.03, 1));
            let tools: Vec<Solid> = balls.map(|s| s.solid()).collect();
            measured(|| chain(block.solid(), &tools));
        }
        "expression" => {
            let boxes = places(64).map(|low| Shape::cuboid(low, low.map(|c| c + UNIT / 8)));
            let solids: Vec<Solid> = boxes.map(|s| s.solid()).collect();
            measured(|| expression(&solids));
        }
        _ => {
            eprintln!("fixed_cases: name a case: pair, small, cubes, chain, or expression");
            std::process::exit(2);
        }
    }
}

/// Do the work that is counted.
#[inline(never)]
fn measured(work: impl FnOnce() -> usize) {
    let triangles = work();
    println!("{}", black_box(triangles));
}

/// Two spheres that cross, of 20 triangles each, divided in four so many times.
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

/// An operation with two meshes, arrays in to arrays out.
fn pair(op: SetOp, a: &Arrays, b: &Arrays) -> usize {
    let [a, b] = [a, b].map(|mesh| {
        let source = import(&mesh.vertices, &mesh.faces, None).expect("a closed mesh");
        Solid::of_source(Arc::new(source), false)
    });
    triangles(&applied(op, &a, &b))
}

/// Differences one after the other, with the volume after each as sums kept in the nodes give it.
fn chain(block: Solid, tools: &[Solid]) -> usize {
    let mut solid = block;
    for tool in tools {
        solid = applied(SetOp::Difference, &solid, tool);
        black_box(volume_rounded(&solid));
    }
    triangles(&solid)
}

/// A union of many solids in one expression.
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
