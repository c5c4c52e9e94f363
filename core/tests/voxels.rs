//! Unions of unit cubes through `evaluate` and `normalize`, compared with bit masks and counted winding
//! numbers. Many faces are coplanar; rotated by `turned`, no plane is axis-parallel.

use bspcsg::error::ErrorKind;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::expression::Term;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::query::measure;
use bspcsg::tree::solid::Solid;

use super::support::{
    applied, combined, complement, inside, is_empty, is_full, manifold_mesh, normalized, straight,
    turned, volume, wanted, Numbers, Ratio, Shape, Voxels,
};

/// A placement of the cubes: a map of the lattice, and the volume of the image of a cube of side 2.
#[derive(Clone, Copy)]
struct Placement {
    map: fn(Lattice) -> Lattice,
    cube: i64,
}

const STRAIGHT: Placement = Placement {
    map: straight,
    cube: 8,
};

const TURNED: Placement = Placement {
    map: turned,
    cube: 216,
};

impl Placement {
    fn solid(&self, voxels: &Voxels) -> Solid {
        voxels.solid(self.map)
    }

    fn centers(&self, side: i64) -> Vec<Lattice> {
        let center = |at: Lattice| (self.map)(at.map(|c| 2 * c + 1));
        Voxels::places(side).map(center).collect()
    }

    /// Compares a solid with the cubes that it should consist of.
    fn check(&self, solid: &Solid, expected: &Voxels, context: &str) {
        let found = inside(solid, &self.centers(expected.side));
        for (at, found) in Voxels::places(expected.side).zip(found) {
            assert_eq!(found, expected.has(at), "{context}: the cube at {at:?}");
        }
        manifold_mesh(solid, context);
        let cubes = i64::from(expected.bits.count_ones());
        assert_eq!(volume(solid), Ratio::whole(cubes * self.cube), "{context}");
        assert_eq!(is_empty(solid), expected.bits == 0, "{context}: emptiness");
    }
}

fn bits(op: SetOp, a: u32, b: u32) -> u32 {
    match op {
        SetOp::Union => a | b,
        SetOp::Intersection => a & b,
        SetOp::Difference => a & !b,
        SetOp::SymmetricDifference => a ^ b,
    }
}

fn check_pair(placement: Placement, a: Voxels, b: Voxels) {
    let (solid_a, solid_b) = (placement.solid(&a), placement.solid(&b));
    for op in SetOp::ALL {
        let expected = Voxels {
            side: a.side,
            bits: bits(op, a.bits, b.bits),
        };
        let context = format!("{op:?} of {a:?} and {b:?}");
        let result = applied(op, &solid_a, &solid_b);
        placement.check(&result, &expected, &context);
    }
}

#[test]
fn small_voxel_sets_combine_like_bit_masks() {
    let mut numbers = Numbers::new(1);
    for a in 0..256 {
        let b = Voxels::any(&mut numbers, 2);
        let a = Voxels { side: 2, bits: a };
        let placement = numbers.pick(&[STRAIGHT, STRAIGHT, TURNED]);
        check_pair(placement, a, b);
    }
}

#[test]
fn larger_voxel_sets_combine_like_bit_masks() {
    let mut numbers = Numbers::new(2);
    for round in 0..24 {
        let [a, b] = [0; 2].map(|_| Voxels::any(&mut numbers, 3));
        let placement = if round % 4 == 0 { TURNED } else { STRAIGHT };
        check_pair(placement, a, b);
    }
}

/// A random line of an expression over earlier lines, and its value on bit masks.
fn any_line(numbers: &mut Numbers, values: &[u32]) -> (Term, u32) {
    let count = values.len();
    let mut some = |n: usize| -> Vec<u32> {
        let line = |_| u32::try_from(numbers.index(count)).expect("few lines");
        (0..n).map(line).collect()
    };
    let list = some(3);
    let masks: Vec<u32> = list.iter().map(|i| values[*i as usize]).collect();
    let [a, b, c] = [masks[0], masks[1], masks[2]];
    match numbers.below(4) {
        0 => (Term::Not(list[0]), !a),
        1 => (Term::And(list), a & b & c),
        2 => (Term::Or(list), a | b | c),
        _ => (Term::Xor(list), a ^ b ^ c),
    }
}

/// Whole expressions at once, with many operands, shared lines and inner complements.
#[test]
fn expressions_have_the_value_of_their_bit_masks() {
    let mut numbers = Numbers::new(3);
    for round in 0..60 {
        let side = if round % 4 == 0 { 3 } else { 2 };
        let operands: Vec<Voxels> = (0..3 + round % 4)
            .map(|_| Voxels::any(&mut numbers, side))
            .collect();
        let mut values: Vec<u32> = operands.iter().map(|v| v.bits).collect();
        let mut lines = Vec::new();
        for _ in 0..6 {
            let (line, value) = any_line(&mut numbers, &values);
            lines.push(line);
            values.push(value);
        }
        // Inside the first operand everything is bounded.
        let last = u32::try_from(values.len() - 1).expect("few lines");
        lines.push(Term::And(vec![0, last]));
        let expected = Voxels {
            side,
            bits: operands[0].bits & values[values.len() - 1],
        };
        let placement = if round % 3 == 0 { TURNED } else { STRAIGHT };
        let solids: Vec<Solid> = operands.iter().map(|v| placement.solid(v)).collect();
        let context = format!("{lines:?} of {operands:?}");
        placement.check(&combined(&solids, lines), &expected, &context);
    }
}

#[test]
fn complements_are_unbounded_and_turn_back() {
    let mut numbers = Numbers::new(4);
    for _ in 0..20 {
        let voxels = Voxels::any(&mut numbers, 2);
        let solid = STRAIGHT.solid(&voxels);
        let outside = complement(&solid);
        let unbounded = measure::volume(&outside).expect_err("a complement is unbounded");
        assert_eq!(unbounded.kind(), ErrorKind::Unbounded);
        for (at, found) in Voxels::places(2).zip(inside(&outside, &STRAIGHT.centers(2))) {
            assert_eq!(found, !voxels.has(at), "{voxels:?} at {at:?}");
        }
        assert!(is_full(&applied(SetOp::Union, &solid, &outside)));
        assert!(is_empty(&applied(SetOp::Intersection, &solid, &outside)));
        STRAIGHT.check(&complement(&outside), &voxels, "twice turned");
    }
}

/// A box of whole cubes with a weight of +1 or, if inverted, −1.
struct Layer {
    low: Lattice,
    high: Lattice,
    weight: i32,
}

impl Layer {
    fn any(numbers: &mut Numbers, side: i64) -> Self {
        let low = numbers.point(side);
        let high = low.map(|c| c + 1 + numbers.below(side - c));
        let weight = numbers.pick(&[1, 1, 1, -1]);
        Self { low, high, weight }
    }

    fn shape(&self) -> Shape {
        let shape = Shape::cuboid(self.low.map(|c| 2 * c), self.high.map(|c| 2 * c));
        if self.weight < 0 {
            shape.inverted()
        } else {
            shape
        }
    }

    fn holds(&self, at: Lattice) -> bool {
        (0..3).all(|i| (self.low[i]..self.high[i]).contains(&at[i]))
    }
}

/// The cubes that a rule calls inside, from counted winding numbers.
fn counted(layers: &[Layer], side: i64, rule: Rule) -> Voxels {
    let number = |at: Lattice| -> i32 {
        let around = layers.iter().filter(|layer| layer.holds(at));
        around.map(|layer| layer.weight).sum()
    };
    let mut bits = 0;
    for (i, at) in Voxels::places(side).enumerate() {
        bits |= u32::from(wanted(rule, number(at))) << i;
    }
    Voxels { side, bits }
}

#[test]
fn overlapping_layers_are_united_by_counted_winding_numbers() {
    let mut numbers = Numbers::new(5);
    for round in 0..60 {
        let layers: Vec<Layer> = (0..=round % 6)
            .map(|_| Layer::any(&mut numbers, 3))
            .collect();
        let placement = if round % 3 == 0 { TURNED } else { STRAIGHT };
        let shape = layers.iter().map(Layer::shape).reduce(Shape::with);
        let solid = shape.expect("layers").mapped(placement.map).unchecked();
        for rule in [Rule::Positive, Rule::Nonzero, Rule::EvenOdd] {
            let expected = counted(&layers, 3, rule);
            let context = format!("{rule:?} in round {round}");
            let united = normalized(&solid, rule);
            assert!(united.is_reduced());
            placement.check(&united, &expected, &context);
            placement.check(&normalized(&united, rule), &expected, &context);
        }
    }
}

/// Operands that overlap themselves and were not united: the set of the result is still right (G1).
#[test]
fn unchecked_operands_give_the_right_set() {
    let mut numbers = Numbers::new(6);
    for round in 0..40 {
        let mut operand = || {
            let count = 1 + numbers.below(4);
            let layers: Vec<Layer> = (0..count).map(|_| Layer::any(&mut numbers, 3)).collect();
            let shape = layers.iter().map(Layer::shape).reduce(Shape::with);
            let solid = shape.expect("layers").unchecked();
            (counted(&layers, 3, Rule::Positive), solid)
        };
        let ((a, solid_a), (b, solid_b)) = (operand(), operand());
        for op in SetOp::ALL {
            let result = applied(op, &solid_a, &solid_b);
            let expected = Voxels {
                side: 3,
                bits: bits(op, a.bits, b.bits),
            };
            let context = format!("{op:?} in round {round}");
            let found = inside(&result, &STRAIGHT.centers(3));
            for (at, found) in Voxels::places(3).zip(found) {
                assert_eq!(found, expected.has(at), "{context}: the cube at {at:?}");
            }
            let united = normalized(&result, Rule::Positive);
            STRAIGHT.check(&united, &expected, &context);
        }
    }
}
