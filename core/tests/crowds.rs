//! Many operands in one region: evaluated in groups, they make what single operations in succession make.

use std::sync::Arc;

use bspcsg::arith::convert::as_whole;
use bspcsg::arith::Int;
use bspcsg::extract::rounding::round::mesh;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::mesh::handle::VertexId;
use bspcsg::query::classify::Location;
use bspcsg::tree::node::Node;
use bspcsg::tree::solid::Solid;

use super::support::{
    applied, assert_same_set, combined, complement, double, inside, located, manifold_mesh,
    normalized, volume, Numbers, Shape,
};

/// Random lines of nested operations over operands 0 … count − 1, in which each operand occurs once.
fn any_terms(numbers: &mut Numbers, count: u32) -> Vec<Term> {
    let mut terms: Vec<Term> = (0..count).map(Term::Operand).collect();
    let mut open: Vec<u32> = (0..count).collect();
    while open.len() > 1 {
        let size = 2 + usize::try_from(numbers.below(4)).expect("small");
        let list = open.drain(..size.min(open.len())).collect();
        terms.push(match numbers.below(3) {
            0 => Term::And(list),
            1 => Term::Or(list),
            _ => Term::Xor(list),
        });
        if numbers.below(3) == 0 {
            let last = u32::try_from(terms.len()).expect("few") - 1;
            terms.push(Term::Not(last));
        }
        open.push(u32::try_from(terms.len()).expect("few") - 1);
    }
    terms
}

/// A random expression over operands of which some are equal, and for each operand the first equal one.
fn with_twins(numbers: &mut Numbers, count: u32) -> (Expression, Vec<u32>) {
    let expression = Expression::new(any_terms(numbers, count)).expect("well formed");
    let kinds = 1 + numbers.below(i64::from(count));
    let kind_of: Vec<i64> = (0..count).map(|_| numbers.below(kinds)).collect();
    let first = |kind| kind_of.iter().position(|k| *k == kind).expect("its own");
    let firsts = kind_of.iter().map(|kind| first(*kind));
    let firsts = firsts.map(|k| u32::try_from(k).expect("few")).collect();
    (expression, firsts)
}

#[test]
fn an_expression_of_twins_is_one_of_the_first_of_them() {
    let mut numbers = Numbers::new(37);
    let mut merged = 0;
    for count in 2..9 {
        for _ in 0..60 {
            let (expression, firsts) = with_twins(&mut numbers, count);
            let fewer = expression.merged(|k| firsts[k as usize]);
            merged += usize::from(fewer.operands().len() < expression.operands().len());
            for inside in 0..1 << count {
                let of_first = |k: u32| inside >> firsts[k as usize] & 1 == 1;
                let expected = expression.value(of_first, &mut Vec::new());
                assert_eq!(fewer.value(of_first, &mut Vec::new()), expected);
            }
        }
    }
    assert!(merged > 100, "{merged}");
}

#[test]
fn copies_of_meshes_change_no_byte() {
    let mut numbers = Numbers::new(41);
    for _ in 0..20 {
        let shapes: Vec<Shape> = (0..6).map(|_| Shape::any_cuboid(&mut numbers, 4)).collect();
        let solids: Vec<Solid> = shapes.iter().map(Shape::solid).collect();
        let copies: Vec<Solid> = shapes.iter().cycle().take(70).map(Shape::solid).collect();
        for list in [Term::And as fn(Vec<u32>) -> Term, Term::Or] {
            let once = listed(&solids, list);
            assert_eq!(listed(&copies, list), once);
        }
        let twice: Vec<Solid> = shapes.iter().chain(&shapes).map(Shape::solid).collect();
        assert!(listed(&twice, Term::Xor).1.is_empty());
    }
}

/// The mesh of one operation over all operands: its vertices and triangles.
fn listed(solids: &[Solid], list: fn(Vec<u32>) -> Term) -> (Vec<[f64; 3]>, Vec<[VertexId; 3]>) {
    let count = u32::try_from(solids.len()).expect("few");
    let lines = vec![list((0..count).collect())];
    let made = manifold_mesh(&combined(solids, lines), "copies");
    (made.vertices, made.triangles)
}

/// The value of an expression at a point, where operand k is inside if bit k of `inside` is set.
fn value(expression: &Expression, inside: u32) -> bool {
    expression.value(|k| inside >> k & 1 == 1, &mut Vec::new())
}

#[test]
fn an_expression_is_what_its_two_parts_make() {
    let mut numbers = Numbers::new(31);
    let mut parted = 0;
    for count in 2..9 {
        for _ in 0..60 {
            let expression = Expression::new(any_terms(&mut numbers, count)).expect("well formed");
            let Some(parts) = expression.split() else {
                continue;
            };
            parted += 1;
            let [ours, theirs] = parts.halves.each_ref().map(Expression::operands);
            assert!(!ours.is_empty() && !theirs.is_empty());
            assert!(ours.iter().all(|k| !theirs.contains(k)));
            for inside in 0..1 << count {
                let [left, right] = parts.halves.each_ref().map(|half| value(half, inside));
                let of = |k: u32| if k == 0 { left } else { right };
                let whole = parts.whole.value(of, &mut Vec::new());
                assert_eq!(whole, value(&expression, inside), "{expression:?}");
            }
        }
    }
    assert!(parted > 300, "{parted}");
}

#[test]
fn an_operand_in_both_parts_is_not_parted() {
    let terms = vec![
        Term::Operand(0),
        Term::Operand(1),
        Term::And(vec![0, 1]),
        Term::Not(0),
        Term::Or(vec![2, 3]),
    ];
    assert!(Expression::new(terms)
        .expect("well formed")
        .split()
        .is_none());
}

/// Evaluates the lines of an expression one after another.
fn stepwise(solids: &[Solid], terms: &[Term]) -> Solid {
    let mut made: Vec<Solid> = Vec::new();
    for term in terms {
        let fold = |list: &[u32], op: SetOp| {
            let all = list.iter().map(|line| made[*line as usize].clone());
            all.reduce(|a, b| applied(op, &a, &b)).expect("not empty")
        };
        made.push(match term {
            Term::Operand(k) => solids[*k as usize].clone(),
            Term::Not(line) => complement(&made[*line as usize]),
            Term::And(list) => fold(list, SetOp::Intersection),
            Term::Or(list) => fold(list, SetOp::Union),
            Term::Xor(list) => fold(list, SetOp::SymmetricDifference),
        });
    }
    made.pop().expect("not empty")
}

fn assert_same_as_stepwise(solids: &[Solid], terms: &[Term], context: &str) {
    let at_once = combined(solids, terms[solids.len()..].to_vec());
    let steps = stepwise(solids, terms);
    assert_same_set(&at_once, &steps);
    let [at_once, steps] = [at_once, steps].map(|solid| normalized(&solid, Rule::Positive));
    if at_once.root().outside == 0 {
        manifold_mesh(&at_once, context);
        assert_eq!(volume(&at_once), volume(&steps), "{context}");
    }
}

#[test]
fn solids_in_one_place_make_what_they_make_one_after_the_other() {
    let mut numbers = Numbers::new(32);
    for round in 0..24 {
        let count = 3 + round % 8;
        let any = |numbers: &mut Numbers| match numbers.below(4) {
            0 => Shape::any_cuboid(numbers, 40).solid(),
            // A mesh that may overlap itself.
            3 => Shape::any_cuboid(numbers, 40)
                .with(Shape::any_tetrahedron(numbers, 40))
                .unchecked(),
            1 => Shape::sphere([20; 3], 15.0, 1).solid(),
            _ => Shape::any_tetrahedron(numbers, 40).solid(),
        };
        let solids: Vec<Solid> = (0..count).map(|_| any(&mut numbers)).collect();
        let terms = any_terms(&mut numbers, count);
        assert_same_as_stepwise(&solids, &terms, &format!("round {round}: {terms:?}"));
    }
}

// Found: many half-spaces, turned cubes or shells in one region took minutes.
#[test]
fn half_spaces_in_one_place_make_what_they_make_one_after_the_other() {
    let mut numbers = Numbers::new(33);
    let pitch = Pitch::new(0).expect("a pitch");
    for round in 0..8 {
        let spaces = (0..12).map(|_| {
            let normal = [0; 3].map(|_| i128::from(numbers.below(41) - 20));
            let normal = if normal == [0; 3] { [1, 0, 0] } else { normal };
            let offset = Int::from_i64(numbers.below(400));
            let space = half_space(normal, &offset, pitch, None).expect("a half-space");
            Solid::of_source(Arc::new(space), true)
        });
        let mut solids: Vec<Solid> = spaces.collect();
        solids.push(Shape::cuboid([-60; 3], [60; 3]).solid());
        let count = u32::try_from(solids.len()).expect("few");
        let mut terms: Vec<Term> = (0..count).map(Term::Operand).collect();
        terms.push(Term::And((0..count).collect()));
        assert_same_as_stepwise(&solids, &terms, &format!("round {round}"));
    }
}

#[test]
fn shells_of_one_mesh_make_what_they_make_one_after_the_other() {
    let mut numbers = Numbers::new(34);
    for round in 0..24 {
        let any = |numbers: &mut Numbers| match numbers.below(3) {
            0 => Shape::any_cuboid(numbers, 40),
            1 => Shape::sphere(numbers.point(30), 9.0, 1),
            _ => Shape::any_tetrahedron(numbers, 40),
        };
        let shapes: Vec<Shape> = (0..2 + round % 9).map(|_| any(&mut numbers)).collect();
        let all = shapes.iter().cloned().fold(Shape::default(), Shape::with);
        let solids = shapes.iter().map(Shape::solid);
        let union = solids.reduce(|a, b| applied(SetOp::Union, &a, &b));
        let union = union.expect("several");
        for rule in [Rule::Positive, Rule::Nonzero] {
            let united = normalized(&all.unchecked(), rule);
            assert!(united.is_reduced());
            assert_same_set(&united, &union);
            manifold_mesh(&united, &format!("round {round}"));
            assert_eq!(volume(&united), volume(&union), "round {round}");
        }
    }
}

#[test]
fn a_shell_that_is_turned_around_takes_away() {
    let inner = Shape::cuboid([10; 3], [30; 3]).inverted();
    let beside = Shape::cuboid([20, 20, 20], [60; 3]);
    let shape = Shape::cuboid([0; 3], [40; 3]).with(inner).with(beside);
    let united = normalized(&shape.unchecked(), Rule::Positive);
    // Inside the inner shell the winding numbers of both shells cancel.
    let points = [[15, 15, 15], [25, 25, 25], [5, 5, 5], [50, 50, 50]];
    assert_eq!(inside(&united, &points), [false, true, true, true]);
}

/// A sphere with some vertices moved to random points, so that its faces cross each other.
fn crumpled(numbers: &mut Numbers, size: i64) -> Shape {
    let mut shape = Shape::sphere([0; 3], double(size), 2);
    for vertex in shape.vertices.iter_mut().step_by(9) {
        *vertex = numbers.point(size);
    }
    shape
}

/// A tube of `rings` rings that passes through itself once.
fn eight(rings: i64) -> Shape {
    let sides = 12;
    let at = |ring: i64, side: i64| {
        let turn = std::f64::consts::TAU * double(ring) / double(rings);
        let around = std::f64::consts::TAU * double(side) / double(sides) + 0.1;
        let ahead = [-turn.sin(), (2.0 * turn).cos()];
        let length = ahead[0].hypot(ahead[1]);
        let out = 0.2 * around.cos() / length;
        let place = [
            turn.cos() - out * ahead[1],
            turn.sin() * turn.cos() + out * ahead[0],
            0.2 * around.sin(),
        ];
        place.map(|x| as_whole(1e6 * x))
    };
    let number = |ring: i64, side: i64| ring % rings * sides + side % sides;
    let places = || (0..rings).flat_map(|ring| (0..sides).map(move |side| (ring, side)));
    let faces = places().flat_map(|(ring, side)| {
        let [a, b] = [number(ring, side), number(ring + 1, side)];
        let [c, d] = [number(ring + 1, side + 1), number(ring, side + 1)];
        [[a, d, c], [a, c, b]]
    });
    Shape {
        vertices: places().map(|(ring, side)| at(ring, side)).collect(),
        faces: faces.collect(),
    }
}

#[test]
fn a_shell_that_crosses_itself_bounds_what_it_winds_around() {
    let mut numbers = Numbers::new(38);
    for round in 0..24 {
        let size = if round % 2 == 0 { 12 } else { 4000 };
        let raw = crumpled(&mut numbers, size).unchecked();
        let united = normalized(&raw, Rule::Positive);
        assert!(united.is_reduced());
        manifold_mesh(&united, &format!("round {round}"));
        let points: Vec<Lattice> = (0..200).map(|_| numbers.point(size)).collect();
        let found = located(&raw, &points)
            .into_iter()
            .zip(located(&united, &points));
        for (raw, united) in found.filter(|(raw, _)| *raw != Location::Boundary) {
            assert_eq!(raw, united, "round {round}");
        }
    }
}

/// Faces are cut where a mesh overlaps itself, and all that is left is one list, not a tree of cells.
#[test]
fn what_crosses_itself_in_one_place_costs_no_tree() {
    for rings in [60, 120] {
        let shape = eight(rings);
        let united = normalized(&shape.unchecked(), Rule::Positive);
        let Node::Deferred(leaf) = &*united.root().node else {
            panic!("{rings} rings are divided");
        };
        assert!(leaf.len() <= shape.faces.len() && leaf.parts.len() < shape.faces.len() / 4);
        manifold_mesh(&united, &format!("{rings} rings"));
    }
}

/// A mesh is kept as it is only if its surfaces cross on the lattice, and one such crossing suffices.
#[test]
fn a_mesh_says_that_it_crosses_itself_without_being_united() {
    let mut askew = Shape::cuboid([-80, -90, -2], [-70, 95, 2]);
    for place in &mut askew.vertices {
        place[0] += place[1] / 10;
    }
    let bars = Shape::cuboid([-100, -3, -3], [100, 3, 3]).with(askew);
    let bars = bars.unchecked();
    let tool = Shape::cuboid([80, -20, -20], [130, 20, 20]).unchecked();
    let result = applied(SetOp::Difference, &bars, &tool);
    assert!(bars.simple().get().is_none(), "no cell showed it");
    mesh(&result).expect("bounded");
    assert_eq!(result.simple().get(), Some(&false));
    assert!(
        bars.simple().get().is_none(),
        "the places of the crossings sufficed"
    );
    assert!(bars.united().get().is_none() && result.united().get().is_none());
}
