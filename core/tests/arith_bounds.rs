//! The widths of the exact predicates: the derived table, and points that reach the bounds.

use bspcsg::arith::bounds::{self, limbs_for, COORDINATE_BITS};
use bspcsg::arith::Int;
use num_bigint::BigInt;
use proptest::prelude::*;

/// Each bound is a multiple of the coordinate's bits plus a constant.
#[test]
fn bounds_are_linear_in_the_coordinate() {
    type Row = (fn(u32) -> u32, u32, u32);
    let rows: [Row; 17] = [
        (bounds::normal, 2, 2),
        (bounds::edge_at_corner, 2, 3),
        (bounds::offset, 3, 2),
        (bounds::plane_at_lattice_point, 3, 4),
        (bounds::plane_at_corner, 3, 5),
        (bounds::line_direction, 4, 5),
        (bounds::edge_point_at_cut, 4, 7),
        (bounds::plane_pair_at_corner, 5, 8),
        (bounds::edge_crossing_at_plane, 5, 7),
        (bounds::edge_point_at_plane, 6, 9),
        (bounds::point_weight, 6, 8),
        (bounds::point_numerator, 7, 8),
        (bounds::plane_pair_in_cut_at_plane, 7, 11),
        (bounds::point_at_cut, 7, 10),
        (bounds::plane_at_point, 9, 12),
        (bounds::numerator_times_weight, 13, 16),
        (bounds::point_orientation, 20, 26),
    ];
    for (bound, slope, constant) in rows {
        for p in [1, 48, COORDINATE_BITS] {
            assert_eq!(bound(p), slope * p + constant);
        }
    }
}

#[test]
fn limbs_hold_the_sign() {
    assert_eq!([0, 63, 64, 127, 128].map(limbs_for), [1, 1, 2, 2, 3]);
    let of = |p: u32| {
        [
            bounds::normal(p),
            bounds::plane_at_corner(p),
            bounds::line_direction(p),
            bounds::plane_pair_at_corner(p),
            bounds::edge_point_at_plane(p),
            bounds::plane_pair_in_cut_at_plane(p),
            bounds::plane_at_point(p),
        ]
        .map(limbs_for)
    };
    assert_eq!(of(48), [2, 3, 4, 4, 5, 6, 7]);
    assert_eq!(of(53), [2, 3, 4, 5, 6, 6, 8]);
}

type Point = [i64; 3];

/// A plane: normal and offset, positive where normal · x + offset is.
type Plane = ([i128; 3], Int<3>);

/// A point in homogeneous coordinates `(x, y, z, w)`.
type Meet = [Int<6>; 4];

fn coordinate() -> impl Strategy<Value = i64> {
    let limit = (1i64 << COORDINATE_BITS) - 1;
    prop_oneof![4 => Just(limit), 4 => Just(-limit), 1 => -limit..=limit]
}

fn point() -> impl Strategy<Value = Point> {
    [coordinate(), coordinate(), coordinate()]
}

fn plane() -> impl Strategy<Value = Plane> {
    [point(), point(), point()].prop_map(|[a, b, c]| plane_through(a, b, c))
}

fn plane_through(a: Point, b: Point, c: Point) -> Plane {
    let [u, v] = [b, c].map(|q| [0, 1, 2].map(|i| i128::from(q[i]) - i128::from(a[i])));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
    let along = (0..3).map(|i| Int::<2>::from_i128(normal[i]).mul_i64::<3>(a[i]));
    (normal, -along.fold(Int::ZERO, |sum, term| sum + term))
}

/// The point where three planes meet, by cofactors of `[normal | offset]`.
fn meet(planes: &[Plane; 3]) -> Meet {
    let minor = |columns: [usize; 2], rows: [usize; 2]| {
        let entry = |row: usize, column: usize| Int::<2>::from_i128(planes[row].0[column]);
        let product = |i: usize, j: usize| {
            entry(rows[0], columns[i]).mul::<2, 4>(&entry(rows[1], columns[j]))
        };
        product(0, 1) - product(1, 0)
    };
    let rows = [[1, 2], [2, 0], [0, 1]];
    let numerator = |columns: [usize; 2]| {
        let terms = (0..3).map(|i| minor(columns, rows[i]).mul::<3, 6>(&planes[i].1));
        -terms.fold(Int::ZERO, |sum, term| sum + term)
    };
    let weight = (0..3).map(|i| minor([1, 2], rows[i]).mul_i128::<6>(planes[i].0[0]));
    [
        numerator([1, 2]),
        numerator([2, 0]),
        numerator([0, 1]),
        weight.fold(Int::ZERO, |sum, term| sum + term),
    ]
}

fn plane_at_point(plane: &Plane, point: &Meet) -> Int<8> {
    let along = (0..3).map(|i| point[i].mul_i128::<8>(plane.0[i]));
    along.fold(point[3].mul(&plane.1), |sum, term| sum + term)
}

/// The determinant of the rows (x, y, w).
fn orientation(points: &[Meet; 3]) -> Int<18> {
    let cross = |i: usize, j: usize| -> Int<12> {
        points[i][0].mul::<6, 12>(&points[j][1]) - points[i][1].mul::<6, 12>(&points[j][0])
    };
    let term = |i: usize, j: usize, k: usize| cross(i, j).mul::<6, 18>(&points[k][3]);
    term(0, 1, 2) + term(1, 2, 0) + term(2, 0, 1)
}

fn big<const N: usize>(x: &Int<N>) -> BigInt {
    let bytes: Vec<u8> = x.limbs().iter().flat_map(|l| l.to_le_bytes()).collect();
    BigInt::from_signed_bytes_le(&bytes)
}

fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    if rows.is_empty() {
        return 1.into();
    }
    let without = |row: usize| -> Vec<Vec<BigInt>> {
        let others = rows.iter().enumerate().filter(|(i, _)| *i != row);
        others.map(|(_, entries)| entries[1..].to_vec()).collect()
    };
    let term = |i: usize| &rows[i][0] * determinant(&without(i));
    (0..rows.len()).fold(0.into(), |sum: BigInt, i| {
        if i % 2 == 0 {
            sum + term(i)
        } else {
            sum - term(i)
        }
    })
}

fn big_plane(plane: &Plane) -> Vec<BigInt> {
    let normal = plane.0.iter().map(|&n| BigInt::from(n));
    normal.chain([big(&plane.1)]).collect()
}

proptest! {
    #[test]
    fn extreme_planes_and_points_fit(planes in [plane(), plane(), plane(), plane()]) {
        let p = COORDINATE_BITS;
        for (normal, offset) in &planes {
            prop_assert!(normal.iter().all(|n| n.unsigned_abs() >> bounds::normal(p) == 0));
            prop_assert!(offset.bit_length() <= bounds::offset(p));
        }
        let point = meet(&[planes[0], planes[1], planes[2]]);
        prop_assert!(point[..3].iter().all(|x| x.bit_length() <= bounds::point_numerator(p)));
        prop_assert!(point[3].bit_length() <= bounds::point_weight(p));
        let value = plane_at_point(&planes[3], &point);
        prop_assert!(value.bit_length() <= bounds::plane_at_point(p));
        prop_assert_eq!(big(&value), determinant(&planes.each_ref().map(big_plane)));
    }

    #[test]
    fn extreme_orientations_fit(planes in prop::array::uniform9(plane())) {
        let points = [0, 3, 6].map(|i| meet(&[planes[i], planes[i + 1], planes[i + 2]]));
        let value = orientation(&points);
        prop_assert!(value.bit_length() <= bounds::point_orientation(COORDINATE_BITS));
        let rows = points.map(|point| [0, 1, 3].map(|i| big(&point[i])).to_vec());
        prop_assert_eq!(big(&value), determinant(&rows));
    }
}
