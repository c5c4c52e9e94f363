//! How many bits and limbs the exact integers of the geometric predicates need.
//!
//! A bound is a number of bits `b` such that the magnitude is below 2^`b`; the sign takes one bit more. All
//! bounds follow from one fact: a determinant of order 2, 3 or 4 with entries in [−1, 1] is at most 2, 4 or
//! 16 (Hadamard 1893), and it is linear in each column. So the bound of a determinant is the sum of its
//! columns' bounds plus 1, 2 or 4.
//!
//! Notation: `p` bounds a lattice coordinate. A corner of a cell lies half a step between lattice points; it
//! enters doubled, as the homogeneous point (2x, 2y, 2z, 2).
//!
//! # Example
//! ```
//! use bspcsg::arith::bounds::{limbs_for, offset, plane_at_point, COORDINATE_BITS};
//!
//! // The offset of a plane through lattice points is a determinant of three coordinates.
//! assert_eq!(offset(COORDINATE_BITS), 3 * 53 + 2);
//! // A side test takes a point where three planes meet against a fourth plane.
//! assert_eq!(limbs_for(plane_at_point(COORDINATE_BITS)), 8);
//! ```

/// The number of bits of a lattice coordinate: its magnitude is below 2^`COORDINATE_BITS`.
///
/// A double represents every integer up to 2^53, and so every lattice coordinate.
pub const COORDINATE_BITS: u32 = 53;

/// The least integer above all lattice coordinates; points on the line, and lines in the plane that are
/// perpendicular to an axis, may lie there.
pub const MAX_COORDINATE: i64 = 1 << COORDINATE_BITS;

/// Return whether an integer is below 2^[`COORDINATE_BITS`] in magnitude, so that it is a lattice coordinate.
pub const fn is_coordinate(k: i64) -> bool {
    k.unsigned_abs() < MAX_COORDINATE.unsigned_abs()
}

/// The number of bits of a half-space's normal: its components are below 2^`HALF_SPACE_NORMAL_BITS` in
/// magnitude.
///
/// A plane n·x = d that meets the lattice has |d| < 3·2^(`HALF_SPACE_NORMAL_BITS` + `COORDINATE_BITS`), no
/// wider than the offset of a plane through lattice points; the same holds after a motion or refinement that
/// keeps the plane on the lattice.
pub const HALF_SPACE_NORMAL_BITS: u32 = normal(COORDINATE_BITS) - 2;

/// Limbs of a component of a plane's normal; as many as an `i128` has.
pub const NORMAL_LIMBS: usize = 2;

/// Limbs of a plane's offset.
pub const OFFSET_LIMBS: usize = 3;

/// Limbs of each of the homogeneous coordinates of a point where three planes meet.
pub const POINT_LIMBS: usize = 6;

/// The number of bits of a short plane's normal: 2×2 determinants of components then fit an `i128`.
pub const SHORT_NORMAL_BITS: u32 = 62;

/// The number of bits of a short plane's offset: the plane's values at lattice points then fit an `i128`.
pub const SHORT_OFFSET_BITS: u32 = 124;

/// The number of bits of the normal of a line in the plane: 2×2 determinants of components then fit an
/// `i128`.
pub const LINE_NORMAL_BITS: u32 = 62;

/// The number of bits of the offset of a line in the plane, if the line meets the square |x|, |y| ≤
/// [`MAX_COORDINATE`].
pub const LINE_OFFSET_BITS: u32 = LINE_NORMAL_BITS + COORDINATE_BITS + 2;

/// Limbs of each homogeneous coordinate of a point where two lines of the plane meet.
pub const LINE_MEET_LIMBS: usize = 3;

/// Limbs of a line's value at a point where two other lines of the plane meet.
pub const LINE_AT_MEET_LIMBS: usize = 4;

/// Limbs of a homogeneous coordinate of one meet of two lines times the weight of another such meet.
pub const LINE_CROSS_LIMBS: usize = 5;

/// Limbs of each of the homogeneous coordinates of a point where three short planes meet.
pub const SHORT_POINT_LIMBS: usize = 4;

/// Limbs of a short plane's value at a point where three short planes meet.
pub const SHORT_PLANE_AT_POINT_LIMBS: usize = 6;

/// Limbs of a homogeneous coordinate of one meet of three short planes times the weight of another such meet.
pub const SHORT_CROSS_LIMBS: usize = 8;

/// Limbs of a plane's value at a point where three planes meet.
pub const PLANE_AT_POINT_LIMBS: usize = 8;

/// Limbs of one plane's value at a corner of a cell times another plane's value at a meet of three planes.
pub const CORNER_TIMES_POINT_LIMBS: usize = 11;

/// Limbs of a homogeneous coordinate of one meet of three planes times the weight of another such meet.
pub const CROSS_LIMBS: usize = 12;

/// Limbs of the orientation of three points, each the meet of three planes, in a projection along an axis.
pub const ORIENTATION_LIMBS: usize = 18;

/// Limbs of the dot product, and of the cross product, of two vectors between points where three planes meet,
/// projected along an axis: the cosine and the sine of the angle between the vectors, times both lengths.
pub const ANGLE_LIMBS: usize = 24;

/// Limbs of the determinant whose sign says on which side of the plane through three points a fourth one
/// lies, where each point is the meet of three planes.
pub const SIDE_LIMBS: usize = 36;

/// Limbs of the sine of the sum of two angles, times the lengths of the vectors at both angles; cosines and
/// sines times lengths have [`ANGLE_LIMBS`] limbs.
pub const ANGLES_LIMBS: usize = 48;

/// The bound, in bits, of a sum of two integers, from their bounds.
const fn sum(a: u32, b: u32) -> u32 {
    1 + if a > b { a } else { b }
}

/// The bound, in bits, of a 2×2 determinant, from the bounds of its columns.
const fn det2(columns: [u32; 2]) -> u32 {
    columns[0] + columns[1] + 1
}

/// The bound, in bits, of a 3×3 determinant, from the bounds of its columns.
const fn det3(columns: [u32; 3]) -> u32 {
    columns[0] + columns[1] + columns[2] + 2
}

/// The bound, in bits, of a 4×4 determinant, from the bounds of its columns.
const fn det4(columns: [u32; 4]) -> u32 {
    columns[0] + columns[1] + columns[2] + columns[3] + 4
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a component of the normal of a plane through three
/// lattice points.
pub const fn normal(p: u32) -> u32 {
    det3([p, p, 0])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the offset of a plane through three lattice
/// points.
pub const fn offset(p: u32) -> u32 {
    det3([p, p, p])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a plane's value at a lattice point.
pub const fn plane_at_lattice_point(p: u32) -> u32 {
    det4([p, p, p, 0])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a plane's value at the doubled corner of a cell.
pub const fn plane_at_corner(p: u32) -> u32 {
    plane_at_lattice_point(p) + 1
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant that orients a cell's doubled
/// corner against a lattice edge, in a projection along an axis.
pub const fn edge_at_corner(p: u32) -> u32 {
    det3([p, p, 0]) + 1
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant that decides on which side of a
/// plane an axis-parallel line through a cell's doubled corner meets another plane.
pub const fn plane_pair_at_corner(p: u32) -> u32 {
    det2([normal(p), plane_at_corner(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a component of the direction of the line in which
/// two planes meet.
pub const fn line_direction(p: u32) -> u32 {
    det2([normal(p), normal(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant that decides on which side of one
/// plane another plane cuts a lattice edge, or which of two planes cuts the edge first.
pub const fn edge_point_at_plane(p: u32) -> u32 {
    det2([plane_at_lattice_point(p), plane_at_lattice_point(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant that decides on which side of a
/// cut, halfway between lattice planes, a plane cuts a lattice edge.
pub const fn edge_point_at_cut(p: u32) -> u32 {
    let end_to_cut = sum(p + 1, p + 1);
    det2([end_to_cut, plane_at_lattice_point(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant that decides on which side of a
/// plane two coplanar lattice edges cross.
pub const fn edge_crossing_at_plane(p: u32) -> u32 {
    let edge_at_lattice_point = det3([p, p, 0]);
    det2([edge_at_lattice_point, plane_at_lattice_point(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a plane's value at the point where two other
/// planes meet a cut across an axis.
pub const fn plane_pair_in_cut_at_plane(p: u32) -> u32 {
    det3([normal(p), normal(p), plane_at_corner(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the weight of a point where three planes meet,
/// which is also the product of a plane's normal with the direction of a line of two planes.
pub const fn point_weight(p: u32) -> u32 {
    det3([normal(p), normal(p), normal(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a homogeneous coordinate x, y or z of a point
/// where three planes meet.
pub const fn point_numerator(p: u32) -> u32 {
    det3([normal(p), normal(p), offset(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the value of a cut, halfway between lattice
/// planes, at a point where three planes meet.
pub const fn point_at_cut(p: u32) -> u32 {
    let cut = p + 1;
    sum(point_numerator(p) + 1, point_weight(p) + cut)
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a plane's value at a point where three planes
/// meet; the same determinant orders two such points on any line.
pub const fn plane_at_point(p: u32) -> u32 {
    det4([normal(p), normal(p), normal(p), offset(p)])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a difference of products, each of one plane's
/// value at a cell's corner and another plane's value at a meet of three planes.
pub const fn corner_times_point(p: u32) -> u32 {
    sum(
        plane_at_corner(p) + plane_at_point(p),
        plane_at_corner(p) + plane_at_point(p),
    )
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the determinant of three vectors, each the
/// difference between a doubled lattice point and a doubled corner of a cell.
pub const fn determinant_at_corner(p: u32) -> u32 {
    det3([p + 2, p + 2, p + 2])
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on a homogeneous coordinate of one meet of three
/// planes times the weight of another such meet.
pub const fn numerator_times_weight(p: u32) -> u32 {
    point_numerator(p) + point_weight(p)
}

/// Bound, in bits, for lattice coordinates below 2^`p`, on the orientation of three points, each the meet of
/// three planes, in a projection along an axis.
pub const fn point_orientation(p: u32) -> u32 {
    det3([point_numerator(p), point_numerator(p), point_weight(p)])
}

/// Bound, in bits, on the dot product and on the cross product of two plane vectors with components below
/// 2^`d`: the cosine and the sine of the angle between the vectors, times both lengths.
pub const fn angle(d: u32) -> u32 {
    sum(2 * d, 2 * d)
}

/// Bound, in bits, on the determinant of three vectors with components below 2^`d`: the signed volume of the
/// box that they span.
pub const fn volume(d: u32) -> u32 {
    det3([d, d, d])
}

/// Bound, in bits, on the sine of the sum of two angles, times the lengths of the four plane vectors at the
/// angles, which have components below 2^`d`.
pub const fn sum_of_angles(d: u32) -> u32 {
    sum(2 * angle(d), 2 * angle(d))
}

/// The number of limbs that signed integers of magnitude below 2^`bits` need.
pub const fn limbs_for(bits: u32) -> usize {
    (bits as usize + 1).div_ceil(64)
}

const _: () = {
    const P: u32 = COORDINATE_BITS;
    assert!(limbs_for(normal(P)) <= NORMAL_LIMBS);
    assert!(limbs_for(edge_at_corner(P)) <= NORMAL_LIMBS);
    assert!(limbs_for(offset(P)) <= OFFSET_LIMBS);
    assert!(limbs_for(plane_at_corner(P)) <= OFFSET_LIMBS);
    assert!(limbs_for(point_numerator(P)) <= POINT_LIMBS);
    assert!(limbs_for(point_weight(P)) <= POINT_LIMBS);
    assert!(limbs_for(point_at_cut(P)) <= POINT_LIMBS);
    assert!(limbs_for(edge_point_at_plane(P)) <= POINT_LIMBS);
    assert!(limbs_for(plane_at_point(P)) <= PLANE_AT_POINT_LIMBS);
    assert!(limbs_for(corner_times_point(P)) <= CORNER_TIMES_POINT_LIMBS);
    assert!(limbs_for(determinant_at_corner(P)) <= OFFSET_LIMBS);
    assert!(limbs_for(numerator_times_weight(P) + 1) <= CROSS_LIMBS);
    assert!(limbs_for(point_orientation(P)) <= ORIENTATION_LIMBS);
    assert!(limbs_for(angle(P + 1)) <= NORMAL_LIMBS);
    assert!(limbs_for(angle(numerator_times_weight(P) + 1)) <= ANGLE_LIMBS);
    assert!(limbs_for(volume(numerator_times_weight(P) + 1)) <= SIDE_LIMBS);
    assert!(limbs_for(sum_of_angles(numerator_times_weight(P) + 1)) <= ANGLES_LIMBS);
    assert!(HALF_SPACE_NORMAL_BITS + P + 2 <= offset(P));
};

const _: () = {
    const N: u32 = LINE_NORMAL_BITS;
    const D: u32 = LINE_OFFSET_BITS;
    const WORDS: usize = 2;
    let weight = det2([N, N]);
    let numerator = det2([N, D]);
    assert!(limbs_for(D) <= WORDS);
    assert!(limbs_for(weight) <= WORDS);
    assert!(limbs_for(numerator) <= LINE_MEET_LIMBS);
    assert!(limbs_for(det3([N, N, D])) <= LINE_AT_MEET_LIMBS);
    assert!(limbs_for(numerator + weight + 1) <= LINE_CROSS_LIMBS);
};

const _: () = {
    const N: u32 = SHORT_NORMAL_BITS;
    const D: u32 = SHORT_OFFSET_BITS;
    const P: u32 = COORDINATE_BITS;
    const WORDS: usize = 2;
    let value = sum(N + P + 2, D);
    let reduced = sum(D + 1, 64 + N);
    let numerator = det3([N, N, D]);
    let weight = det3([N, N, N]);
    assert!(limbs_for(det2([N, N]) + 1) <= WORDS);
    assert!(limbs_for(sum(value, value)) <= WORDS);
    assert!(limbs_for(reduced) <= WORDS);
    assert!(limbs_for(sum(value + P, value + P)) <= SHORT_POINT_LIMBS);
    assert!(limbs_for(sum(reduced + N, reduced + N)) <= SHORT_POINT_LIMBS);
    assert!(limbs_for(numerator) <= SHORT_POINT_LIMBS);
    assert!(limbs_for(weight) <= SHORT_POINT_LIMBS);
    assert!(limbs_for(det4([N, N, N, D])) <= SHORT_PLANE_AT_POINT_LIMBS);
    assert!(limbs_for(numerator + weight) <= SHORT_CROSS_LIMBS);
};
