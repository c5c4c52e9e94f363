//! Residuals of expressions, against their truth tables.

mod support;

use bspcsg::merge::expression::{Expression, Residual, Term};

use support::Numbers;

const OPERANDS: u32 = 6;

/// An expression of all operands and some lines over them, lists with repeated names among them.
fn any_expression(numbers: &mut Numbers) -> Expression {
    let mut terms: Vec<Term> = (0..OPERANDS).map(Term::Operand).collect();
    for _ in 0..=numbers.below(9) {
        let last = i64::try_from(terms.len()).expect("few");
        let mut pick = || u32::try_from(numbers.below(last)).expect("few");
        let line = pick();
        let list: Vec<u32> = (0..4).map(|_| pick()).collect();
        let list = list[..=line as usize % 4].to_vec();
        terms.push(match numbers.below(4) {
            0 => Term::Not(line),
            1 => Term::And(list),
            2 => Term::Or(list),
            _ => Term::Xor(list),
        });
    }
    Expression::new(terms).expect("lines name earlier lines")
}

fn has(bits: u32, k: u32) -> bool {
    bits >> k & 1 == 1
}

fn value_of(residual: &Residual, bits: u32) -> bool {
    match residual {
        Residual::Constant(value) => *value,
        Residual::Literal(k, negate) => has(bits, *k) != *negate,
        Residual::Open(left) => left.value(|k| has(bits, k), &mut Vec::new()),
    }
}

/// Whatever is put in first, what is left has the values of the whole, and names nothing known.
#[test]
fn residuals_have_the_values_of_the_whole() {
    let mut numbers = Numbers::new(31);
    for round in 0..400 {
        let whole = any_expression(&mut numbers);
        let known = u32::try_from(numbers.below(1 << OPERANDS)).expect("few");
        let told = u32::try_from(numbers.below(1 << OPERANDS)).expect("few");
        let left = whole.residual(|k| has(known, k).then(|| has(told, k)));
        for free in 0..1 << OPERANDS {
            let bits = told & known | free & !known;
            let expected = whole.value(|k| has(bits, k), &mut Vec::new());
            let context = format!("{whole:?} with {known:b} as {told:b} in round {round}");
            // What is known already must not be asked for.
            assert_eq!(value_of(&left, bits ^ known), expected, "{context}");
        }
    }
}

/// An expression taken apart has the values of the whole.
#[test]
fn parts_make_the_whole() {
    let mut numbers = Numbers::new(32);
    for _ in 0..400 {
        let whole = any_expression(&mut numbers);
        let Some(parted) = whole.parted() else {
            continue;
        };
        for bits in 0..1 << OPERANDS {
            let value = |one: &Expression| one.value(|k| has(bits, k), &mut Vec::new());
            let halves = parted.halves.each_ref().map(value);
            let found = parted.whole.value(|k| halves[k as usize], &mut Vec::new());
            assert_eq!(found, value(&whole), "{whole:?}");
        }
    }
}
