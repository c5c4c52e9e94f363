//! Exhaustive laws on the line: the sets of seven cells between six points, against bit arithmetic.

use bspcsg::geometry::side::{Half, Side};
use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
use bspcsg::geometry::spaces::space::Space;
use bspcsg::merge::{merge, partition_tree, split_tree, SetOp};
use bspcsg::tree::partition::{
    autopartition, boundary, check, classify, owned_boundary, winding_tree, Facet, Label, Location,
    PartitionTree, PivotPolicy,
};

/// A set of cells as seven bits: bit i is the cell below point i, bit 6 the cell above all points.
type Bits = u8;
type Tree = PartitionTree<Dim1>;

const POINTS: i64 = 6;
const ALL: Bits = 0x7f;

/// The coordinate of a point; odd coordinates lie inside the cells between.
fn place(point: i64) -> i64 {
    2 * point
}

fn facets(bits: Bits, first_source: u64) -> Vec<Facet<Dim1>> {
    (0..POINTS)
        .filter(|i| (bits >> i ^ bits >> (i + 1)) & 1 == 1)
        .map(|i| {
            let below = bits >> i & 1 == 1;
            let inside = if below {
                Direction::Below
            } else {
                Direction::Above
            };
            let source = first_source + i.unsigned_abs();
            let fragment = Point1::new(place(i), inside);
            Facet { fragment, source }
        })
        .collect()
}

fn tree_of(bits: Bits, policy: PivotPolicy) -> Tree {
    let empty = Label::from_inside(bits & 1 == 1);
    let built = autopartition(facets(bits, 0), (), empty, policy).unwrap();
    assert!(built.simple);
    built.tree
}

fn bits_of(tree: &Tree) -> Bits {
    (0..=POINTS)
        .map(|cell| match classify(tree, &(place(cell) - 1)) {
            Location::In => 1 << cell,
            Location::Out => 0,
            Location::On => panic!("a cell's interior lies on the boundary"),
        })
        .sum()
}

fn expected(op: SetOp, a: Bits, b: Bits) -> Bits {
    match op {
        SetOp::Union => a | b,
        SetOp::Intersection => a & b,
        SetOp::Difference => a & !b,
        SetOp::SymmetricDifference => a ^ b,
    }
}

/// Asserts that the tree stands for `bits`: its cells, its boundary, points on it, and all invariants.
fn assert_region(tree: &Tree, bits: Bits, context: &str) {
    check(tree, &()).unwrap();
    assert_eq!(bits_of(tree), bits, "{context}");
    let mut walls = boundary(tree).unwrap();
    walls.sort_by_key(Point1::at);
    let wanted: Vec<Point1> = facets(bits, 0).iter().map(|f| f.fragment).collect();
    assert_eq!(walls, wanted, "boundary of {context}");
    for point in 0..POINTS {
        let on = wanted.iter().any(|wall| wall.at() == place(point));
        let found = classify(tree, &place(point)) == Location::On;
        assert_eq!(found, on, "point {point} of {context}");
    }
}

#[test]
fn building_gives_the_region_for_every_policy() {
    let policies = [
        PivotPolicy::First,
        PivotPolicy::Random(7),
        PivotPolicy::FewestSplits(4),
    ];
    for bits in 0..=ALL {
        for policy in policies {
            assert_region(
                &tree_of(bits, policy),
                bits,
                &format!("{bits:07b} {policy:?}"),
            );
        }
    }
}

#[test]
fn merging_any_two_regions_agrees_with_bit_operations() {
    let first: Vec<Tree> = (0..=ALL).map(|a| tree_of(a, PivotPolicy::First)).collect();
    let random = PivotPolicy::Random(3);
    let second: Vec<Tree> = (0..=ALL).map(|b| tree_of(b, random)).collect();
    for (a, tree_a) in (0..=ALL).zip(&first) {
        for (b, tree_b) in (0..=ALL).zip(&second) {
            for op in SetOp::ALL {
                let result = merge(tree_a, tree_b, op).unwrap();
                let context = format!("{op:?} of {a:07b} and {b:07b}");
                assert_region(&result, expected(op, a, b), &context);
            }
        }
    }
}

#[test]
fn owned_boundary_is_the_boundary_and_the_first_source_owns_shared_points() {
    for a in 0..=ALL {
        for b in 0..=ALL {
            let build = |bits, source| {
                let empty = Label::from_inside(bits & 1 == 1);
                let facets = facets(bits, source);
                autopartition(facets, (), empty, PivotPolicy::First)
                    .unwrap()
                    .tree
            };
            let result = merge(&build(a, 0), &build(b, 100), SetOp::Union).unwrap();
            let mut owned = owned_boundary(&result).unwrap();
            owned.sort_by_key(|f| f.fragment.at());
            for (facet, wall) in owned.iter().zip(facets(a | b, 0)) {
                assert_eq!(facet.fragment, wall.fragment);
                let in_first = facets(a, 0).iter().any(|f| f.source == wall.source);
                assert_eq!(facet.source < 100, in_first, "{a:07b} | {b:07b}");
            }
            assert_eq!(owned.len(), facets(a | b, 0).len());
        }
    }
}

#[test]
fn complement_costs_nothing_and_shares_everything() {
    for bits in 0..=ALL {
        let tree = tree_of(bits, PivotPolicy::First);
        let other = tree.complement();
        assert_region(&other, !bits & ALL, &format!("complement of {bits:07b}"));
        assert!(other.is_complement(&tree) && other.complement().is_same(&tree));
        for (op, result) in SetOp::ALL.into_iter().zip([ALL, 0, bits, ALL]) {
            assert_region(
                &merge(&tree, &other, op).unwrap(),
                result,
                "with its complement",
            );
        }
    }
}

#[test]
fn complements_as_operands_agree_with_bit_operations() {
    let trees: Vec<Tree> = (0..=ALL)
        .map(|a| tree_of(a, PivotPolicy::Random(5)))
        .collect();
    for (a, tree_a) in (0..=ALL).zip(&trees).step_by(3) {
        for (b, tree_b) in (0..=ALL).zip(&trees) {
            for op in SetOp::ALL {
                let result = merge(&tree_a.complement(), &tree_b.complement(), op).unwrap();
                assert_region(&result, expected(op, !a, !b) & ALL, "complements");
            }
        }
    }
}

/// The bits of the cells on one side of a point.
fn cells_beside(cut: &Point1, half: Half) -> Bits {
    let wanted = match half {
        Half::Minus => Side::Minus,
        Half::Plus => Side::Plus,
    };
    (0..=POINTS)
        .filter(|cell| Dim1::side(cut, &(place(*cell) - 1)) == wanted)
        .map(|cell| 1 << cell)
        .sum()
}

#[test]
fn splitting_every_region_at_every_point_keeps_both_sides() {
    for bits in 0..=ALL {
        for policy in [PivotPolicy::First, PivotPolicy::Random(11)] {
            let tree = tree_of(bits, policy);
            for point in -1..=POINTS {
                for inside in [Direction::Below, Direction::Above] {
                    let cut = Point1::new(place(point), inside);
                    let halves = split_tree(&tree, &cut).unwrap();
                    let minus = bits_of(&halves.minus) ^ bits;
                    let plus = bits_of(&halves.plus) ^ bits;
                    assert_eq!(minus & cells_beside(&cut, Half::Minus), 0);
                    assert_eq!(plus & cells_beside(&cut, Half::Plus), 0);
                    assert_region(&partition_tree(&tree, cut).unwrap(), bits, "partition_tree");
                }
            }
        }
    }
}

/// A tree whose root is the lowest of three points: its minus child is a leaf, its plus child a chain.
fn chain() -> Tree {
    tree_of(0b000_1010, PivotPolicy::First)
}

#[test]
fn coplanar_cases_return_the_subtrees_untouched() {
    let tree = chain();
    let PartitionTree::Cut(root) = &tree else {
        panic!("a region with boundary is cut");
    };
    let (minus, plus) = (root.child(Half::Minus), root.child(Half::Plus));
    let same = split_tree(&tree, root.hyperplane()).unwrap();
    assert!(same.minus.is_same(&minus) && same.plus.is_same(&plus));
    assert_eq!(same.coplanar.len(), 1);
    let opposite = split_tree(&tree, &Dim1::reversed(root.hyperplane())).unwrap();
    assert!(opposite.minus.is_same(&plus) && opposite.plus.is_same(&minus));
}

#[test]
fn one_sided_cases_share_what_is_not_cut() {
    let (root_at, beyond) = (Point1::new(2, Direction::Below), 9);
    for root_inside in [Direction::Below, Direction::Above] {
        for cut_inside in [Direction::Below, Direction::Above] {
            let fragment = Point1::new(root_at.at(), root_inside);
            let facets = vec![Facet {
                fragment,
                source: 0,
            }];
            let policy = PivotPolicy::First;
            let tree = autopartition::<Dim1>(facets, (), Label::Out, policy)
                .unwrap()
                .tree;
            let cut = Point1::new(beyond, cut_inside);
            let halves = split_tree(&tree, &cut).unwrap();
            let (with_node, without) = match cut_inside {
                Direction::Below => (halves.minus, halves.plus),
                Direction::Above => (halves.plus, halves.minus),
            };
            assert!(with_node.is_same(&tree), "the uncut part is shared");
            assert_eq!(
                without.label(),
                Some(Label::from_inside(root_inside == Direction::Above))
            );
        }
    }
}

#[test]
fn merging_with_a_leaf_or_itself_shares_the_operand() {
    let tree = chain();
    let shared = [
        merge(&tree, &Tree::EMPTY, SetOp::Union),
        merge(&Tree::FULL, &tree, SetOp::Intersection),
        merge(&tree, &tree, SetOp::Union),
        merge(&tree, &Tree::EMPTY, SetOp::Difference),
        merge(&tree, &Tree::FULL, SetOp::SymmetricDifference).map(|t| t.complement()),
    ];
    for result in shared {
        assert!(result.unwrap().is_same(&tree));
    }
}

#[test]
fn merging_far_apart_keeps_subtrees_by_reference() {
    let low = tree_of(0b000_0010, PivotPolicy::First);
    let high = tree_of(0b010_0000, PivotPolicy::First);
    let PartitionTree::Cut(root) = merge(&low, &high, SetOp::Union).unwrap() else {
        panic!("the union is not empty");
    };
    let PartitionTree::Cut(second) = root.child(Half::Minus) else {
        panic!("the low interval ends above its first point");
    };
    assert!(second.child(Half::Plus).is_same(&high));
}

/// The facets of two sets in one list, labelled by winding numbers, make the union of the sets.
#[test]
fn winding_numbers_unite_overlapping_boundaries() {
    for a in 0..=ALL {
        for b in 0..=ALL {
            let mut both = facets(a, 0);
            both.extend(facets(b, 10));
            let count = i32::from(a & 1) + i32::from(b & 1);
            let tree = autopartition::<Dim1>(both, (), Label::Out, PivotPolicy::Random(1))
                .unwrap()
                .tree;
            let below = |cut: &Point1| match cut.inside() {
                Direction::Below => Half::Minus,
                Direction::Above => Half::Plus,
            };
            let union = winding_tree(&tree, below, count, |w| w > 0).unwrap();
            assert_region(&union.tree, a | b, "positive");
            let xor = winding_tree(&tree, below, count, |w| w % 2 != 0).unwrap();
            assert_region(&xor.tree, a ^ b, "even-odd");
            let overlaps = facets(a, 0).iter().any(|f| {
                facets(b, 0)
                    .iter()
                    .any(|g| g.fragment.at() == f.fragment.at())
            });
            assert_eq!(union.simple, a & b == 0 && !overlaps, "{a:07b} and {b:07b}");
        }
    }
}
