//! Large faces that other surfaces cross in one closed curve, in several, and in curves that cross.

use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::SetOp;
use bspcsg::tree::solid::Solid;

use super::support::{applied, assert_same_set, double, manifold_mesh, volume, Numbers, Shape};

const OPERATIONS: [SetOp; 4] = [
    SetOp::Union,
    SetOp::Intersection,
    SetOp::Difference,
    SetOp::SymmetricDifference,
];

/// The number of rounds, each with spheres at other positions.
const ROUNDS: usize = 4;

/// The height of the slab's upper faces, near which the spheres lie.
const TOP: i64 = 500;

/// A slab with a few large faces.
fn slab() -> Solid {
    Shape::cuboid([-2001, -2003, -401], [2003, 2001, TOP]).solid()
}

/// A sphere through the slab's upper faces, with no vertex in their plane.
fn ball(numbers: &mut Numbers, at: [i64; 2], radius: i64) -> Shape {
    let mut near = |x: i64| x + numbers.below(41) - 20;
    let center: Lattice = [near(at[0]), near(at[1]), near(TOP - radius / 7)];
    let shape = Shape::sphere(center, double(radius), 2);
    shape.mapped(|p| {
        if p[2] == TOP {
            [p[0], p[1], p[2] + 1]
        } else {
            p
        }
    })
}

/// Compares all operations on the slab and a surface with those on the slab and the solid `truth`.
fn check(surface: &Shape, truth: &Solid, context: &str) {
    let slab = slab();
    for op in OPERATIONS {
        let found = applied(op, &slab, &surface.unchecked());
        let wanted = applied(op, &slab, truth);
        assert_same_set(&found, &wanted);
        let turned = applied(op, &surface.unchecked(), &slab);
        assert_same_set(&turned, &applied(op, truth, &slab));
        manifold_mesh(&wanted, context);
    }
    let sum = |op: SetOp| volume(&applied(op, &slab, &surface.unchecked()));
    let both = sum(SetOp::Union).plus(&sum(SetOp::Intersection));
    assert_eq!(both, volume(&slab).plus(&volume(truth)), "{context}");
}

fn union(a: &Shape, b: &Shape) -> Solid {
    applied(SetOp::Union, &a.solid(), &b.solid())
}

#[test]
fn one_curve_is_closed_or_leaves_by_the_border() {
    let mut numbers = Numbers::new(41);
    for round in 0..ROUNDS {
        for at in [[0, 0], [-900, 700], [1990, 100], [1990, -1990]] {
            let ball = ball(&mut numbers, at, 300);
            check(&ball, &ball.solid(), &format!("round {round} at {at:?}"));
        }
    }
}

#[test]
fn several_curves_lie_apart_on_one_face() {
    let mut numbers = Numbers::new(42);
    for round in 0..ROUNDS {
        for other in [[-1100, 900], [-1990, 600], [900, -1200]] {
            let (a, b) = (
                ball(&mut numbers, [-500, 1500], 280),
                ball(&mut numbers, other, 290),
            );
            let truth = union(&a, &b);
            check(&a.with(b), &truth, &format!("round {round} with {other:?}"));
        }
    }
}

#[test]
fn curves_of_a_surface_that_overlaps_itself_cross() {
    let mut numbers = Numbers::new(43);
    for round in 0..ROUNDS {
        // The last two leave the face through its edge, in separate arcs.
        let places = [
            ([0, 0], [250, 90]),
            ([1850, 300], [1950, 600]),
            ([1743, -200], [1743, 200]),
        ];
        for (at, other) in places {
            let (a, b) = (ball(&mut numbers, at, 300), ball(&mut numbers, other, 310));
            let truth = union(&a, &b);
            check(&a.with(b), &truth, &format!("round {round} at {at:?}"));
        }
    }
}

#[test]
fn curves_lie_inside_each_other() {
    let mut numbers = Numbers::new(44);
    for round in 0..ROUNDS {
        for at in [[-700, 0], [1800, 200]] {
            let (a, b) = (ball(&mut numbers, at, 400), ball(&mut numbers, at, 200));
            let context = format!("round {round} at {at:?}");
            let within = a.clone().with(b.clone());
            check(&within, &a.solid(), &context);
            let hollow = applied(SetOp::Difference, &a.solid(), &b.solid());
            check(&a.with(b.inverted()), &hollow, &context);
        }
    }
}
