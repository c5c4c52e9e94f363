//! Sets of the plane made by sweeps equal the sets that trees make, with the same boundaries and parts.

use std::collections::BTreeMap;

use bspcsg::arith::bounds::MAX_COORDINATE;
use bspcsg::error::ErrorKind;
use bspcsg::geometry::spaces::dim2::{Dim2, Point2, Segment2, Square};
use bspcsg::geometry::spaces::motion::Motion;
use bspcsg::merge::plane::{bounded, combined, composed, located, Outlines};
use bspcsg::merge::{merge, SetOp};
use bspcsg::query::region::outlines::outlines;
use bspcsg::tree::partition::{check, classify, enclosed, Facet, PartitionTree, Plan};
use bspcsg::tree::plane::{Boundary, PlaneSet};

use super::support::Numbers;

type Corners = Vec<[i64; 2]>;

fn random_corners(numbers: &mut Numbers, count: i64, size: i64) -> Corners {
    let shift = size / 2;
    let mut corner = || [numbers.below(size) - shift, numbers.below(size) - shift];
    (0..count).map(|_| corner()).collect()
}

fn sides(corners: &Corners) -> impl Iterator<Item = ([i64; 2], [i64; 2])> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().copied().zip(next.copied())
}

fn swept(corners: &Corners, rule: fn(i32) -> bool) -> Boundary {
    let mut strands = Outlines::default();
    for (from, to) in sides(corners) {
        strands.push(from, to, 1).unwrap();
    }
    bounded(&strands, rule).unwrap()
}

fn built(corners: &Corners, rule: fn(i32) -> bool) -> PartitionTree<Dim2> {
    let segments = sides(corners).filter_map(|(from, to)| Segment2::between(from, to));
    let facet = |(source, fragment)| Facet { fragment, source };
    let facets = (0..).zip(segments).map(facet).collect();
    enclosed(facets, 0, rule, &Plan::BALANCED).unwrap()
}

const RULES: [fn(i32) -> bool; 3] = [|n| n > 0, |n| n != 0, |n| n % 2 != 0];

/// Sizes of grids: small ones, on which all segments meet, and one as wide as the lattice.
const SIZES: [i64; 5] = [3, 6, 12, 1000, 2 * MAX_COORDINATE];

/// Asserts that two boundaries are equal, and that their parts are the same up to numbering.
fn assert_same(a: &Boundary, b: &Boundary, what: &str) {
    assert!(a.equals(b), "{what}: {a:?} {b:?}");
    let mut names = BTreeMap::new();
    for (e, f) in a.edges.iter().zip(&b.edges) {
        for (key, name) in [((0, e.inside), f.inside), ((1, e.outside), f.outside)] {
            assert_eq!(*names.entry(key).or_insert(name), name, "{what}");
        }
    }
    let distinct: std::collections::BTreeSet<_> = names
        .iter()
        .map(|((side, _), name)| (*side, *name))
        .collect();
    assert_eq!(distinct.len(), names.len(), "{what}: parts run together");
}

#[test]
fn outlines_bound_what_they_enclose() {
    for (seed, size) in (0..300).zip(SIZES.into_iter().cycle()) {
        let mut numbers = Numbers::new(seed);
        let corners = random_corners(&mut numbers, 4 + numbers_of_corners(seed), size);
        for rule in RULES {
            let expected = Boundary::of(&built(&corners, rule)).unwrap();
            assert_same(&swept(&corners, rule), &expected, &format!("seed {seed}"));
        }
    }
}

fn numbers_of_corners(seed: u64) -> i64 {
    i64::try_from(seed % 37).unwrap()
}

#[test]
fn operations_make_what_merging_makes() {
    for (seed, size) in (0..60).zip(SIZES.into_iter().cycle()) {
        let mut numbers = Numbers::new(seed + 1000);
        let mut operand = || {
            let corners = random_corners(&mut numbers, 14, size);
            (
                PlaneSet::from(swept(&corners, RULES[0])),
                built(&corners, RULES[0]),
            )
        };
        // A chain, so that operands have constructed corners, and a complement.
        let (mut set, mut tree) = operand();
        (set, tree) = (set.complement(), tree.complement());
        for op in SetOp::ALL {
            let (next, other) = operand();
            set = combined(&set, &next, op).unwrap();
            tree = merge(&tree, &other, op).unwrap();
            let expected = Boundary::of(&tree).unwrap();
            assert_same(
                set.boundary().unwrap(),
                &expected,
                &format!("seed {seed} {op:?}"),
            );
        }
        check(set.tree().unwrap(), &Square).unwrap();
        assert!(Boundary::of(set.tree().unwrap())
            .unwrap()
            .equals(set.boundary().unwrap()));
    }
}

#[test]
fn a_composition_is_the_union_of_all() {
    let mut numbers = Numbers::new(5);
    let all: Vec<Corners> = (0..12)
        .map(|_| random_corners(&mut numbers, 5, 30))
        .collect();
    let sets: Vec<PlaneSet> = all.iter().map(|c| swept(c, RULES[1]).into()).collect();
    let union = composed(&sets.iter().collect::<Vec<_>>()).unwrap();
    let mut tree = PartitionTree::EMPTY;
    for corners in &all {
        tree = merge(&tree, &built(corners, RULES[1]), SetOp::Union).unwrap();
    }
    assert_same(
        union.boundary().unwrap(),
        &Boundary::of(&tree).unwrap(),
        "union",
    );
}

#[test]
fn points_lie_where_the_tree_says() {
    for (seed, size) in (0..40).zip(SIZES.into_iter().cycle()) {
        let mut numbers = Numbers::new(seed + 77);
        let corners = random_corners(&mut numbers, 20, size);
        let set = PlaneSet::from(swept(&corners, RULES[2]));
        let tree = built(&corners, RULES[2]);
        let mut points = random_corners(&mut numbers, 200, size);
        points.extend(&corners);
        let expected: Vec<_> = points
            .iter()
            .map(|p| classify(&tree, &Point2::lattice(*p)))
            .collect();
        assert_eq!(located(&set, &points).unwrap(), expected, "seed {seed}");
        assert!(set.known_tree().is_none());
        let outside = located(&set.complement(), &points).unwrap();
        let within: Vec<_> = points
            .iter()
            .map(|p| classify(&tree.complement(), &Point2::lattice(*p)))
            .collect();
        assert_eq!(outside, within, "seed {seed}");
    }
}

#[test]
fn many_questions_about_one_point_make_a_tree() {
    let set = PlaneSet::from(swept(
        &random_corners(&mut Numbers::new(9), 20, 50),
        RULES[2],
    ));
    let tree = set.clone();
    let expected = classify(tree.tree().unwrap(), &Point2::lattice([1, 2]));
    for _ in 0..40 {
        assert_eq!(located(&set, &[[1, 2]]).unwrap(), [expected]);
    }
    assert!(set.known_tree().is_some());
}

#[test]
fn moved_boundaries_are_those_of_moved_outlines() {
    let motions = [
        Motion::of_axes(&[1, 2], &[5, -7]),
        Motion::of_axes(&[-2, 1], &[1, 0]),
        Motion::of_axes(&[2, 1], &[0, 3]).map(|motion| Motion {
            scale: 10,
            ..motion
        }),
        Motion::of_axes(&[1, -2], &[0, 0]),
    ];
    for (seed, motion) in (0..).zip(motions.into_iter().map(Option::unwrap)) {
        let corners = random_corners(&mut Numbers::new(seed), 25, 20);
        let place = |p: &[i64; 2]| motion.point(&[p[0], p[1], 0]).map(|[x, y, _]| [x, y]);
        let mut image: Corners = corners.iter().filter_map(place).collect();
        if motion.mirrors() {
            image.reverse();
        }
        let moved = swept(&corners, RULES[0]).moved(&motion).unwrap();
        assert_same(&moved, &swept(&image, RULES[0]), &format!("{motion:?}"));
    }
    let far = Motion::of_axes(&[1, 2], &[MAX_COORDINATE, 0]).unwrap();
    assert!(swept(&vec![[0, 0], [1, 0], [0, 1]], RULES[0])
        .moved(&far)
        .is_none());
}

#[test]
fn islands_lie_in_holes() {
    // Squares nested in each other, under the even-odd rule, and one beside them all.
    let square = |low: i64, high: i64| vec![[low, low], [high, low], [high, high], [low, high]];
    let mut strands = Outlines::default();
    for corners in [
        square(0, 100),
        square(10, 90),
        square(20, 80),
        square(200, 210),
    ] {
        for (from, to) in sides(&corners) {
            strands.push(from, to, 1).unwrap();
        }
    }
    let found = outlines(&bounded(&strands, RULES[2]).unwrap()).unwrap();
    let nesting: Vec<_> = found.iter().map(|o| (o.is_hole, o.parent)).collect();
    let expected = [
        (false, None),
        (true, Some(0)),
        (false, Some(1)),
        (false, None),
    ];
    assert_eq!(nesting, expected);
}

#[test]
fn what_is_open_is_refused() {
    let mut strands = Outlines::default();
    strands.push([0, 0], [4, 0], 1).unwrap();
    strands.push([4, 0], [4, 4], 1).unwrap();
    let error = bounded(&strands, RULES[0]).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::NotClosed);
}

#[test]
fn a_small_operand_of_many_meets_a_tree() {
    // A round region loses one small square after another, in the end by merging.
    let corners: Corners = (-300..=300).map(|x| [x, x * x]).collect();
    let mut set = PlaneSet::from(swept(&corners, RULES[0]));
    let mut tree = built(&corners, RULES[0]);
    for k in 0..60 {
        let low = [k, 1000 + 1000 * k];
        let square: Corners = [[0, 0], [3, 0], [3, 3], [0, 3]]
            .map(|[x, y]: [i64; 2]| [x + low[0], y + low[1]])
            .to_vec();
        let hole = PlaneSet::from(swept(&square, RULES[0]));
        set = combined(&set, &hole, SetOp::Difference).unwrap();
        tree = merge(&tree, hole.tree().unwrap(), SetOp::Difference).unwrap();
    }
    assert!(
        set.known_tree().is_some(),
        "sixty sweeps cost more than a tree"
    );
    assert_same(
        set.boundary().unwrap(),
        &Boundary::of(&tree).unwrap(),
        "holes",
    );
}
