//! Laws in space: cubes of a 2×2×2 lattice against bit masks, and tetrahedra of lattice points.

use std::sync::Arc;

use bspcsg::geometry::cell::Cell;
use bspcsg::geometry::plane::{Lattice, Plane};
use bspcsg::geometry::polygon::Polygon;
use bspcsg::geometry::side::{Half, Side};
use bspcsg::geometry::spaces::dim3::Dim3;
use bspcsg::geometry::vertex::Vertex;
use bspcsg::merge::{merge, partition_tree, SetOp};
use bspcsg::tree::partition::{
    autopartition, boundary, check, classify, owned_boundary, stats, winding_tree, Facet, Label,
    Location, PartitionTree, PivotPolicy,
};
use num_bigint::{BigInt, Sign};

use super::support::Numbers;

type Tree = PartitionTree<Dim3>;

/// A rational number, numerator over positive denominator, not reduced.
#[derive(Clone, Debug)]
struct Ratio(BigInt, BigInt);

impl Ratio {
    fn whole(value: i64) -> Self {
        Self(BigInt::from(value), BigInt::from(1))
    }

    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 * &other.1 + &other.0 * &self.1, &self.1 * &other.1)
    }

    fn equals(&self, other: &Self) -> bool {
        &self.0 * &other.1 == &other.0 * &self.1
    }
}

/// The homogeneous coordinates x, y, z and w of a vertex.
fn coordinates(vertex: &Vertex) -> [BigInt; 4] {
    let h = vertex.coordinates();
    let [x, y, z] = h.x;
    [x, y, z, h.w].map(|c| {
        let sign = if c.is_negative() {
            Sign::Minus
        } else {
            Sign::Plus
        };
        let bytes: Vec<u8> = c
            .abs()
            .limbs()
            .iter()
            .flat_map(|l| l.to_le_bytes())
            .collect();
        BigInt::from_bytes_le(sign, &bytes)
    })
}

fn determinant(a: &[BigInt; 4], b: &[BigInt; 4], c: &[BigInt; 4]) -> BigInt {
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
}

/// Six times the volume inside an oriented boundary, by the divergence theorem.
fn sixfold_volume<'a>(walls: impl IntoIterator<Item = &'a Polygon>) -> Ratio {
    let mut sum = Ratio::whole(0);
    for wall in walls {
        let corners: Vec<_> = wall.corners().iter().map(|c| coordinates(&c.at)).collect();
        for pair in corners[1..].windows(2) {
            let (a, b, c) = (&corners[0], &pair[0], &pair[1]);
            sum = sum.plus(&Ratio(determinant(a, b, c), &a[3] * &b[3] * &c[3]));
        }
    }
    sum
}

fn volume(tree: &Tree) -> Ratio {
    sixfold_volume(&boundary(tree).unwrap())
}

fn owned_volume(tree: &Tree) -> Ratio {
    sixfold_volume(owned_boundary(tree).unwrap().iter().map(|f| &f.fragment))
}

/// A frame around all coordinates of small tests.
fn small_frame() -> Cell {
    Cell::around(&[-40; 3], &[40; 3])
}

fn triangle(points: [Lattice; 3], source: u64) -> Facet<Dim3> {
    let [a, b, c] = &points;
    let support = Arc::new(Plane::through(a, b, c).expect("a triangle with area"));
    let fragment = Polygon::triangle(&points, support);
    Facet { fragment, source }
}

fn build(facets: Vec<Facet<Dim3>>, frame: Cell, policy: PivotPolicy) -> Tree {
    let built = autopartition(facets, frame, Label::Out, policy).unwrap();
    assert!(built.simple);
    check(&built.tree, &frame).unwrap();
    built.tree
}

fn assert_same_set(a: &Tree, b: &Tree) {
    let difference = merge(a, b, SetOp::SymmetricDifference).unwrap();
    assert_eq!(difference.label(), Some(Label::Out));
}

fn point(numbers: &mut Numbers, reach: i64) -> Lattice {
    [0; 3].map(|_| numbers.below(2 * reach) - reach)
}

// Sets of cubes: bit 4·z + 2·y + x of a mask is a cube of side 2.

fn voxel(mask: u16, at: Lattice) -> bool {
    let [x, y, z] = at;
    at.iter().all(|c| (0..2).contains(c)) && mask >> (4 * z + 2 * y + x) & 1 == 1
}

fn voxels() -> impl Iterator<Item = Lattice> {
    (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2])
}

/// The square face of a voxel towards `sign` along `axis`, as two triangles.
fn square(at: Lattice, axis: usize, sign: i64, source: u64) -> [Facet<Dim3>; 2] {
    let [a, b, c, d] = super::support::square(at, axis, sign);
    [triangle([a, b, c], source), triangle([a, c, d], source)]
}

fn voxel_facets(mask: u16) -> Vec<Facet<Dim3>> {
    let mut facets = Vec::new();
    for at in voxels().filter(|at| voxel(mask, *at)) {
        for (axis, sign) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut beyond = at;
            beyond[axis] += sign;
            if !voxel(mask, beyond) {
                facets.extend(square(at, axis, sign, facets.len() as u64));
            }
        }
    }
    facets
}

fn assert_voxels(tree: &Tree, mask: u16, context: &str) {
    for at in voxels() {
        let centre = Vertex::lattice(at.map(|c| 2 * c + 1));
        let inside = classify(tree, &centre) == Location::In;
        assert_eq!(inside, voxel(mask, at), "{context} at {at:?}");
    }
    let cubes = Ratio::whole(48 * i64::from(mask.count_ones()));
    assert!(volume(tree).equals(&cubes), "volume of {context}");
    assert!(
        owned_volume(tree).equals(&cubes),
        "owned volume of {context}"
    );
}

#[test]
fn every_voxel_set_is_built_and_complemented() {
    for mask in 0..256 {
        let policy = PivotPolicy::Random(u64::from(mask));
        let tree = build(voxel_facets(mask), small_frame(), policy);
        assert_voxels(&tree, mask, &format!("{mask:08b}"));
        let both = merge(&tree, &tree.complement(), SetOp::Union).unwrap();
        assert_eq!(both.label(), Some(Label::In));
    }
}

#[test]
fn voxel_sets_combine_like_bit_masks() {
    let policies = [
        PivotPolicy::First,
        PivotPolicy::Random(1),
        PivotPolicy::FewestSplits(6),
    ];
    let tree_of = |mask: u16| {
        let policy = policies[usize::from(mask) % 3];
        build(voxel_facets(mask), small_frame(), policy)
    };
    let trees: Vec<Tree> = (0..256).map(tree_of).collect();
    let mut numbers = Numbers::new(1);
    for a in 0..256_u16 {
        for _ in 0..4 {
            let b = u16::try_from(numbers.below(256)).unwrap();
            for (op, mask) in SetOp::ALL.into_iter().zip([a | b, a & b, a & !b, a ^ b]) {
                let result = merge(&trees[usize::from(a)], &trees[usize::from(b)], op).unwrap();
                assert_voxels(&result, mask, &format!("{op:?} of {a:08b} and {b:08b}"));
                check(&result, &small_frame()).unwrap();
            }
        }
    }
}

fn corner_side(cut: &Arc<Plane>) -> Half {
    cut.side_of_corner(&small_frame().corner())
}

#[test]
fn overlapping_voxel_boundaries_are_united_by_winding_numbers() {
    let mut numbers = Numbers::new(2);
    for round in 0..60 {
        let [a, b] = [0; 2].map(|_| u16::try_from(numbers.below(256)).unwrap());
        let facets = [voxel_facets(a), voxel_facets(b)].concat();
        let policy = PivotPolicy::Random(round);
        let built = autopartition(facets, small_frame(), Label::Out, policy).unwrap();
        let union = winding_tree(&built.tree, corner_side, 0, |w| w > 0).unwrap();
        assert_voxels(&union.tree, a | b, "positive");
        let odd = winding_tree(&built.tree, corner_side, 0, |w| w % 2 != 0).unwrap();
        assert_voxels(&odd.tree, a ^ b, "even-odd");
        assert!(!union.simple || a & b == 0);
    }
}

#[test]
fn an_open_surface_has_no_winding_numbers() {
    let mut facets = voxel_facets(0b0000_1000);
    facets.pop();
    let built = autopartition(facets, small_frame(), Label::Out, PivotPolicy::First).unwrap();
    assert!(winding_tree(&built.tree, corner_side, 0, |w| w > 0).is_err());
}

// Tetrahedra.

/// The faces of a tetrahedron, oriented outwards; `None` if it is flat.
fn tetrahedron(corners: [Lattice; 4], source: u64) -> Option<Vec<Facet<Dim3>>> {
    let [a, b, c, d] = corners;
    let (b, c) = match Plane::through(&a, &b, &c)?.side_of_lattice(&d) {
        Side::On => return None,
        Side::Plus => (c, b),
        Side::Minus => (b, c),
    };
    let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
    Some(faces.map(|face| triangle(face, source)).to_vec())
}

fn tetrahedra(numbers: &mut Numbers, reach: i64) -> [Vec<Facet<Dim3>>; 2] {
    loop {
        let shared: usize = usize::try_from(numbers.below(4)).unwrap();
        let first = [0; 4].map(|_| point(numbers, reach));
        let mut second = [0; 4].map(|_| point(numbers, reach));
        second[..shared].copy_from_slice(&first[..shared]);
        if let (Some(a), Some(b)) = (tetrahedron(first, 0), tetrahedron(second, 1)) {
            return [a, b];
        }
    }
}

fn assert_pointwise(a: &Tree, b: &Tree, op: SetOp, result: &Tree, points: &[Lattice]) {
    let label = |tree: &Tree, point: &Vertex| match classify(tree, point) {
        Location::In => Some(Label::In),
        Location::Out => Some(Label::Out),
        Location::On => None,
    };
    for point in points.iter().map(|p| Vertex::lattice(*p)) {
        if let (Some(in_a), Some(in_b)) = (label(a, &point), label(b, &point)) {
            let expected = Some(op.labels(in_a, in_b));
            assert_eq!(label(result, &point), expected, "{op:?} at {point:?}");
        }
    }
}

fn assert_volume_identities(a: &Tree, b: &Tree, results: &[Tree; 4]) {
    let [a, b] = [a, b].map(volume);
    let volumes = results.each_ref().map(volume);
    let [union, intersection, difference, symmetric] = &volumes;
    assert!(union.plus(intersection).equals(&a.plus(&b)));
    assert!(difference.plus(intersection).equals(&a));
    assert!(symmetric.plus(intersection).equals(union));
    for (tree, volume) in results.iter().zip(&volumes) {
        assert!(owned_volume(tree).equals(volume));
    }
}

fn assert_laws(a: &Tree, b: &Tree, frame: &Cell, points: &[Lattice]) {
    let results = SetOp::ALL.map(|op| merge(a, b, op).unwrap());
    for (op, result) in SetOp::ALL.into_iter().zip(&results) {
        check(result, frame).unwrap();
        assert_pointwise(a, b, op, result, points);
    }
    assert_volume_identities(a, b, &results);
    let [union, intersection, difference, _] = &results;
    let de_morgan = merge(&a.complement(), &b.complement(), SetOp::Intersection).unwrap();
    assert_same_set(&de_morgan.complement(), union);
    assert_same_set(&merge(difference, intersection, SetOp::Union).unwrap(), a);
}

/// Small coordinate ranges make shared corners, edges and planes likely; the largest is the whole lattice.
#[test]
fn tetrahedra_obey_the_laws() {
    let mut numbers = Numbers::new(3);
    for (reach, frame) in [
        (2, small_frame()),
        (5, small_frame()),
        (39, small_frame()),
        ((1 << 53) - 1, Cell::UNIVERSE),
    ] {
        for round in 0..30 {
            let facets = tetrahedra(&mut numbers, reach);
            let [a, b] = facets.map(|f| build(f, frame, PivotPolicy::Random(round)));
            let points: Vec<Lattice> = (0..30).map(|_| point(&mut numbers, reach)).collect();
            assert_laws(&a, &b, &frame, &points);
        }
    }
}

/// A random plane becomes the root of a tree without changing the set or violating invariants.
#[test]
fn any_plane_can_become_the_root() {
    use bspcsg::geometry::spaces::space::Space;
    let mut numbers = Numbers::new(5);
    for reach in [3, 30] {
        for round in 0..60 {
            let [facets, _] = tetrahedra(&mut numbers, reach);
            let tree = build(facets, small_frame(), PivotPolicy::Random(round));
            let points = [0; 3].map(|_| point(&mut numbers, reach));
            let Some(plane) = Plane::through(&points[0], &points[1], &points[2]) else {
                continue;
            };
            let span = Dim3::span(&Arc::new(plane), &small_frame()).unwrap();
            let rooted = partition_tree(&tree, span).unwrap();
            check(&rooted, &small_frame()).unwrap();
            assert_same_set(&rooted, &tree);
            assert!(volume(&rooted).equals(&volume(&tree)));
        }
    }
}

/// The tetrahedra of a fan around an inner point share slanted faces: each is cut out and put back.
#[test]
fn sectors_of_a_solid_can_be_cut_out_and_put_back() {
    let mut numbers = Numbers::new(4);
    for round in 0..12 {
        let reach = [4, 35][round % 2];
        let Some(facets) = tetrahedron([0; 4].map(|_| point(&mut numbers, reach)), 0) else {
            continue;
        };
        let whole = build(facets.clone(), small_frame(), PivotPolicy::First);
        let apex = point(&mut numbers, 3);
        let mut rest = whole.clone();
        for face in &facets {
            let ring: Vec<Lattice> = face
                .fragment
                .corners()
                .iter()
                .filter_map(|c| c.at.as_lattice().copied())
                .collect();
            let Some(sector) = tetrahedron([ring[0], ring[1], ring[2], apex], 1) else {
                continue;
            };
            let sector = build(sector, small_frame(), PivotPolicy::Random(7));
            let piece = merge(&rest, &sector, SetOp::Intersection).unwrap();
            let smaller = merge(&rest, &sector, SetOp::Difference).unwrap();
            check(&smaller, &small_frame()).unwrap();
            assert_same_set(&merge(&smaller, &piece, SetOp::Union).unwrap(), &rest);
            rest = smaller;
        }
        let inside = classify(&whole, &Vertex::lattice(apex)) != Location::Out;
        assert!(
            !inside || rest.label() == Some(Label::Out),
            "sectors cover the solid"
        );
        assert!(stats(&whole).cuts >= 4);
    }
}
