//! Trees deeper than any stack allows: a chain of 10^5 cuts on a stack of 256 KiB.

use std::sync::Arc;
use std::thread;

use bspcsg::geometry::side::Half;
use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
use bspcsg::geometry::spaces::dim2::{Dim2, Line2, Point2, Square};
use bspcsg::geometry::spaces::space::Space;
use bspcsg::merge::{merge, split_tree, SetOp};
use bspcsg::tree::partition::{
    autopartition, boundary, check, classify, owned_boundary, stats, winding_tree, Facet, Label,
    Location, PartitionTree, PivotPolicy, SubHyperplane,
};

const DEPTH: i64 = 100_000;

fn on_a_small_stack(test: impl FnOnce() + Send + 'static) {
    let small = thread::Builder::new().stack_size(256 << 10);
    small.spawn(test).unwrap().join().unwrap();
}

/// A chain of cuts, the first one at the root; cells between them are alternately Out and In.
fn chain<S: Space<Frame: Default>>(
    cuts: impl DoubleEndedIterator<Item = S::Hyperplane>,
) -> PartitionTree<S> {
    let frame = S::Frame::default();
    cuts.rev().fold(PartitionTree::EMPTY, |above, cut| {
        let next = match &above {
            PartitionTree::Leaf(label) => *label,
            PartitionTree::Cut(cut) => cut.child(Half::Minus).label().unwrap(),
        };
        let fragment = S::span(&cut, &frame).unwrap();
        let fragment = match next {
            Label::In => S::reversed(&fragment),
            Label::Out => fragment,
        };
        let span = S::span(&cut, &frame).unwrap();
        let facets = vec![Facet {
            fragment,
            source: 0,
        }];
        let below = PartitionTree::Leaf(next.complement());
        PartitionTree::cut(Arc::new(SubHyperplane { span, facets }), below, above)
    })
}

fn points(shift: i64) -> PartitionTree<Dim1> {
    chain((0..DEPTH).map(|i| Point1::new(4 * i + shift, Direction::Below)))
}

/// Vertical lines; the left of an upward line is its minus side.
fn strips(shift: i64) -> PartitionTree<Dim2> {
    let line = |x| Line2::through([x, 0], [x, 1]).unwrap();
    chain((0..DEPTH).map(|i| line(4 * i + shift)))
}

#[test]
fn deep_chains_on_the_line_are_built_merged_measured_and_dropped() {
    on_a_small_stack(|| {
        let (a, b) = (points(0), points(1));
        let expected = usize::try_from(DEPTH).unwrap();
        assert_eq!(stats(&a).depth, expected);
        for op in SetOp::ALL {
            let result = merge(&a, &b, op).unwrap();
            assert!(boundary(&result).unwrap().len() >= expected);
            assert!(owned_boundary(&result).unwrap().len() >= expected);
            assert_ne!(classify(&result, &(4 * DEPTH)), Location::On);
        }
        let numbers = winding_tree(&a, |_| Half::Plus, 0, |w| w > 0).unwrap();
        assert!(numbers.simple);
        assert!(merge(&numbers.tree, &a, SetOp::SymmetricDifference)
            .unwrap()
            .label()
            .is_some());
    });
}

#[test]
fn deep_strips_are_split_across_and_merged() {
    on_a_small_stack(|| {
        let (a, b) = (strips(0), strips(2));
        let across = Line2::through([0, 0], [1, 0]).unwrap();
        let halves = split_tree(&a, &Dim2::span(&across, &Square).unwrap()).unwrap();
        for half in [&halves.minus, &halves.plus] {
            assert_eq!(stats(half).depth, usize::try_from(DEPTH).unwrap());
        }
        let result = merge(&a, &b, SetOp::Intersection).unwrap();
        let inside = classify(&result, &Point2::lattice([4 * DEPTH, 5]));
        assert_ne!(inside, Location::On);
        assert!(boundary(&result).unwrap().len() > 1000);
        drop((a, b, halves));
        drop(result);
    });
}

/// The tree of a convex polygon is a chain for every pivot policy.
#[test]
fn autopartition_of_a_convex_polygon_is_a_chain() {
    on_a_small_stack(|| {
        let corners: Vec<[i64; 2]> = (-400..=400).map(|x| [x, x * x]).collect();
        let facets = corners
            .iter()
            .zip(corners.iter().cycle().skip(1))
            .map(|(a, b)| Facet {
                fragment: bspcsg::geometry::spaces::dim2::Segment2::between(*a, *b).unwrap(),
                source: 0,
            })
            .collect();
        let built =
            autopartition::<Dim2>(facets, Square, Label::Out, PivotPolicy::Random(1)).unwrap();
        assert!(built.simple);
        assert_eq!(stats(&built.tree).depth, corners.len());
        check(&built.tree, &Square).unwrap();
    });
}
