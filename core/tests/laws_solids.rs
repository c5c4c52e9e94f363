//! Exact identities of solids through evaluation, measures and meshes.

use std::sync::Arc;

use bspcsg::arith::bounds::{self, COORDINATE_BITS, HALF_SPACE_NORMAL_BITS};
use bspcsg::arith::Int;
use bspcsg::error::ErrorKind;
use bspcsg::geometry::plane::{Lattice, Plane};
use bspcsg::geometry::spaces::motion::Motion;
use bspcsg::merge::descent::choice::MAX_ELEMENTS_PER_LEAF;
use bspcsg::merge::expression::Term;
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::query::classify::Location;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::solid::Solid;

use super::support::{
    applied, assert_same_set, assert_same_triangles, combined, complement, is_empty, is_full,
    located, manifold_mesh, normalized, straight, turned, volume, Numbers, Ratio, Shape, LIMIT,
};

/// Asserts that all four results have closed meshes, and the laws of volumes of any two solids.
fn assert_laws(a: &Solid, b: &Solid, context: &str) {
    let results = SetOp::ALL.map(|op| applied(op, a, b));
    for (op, result) in SetOp::ALL.into_iter().zip(&results) {
        manifold_mesh(result, &format!("{op:?}: {context}"));
        assert_eq!(is_empty(result), volume(result) == Ratio::whole(0));
    }
    let [union, intersection, difference, symmetric] = results.each_ref().map(volume);
    let (all, first) = (volume(a).plus(&volume(b)), volume(a));
    assert_eq!(union.plus(&intersection), all, "{context}");
    assert_eq!(difference.plus(&intersection), first, "{context}");
    assert_eq!(union.minus(&intersection), symmetric, "{context}");
    let [union, intersection, difference, _] = &results;
    assert_same_set(
        &applied(SetOp::Intersection, &complement(a), &complement(b)),
        &complement(union),
    );
    let back = applied(SetOp::Union, difference, intersection);
    assert_same_triangles(&back, a, &format!("put back: {context}"));
}

/// Small coordinate ranges make shared corners, edges and planes likely.
#[test]
fn tetrahedra_obey_the_laws() {
    let mut numbers = Numbers::new(1);
    for reach in [3, 5, 9, 1000, 1 << 30] {
        for _ in 0..20 {
            let [a, b] = [0; 2].map(|_| Shape::any_tetrahedron(&mut numbers, reach));
            assert_laws(&a.solid(), &b.solid(), &format!("{a:?} {b:?}"));
        }
    }
}

/// Coordinates at the limit: debug builds check that no integer overflows.
#[test]
fn the_largest_tetrahedra_obey_the_laws() {
    let mut numbers = Numbers::new(12);
    for _ in 0..25 {
        let mut coordinate = || match numbers.below(5) {
            0 | 1 => LIMIT,
            2 | 3 => -LIMIT,
            _ => numbers.below(2 * LIMIT) - LIMIT,
        };
        let mut corner = || [coordinate(), coordinate(), coordinate()];
        let mut shape = || Shape::tetrahedron([corner(), corner(), corner(), corner()]);
        if let (Some(a), Some(b)) = (shape(), shape()) {
            assert_laws(&a.solid(), &b.solid(), &format!("{a:?} {b:?}"));
        }
    }
}

/// A box turned by a rational rotation, its corners rounded to the lattice one by one.
fn rounded_box(numbers: &mut Numbers) -> Shape {
    let [p, q] = numbers.pick(&[[3, 4], [5, 12], [8, 15], [20, 21]]);
    let r = [5, 13, 17, 29][[3, 5, 8, 20].iter().position(|n| *n == p).expect("listed")];
    let [u, v] = numbers.pick(&[[0, 1], [1, 2], [2, 0]]);
    let shift = numbers.point(40);
    let turn = move |point: Lattice| {
        let mut image = point;
        image[u] = (p * point[u] - q * point[v]).div_euclid(r);
        image[v] = (q * point[u] + p * point[v]).div_euclid(r);
        [0, 1, 2].map(|i| image[i] + shift[i])
    };
    Shape::any_cuboid(numbers, 60).mapped(|x| turn(x.map(|c| 3 * c)))
}

#[test]
fn rounded_boxes_obey_the_laws() {
    let mut numbers = Numbers::new(2);
    for _ in 0..40 {
        let [a, b] = [0; 2].map(|_| rounded_box(&mut numbers));
        assert_laws(&a.solid(), &b.solid(), &format!("{a:?} {b:?}"));
    }
}

/// Boxes in one rotated frame: coplanar contacts in planes that are not axis-parallel.
#[test]
fn boxes_that_touch_obey_the_laws() {
    let mut numbers = Numbers::new(3);
    for round in 0..60 {
        let [a, b] = [0; 2].map(|_| Shape::any_cuboid(&mut numbers, 4));
        let map = [straight, turned][round % 2];
        let (a, b) = (a.mapped(map), b.mapped(map));
        assert_laws(&a.solid(), &b.solid(), &format!("{a:?} {b:?}"));
    }
}

/// A prism over a triangle, with its ends in two planes of a rotated frame.
fn prism(triangle: [[i64; 2]; 3], low: i64, high: i64) -> Shape {
    let [a, b, c] = triangle;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let ring = if area > 0 { [a, b, c] } else { [a, c, b] };
    let at = |z: i64| ring.map(|[x, y]| turned([x, y, z]));
    Shape {
        vertices: [at(low), at(high)].concat(),
        faces: vec![
            [0, 2, 1],
            [3, 4, 5],
            [0, 1, 4],
            [0, 4, 3],
            [1, 2, 5],
            [1, 5, 4],
            [2, 0, 3],
            [2, 3, 5],
        ],
    }
}

fn any_prism(numbers: &mut Numbers) -> Shape {
    loop {
        let mut corner = || [numbers.below(6), numbers.below(6)];
        let [a, b, c] = [corner(), corner(), corner()];
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let low = numbers.below(2);
        if area != 0 {
            return prism([a, b, c], low, low + 1 + numbers.below(2));
        }
    }
}

/// Prisms with their ends in common planes: triangles overlap in one slanted plane.
#[test]
fn prisms_over_common_planes_obey_the_laws() {
    let mut numbers = Numbers::new(4);
    for _ in 0..60 {
        let [a, b] = [0; 2].map(|_| any_prism(&mut numbers));
        assert_laws(&a.solid(), &b.solid(), &format!("{a:?} {b:?}"));
    }
    let results: Vec<Solid> = (0..5).map(|_| any_prism(&mut numbers).solid()).collect();
    let all = combined(&results, vec![Term::Xor(vec![0, 1, 2, 3, 4])]);
    manifold_mesh(&all, "five prisms");
}

/// Three lines of one plane pass through one point, which is the end of no edge.
#[test]
fn edges_cross_where_none_of_them_ends() {
    let mut numbers = Numbers::new(5);
    let first = prism([[0, 0], [0, 40], [20, 20]], 0, 1);
    let second = prism([[0, 0], [40, 0], [20, 20]], 0, 1);
    assert_laws(&first.solid(), &second.solid(), "two prisms");
    for _ in 0..10 {
        let shapes = [0; 3].map(|_| any_prism(&mut numbers).solid());
        let symmetric = combined(&shapes, vec![Term::Xor(vec![0, 1, 2])]);
        manifold_mesh(&symmetric, "three prisms");
    }
    let cut = |triangle| prism(triangle, 0, 1).solid();
    let solids = [
        cut([[0, 0], [4, 0], [4, 8]]),
        cut([[0, 8], [8, 0], [0, 0]]),
        cut([[0, 4], [8, 4], [8, 12]]),
    ];
    let crossing = combined(&solids, vec![Term::Xor(vec![0, 1, 2])]);
    manifold_mesh(&crossing, "a crossing");
}

/// Tetrahedra on different sides, and on the same side, of a common face.
#[test]
fn tetrahedra_on_a_common_face_obey_the_laws() {
    let mut numbers = Numbers::new(6);
    for _ in 0..40 {
        let [a, b, c, d, e] = [0; 5].map(|_| numbers.point(30));
        let pair = [[a, b, c, d], [a, b, c, e]].map(Shape::tetrahedron);
        let [Some(first), Some(second)] = pair else {
            continue;
        };
        assert_laws(
            &first.solid(),
            &second.solid(),
            &format!("{first:?} {second:?}"),
        );
    }
}

#[test]
fn spheres_obey_the_laws() {
    let sphere = |x: i64, radius: f64| Shape::sphere([x, 2 * x, 5000], radius, 2).solid();
    let pairs = [
        (sphere(5000, 3000.0), sphere(6000, 2500.0)),
        (sphere(5000, 3000.0), sphere(5000, 3000.0)),
        (sphere(5000, 3000.0), sphere(5001, 3000.0)),
        (sphere(5000, 3000.0), sphere(5000, 2000.0)),
    ];
    for (i, (a, b)) in pairs.iter().enumerate() {
        assert_laws(a, b, &format!("pair {i} of spheres"));
    }
}

/// Cutting off a piece and putting it back gives the first solid's triangles each time.
#[test]
fn pieces_cut_off_can_be_put_back() {
    let mut numbers = Numbers::new(7);
    let whole = Shape::sphere([500; 3], 400.0, 1).solid();
    let mut solid = whole.clone();
    for round in 0..8 {
        let tool = Shape::any_tetrahedron(&mut numbers, 1000).solid();
        let piece = applied(SetOp::Intersection, &solid, &tool);
        let rest = applied(SetOp::Difference, &solid, &tool);
        solid = applied(SetOp::Union, &rest, &piece);
        assert_same_triangles(&solid, &whole, &format!("round {round}"));
    }
}

fn any_half_space(numbers: &mut Numbers, offset: i64) -> Solid {
    let normal = loop {
        let normal = numbers.point(7).map(|c| c - 3);
        if normal != [0; 3] {
            break normal;
        }
    };
    side_of_plane(normal, normal.iter().sum::<i64>() * offset)
}

fn side_of_plane(normal: [i64; 3], offset: i64) -> Solid {
    let pitch = Pitch::new(0).expect("a pitch");
    let offset = Int::from_i64(offset);
    let source = half_space(normal.map(i128::from), &offset, pitch, None).expect("a half-space");
    Solid::of_source(Arc::new(source), true)
}

/// The parts of a solid on both sides of a plane, united, are the solid.
#[test]
fn halves_reunite() {
    let mut numbers = Numbers::new(11);
    for round in 0..30 {
        let solid = match round % 3 {
            0 => Shape::any_cuboid(&mut numbers, 20).solid(),
            1 => Shape::any_tetrahedron(&mut numbers, 20).solid(),
            _ => Shape::sphere([10; 3], 9.0, 1).solid(),
        };
        let below = any_half_space(&mut numbers, 10);
        let context = format!("round {round}");
        let minus = applied(SetOp::Intersection, &solid, &below);
        let plus = applied(SetOp::Difference, &solid, &below);
        manifold_mesh(&minus, &context);
        manifold_mesh(&plus, &context);
        assert_eq!(
            volume(&minus).plus(&volume(&plus)),
            volume(&solid),
            "{context}"
        );
        assert_same_triangles(&applied(SetOp::Union, &minus, &plus), &solid, &context);
        let above = complement(&below);
        assert_same_set(&applied(SetOp::Intersection, &solid, &above), &plus);
        assert!(is_full(&applied(SetOp::Union, &below, &above)));
    }
}

/// A cell of which one half comes from an operand with winding number two, and the other half from a kernel
/// with winding number one: they must not become one leaf.
#[test]
fn leaves_of_different_winding_numbers_stay_apart() {
    let small = |x: i64, y: i64| {
        let corners = [[x, y, 1], [x + 4, y, 1], [x, y + 4, 1], [x, y, 6]];
        Shape::tetrahedron(corners).expect("not flat")
    };
    let twice = Shape::cuboid([-100; 3], [100; 3]).with(Shape::cuboid([-90; 3], [110; 3]));
    let holes = small(1, 1).with(small(1, 9)).inverted();
    let body = twice.with(holes);
    let mut operands = vec![body.unchecked()];
    operands.extend((0..MAX_ELEMENTS_PER_LEAF / 4).map(|_| small(9, 1).solid()));
    let copies = u32::try_from(operands.len()).expect("few");
    let lines = vec![
        Term::Or((1..copies).collect()),
        Term::Not(copies),
        Term::And(vec![0, copies + 1]),
    ];
    let raw = combined(&operands, lines);
    assert_eq!(located(&raw, &[[10, 2, 2]]), [Location::Outside]);
    let clean = applied(SetOp::Difference, &body.united(), &small(9, 1).solid());
    assert_eq!(volume(&normalized(&raw, Rule::Positive)), volume(&clean));
}

/// Half-spaces as the only operands: bounded results have a mesh, unbounded ones are sets.
#[test]
fn half_spaces_bound_solids() {
    let planes = [
        side_of_plane([-1, 0, 0], 0),
        side_of_plane([0, -1, 0], 0),
        side_of_plane([0, 0, -1], 0),
        side_of_plane([1, 1, 1], 30),
    ];
    let corner = combined(&planes, vec![Term::And(vec![0, 1, 2, 3])]);
    assert_eq!(volume(&corner), Ratio::whole(4500));
    assert_eq!(manifold_mesh(&corner, "a corner").triangles.len(), 4);
    let octant = combined(&planes[..3], vec![Term::And(vec![0, 1, 2])]);
    let found = located(&octant, &[[5, 5, 5], [-5, 5, 5], [0, 5, 5]]);
    let expected = [Location::Inside, Location::Outside, Location::Boundary];
    assert_eq!(found, expected);
    let tetrahedron = Shape::tetrahedron([[0; 3], [30, 0, 0], [0, 30, 0], [0, 0, 30]]);
    assert_same_set(&corner, &tetrahedron.expect("not flat").solid());
}

/// The half-space behind a face, by its plane's coefficients.
fn behind(shape: &Shape, face: usize) -> Solid {
    let [a, b, c] = shape.corners(face);
    let plane = Plane::through(&a, &b, &c).expect("an area");
    let pitch = Pitch::new(0).expect("a pitch");
    let source = half_space(*plane.normal(), &-*plane.offset(), pitch, None);
    Solid::of_source(Arc::new(source.expect("a half-space")), true)
}

/// Half-spaces through faces, with normals of up to 106 bits.
#[test]
fn tetrahedra_are_what_lies_behind_their_faces() {
    let mut numbers = Numbers::new(5);
    for bound in [9, 1 << 20, 1 << 40, 1 << 52] {
        for _ in 0..8 {
            let shape = Shape::any_tetrahedron(&mut numbers, bound);
            let sides: Vec<Solid> = (0..4).map(|face| behind(&shape, face)).collect();
            let common = combined(&sides, vec![Term::And(vec![0, 1, 2, 3])]);
            assert_same_set(&common, &shape.solid());
            assert_eq!(volume(&common), volume(&shape.solid()));
        }
    }
}

/// Planes of half-spaces have the widths that `arith::bounds` gives them.
#[test]
fn half_spaces_keep_to_their_widths() {
    let pitch = Pitch::new(0).expect("a pitch");
    let made = |normal: [i128; 3], offset: Int<3>| half_space(normal, &offset, pitch, None);
    let widest = (1i128 << HALF_SPACE_NORMAL_BITS) - 1;
    let reach: Int<3> = Int::<2>::from_i128(3 * widest).mul_i64(1 << COORDINATE_BITS);
    let farthest = reach - Int::ONE;
    assert!(farthest.bit_length() <= bounds::offset(COORDINATE_BITS));
    assert!(made([widest; 3], farthest).is_ok());
    let kind = |normal, offset| made(normal, offset).err().map(|e| e.kind());
    assert_eq!(kind([widest; 3], reach), Some(ErrorKind::TooLarge));
    assert_eq!(
        kind([widest + 1, 1, 0], Int::ZERO),
        Some(ErrorKind::TooLarge)
    );
    assert_eq!(
        kind([1, 0, 0], Int::from_i64(1 << 53)),
        Some(ErrorKind::TooLarge)
    );
    assert_eq!(kind([0; 3], Int::ONE), Some(ErrorKind::BadNormal));
    let far = Int::<2>::from_i128(widest).mul_i64((1 << 53) - 2);
    let solid = Solid::of_source(Arc::new(made([widest, 1, 0], far).expect("near")), true);
    for motion in [
        Motion {
            scale: 1000,
            ..Motion::IDENTITY
        },
        Motion {
            shift: [1 << 60, 0, 0],
            ..Motion::IDENTITY
        },
    ] {
        let moved = Snapshot::of(&solid).moved(&motion, pitch).err();
        assert_eq!(moved.map(|e| e.kind()), Some(ErrorKind::TooLarge));
    }
}
