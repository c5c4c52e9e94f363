//! Any bytes as a snapshot.

use bspcsg::arith::Int;
use bspcsg::extract::rounding::round;
use bspcsg::merge::evaluate::evaluate as run;
use bspcsg::merge::expression::Expression;
use bspcsg::merge::expression::Term;
use bspcsg::mesh::import as importing;
use bspcsg::query::classify::classify;
use bspcsg::query::measure;
use bspcsg::query::region::hyperplane::plane;
use bspcsg::query::region::section::Sections;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::solid::Solid;

use super::checks::kept;

/// Any bytes as a snapshot: refused, or a solid that every question can be put to.
pub fn snapshot(data: &[u8]) {
    let Ok(solid) = Snapshot::solid_from_bytes(&unsealed(data)) else {
        return;
    };
    kept(&solid, "a snapshot");
    let _ = (
        round::mesh(&solid),
        measure::volume(&solid),
        measure::volume_rounded(&solid),
    );
    let _ = classify(&solid, &[[0; 3], [1, 2, 3], [20; 3]]);
    if let Ok(plane) = plane([1, 2, 3], &Int::from_i128(4)) {
        let _ = Sections::of(&solid).and_then(|sections| sections.by(&plane));
    }
    let tool = importing::import(&BOX.0, &BOX.1, Some(solid.pitch()));
    let Ok(tool) = tool.map(|s| Solid::of_source(s.into(), true)) else {
        return;
    };
    let lines = vec![Term::Operand(0), Term::Operand(1), Term::Xor(vec![0, 1])];
    let terms = Expression::new(lines).expect("well formed");
    let Ok((result, _)) = run(&terms, &[solid, tool]) else {
        return;
    };
    let _ = (round::mesh(&result), Snapshot::of(&result).to_bytes());
}

/// The bytes in the first version of the format, whose payload no checksum guards.
fn unsealed(data: &[u8]) -> Vec<u8> {
    match data {
        [b'b', b's', b'p', b'c', b's', b'g', _, _, payload @ .., _, _, _, _] => {
            [&[1], payload].concat()
        }
        _ => data.to_vec(),
    }
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
