//! Sets built from outlines that cross: invariants of their trees, and results of queries.

use bspcsg::arith::bounds::MAX_COORDINATE;
use bspcsg::geometry::side::{Half, Side};
use bspcsg::geometry::spaces::axis::AxisSpace;
use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
use bspcsg::geometry::spaces::dim2::{Dim2, Line2, Point2, Segment2, Square};
use bspcsg::geometry::spaces::dim3::Dim3;
use bspcsg::geometry::spaces::space::Space;
use bspcsg::merge::{merge, SetOp};
use bspcsg::query::region::condense::condensed_line;
use bspcsg::query::region::outlines::outlines;
use bspcsg::tree::partition::{
    check, enclosed, from_preorder, is_bounded, preorder, stats, Entry, Facet, Label,
    PartitionTree, PivotPolicy, Plan,
};
use bspcsg::tree::plane::{tree_of, Boundary};

use super::support::Numbers;

fn facets(corners: &[[i64; 2]]) -> Vec<Facet<Dim2>> {
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next).zip(0..);
    pairs
        .filter_map(|((a, b), source)| {
            let fragment = Segment2::between(*a, *b)?;
            Some(Facet { fragment, source })
        })
        .collect()
}

fn positive(number: i32) -> bool {
    number > 0
}

fn random_region(seed: u64, size: i64) -> PartitionTree<Dim2> {
    let mut numbers = Numbers::new(seed);
    let corners: Vec<[i64; 2]> = (0..40)
        .map(|_| [numbers.below(size), numbers.below(size)])
        .collect();
    enclosed(facets(&corners), 0, positive, &Plan::BALANCED).unwrap()
}

fn same<S: Space>(a: &PartitionTree<S>, b: &PartitionTree<S>) -> bool {
    merge(a, b, SetOp::SymmetricDifference).unwrap().label() == Some(Label::Out)
}

#[test]
fn trees_with_axis_cuts_keep_the_invariants() {
    for (seed, size) in (0..20).zip([8, 1000, MAX_COORDINATE].into_iter().cycle()) {
        let tree = random_region(seed, size);
        check(&tree, &Square).unwrap();
        assert!(is_bounded(&tree));
        assert!(!is_bounded(&tree.complement()));
        let again = tree_of(&Boundary::of(&tree).unwrap()).unwrap();
        check(&again, &Square).unwrap();
        assert!(same(&tree, &again), "seed {seed}");
        let outside = tree_of(&Boundary::of(&tree.complement()).unwrap()).unwrap();
        assert!(same(&tree.complement(), &outside), "seed {seed}");
    }
}

#[test]
fn policies_agree() {
    let mut numbers = Numbers::new(3);
    let corners: Vec<[i64; 2]> = (0..30)
        .map(|_| [numbers.below(20), numbers.below(20)])
        .collect();
    let expected = enclosed(facets(&corners), 0, positive, &Plan::BALANCED).unwrap();
    let cuts = [Line2::axis_cut(0, 10), Line2::axis_cut(1, 7)];
    for policy in [PivotPolicy::First, PivotPolicy::FewestSplits(5)] {
        let plan = Plan {
            cuts: &cuts,
            axis_cuts: false,
            policy,
        };
        let tree = enclosed(facets(&corners), 0, positive, &plan).unwrap();
        check(&tree, &Square).unwrap();
        assert!(same(&tree, &expected));
        let Some(Entry::Cut(root)) = preorder(&tree).into_iter().next() else {
            panic!("the tree is a leaf");
        };
        assert_eq!(root, cuts[0]);
    }
}

#[test]
fn a_list_of_nodes_is_the_tree_again() {
    for seed in 0..10 {
        let tree = random_region(seed, 50);
        let mut entries = preorder(&tree);
        let again: PartitionTree<Dim2> = from_preorder(&entries, Square).unwrap();
        check(&again, &Square).unwrap();
        assert!(same(&tree, &again));
        assert_eq!(preorder(&again), entries);
        entries.pop();
        assert!(from_preorder::<Dim2>(&entries, Square).is_err());
    }
    assert!(from_preorder::<Dim2>(&[], Square).is_err());
}

#[test]
fn a_convex_outline_makes_no_chain() {
    let corners: Vec<[i64; 2]> = (-3000..=3000).map(|x| [x, x * x]).collect();
    let tree = enclosed(facets(&corners), 0, positive, &Plan::BALANCED).unwrap();
    assert!(stats(&tree).depth < 40, "{:?}", stats(&tree));
    let [outline] = outlines(&Boundary::of(&tree).unwrap())
        .unwrap()
        .try_into()
        .unwrap();
    assert_eq!(outline.corners.len(), corners.len());
    assert!(!outline.is_hole);
}

#[test]
fn a_chain_of_nodes_needs_no_stack() {
    let depth = 20_000;
    let cut = |at: i64| Entry::Cut(Point1::new(at, Direction::Below));
    let mut entries: Vec<Entry<Point1>> = (0..depth).rev().map(cut).collect();
    entries.push(Entry::Leaf(Label::In));
    entries.extend((0..depth).map(|k| Entry::Leaf(Label::from_inside(k % 2 == 1))));
    let work = move || {
        let tree: PartitionTree<Dim1> = from_preorder(&entries, ()).unwrap();
        assert_eq!(stats(&tree).depth, 20_000);
        let again = condensed_line(&tree).unwrap();
        assert!(stats(&again).depth < 60);
        assert!(same(&tree, &again));
    };
    let small = std::thread::Builder::new().stack_size(256 << 10);
    small.spawn(work).unwrap().join().unwrap();
}

#[test]
fn wide_coordinates_stay_exact() {
    // Two lines that meet far from the lattice points that define them, with the widest coordinates.
    let (a, b) = (
        [-MAX_COORDINATE, -MAX_COORDINATE],
        [MAX_COORDINATE, MAX_COORDINATE - 1],
    );
    let (c, d) = (
        [-MAX_COORDINATE, -MAX_COORDINATE + 1],
        [MAX_COORDINATE, MAX_COORDINATE],
    );
    let lines = [Line2::through(a, b).unwrap(), Line2::through(c, d).unwrap()];
    assert!(Point2::meet(&lines[0], &lines[1]).is_none());
    let across = Line2::through(
        [-MAX_COORDINATE, MAX_COORDINATE],
        [MAX_COORDINATE - 1, -MAX_COORDINATE],
    )
    .unwrap();
    let meet = Point2::meet(&lines[0], &across).unwrap();
    assert_eq!(Dim2::side(&lines[0], &meet), Side::On);
    assert_eq!(Dim2::side(&across, &meet), Side::On);
    assert_eq!(Dim2::side(&lines[1], &meet), Side::Plus);
    assert!(Line2::through([MAX_COORDINATE + 1, 0], [0, 0]).is_none());
}

#[test]
fn the_border_of_the_frame() {
    assert_eq!(Dim1::border().len(), 2);
    assert_eq!(Dim2::border().len(), 4);
    assert_eq!(Dim3::border().len(), 6);
    for wall in Dim2::border() {
        assert_eq!(
            Dim2::side(wall.line(), &Point2::lattice([0, 0])),
            Side::Minus
        );
    }
    for axis in 0..2 {
        assert_eq!(Dim2::side_of_corner(&Line2::axis_cut(axis, 5)), Half::Minus);
    }
}
