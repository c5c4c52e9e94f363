//! Operations on solids, and queries of them, for tests.

use bspcsg::extract::boundary::collect::has_no_boundary;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::evaluate::{evaluate, normalize};
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::query::classify::{classify, Location};
use bspcsg::tree::solid::Solid;

/// Evaluates an expression: one line for each operand, followed by `lines`.
pub fn combined(solids: &[Solid], lines: Vec<Term>) -> Solid {
    let count = u32::try_from(solids.len()).expect("few");
    let terms = (0..count).map(Term::Operand).chain(lines).collect();
    let expression = Expression::new(terms).expect("well formed");
    let done = evaluate(&expression, solids);
    done.expect("evaluates").0
}

/// Applies one set operation to two solids.
pub fn applied(op: SetOp, a: &Solid, b: &Solid) -> Solid {
    let lines = match op {
        SetOp::Union => vec![Term::Or(vec![0, 1])],
        SetOp::Intersection => vec![Term::And(vec![0, 1])],
        SetOp::Difference => vec![Term::Not(1), Term::And(vec![0, 2])],
        SetOp::SymmetricDifference => vec![Term::Xor(vec![0, 1])],
    };
    combined(&[a.clone(), b.clone()], lines)
}

/// The complement of a solid.
pub fn complement(a: &Solid) -> Solid {
    combined(std::slice::from_ref(a), vec![Term::Not(0)])
}

/// Returns true if no point is inside the solid.
pub fn is_empty(solid: &Solid) -> bool {
    has_no_boundary(solid) && solid.root().outside <= 0
}

/// Returns true if all points are inside the solid.
pub fn is_full(solid: &Solid) -> bool {
    has_no_boundary(solid) && solid.root().outside > 0
}

/// The solid united with itself under a winding rule.
pub fn normalized(solid: &Solid, rule: Rule) -> Solid {
    normalize(solid, rule).expect("normalizes")
}

/// Returns whether a rule calls a winding number inside, without the code under test.
pub fn wanted(rule: Rule, number: i32) -> bool {
    match rule {
        Rule::Positive => number >= 1,
        Rule::Nonzero => number.abs() >= 1,
        Rule::EvenOdd => number & 1 == 1,
    }
}

/// Returns the locations of lattice points.
pub fn located(solid: &Solid, points: &[Lattice]) -> Vec<Location> {
    classify(solid, points).expect("lattice points")
}

/// Returns for each point whether it is inside the solid; no point may be on the boundary.
pub fn inside(solid: &Solid, points: &[Lattice]) -> Vec<bool> {
    let is_inside = |l: &Location| *l == Location::Inside;
    located(solid, points).iter().map(is_inside).collect()
}
