//! Replaying the traces of trees gives the same trees and answers.

#![allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)]

use bspcsg::geometry::side::{Half, Side};
use bspcsg::geometry::spaces::affine::{Affine, Viewpoint};
use bspcsg::geometry::spaces::dim2::Dim2;
use bspcsg::merge::generic::trace::{Decision, DecisionReason, Journal, MergeStep};
use bspcsg::merge::{merge, merge_watched, SetOp, SplitCase};
use bspcsg::mesh::facets::Facet;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::handle::NodeId;
use bspcsg::query::path::{cast_ray, locate, RayEvent};
use bspcsg::query::ray::facet::meet;
use bspcsg::query::ray::{Ray, Scene};
use bspcsg::query::stab::node::Growth;
use bspcsg::query::stab::{StabEvent, StabTree};
use bspcsg::tree::fragments::{
    build, build_watched, Division, FragmentTree, Piece, Plan, Policy, Reason, Sample,
};
use bspcsg::tree::partition::{enclosed, Facet as SetFacet};
use bspcsg::tree::partition::{preorder, Entry, Label, PartitionTree, Plan as SetPlan};

use super::support::Numbers;

type Ends = [[i64; 2]; 2];

fn segments(numbers: &mut Numbers, count: usize) -> Vec<Ends> {
    let mut point = || [numbers.below(41) - 20, numbers.below(41) - 20];
    let mut found: Vec<Ends> = Vec::new();
    while found.len() < count {
        let ends = [point(), point()];
        if ends[0] != ends[1] {
            found.push(ends);
        }
    }
    found
}

fn pieces(segments: &[Ends]) -> Vec<Piece<Dim2>> {
    let piece = |(number, ends): (u32, &Ends)| Piece {
        fragment: Dim2::fragment(&ends.map(|[x, y]| [x, y, 0])).expect("it has a length"),
        number,
    };
    (0..).zip(segments).map(piece).collect()
}

fn facets(segments: &[Ends]) -> Vec<Facet> {
    let facet = |(source, ends): (u32, &Ends)| Facet {
        corners: ends.iter().map(|&[x, y]| [x, y, 0]).collect(),
        seams: vec![false; 2],
        source,
    };
    (0..).zip(segments).map(facet).collect()
}

fn by(policy: Policy) -> Plan<Dim2> {
    Plan::Policy {
        policy,
        top: None,
        region: None,
    }
}

fn shape(tree: &FragmentTree<Dim2>) -> Vec<(Option<NodeId>, Option<NodeId>, usize)> {
    let node = |n: &bspcsg::tree::fragments::Node<Dim2>| (n.minus, n.plus, n.coplanar.len());
    tree.nodes().iter().map(node).collect()
}

#[test]
fn divisions_tell_of_every_node_and_of_the_best_candidate() {
    let mut numbers = Numbers::new(1);
    for round in 0..40 {
        let list = segments(&mut numbers, 2 + round % 9);
        let policy = [Policy::Random(7), Policy::LeastSplits(Sample(4))][round % 2];
        let mut told: Vec<Division> = Vec::new();
        let tree = build_watched(pieces(&list), by(policy), &mut told).expect("built");
        let silent = build(pieces(&list), by(policy)).expect("built");
        assert_eq!(shape(&tree), shape(&silent));
        assert_eq!(told.len(), tree.nodes().len());
        let cuts: Vec<_> = told.iter().map(|d| d.cut).collect();
        let again = build(pieces(&list), Plan::Given(cuts)).expect("built");
        assert_eq!(shape(&tree), shape(&again));
        for division in &told {
            let parts = division.minus.len() + division.plus.len() + division.coplanar.len();
            assert_eq!(parts, division.pieces.len() + division.split.len());
            if let Some((above, half)) = division.place {
                let above = &told[above.index()];
                let side = [&above.minus, &above.plus][usize::from(half == Half::Plus)];
                assert_eq!(&division.pieces, side);
            }
            if division.reason == Reason::LeastSplits {
                let least = division.candidates.iter().map(|c| c.splits).min();
                assert_eq!(least, Some(division.split.len() as u32));
            }
        }
    }
}

#[test]
fn rays_through_a_tree_meet_what_is_nearest() {
    let mut numbers = Numbers::new(2);
    let pitch = Pitch::new(0).expect("a pitch");
    for round in 0..200 {
        let list = segments(&mut numbers, 1 + round % 12);
        let tree = build(pieces(&list), by(Policy::First)).expect("built");
        let mut near = || numbers.below(21) - 10;
        let (origin, to) = ([near(), near()], [near(), near()]);
        let Ok(ray) = Ray::<2>::between(origin, &to) else {
            continue;
        };
        let mut told: Vec<RayEvent> = Vec::new();
        let path = cast_ray::<Dim2, 2>(&tree, &facets(&list), pitch, &ray, &mut told);
        let corners = |ends: &Ends| ends.map(|p| p.map(|c| c as f64));
        let nearest = list.iter().filter_map(|ends| meet(&ray, &corners(ends)));
        let nearest = nearest.map(|m| m.at).min().map(|at| at.to_f64());
        assert_eq!(path.hit.map(|h| h.1), nearest, "{list:?} {origin:?} {to:?}");
        assert_eq!(told.len() as u64, path.cost() + path.tests);
        let levels = 1 + tree.nodes().iter().map(|n| n.depth + 2).max().unwrap_or(0);
        assert!(path.cost() <= u64::from(levels) * path.leaves);
    }
}

#[test]
fn a_point_goes_down_to_its_leaf_or_stops_in_a_cut() {
    let list = [[[0, 0], [4, 0]], [[0, 2], [4, 2]]];
    let tree = build(pieces(&list), by(Policy::First)).expect("built");
    let sides = |x: f64, y: f64| {
        let steps = locate(&tree, &Viewpoint::point(&[x, y, 0.0], 0));
        steps.iter().map(|s| (s.node, s.side)).collect::<Vec<_>>()
    };
    let above = sides(1.0, 0.0)[0].1;
    assert_eq!(above, Side::On);
    assert_eq!(sides(1.0, 0.0).len(), 1);
    assert_eq!(sides(1.0, 3.0).len(), 2);
    assert_eq!(sides(1.0, -3.0).len(), 1);
}

#[test]
fn a_tree_that_counts_tells_what_it_counts() {
    let mut numbers = Numbers::new(3);
    let list = segments(&mut numbers, 30);
    let corners: Vec<_> = list
        .iter()
        .map(|e| e.map(|p| p.map(|c| c as f64)))
        .collect();
    let scene = || Scene::new(&corners, Some(Pitch::new(0).expect("a pitch"))).expect("a scene");
    let watched = StabTree::<Dim2, 2>::new(scene(), Growth::Visits(3), None).expect("a tree");
    let silent = StabTree::<Dim2, 2>::new(scene(), Growth::Visits(3), None).expect("a tree");
    let mut told: Vec<StabEvent> = Vec::new();
    for _ in 0..120 {
        let mut near = || numbers.below(61) - 30;
        if let Ok(ray) = Ray::<2>::between([near(), near()], &[near(), near()]) {
            let (_, counts) = watched.test_ray_watched(&ray, &mut told);
            assert_eq!(counts, silent.test_ray(&ray).1);
        }
    }
    assert_eq!(watched.record(), silent.record());
    let divided = told
        .iter()
        .filter(|e| matches!(e, StabEvent::Divide { .. }));
    assert_eq!(divided.count() as u64, watched.shape().subdivisions);
    let visited = told.iter().filter(|e| matches!(e, StabEvent::Visit { .. }));
    assert_eq!(visited.count() as u64, watched.shape().visits);
}

/// A tree of labels and numbers of cuts, in the structure of a partition tree.
#[derive(Clone, Debug, PartialEq)]
enum Plain {
    Leaf(Label),
    Cut(usize, Box<Plain>, Box<Plain>),
}

impl Plain {
    /// Converts a partition tree; `numbers` gives the numbers of its cuts, in preorder.
    fn of(tree: &PartitionTree<Dim2>, numbers: &mut impl FnMut() -> usize) -> Self {
        fn next(
            entries: &mut impl Iterator<Item = Entry<bspcsg::geometry::spaces::dim2::Line2>>,
            numbers: &mut impl FnMut() -> usize,
        ) -> Plain {
            match entries.next().expect("a node") {
                Entry::Leaf(label) => Plain::Leaf(label),
                Entry::Cut(_) => {
                    let number = numbers();
                    let minus = next(entries, numbers);
                    let plus = next(entries, numbers);
                    Plain::Cut(number, Box::new(minus), Box::new(plus))
                }
            }
        }
        next(&mut preorder(tree).into_iter(), numbers)
    }

    fn cut(number: usize, minus: Self, plus: Self) -> Self {
        match (&minus, &plus) {
            (Self::Leaf(a), Self::Leaf(b)) if a == b => minus,
            _ => Self::Cut(number, Box::new(minus), Box::new(plus)),
        }
    }

    fn complement(self) -> Self {
        match self {
            Self::Leaf(label) => Self::Leaf(label.complement()),
            Self::Cut(n, minus, plus) => Self::cut(n, minus.complement(), plus.complement()),
        }
    }

    fn numbers(&self, found: &mut Vec<usize>) {
        if let Self::Cut(number, minus, plus) = self {
            found.push(*number);
            minus.numbers(found);
            plus.numbers(found);
        }
    }
}

/// Merges trees by the recorded steps alone.
struct Replay<I: Iterator<Item = MergeStep>>(I);

impl<I: Iterator<Item = MergeStep>> Replay<I> {
    fn pair(&mut self, a: Plain, b: Plain) -> Plain {
        let Some(MergeStep::Pair { decision, .. }) = self.0.next() else {
            panic!("a pair comes next");
        };
        match decision {
            Decision::Leaf(label, _) => Plain::Leaf(label),
            Decision::First(_) => a,
            Decision::FirstComplement(_) => a.complement(),
            Decision::Second(because) => {
                assert_eq!(because, DecisionReason::FirstIsLeaf);
                b
            }
            Decision::SecondComplement(_) => b.complement(),
            Decision::Divide => {
                let Plain::Cut(number, minus, plus) = a else {
                    panic!("a leaf divides nothing");
                };
                let [b_minus, b_plus] = self.split(b);
                let minus = self.pair(*minus, b_minus);
                let plus = self.pair(*plus, b_plus);
                assert!(matches!(self.0.next(), Some(MergeStep::Join { .. })));
                Plain::cut(number, minus, plus)
            }
        }
    }

    fn split(&mut self, tree: Plain) -> [Plain; 2] {
        let Some(MergeStep::Split { case, .. }) = self.0.next() else {
            panic!("a split comes next");
        };
        let halves = match (tree, case) {
            (leaf @ Plain::Leaf(_), SplitCase::Leaf) => [leaf.clone(), leaf],
            (Plain::Cut(_, minus, plus), SplitCase::Same) => [*minus, *plus],
            (Plain::Cut(_, minus, plus), SplitCase::Opposite) => [*plus, *minus],
            (Plain::Cut(n, minus, plus), SplitCase::OneSided { deep, home }) => {
                let (subtree, other) = match deep {
                    Half::Minus => (*minus, *plus),
                    Half::Plus => (*plus, *minus),
                };
                let [low, high] = self.split(subtree);
                let around = |part| match deep {
                    Half::Minus => Plain::cut(n, part, other.clone()),
                    Half::Plus => Plain::cut(n, other.clone(), part),
                };
                match home {
                    Half::Minus => [around(low), high],
                    Half::Plus => [low, around(high)],
                }
            }
            (Plain::Cut(n, minus, plus), SplitCase::Crossing) => {
                let [mm, mp] = self.split(*minus);
                let [pm, pp] = self.split(*plus);
                [Plain::cut(n, mm, pm), Plain::cut(n, mp, pp)]
            }
            (tree, case) => panic!("{case:?} of {tree:?}"),
        };
        assert!(matches!(self.0.next(), Some(MergeStep::Halves { .. })));
        halves
    }
}

fn polygon(numbers: &mut Numbers) -> PartitionTree<Dim2> {
    let list: Vec<[i64; 2]> = (0..3 + numbers.below(4))
        .map(|_| [numbers.below(13), numbers.below(13)])
        .collect();
    let ends = list.iter().zip(list.iter().cycle().skip(1));
    let facets = ends.enumerate().filter_map(|(i, (a, b))| {
        let fragment = Dim2::fragment(&[[a[0], a[1], 0], [b[0], b[1], 0]])?;
        let source = i as u64;
        Some(SetFacet { fragment, source })
    });
    enclosed(facets.collect(), 0, |w| w % 2 != 0, &SetPlan::BALANCED).expect("a set")
}

#[test]
fn the_cases_of_a_merge_lead_to_its_result() {
    let mut numbers = Numbers::new(4);
    for round in 0..200 {
        let (a, mut b) = (polygon(&mut numbers), polygon(&mut numbers));
        if round % 7 == 0 {
            b = if round % 2 == 0 {
                a.clone()
            } else {
                a.complement()
            };
        }
        for op in SetOp::ALL {
            let mut journal = Journal::new(&a, &b);
            let found = merge_watched(&a, &b, op, &mut journal).expect("merged");
            let silent = merge(&a, &b, op).expect("merged");
            assert_eq!(preorder(&found), preorder(&silent));
            let cuts = |tree| {
                let cut = |entry| match entry {
                    Entry::Cut(cut) => Some(cut),
                    Entry::Leaf(_) => None,
                };
                preorder::<Dim2>(tree)
                    .into_iter()
                    .filter_map(cut)
                    .collect::<Vec<_>>()
            };
            let mut known = cuts(&a);
            let second = known.len();
            known.extend(cuts(&b));
            let count_from = |mut next: usize| {
                move || {
                    next += 1;
                    next - 1
                }
            };
            let plain = [
                Plain::of(&a, &mut count_from(0)),
                Plain::of(&b, &mut count_from(second)),
            ];
            let [first, other] = plain;
            let mut replay = Replay(journal.into_steps().into_iter());
            let result = replay.pair(first, other);
            assert!(replay.0.next().is_none());
            let mut order = Vec::new();
            result.numbers(&mut order);
            let replayed: Vec<_> = order.iter().map(|n| known[*n]).collect();
            assert_eq!(replayed, cuts(&found));
        }
    }
}
