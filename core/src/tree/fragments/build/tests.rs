use super::*;
use crate::geometry::plane::Lattice;
use crate::geometry::spaces::affine::Polytope;
use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim2::Dim2;
use crate::tree::fragments::{NodeCut, Policy, Sample};

fn pieces<S: Affine>(facets: &[&[Lattice]]) -> Vec<Piece<S>> {
    let piece = |(number, corners): (usize, &&[Lattice])| Piece {
        fragment: S::fragment(corners).unwrap(),
        number: u32::try_from(number).unwrap(),
    };
    facets.iter().enumerate().map(piece).collect()
}

fn cross() -> Vec<Piece<Dim2>> {
    let horizontal = [[-5, 0, 0], [5, 0, 0]];
    let vertical = [[0, -5, 0], [0, 5, 0]];
    pieces(&[&horizontal, &vertical])
}

fn by_policy<S: Affine>(pieces: Vec<Piece<S>>, policy: Policy) -> FragmentTree<S> {
    let region = Polytope::cuboid(&[-10; 3], &[10; 3]);
    let plan = Plan::Policy {
        policy,
        top: None,
        region,
    };
    build(pieces, plan).unwrap()
}

#[test]
fn crossing_segments_make_three_fragments() {
    let tree = by_policy(cross(), Policy::First);
    assert_eq!(tree.fragments().len(), 3);
    assert_eq!(
        tree.crossings(),
        [Crossing {
            node: NodeId::ROOT,
            piece: 1
        }]
    );
    let links: Vec<_> = tree.nodes().iter().map(|n| (n.minus, n.plus)).collect();
    assert_eq!(
        links,
        [
            (Some(NodeId(1)), Some(NodeId(2))),
            (None, None),
            (None, None)
        ]
    );
    assert_eq!(tree.nodes()[2].parent, Some((NodeId::ROOT, Half::Plus)));
}

#[test]
fn no_pieces_make_no_nodes() {
    let tree = by_policy(Vec::<Piece<Dim1>>::new(), Policy::First);
    assert!(tree.nodes().is_empty() && tree.fragments().is_empty());
}

#[test]
fn coplanar_pieces_share_a_node() {
    let tree = by_policy(
        pieces::<Dim1>(&[&[[3, 0, 0]], &[[1, 0, 0]], &[[3, 0, 0]]]),
        Policy::First,
    );
    assert_eq!(tree.nodes().len(), 2);
    assert_eq!(tree.nodes()[0].coplanar, 0..2);
}

#[test]
fn cuts_in_preorder_rebuild_the_tree() {
    let policies = [
        Policy::Random(3),
        Policy::LeastSplits(Sample(4)),
        Policy::Balanced(Sample(4)),
        Policy::Weighted(Sample(4), 0.5),
        Policy::LeastCost(Sample(4)),
    ];
    for policy in policies {
        let tree = by_policy(cross(), policy);
        let cuts: Vec<NodeCut> = tree.nodes().iter().map(|n| n.cut).collect();
        let again = build(cross(), Plan::Given(cuts)).unwrap();
        let links = |t: &FragmentTree<Dim2>| -> Vec<_> {
            t.nodes().iter().map(|n| (n.cut, n.minus, n.plus)).collect()
        };
        assert_eq!(links(&tree), links(&again));
    }
}

#[test]
fn unsuited_cuts_are_refused() {
    let refused = |cuts: Vec<NodeCut>| {
        let built = build(cross(), Plan::Given(cuts));
        built.unwrap_err().kind() == ErrorKind::BadSnapshot
    };
    assert!(refused(vec![NodeCut::Pivot(0)]));
    assert!(refused(vec![NodeCut::Pivot(7)]));
    assert!(refused(vec![NodeCut::Axis { axis: 2, at: 0 }]));
    let full = [0, 1, 1, 1].map(NodeCut::Pivot);
    assert!(refused(full.to_vec()));
}

#[test]
fn a_convex_chain_becomes_shallow_under_axis_cuts() {
    let points: Vec<Vec<Lattice>> = (0..64).map(|x| vec![[3 * x, 0, 0]]).collect();
    let facets: Vec<&[Lattice]> = points.iter().map(Vec::as_slice).collect();
    let depth = |top| {
        let plan = Plan::Policy {
            policy: Policy::First,
            top,
            region: None,
        };
        let tree = build(pieces::<Dim1>(&facets), plan).unwrap();
        tree.nodes().iter().map(|n| n.depth).max().unwrap()
    };
    assert_eq!(depth(None), 63);
    assert!(depth(Some(1)) < 8);
}
