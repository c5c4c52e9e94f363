//! Compares the arrangement of two meshes with the descent: both must make the same set.

use bspcsg::merge::arrangement::arranged;
use bspcsg::merge::descent::descend::Descent;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::lists::list::Sources;
use bspcsg::merge::profile::Profile;
use bspcsg::merge::rule::Rule;
use bspcsg::tree::node::Branch;
use bspcsg::tree::solid::Solid;

use super::support::{assert_same_set, manifold_mesh, normalized, volume, Numbers, Shape};

const REACH: i64 = 60;

/// The expressions of two operands that are tested.
fn terms() -> [Vec<Term>; 6] {
    let with = |more: Vec<Term>| [vec![Term::Operand(0), Term::Operand(1)], more].concat();
    [
        with(vec![Term::Or(vec![0, 1])]),
        with(vec![Term::And(vec![0, 1])]),
        with(vec![Term::Not(1), Term::And(vec![0, 2])]),
        with(vec![Term::Xor(vec![0, 1])]),
        with(vec![Term::Not(0), Term::And(vec![1, 2])]),
        with(vec![Term::And(vec![0, 1]), Term::Xor(vec![2, 1])]),
    ]
}

/// The expressions of three operands that are tested.
fn terms_of_three() -> [Vec<Term>; 4] {
    let with = |more: Vec<Term>| [(0..3).map(Term::Operand).collect(), more].concat();
    [
        with(vec![Term::Or(vec![0, 1, 2])]),
        with(vec![Term::And(vec![0, 1, 2])]),
        with(vec![Term::Xor(vec![0, 1, 2])]),
        with(vec![
            Term::Or(vec![0, 1]),
            Term::Not(2),
            Term::And(vec![3, 4]),
        ]),
    ]
}

/// The value of an expression by the arrangement and by the descent; `None` if the arrangement declines.
fn both_ways(terms: Vec<Term>, solids: &[Solid]) -> Option<[Solid; 2]> {
    let expression = Expression::new(terms).expect("well formed");
    let sources = Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect());
    let found = arranged(&expression, solids, &sources, &mut Profile::default()).ok()?;
    let roots = solids.iter().map(|s| s.root().clone()).collect();
    let descent = Descent::new(&sources, Rule::Positive, true, solids.len());
    let expected = descent.run(expression, roots).expect("not stopped");
    let solid = |root: Branch| {
        let reduced = solids.iter().all(Solid::is_reduced);
        Solid::new(root, solids[0].pitch(), sources.table().clone(), reduced)
    };
    Some([found.root, expected].map(solid))
}

/// Compares both algorithms for pairs of shapes; returns how many expressions the arrangement evaluated.
fn compared(count: usize, pair: impl FnMut() -> [Solid; 2]) -> usize {
    compared_by(&terms(), count, pair)
}

/// Compares both algorithms for the values of expressions; returns how many the arrangement evaluated.
fn compared_by<const N: usize>(
    terms: &[Vec<Term>],
    count: usize,
    mut shapes: impl FnMut() -> [Solid; N],
) -> usize {
    let mut taken = 0;
    for k in 0..count {
        let solids = shapes();
        for terms in terms.iter().cloned() {
            let Some([found, expected]) = both_ways(terms, &solids) else {
                continue;
            };
            taken += 1;
            let is_strict = found.is_reduced();
            // What differs only by walls inside of overlaps is the same set.
            let united = [&found, &expected].map(|s| normalized(s, Rule::Positive));
            assert_same_set(&united[0], &united[1]);
            // Fails if the boundary is open.
            let size = volume(&found);
            if is_strict {
                assert_eq!(size, volume(&expected), "{k}");
            }
            // Of more operands, the descent may divide coplanar faces otherwise.
            if is_strict && N == 2 {
                let [found, expected] = [&found, &expected].map(|s| manifold_mesh(s, "arranged"));
                assert_eq!(found.triangles, expected.triangles, "{k}");
                assert_eq!(
                    (found.origins, found.flips),
                    (expected.origins, expected.flips),
                    "{k}"
                );
            }
        }
    }
    taken
}

#[test]
fn tetrahedra_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(1);
    let taken = compared(150, || {
        [0; 2].map(|_| Shape::any_tetrahedron(&mut numbers, REACH).solid())
    });
    assert!(taken > 300, "{taken}");
}

/// Small coordinates, so that faces of three shapes touch, cover and cross each other in one place.
#[test]
fn three_shapes_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(7);
    let mut shape = |reach: i64| match numbers.below(2) {
        0 => Shape::any_cuboid(&mut numbers, reach),
        _ => Shape::any_tetrahedron(&mut numbers, reach),
    };
    let touching = |shape: Shape| shape.mapped(|p| p.map(|x| 64 * x)).solid();
    let taken = compared_by(&terms_of_three(), 150, || {
        [0; 3].map(|_| touching(shape(4)))
    });
    assert!(taken > 400, "{taken}");
    let taken = compared_by(&terms_of_three(), 100, || {
        [0; 3].map(|_| shape(REACH).solid())
    });
    assert!(taken > 300, "{taken}");
}

#[test]
fn spheres_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(2);
    let taken = compared(12, || {
        [0; 2].map(|_| Shape::sphere(numbers.point(3000), 2500.0, 2).solid())
    });
    assert!(taken > 30, "{taken}");
}

/// Meshes that overlap themselves, some of them inside out in part.
#[test]
fn overlapping_meshes_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(3);
    let taken = compared(200, || {
        [0; 2].map(|_| {
            let one = Shape::any_tetrahedron(&mut numbers, REACH);
            let other = Shape::any_tetrahedron(&mut numbers, REACH);
            let other = if numbers.below(3) == 0 {
                other.inverted()
            } else {
                other
            };
            one.with(other).unchecked()
        })
    });
    assert!(taken > 1000, "{taken}");
}

/// Small coordinates: the shells of one mesh touch each other, coincide, lie inside each other, and are
/// turned inside out.
#[test]
fn touching_shells_of_one_mesh_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(6);
    let taken = compared(300, || {
        [0; 2].map(|_| {
            let mut shell = || {
                let shape = match numbers.below(2) {
                    0 => Shape::any_cuboid(&mut numbers, 4),
                    _ => Shape::any_tetrahedron(&mut numbers, 4),
                };
                match numbers.below(4) {
                    0 => shape.inverted(),
                    1 => shape.clone().with(shape),
                    _ => shape,
                }
            };
            // On a finer lattice, faces have lattice points inside at which winding numbers can be counted.
            let all = shell().with(shell()).with(shell());
            all.mapped(|p| p.map(|x| 64 * x)).unchecked()
        })
    });
    assert!(taken > 1000, "{taken}");
}

/// Small coordinates: corners in faces, edges in planes, faces in one plane.
#[test]
fn touching_meshes_are_combined_as_by_the_descent() {
    let mut numbers = Numbers::new(4);
    let taken = compared(300, || {
        [0; 2].map(|_| match numbers.below(2) {
            0 => Shape::any_cuboid(&mut numbers, 6).solid(),
            _ => Shape::any_tetrahedron(&mut numbers, 6).solid(),
        })
    });
    assert!(taken > 850, "{taken}");
}

/// A face with many holes, islands in holes, and curves from border to border.
#[test]
fn a_face_with_many_segments_is_divided_as_by_the_descent() {
    let mut numbers = Numbers::new(5);
    let plate = Shape::tetrahedron([
        [-999, -998, 0],
        [5003, -997, 7],
        [-1001, 5009, 11],
        [500, 600, 900],
    ]);
    let plate = plate.expect("a tetrahedron").solid();
    let taken = compared(6, || {
        let ball = |numbers: &mut Numbers| {
            let at = [numbers.below(9), numbers.below(9), 0].map(|x| 400 * x);
            Shape::sphere(at, 90.0, 2)
        };
        let first = ball(&mut numbers);
        let all = (0..9).fold(first, |all, _| all.with(ball(&mut numbers)));
        [plate.clone(), all.unchecked()]
    });
    assert!(taken > 8, "{taken}");
}

/// Found: a number was counted where a corner touches the middle of a face.
#[test]
fn numbers_are_not_counted_where_surfaces_touch() {
    let below = [[1, 3, -6], [4, 3, -6], [2, 7, -6], [2, 4, 0]];
    let below = Shape::tetrahedron(below).expect("a tetrahedron");
    let alone = below.solid();
    let both = Shape::cuboid([0; 3], [6; 3]).with(below).unchecked();
    let united = normalized(&both, Rule::Positive);
    assert!(both.is_reduced());
    let cube = Shape::cuboid([0; 3], [6; 3]).solid();
    assert_eq!(volume(&united), volume(&cube).plus(&volume(&alone)));
}
