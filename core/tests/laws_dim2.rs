//! Laws in the plane: squares of a 3×3 lattice against bit masks, and random polygons.

use bspcsg::geometry::side::{Half, Side};
use bspcsg::geometry::spaces::dim2::{Dim2, Point2, Segment2, Square};
use bspcsg::geometry::spaces::space::Space;
use bspcsg::geometry::unbounded::big;
use bspcsg::merge::{merge, SetOp};
use bspcsg::tree::partition::{
    autopartition, boundary, check, classify, owned_boundary, winding_tree, Facet, Label, Location,
    PartitionTree, PivotPolicy,
};
use num_bigint::BigInt;

use super::support::Numbers;

type Tree = PartitionTree<Dim2>;
type Lattice = [i64; 2];

/// A rational number, numerator over positive denominator, not reduced.
#[derive(Clone, Debug)]
struct Ratio(BigInt, BigInt);

impl Ratio {
    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 * &other.1 + &other.0 * &self.1, &self.1 * &other.1)
    }

    fn equals(&self, other: &Self) -> bool {
        &self.0 * &other.1 == &other.0 * &self.1
    }
}

/// Twice the area inside an oriented boundary, by the sum of cross products.
fn doubled_area<'a>(walls: impl IntoIterator<Item = &'a Segment2>) -> Ratio {
    let zero = Ratio(BigInt::from(0), BigInt::from(1));
    walls.into_iter().fold(zero, |sum, wall| {
        let [[x1, y1, w1], [x2, y2, w2]] = wall.points().map(|p| {
            let ([x, y], w) = p.coordinates();
            [big(x), big(y), big(w)]
        });
        sum.plus(&Ratio(x1 * y2 - x2 * y1, w1 * w2))
    })
}

fn area(tree: &Tree) -> Ratio {
    doubled_area(&boundary(tree).unwrap())
}

fn owned_area(tree: &Tree) -> Ratio {
    doubled_area(owned_boundary(tree).unwrap().iter().map(|f| &f.fragment))
}

fn segment(from: Lattice, to: Lattice, source: u64) -> Facet<Dim2> {
    let fragment = Segment2::between(from, to).expect("two different lattice points");
    Facet { fragment, source }
}

fn polygon_facets(corners: &[Lattice]) -> Vec<Facet<Dim2>> {
    let next = corners.iter().cycle().skip(1);
    corners
        .iter()
        .zip(next)
        .zip(0..)
        .map(|((a, b), i)| segment(*a, *b, i))
        .collect()
}

fn build(facets: Vec<Facet<Dim2>>, policy: PivotPolicy) -> Tree {
    let built = autopartition(facets, Square, Label::Out, policy).unwrap();
    assert!(built.simple);
    check(&built.tree, &Square).unwrap();
    built.tree
}

fn assert_same_set(a: &Tree, b: &Tree) {
    let difference = merge(a, b, SetOp::SymmetricDifference).unwrap();
    assert_eq!(difference.label(), Some(Label::Out));
}

// Sets of squares: bit 3·row + column of a mask is a square of side 2.

fn voxel(mask: u16, column: i64, row: i64) -> bool {
    (0..3).contains(&column) && (0..3).contains(&row) && mask >> (3 * row + column) & 1 == 1
}

/// The edges between a square inside and one outside, with the inside on the left.
fn voxel_facets(mask: u16) -> Vec<Facet<Dim2>> {
    let mut facets = Vec::new();
    for (column, row) in (0..9).map(|i| (i % 3, i / 3)) {
        if !voxel(mask, column, row) {
            continue;
        }
        let (x, y) = (2 * column, 2 * row);
        let corners = [[x, y], [x + 2, y], [x + 2, y + 2], [x, y + 2]];
        let beyond = [(0, -1), (1, 0), (0, 1), (-1, 0)];
        for (i, (dx, dy)) in beyond.into_iter().enumerate() {
            if !voxel(mask, column + dx, row + dy) {
                facets.push(segment(
                    corners[i],
                    corners[(i + 1) % 4],
                    facets.len() as u64,
                ));
            }
        }
    }
    facets
}

fn assert_voxels(tree: &Tree, mask: u16, context: &str) {
    for (column, row) in (0..9).map(|i| (i % 3, i / 3)) {
        let centre = Point2::lattice([2 * column + 1, 2 * row + 1]);
        let inside = classify(tree, &centre) == Location::In;
        assert_eq!(
            inside,
            voxel(mask, column, row),
            "{context} at {column}, {row}"
        );
    }
    let squares = Ratio(BigInt::from(8 * mask.count_ones()), BigInt::from(1));
    assert!(area(tree).equals(&squares), "area of {context}");
    assert!(owned_area(tree).equals(&squares), "owned area of {context}");
}

#[test]
fn every_voxel_set_is_built_and_complemented() {
    for mask in 0..512 {
        let tree = build(voxel_facets(mask), PivotPolicy::Random(u64::from(mask)));
        assert_voxels(&tree, mask, &format!("{mask:09b}"));
        assert!(tree.complement().complement().is_same(&tree));
    }
}

#[test]
fn voxel_sets_combine_like_bit_masks() {
    let policy = |mask: u16| {
        let seed = u64::from(mask);
        [
            PivotPolicy::First,
            PivotPolicy::Random(seed),
            PivotPolicy::FewestSplits(6),
        ][usize::from(mask) % 3]
    };
    let trees: Vec<Tree> = (0..512)
        .map(|mask| build(voxel_facets(mask), policy(mask)))
        .collect();
    let mut numbers = Numbers::new(1);
    for a in 0..512_u16 {
        for _ in 0..12 {
            let b = u16::try_from(numbers.below(512)).unwrap();
            for (op, mask) in SetOp::ALL.into_iter().zip([a | b, a & b, a & !b, a ^ b]) {
                let result = merge(&trees[usize::from(a)], &trees[usize::from(b)], op).unwrap();
                assert_voxels(&result, mask, &format!("{op:?} of {a:09b} and {b:09b}"));
                check(&result, &Square).unwrap();
            }
        }
    }
}

#[test]
fn overlapping_voxel_boundaries_are_united_by_winding_numbers() {
    let mut numbers = Numbers::new(2);
    let corner = Point2::lattice([-5, -7]);
    let reference = |cut: &_| match Dim2::side(cut, &corner) {
        Side::Minus => Half::Minus,
        _ => Half::Plus,
    };
    for _ in 0..400 {
        let [a, b] = [0; 2].map(|_| u16::try_from(numbers.below(512)).unwrap());
        let facets = [voxel_facets(a), voxel_facets(b)].concat();
        let tree = autopartition(facets, Square, Label::Out, PivotPolicy::Random(9))
            .unwrap()
            .tree;
        let union = winding_tree(&tree, reference, 0, |w| w > 0).unwrap();
        assert_voxels(&union.tree, a | b, "positive");
        let both = winding_tree(&tree, reference, 0, |w| w > 1).unwrap();
        assert_voxels(&both.tree, a & b, "twice");
        let odd = winding_tree(&tree, reference, 0, |w| w % 2 != 0).unwrap();
        assert_voxels(&odd.tree, a ^ b, "even-odd");
    }
}

#[test]
fn an_open_outline_has_no_winding_numbers() {
    let mut facets = voxel_facets(0b000_010_000);
    facets.pop();
    let tree = autopartition(facets, Square, Label::Out, PivotPolicy::First)
        .unwrap()
        .tree;
    assert!(winding_tree(&tree, |_| Half::Plus, 0, |w| w > 0).is_err());
}

// Random star-shaped polygons, with corners anywhere on the lattice:

/// Corners in every eighth of the circle around `centre`, so that no gap reaches a half turn.
fn star(numbers: &mut Numbers, centre: Lattice, reach: i64) -> Vec<Lattice> {
    let mut directions: Vec<Lattice> = (0..12)
        .map(|i| {
            let [u, v] = [reach / 3 + numbers.below(reach / 2), numbers.below(reach)];
            [[u, v], [-v, u], [-u, -v], [v, -u]][i % 4]
        })
        .collect();
    let half = |d: &Lattice| d[1] < 0 || (d[1] == 0 && d[0] < 0);
    let cross = |a: &Lattice, b: &Lattice| {
        i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
    };
    directions.sort_by(|a, b| half(a).cmp(&half(b)).then(0.cmp(&cross(a, b))));
    directions.dedup_by(|a, b| cross(a, b) == 0 && half(a) == half(b));
    directions
        .iter()
        .map(|d| [centre[0] + d[0], centre[1] + d[1]])
        .collect()
}

fn assert_pointwise(a: &Tree, b: &Tree, op: SetOp, result: &Tree, points: &[Lattice]) {
    for point in points.iter().map(|p| Point2::lattice(*p)) {
        let [in_a, in_b, found] = [a, b, result].map(|tree| classify(tree, &point));
        let label = |location| match location {
            Location::In => Some(Label::In),
            Location::Out => Some(Label::Out),
            Location::On => None,
        };
        if let (Some(in_a), Some(in_b)) = (label(in_a), label(in_b)) {
            assert_eq!(
                label(found),
                Some(op.labels(in_a, in_b)),
                "{op:?} at {point:?}"
            );
        }
    }
}

fn assert_area_identities(a: &Tree, b: &Tree, results: &[Tree; 4]) {
    let [a, b] = [a, b].map(area);
    let [union, intersection, difference, symmetric] = results.each_ref().map(area);
    assert!(union.plus(&intersection).equals(&a.plus(&b)));
    assert!(difference.plus(&intersection).equals(&a));
    assert!(symmetric.plus(&intersection).equals(&union));
    for (tree, area) in results
        .iter()
        .zip([union, intersection, difference, symmetric])
    {
        assert!(owned_area(tree).equals(&area));
    }
}

fn assert_laws(a: &Tree, b: &Tree, points: &[Lattice]) {
    let results = SetOp::ALL.map(|op| merge(a, b, op).unwrap());
    for (op, result) in SetOp::ALL.into_iter().zip(&results) {
        check(result, &Square).unwrap();
        assert_pointwise(a, b, op, result, points);
    }
    assert_area_identities(a, b, &results);
    let [union, intersection, difference, _] = &results;
    let de_morgan = merge(&a.complement(), &b.complement(), SetOp::Intersection).unwrap();
    assert_same_set(&de_morgan.complement(), union);
    assert_same_set(&merge(difference, intersection, SetOp::Union).unwrap(), a);
    assert_same_set(&merge(union, a, SetOp::Intersection).unwrap(), a);
}

fn pair_of_stars(numbers: &mut Numbers, reach: i64) -> [Vec<Lattice>; 2] {
    [0; 2].map(|_| {
        let centre = [numbers.below(reach), numbers.below(reach)];
        star(numbers, centre, reach)
    })
}

#[test]
fn random_polygons_obey_the_laws() {
    let mut numbers = Numbers::new(3);
    // Small reaches make coincidences likely, the largest one uses the whole lattice.
    for reach in [4, 9, 40, 1000, 1 << 28] {
        for round in 0..40 {
            let corners = pair_of_stars(&mut numbers, reach);
            let policy = PivotPolicy::Random(round);
            let [a, b] = corners.each_ref().map(|c| build(polygon_facets(c), policy));
            let mut points = corners.concat();
            points.extend((0..40).map(|_| {
                [
                    numbers.below(3 * reach) - reach,
                    numbers.below(3 * reach) - reach,
                ]
            }));
            assert_laws(&a, &b, &points);
        }
    }
}

/// A polygon and a sector of it share edges that are not parallel to an axis.
#[test]
fn sectors_of_a_polygon_can_be_cut_out_and_put_back() {
    let mut numbers = Numbers::new(4);
    for reach in [6, 1000, 1 << 28] {
        for round in 0..20 {
            let centre = [numbers.below(reach), numbers.below(reach)];
            let corners = star(&mut numbers, centre, reach);
            let whole = build(polygon_facets(&corners), PivotPolicy::Random(round));
            let mut rest = whole.clone();
            for i in 0..corners.len() {
                let triangle = [centre, corners[i], corners[(i + 1) % corners.len()]];
                let sector = build(polygon_facets(&triangle), PivotPolicy::First);
                let smaller = merge(&rest, &sector, SetOp::Difference).unwrap();
                check(&smaller, &Square).unwrap();
                assert_same_set(&merge(&smaller, &sector, SetOp::Union).unwrap(), &rest);
                rest = smaller;
            }
            assert_eq!(rest.label(), Some(Label::Out));
        }
    }
}
