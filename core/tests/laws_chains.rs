//! Chains of operations: values cached in nodes are compared with values computed for the whole solid.

use std::sync::Arc;

use bspcsg::arith::Int;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::mesh::handle::Slot;
use bspcsg::query::measure::volume_rounded;
use bspcsg::tree::solid::Solid;
use bspcsg::tree::table::SourceTable;

use super::support::{applied, complement, is_empty, normalized, volume, Numbers, Ratio, Shape};

fn any_tool(numbers: &mut Numbers) -> Solid {
    match numbers.below(5) {
        0 => Shape::any_cuboid(numbers, 60).solid(),
        1 => Shape::sphere(numbers.point(60), 14.0, 1).solid(),
        2 => {
            let normal = numbers.point(9).map(|c| i128::from(c - 4));
            let offset = Int::from_i64(numbers.below(400));
            let pitch = Pitch::new(0).expect("a pitch");
            let source = half_space(normal, &offset, pitch, None);
            source.map_or_else(
                |_| Solid::uniform(pitch, true),
                |plane| Solid::of_source(Arc::new(plane), true),
            )
        }
        _ => Shape::any_tetrahedron(numbers, 60).solid(),
    }
}

/// Asserts that the rounded volume is the double nearest to the exact one.
fn assert_nearest(solid: &Solid, exact: &Ratio, context: &str) {
    let Some(rounded) = volume_rounded(solid) else {
        return;
    };
    let distance = |x: f64| exact.minus(&Ratio::of_double(x)).size();
    for other in [rounded.next_up(), rounded.next_down()] {
        assert!(distance(rounded) <= distance(other), "{rounded}: {context}");
    }
}

/// Each step uses the caches of the step before, for complements and for pieces that are put back, too.
#[test]
fn kept_volumes_are_right_at_every_step() {
    let mut numbers = Numbers::new(21);
    for chain in 0..12 {
        let mut solid = Shape::any_cuboid(&mut numbers, 60).solid();
        for step in 0..25 {
            let tool = any_tool(&mut numbers);
            let next = match numbers.below(6) {
                0 => {
                    let piece = applied(SetOp::Intersection, &solid, &tool);
                    let rest = applied(SetOp::Difference, &solid, &tool);
                    assert_eq!(volume(&piece).plus(&volume(&rest)), volume(&solid));
                    applied(SetOp::Union, &rest, &piece)
                }
                1 => {
                    let outside = applied(SetOp::Union, &complement(&solid), &tool);
                    assert!(volume_rounded(&outside).is_none());
                    complement(&outside)
                }
                2 | 3 => applied(SetOp::Difference, &solid, &tool),
                4 => applied(
                    SetOp::SymmetricDifference,
                    &solid,
                    &Shape::any_cuboid(&mut numbers, 60).solid(),
                ),
                _ => applied(
                    SetOp::Union,
                    &solid,
                    &Shape::any_tetrahedron(&mut numbers, 60).solid(),
                ),
            };
            let exact = volume(&next);
            assert_nearest(&next, &exact, &format!("step {step} of chain {chain}"));
            solid = next;
        }
    }
}

/// Results of operands that were not checked are known to be reduced once these operands are checked.
#[test]
fn results_of_simple_meshes_are_reduced_once_these_are_checked() {
    let mut numbers = Numbers::new(22);
    let mut solid = Shape::cuboid([0; 3], [60; 3]).unchecked();
    for _ in 0..10 {
        let tool = Shape::any_tetrahedron(&mut numbers, 60).unchecked();
        solid = applied(SetOp::Difference, &solid, &tool);
        assert!(!solid.is_reduced());
        let same = normalized(&solid, Rule::Positive);
        assert!(solid.is_reduced() && same.is_reduced());
        assert_eq!(volume(&same), volume(&solid));
    }
    // No face of another operand is near where this one overlaps itself, so no visited cell reveals it.
    let twice = Shape::cuboid([50; 3], [300; 3]).with(Shape::cuboid([250; 3], [400; 3]));
    let raw = applied(SetOp::Union, &solid, &twice.unchecked());
    assert!(!raw.is_reduced());
    let clean = normalized(&raw, Rule::Positive);
    assert!(!raw.is_reduced() && clean.is_reduced());
    assert_eq!(
        volume(&clean),
        volume(&applied(SetOp::Union, &solid, &twice.united()))
    );
}

/// If an operand is united with itself during the operation, its result needs no check.
#[test]
fn results_are_reduced_where_a_visited_cell_shows_the_overlap() {
    let solid = Shape::cuboid([0; 3], [60; 3]).unchecked();
    normalized(&solid, Rule::Positive);
    let twice = Shape::cuboid([1; 3], [80; 3]).with(Shape::cuboid([10; 3], [90; 3]));
    let result = applied(SetOp::Difference, &solid, &twice.unchecked());
    assert!(result.is_reduced());
    let expected = applied(SetOp::Difference, &solid, &twice.united());
    assert_eq!(volume(&result), volume(&expected));
}

/// A solid that is its own united form does not keep itself alive.
#[test]
fn checked_solids_are_freed() {
    let mesh = Shape::cuboid([0; 3], [60; 3]).unchecked();
    let tool = Shape::cuboid([20; 3], [90; 3]).unchecked();
    let result = applied(SetOp::Difference, &mesh, &tool);
    let same = normalized(&result, Rule::Positive);
    assert!(mesh.is_reduced() && tool.is_reduced() && result.is_reduced());
    let nodes = [&mesh, &tool, &result].map(|s| Arc::downgrade(&s.root().node));
    drop((mesh, tool, result, same));
    assert!(nodes.iter().all(|node| node.upgrade().is_none()));
}

/// Sources stay in the order of the expression, whichever solid extends a shared table first.
#[test]
fn tables_keep_the_order_of_the_expression() {
    let sources: Vec<_> = (0..9)
        .map(|i| Shape::cuboid([i; 3], [i + 1; 3]).source())
        .collect();
    let table = |list: &[usize]| list.iter().map(|i| &sources[*i]).collect::<SourceTable>();
    let order = |t: &SourceTable| -> Vec<u64> { t.iter().map(|s| s.id()).collect() };
    let expected = |list: &[usize]| -> Vec<u64> { list.iter().map(|i| sources[*i].id()).collect() };
    let base = table(&[0, 1, 2]);
    let first = base.joined(&table(&[3, 1]));
    let second = base.joined(&table(&[4, 0, 3]));
    let third = base.joined(&table(&[3, 5]));
    assert_eq!(order(&first), expected(&[0, 1, 2, 3]));
    assert_eq!(order(&second), expected(&[0, 1, 2, 4, 3]));
    assert_eq!(order(&third), expected(&[0, 1, 2, 3, 5]));
    assert_eq!(order(&first.joined(&third)), expected(&[0, 1, 2, 3, 5]));
    assert_eq!(order(&third.joined(&second)), expected(&[0, 1, 2, 3, 5, 4]));
    assert_eq!(order(&base), expected(&[0, 1, 2]));
    assert_eq!(base.slot(&sources[3]), None);
    assert_eq!(second.slot(&sources[3]), Some(Slot(4)));
}

/// The tables of long chains drop sources that were cut away.
#[test]
fn tables_of_long_chains_forget() {
    let mut solid = Shape::cuboid([0; 3], [100; 3]).solid();
    for i in 0..400 {
        let corner = [i % 10, (i / 10) % 10, 0];
        let tool = Shape::cuboid(corner.map(|c| 7 * c), corner.map(|c| 7 * c + 9)).solid();
        solid = applied(SetOp::Difference, &solid, &tool);
    }
    assert!(
        solid.sources().len() < 300,
        "{} sources",
        solid.sources().len()
    );
    assert!(!is_empty(&solid));
}
