//! Operands with many equal faces: revisions of a mesh, and steps of a chain.

use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::expression::Term;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::query::classify::Location;
use bspcsg::tree::solid::Solid;

use super::support::{
    applied, assert_same_set, combined, complement, located, manifold_mesh, normalized, volume,
    Numbers, Shape,
};

/// All coordinates of shapes here are in `0..REACH`, except for spheres.
const REACH: i64 = 24;

/// A random surface that may meet other surfaces of a mesh.
fn any_part(numbers: &mut Numbers) -> Shape {
    match numbers.below(3) {
        0 => Shape::any_tetrahedron(numbers, REACH),
        1 => Shape::any_cuboid(numbers, REACH),
        _ => Shape::sphere(numbers.point(REACH), 7.0, 1),
    }
}

/// The same surface with its faces in another order, each starting at another corner.
fn shuffled(mut shape: Shape, numbers: &mut Numbers) -> Shape {
    for last in (1..shape.faces.len()).rev() {
        shape.faces.swap(last, numbers.index(last + 1));
    }
    for face in &mut shape.faces {
        face.rotate_left(numbers.index(3));
    }
    shape
}

/// Two meshes with common parts, each perhaps with parts of its own.
fn revisions(numbers: &mut Numbers) -> [Shape; 2] {
    let common: Vec<Shape> = (0..=numbers.below(3)).map(|_| any_part(numbers)).collect();
    [0; 2].map(|_| {
        let own = numbers.below(2);
        let own: Vec<Shape> = (0..own).map(|_| any_part(numbers)).collect();
        let parts = common.iter().cloned().chain(own);
        let all = parts.reduce(Shape::with).expect("a part");
        shuffled(all, numbers)
    })
}

fn places(numbers: &mut Numbers) -> Vec<Lattice> {
    (0..400).map(|_| numbers.point(REACH)).collect()
}

/// Asserts that a result is inside where the operands' locations say so, at points on no boundary.
fn assert_value(
    result: &Solid,
    operands: &[&Solid],
    places: &[Lattice],
    value: impl Fn(&[bool]) -> bool,
    context: &str,
) {
    let of_operands: Vec<Vec<Location>> = operands.iter().map(|s| located(s, places)).collect();
    for (at, found) in located(result, places).iter().enumerate() {
        let said: Vec<Location> = of_operands.iter().map(|all| all[at]).collect();
        if said.iter().all(|l| *l != Location::Boundary) {
            let inside: Vec<bool> = said.iter().map(|l| *l == Location::Inside).collect();
            let wanted = if value(&inside) {
                Location::Inside
            } else {
                Location::Outside
            };
            assert_eq!(*found, wanted, "{context}: {:?}", places[at]);
        }
    }
}

fn value(op: SetOp, inside: &[bool]) -> bool {
    let [a, b] = [inside[0], inside[1]];
    match op {
        SetOp::Union => a || b,
        SetOp::Intersection => a && b,
        SetOp::Difference => a && !b,
        SetOp::SymmetricDifference => a != b,
    }
}

#[test]
fn revisions_combine_like_their_points() {
    let mut numbers = Numbers::new(41);
    for round in 0..120 {
        let meshes = revisions(&mut numbers);
        let [a, b] = meshes.each_ref().map(Shape::unchecked);
        let places = places(&mut numbers);
        let results = SetOp::ALL.map(|op| {
            let context = format!("round {round}, {op:?}");
            let result = applied(op, &a, &b);
            assert_value(&result, &[&a, &b], &places, |v| value(op, v), &context);
            // A mesh that overlaps itself still does so where no operation examined it.
            let reduced = normalized(&result, Rule::Positive);
            manifold_mesh(&reduced, &context);
            reduced
        });
        let [union, common, less, different] = results.each_ref().map(volume);
        assert_eq!(different.plus(&common), union, "round {round}");
        assert_eq!(
            less.plus(&common),
            volume(&meshes[0].united()),
            "round {round}"
        );
    }
}

/// A ball alone has outside around its surface; the same ball in a block does not.
#[test]
fn the_same_faces_in_other_surroundings_are_no_twins() {
    let mut numbers = Numbers::new(44);
    let places = places(&mut numbers);
    let ball = || Shape::sphere([REACH / 2; 3], 7.0, 1);
    let block = || Shape::cuboid([0; 3], [REACH; 3]);
    let alone = ball().solid();
    for inner in [ball(), ball().inverted()] {
        let within = block().with(inner).unchecked();
        let operands = [&within, &alone];
        for op in SetOp::ALL {
            let result = applied(op, &within, &alone);
            assert_value(&result, &operands, &places, |v| value(op, v), "as it is");
            let turned = applied(op, &complement(&within), &alone);
            let values = |v: &[bool]| value(op, &[!v[0], v[1]]);
            assert_value(&turned, &operands, &places, values, "turned");
        }
    }
}

/// Equal operands in different lists, more than two of them.
#[test]
fn expressions_of_revisions_are_like_their_points() {
    let mut numbers = Numbers::new(42);
    for round in 0..40 {
        let mut meshes = revisions(&mut numbers).to_vec();
        meshes.push(shuffled(meshes[0].clone(), &mut numbers));
        meshes.push(any_part(&mut numbers));
        let solids: Vec<Solid> = meshes.iter().map(Shape::unchecked).collect();
        // ((0 ∪ 3) − 1) ⊖ (2 ∩ 3)
        let lines = vec![
            Term::Or(vec![0, 3]),
            Term::Not(1),
            Term::And(vec![4, 5]),
            Term::And(vec![2, 3]),
            Term::Xor(vec![6, 7]),
        ];
        let result = combined(&solids, lines);
        let context = format!("round {round}");
        let value = |v: &[bool]| ((v[0] || v[3]) && !v[1]) != (v[2] && v[3]);
        let operands: Vec<&Solid> = solids.iter().collect();
        assert_value(&result, &operands, &places(&mut numbers), value, &context);
        manifold_mesh(&normalized(&result, Rule::Positive), &context);
    }
}

/// The steps of a chain share the nodes of their trees where nothing changed.
#[test]
fn steps_of_a_chain_combine_like_their_points() {
    let mut numbers = Numbers::new(43);
    for round in 0..40 {
        let mut steps = vec![any_part(&mut numbers).solid()];
        for _ in 0..4 {
            let op = numbers.pick(&[SetOp::Union, SetOp::Difference]);
            let next = applied(op, &steps[steps.len() - 1], &any_part(&mut numbers).solid());
            steps.push(next);
        }
        let [first, last] = [2, steps.len() - 1].map(|k| steps[k].clone());
        let places = places(&mut numbers);
        for op in SetOp::ALL {
            let context = format!("round {round}, {op:?}");
            let result = applied(op, &first, &last);
            assert_value(
                &result,
                &[&first, &last],
                &places,
                |v| value(op, v),
                &context,
            );
            let turned = applied(op, &complement(&first), &last);
            let values = |v: &[bool]| value(op, &[!v[0], v[1]]);
            assert_value(&turned, &[&first, &last], &places, values, &context);
        }
        let difference = applied(SetOp::SymmetricDifference, &first, &last);
        assert_same_set(
            &applied(SetOp::SymmetricDifference, &first, &difference),
            &last,
        );
    }
}
