//! Half-spaces and solids on one side of a plane: the tree of such a result does not cover its whole cell.
//!
//! A cut of the descent's cells crosses only the boundaries of half-spaces there, so only with half-spaces
//! the two sides of a cell that the tree leaves out can differ.

use std::sync::Arc;

use bspcsg::arith::Int;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::query::classify::Location;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::partition::Label;
use bspcsg::tree::solid::Solid;

use super::support::{applied, located, normalized, Shape};

/// The radius of balls in lattice steps.
const RADIUS: i64 = 1 << 20;

/// The radius of balls as a double.
const BALL: f64 = (1u32 << 20) as f64;

/// The centres of balls: one in each octant, and the origin.
fn places() -> impl Iterator<Item = Lattice> {
    let is_place = |p: &Lattice| p.iter().all(|c| *c != 0) || *p == [0; 3];
    grid(3 * RADIUS, 0).filter(is_place)
}

/// Points in and around balls and beside all planes, none of them on a boundary.
fn points() -> Vec<Lattice> {
    let near = grid(3 * RADIUS, 101);
    let far = grid(1 << 40, 17);
    let beside = grid(5 * RADIUS, 7);
    near.chain(far).chain(beside).collect()
}

/// The corners, the centres of sides and edges, and the centre of a cube, all shifted.
fn grid(half: i64, shift: i64) -> impl Iterator<Item = Lattice> {
    let along = [-half, 0, half].map(|k| k + shift);
    let at = move |k: usize| [along[k / 9], along[k / 3 % 3], along[k % 3]];
    (0..27).map(at)
}

/// Half-spaces beside balls, through them, and around them.
fn spaces() -> impl Iterator<Item = Solid> {
    let normals = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, -1], [1, 2, -2]];
    let offsets = [-6 * RADIUS, -RADIUS, 3 * RADIUS];
    let pairs = normals
        .into_iter()
        .flat_map(move |n| offsets.map(|at| (n, at)));
    pairs.map(|(normal, at)| {
        let pitch = Pitch::new(0).expect("a pitch");
        let source = half_space(normal, &Int::from_i128(at.into()), pitch, None);
        Solid::of_source(Arc::new(source.expect("a half-space")), true)
    })
}

/// The label of a point; `None` if it lies on a boundary.
fn side(location: Location) -> Option<Label> {
    match location {
        Location::Inside => Some(Label::In),
        Location::Outside => Some(Label::Out),
        Location::Boundary => None,
    }
}

/// Returns a result, after its points, and those of a copy, were compared with the operands.
fn combined(op: SetOp, [a, b]: [&Solid; 2], points: &[Lattice], context: &str) -> Solid {
    let result = applied(op, a, b);
    let copy = Snapshot::of(&result).solid().expect("a snapshot");
    let [a, b, found, copied] = [a, b, &result, &copy].map(|solid| located(solid, points));
    for (k, point) in points.iter().enumerate() {
        assert_eq!(found[k], copied[k], "{context}: {point:?} in a copy");
        if let (Some(first), Some(second)) = (side(a[k]), side(b[k])) {
            let wanted = Some(op.labels(first, second));
            assert_eq!(side(found[k]), wanted, "{context}: {point:?}");
        }
    }
    result
}

fn ball(levels: u32, at: Lattice) -> Solid {
    Shape::sphere(at, BALL, levels).solid()
}

/// A ball that is inside out, corrected by a winding rule: so its boundary went through a kernel.
fn righted(at: Lattice) -> Solid {
    let ball = Shape::sphere(at, BALL, 0).inverted();
    normalized(&ball.unchecked(), Rule::Nonzero)
}

// Found: half-spaces combined with meshes of more than 16 384 faces, or with results, were wrong far from
// both.
#[test]
fn half_spaces_and_balls_of_any_size() {
    let points = points();
    for place in places() {
        for ball in [ball(0, place), righted(place), ball(3, place)] {
            for (k, space) in spaces().enumerate() {
                for op in SetOp::ALL {
                    let context = format!("ball at {place:?}, half-space {k}, {op:?}");
                    combined(op, [&space, &ball], &points, &context);
                }
            }
        }
    }
}

#[test]
fn results_go_on_with_other_half_spaces() {
    let points = points();
    let ball = ball(3, [-3 * RADIUS, 3 * RADIUS, 3 * RADIUS]);
    for (k, first) in spaces().enumerate() {
        for op in SetOp::ALL {
            let context = format!("half-space {k}, {op:?}");
            let once = combined(op, [&first, &ball], &points, &context);
            for (j, second) in spaces().enumerate().step_by(2) {
                let context = format!("{context}, without half-space {j}");
                combined(SetOp::Difference, [&once, &second], &points, &context);
            }
        }
    }
}
