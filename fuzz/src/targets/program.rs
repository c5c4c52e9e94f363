//! Any lines as an expression.

use arbitrary::Unstructured;
use bspcsg::error::ErrorKind;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::evaluate::evaluate as run;
use bspcsg::merge::expression::Expression;
use bspcsg::merge::expression::Term;
use bspcsg::query::classify::Location;
use bspcsg::query::measure;
use bspcsg::tree::solid::Solid;
use num_bigint::BigInt;

use super::super::support::{located, manifold_mesh, Voxels};

/// Any lines as an expression over unions of unit cubes: refused, or right cube by cube.
pub fn program(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok(cubes) = u.arbitrary::<[u8; 3]>() else {
        return;
    };
    let Ok(terms) = any_terms(&mut u) else {
        return;
    };
    let names_earlier = terms
        .iter()
        .enumerate()
        .all(|(i, t)| arguments(t).iter().all(|a| (*a as usize) < i));
    let found = Expression::new(terms.clone());
    assert_eq!(
        found.is_ok(),
        names_earlier && !terms.is_empty(),
        "{terms:?}"
    );
    let Ok(expression) = found else {
        return;
    };
    let solids: Vec<Solid> = cubes
        .iter()
        .map(|bits| {
            Voxels {
                side: 2,
                bits: u32::from(*bits),
            }
            .solid(|p| p)
        })
        .collect();
    let value = run(&expression, &solids);
    if expression.operands().iter().any(|k| *k >= 3) {
        let kind = value.expect_err("an operand that is not there").kind();
        assert_eq!(kind, ErrorKind::Shape);
        return;
    }
    let (result, _) = value.expect("well formed");
    let word = |k: u32| u64::from(cubes[k as usize]);
    let expected = expression_value(&terms, word);
    let centres: Vec<Lattice> = (0..9i64)
        .map(|i| {
            if i == 8 {
                [9; 3]
            } else {
                [2 * (i % 2) + 1, 2 * (i / 2 % 2) + 1, 2 * (i / 4) + 1]
            }
        })
        .collect();
    for (i, found) in located(&result, &centres).into_iter().enumerate() {
        let inside = expected >> i & 1 == 1;
        assert_eq!(
            found == Location::Inside,
            inside,
            "cube {i} of {terms:?} over {cubes:?}"
        );
    }
    if expected >> 8 & 1 == 0 {
        let cubes = BigInt::from((expected & 0xff).count_ones() * 8);
        let exact = measure::volume(&result).expect("bounded");
        assert_eq!(exact.numerator, cubes * exact.denominator, "{terms:?}");
        manifold_mesh(&result, "cubes");
    }
}

/// The value for the eight cubes and, in the bits above, outside of them.
fn expression_value(terms: &[Term], operand: impl Fn(u32) -> u64) -> u64 {
    let mut values: Vec<u64> = Vec::new();
    for term in terms {
        let at = |k: &u32| values[*k as usize];
        values.push(match term {
            Term::Operand(k) => operand(*k),
            Term::Not(a) => !at(a),
            Term::And(list) => list.iter().fold(u64::MAX, |all, k| all & at(k)),
            Term::Or(list) => list.iter().fold(0, |all, k| all | at(k)),
            Term::Xor(list) => list.iter().fold(0, |all, k| all ^ at(k)),
        });
    }
    *values.last().expect("not empty")
}

fn any_terms(u: &mut Unstructured<'_>) -> arbitrary::Result<Vec<Term>> {
    let count = u.int_in_range(0..=12u32)?;
    (0..count)
        .map(|line| {
            let most = if u.ratio(1, 64)? {
                u32::MAX
            } else {
                line.saturating_sub(1)
            };
            let mut list = || -> arbitrary::Result<Vec<u32>> {
                (0..u.int_in_range(0..=3)?)
                    .map(|_| u.int_in_range(0..=most))
                    .collect()
            };
            let arguments = list()?;
            Ok(match (u.int_in_range(0..=4)?, arguments.first()) {
                (0, Some(first)) => Term::Not(*first),
                (1, _) => Term::And(arguments),
                (2, _) => Term::Or(arguments),
                (3, _) => Term::Xor(arguments),
                _ => Term::Operand(if u.ratio(1, 64)? {
                    u.arbitrary()?
                } else {
                    u.int_in_range(0..=2)?
                }),
            })
        })
        .collect()
}

fn arguments(term: &Term) -> &[u32] {
    match term {
        Term::Operand(_) => &[],
        Term::Not(a) => std::slice::from_ref(a),
        Term::And(list) | Term::Or(list) | Term::Xor(list) => list,
    }
}
