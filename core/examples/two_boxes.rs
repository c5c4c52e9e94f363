//! Cuts one box out of another, asks for the exact volume and for some points, and prints the mesh
//! as OFF: `cargo run --release --example two_boxes > part.off`.

use std::sync::Arc;

use bspcsg::error::Result;
use bspcsg::extract::rounding::round;
use bspcsg::merge::evaluate::evaluate;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::mesh::grid::snap_point;
use bspcsg::mesh::import::import;
use bspcsg::query::classify::classify;
use bspcsg::query::measure::volume;
use bspcsg::tree::solid::Solid;

/// The twelve triangles of a box whose corner `k` is high along an axis if that bit of `k` is set.
const FACES: [[i64; 3]; 12] = [
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
];

fn main() -> Result<()> {
    let (whole, hole) = (
        corners([0.0; 3], [0.3, 0.2, 0.1]),
        corners([0.1, 0.1, 0.0], [0.2; 3]),
    );
    let part = difference((&whole, &FACES), (&hole, &FACES))?;
    for point in [[0.05, 0.05, 0.05], [0.15, 0.15, 0.05], [0.1, 0.15, 0.05]] {
        let place = classify(&part, &[snap_point(part.pitch(), &point)?])?;
        eprintln!("{point:?} is {:?}", place[0]);
    }

    let mesh = round::mesh(&part)?;
    println!("OFF\n{} {} 0", mesh.vertices.len(), mesh.triangles.len());
    for [x, y, z] in &mesh.vertices {
        println!("{x} {y} {z}");
    }
    for [a, b, c] in &mesh.triangles {
        println!("3 {a} {b} {c}");
    }
    Ok(())
}

/// Returns A minus B for two closed triangle meshes.
fn difference(a: (&[[f64; 3]], &[[i64; 3]]), b: (&[[f64; 3]], &[[i64; 3]])) -> Result<Solid> {
    let solid = |(vertices, faces)| {
        let source = import(vertices, faces, None)?;
        Ok(Solid::of_source(Arc::new(source), false))
    };
    let operands = [solid(a)?, solid(b)?];
    // Operand 0 and not operand 1; each line names earlier ones, the last is the value.
    let lines = vec![
        Term::Operand(0),
        Term::Operand(1),
        Term::Not(1),
        Term::And(vec![0, 2]),
    ];
    let (part, _) = evaluate(&Expression::new(lines)?, &operands)?;
    let exact = volume(&part)?;
    eprintln!("volume {}/{}", exact.numerator, exact.denominator);
    Ok(part)
}

/// The corners of a box; bit `i` of a corner's index is set if the corner is high along axis `i`.
fn corners(low: [f64; 3], high: [f64; 3]) -> Vec<[f64; 3]> {
    let corner = |k: usize| [0, 1, 2].map(|axis| [low, high][k >> axis & 1][axis]);
    (0..8).map(corner).collect()
}
