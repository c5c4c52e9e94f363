//! Operations on solids and questions to them.

use bspcsg::extract::boundary::collect::has_no_boundary;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::evaluate::{evaluate, normalize};
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::query::classify::{classify, Location};
use bspcsg::tree::solid::Solid;

/// The value of an expression; its lines come after one line for each operand.
pub fn combined(solids: &[Solid], lines: Vec<Term>) -> Solid {
    let count = u32::try_from(solids.len()).expect("few");
    let terms = (0..count).map(Term::Operand).chain(lines).collect();
    let expression = Expression::new(terms).expect("well formed");
    let done = evaluate(&expression, solids);
    done.expect("evaluates").0
}

/// One set operation.
pub fn applied(op: SetOp, a: &Solid, b: &Solid) -> Solid {
    let lines = match op {
        SetOp::Union => vec![Term::Or(vec![0, 1])],
        SetOp::Intersection => vec![Term::And(vec![0, 1])],
        SetOp::Difference => vec![Term::Not(1), Term::And(vec![0, 2])],
        SetOp::SymmetricDifference => vec![Term::Xor(vec![0, 1])],
    };
    combined(&[a.clone(), b.clone()], lines)
}

/// The complement.
pub fn complement(a: &Solid) -> Solid {
    combined(std::slice::from_ref(a), vec![Term::Not(0)])
}

/// Return whether no point is inside.
pub fn is_empty(solid: &Solid) -> bool {
    has_no_boundary(solid) && solid.root().outside <= 0
}

/// Return whether all points are inside.
pub fn is_full(solid: &Solid) -> bool {
    has_no_boundary(solid) && solid.root().outside > 0
}

/// The solid united with itself.
pub fn normalized(solid: &Solid, rule: Rule) -> Solid {
    normalize(solid, rule).expect("normalizes")
}

/// Return what a rule says of a winding number, in words of its own.
pub fn wanted(rule: Rule, number: i32) -> bool {
    match rule {
        Rule::Positive => number >= 1,
        Rule::Nonzero => number.abs() >= 1,
        Rule::EvenOdd => number & 1 == 1,
    }
}

/// Locate lattice points.
pub fn located(solid: &Solid, points: &[Lattice]) -> Vec<Location> {
    classify(solid, points).expect("lattice points")
}

/// Mark the places of a labelling that are inside; for points on no boundary.
pub fn inside(solid: &Solid, points: &[Lattice]) -> Vec<bool> {
    let is_inside = |l: &Location| *l == Location::Inside;
    located(solid, points).iter().map(is_inside).collect()
}
