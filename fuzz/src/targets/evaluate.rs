//! Scenes, evaluated.

use arbitrary::{Arbitrary, Unstructured};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::query::measure;
use bspcsg::tree::solid::Solid;

use super::super::scene::Scene;
use super::super::support::{applied, combined, complement, located, normalized, volume};
use super::checks::{assert_same, manifold_or_unbounded};

/// A scene: points lie where their winding numbers say, volumes add up, meshes are closed.
pub fn evaluate(data: &[u8]) {
    let Ok(scene) = Scene::arbitrary(&mut Unstructured::new(data)) else {
        return;
    };
    let context = format!("{scene:?}");
    let result = scene.result();
    manifold_or_unbounded(&result, &context);
    assert_points(&scene, &result, &context);
    assert_same(&result, &step_by_step(&scene), &context);
    let solids = scene.solids();
    let [first, second] = [solids.first(), solids.last()].map(|s| s.expect("an operand").clone());
    assert_laws(
        &normalized(&first, Rule::Positive),
        &normalized(&second, Rule::Positive),
        &context,
    );
}

fn assert_points(scene: &Scene, result: &Solid, context: &str) {
    let reduced = normalized(result, Rule::Positive);
    manifold_or_unbounded(&reduced, context);
    for (point, found) in scene.points.iter().zip(located(&reduced, &scene.points)) {
        if let Some(expected) = scene.location(point) {
            assert_eq!(found, expected, "{point:?} in {context}");
        }
    }
}

/// The value of the expression with each line evaluated by itself.
fn step_by_step(scene: &Scene) -> Solid {
    let mut values = scene.solids();
    for line in &scene.lines {
        let value = combined(&values, vec![line.clone()]);
        values.push(value);
    }
    values.pop().expect("there are operands")
}

/// Inclusion and exclusion in exact volumes, and De Morgan.
fn assert_laws(a: &Solid, b: &Solid, context: &str) {
    let [union, common, less, either] = SetOp::ALL.map(|op| applied(op, a, b));
    let outside_both = applied(SetOp::Intersection, &complement(a), &complement(b));
    assert_same(&outside_both, &complement(&union), context);
    assert_same(&applied(SetOp::Union, &less, &common), a, context);
    assert_same(
        &applied(SetOp::Difference, &union, &common),
        &either,
        context,
    );
    if is_bounded(a) && is_bounded(b) {
        assert_eq!(
            volume(&union).plus(&volume(&common)),
            volume(a).plus(&volume(b)),
            "{context}"
        );
        assert_eq!(volume(&less).plus(&volume(&common)), volume(a), "{context}");
        assert_eq!(
            volume(&union).minus(&volume(&common)),
            volume(&either),
            "{context}"
        );
    }
}

fn is_bounded(solid: &Solid) -> bool {
    measure::volume(solid).is_ok()
}
