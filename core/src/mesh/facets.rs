//! Facets on the lattice: points, segments and planar polygons, divided into convex pieces.

use super::ears::{is_convex, triangles};
use super::grid::Pitch;
use crate::arith::bounds::COORDINATE_BITS;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::{normal, Lattice, Plane};
use crate::geometry::side::Side;
use crate::interrupt::poll;

/// A convex facet, or a convex part of one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facet {
    /// The corners: one point, the two ends of a segment, or the corners of a convex polygon; unused
    /// coordinates are zero.
    pub corners: Vec<Lattice>,
    /// For each corner, whether the edge that begins there is a diagonal of the input facet.
    pub seams: Vec<bool>,
    /// The number of the input facet.
    pub source: u32,
}

/// The largest number of corners of a facet; checking an outline takes quadratic time.
const MAX_CORNERS_PER_FACET: usize = 1 << 14;

/// The pitch that suits the largest coordinate of points and the extent of the box around them.
///
/// # Errors
/// `NonFinite`, `TooLarge`.
pub fn suited_pitch(rows: &[[f64; 3]]) -> Result<Pitch> {
    let (mut largest, mut extent) = (0.0f64, 0.0f64);
    for axis in 0..3 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (row, p) in rows.iter().enumerate() {
            poll();
            if !p[axis].is_finite() {
                let text = format!(
                    "corner {row} has the coordinate {}; coordinates must be finite",
                    p[axis]
                );
                return Err(Error::at(ErrorKind::NonFinite, vec![row as u64], text));
            }
            low = low.min(p[axis]);
            high = high.max(p[axis]);
        }
        if low <= high {
            largest = largest.max(low.abs()).max(high.abs());
            extent = extent.max(high - low);
        }
    }
    Pitch::suited(largest, extent)
}

/// Snaps the corners of facets to the lattice; coordinates from number `dimension` on become zero.
///
/// # Errors
/// `NonFinite`, `TooLarge`, with the row of the corner.
pub fn snap_corners(dimension: usize, rows: &[[f64; 3]], pitch: Pitch) -> Result<Vec<Lattice>> {
    let snap = |(row, p): (usize, &[f64; 3])| {
        let place = |e: Error| Error::at(e.kind(), vec![row as u64], e.message());
        let mut lattice = [0; 3];
        for axis in 0..dimension.min(3) {
            lattice[axis] = pitch.snap(p[axis]).map_err(place)?;
        }
        Ok(lattice)
    };
    let snapped: Vec<Lattice> = rows.iter().enumerate().map(snap).collect::<Result<_>>()?;
    check_reach(&snapped)?;
    Ok(snapped)
}

/// Verifies that all lattice coordinates are below 2^53 in magnitude, where the arithmetic is exact.
///
/// # Errors
/// `TooLarge`, with the row of the point.
pub fn check_reach(rows: &[Lattice]) -> Result<()> {
    let limit = (1u64 << COORDINATE_BITS) - 1;
    let beyond = |p: &Lattice| p.iter().any(|k| k.unsigned_abs() > limit);
    match rows.iter().position(beyond) {
        None => Ok(()),
        Some(row) => {
            let text = format!(
                "corner {row} is more than {limit} lattice steps from the origin; scale the corners down, or \
                 choose a coarser pitch"
            );
            Err(Error::at(ErrorKind::TooLarge, vec![row as u64], text))
        }
    }
}

/// Which flaws of facets are mended instead of refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lenience {
    /// Divide polygons that are not planar into triangles.
    pub triangulate_nonplanar: bool,
    /// Leave out segments without length and polygons without area.
    pub drop_flat: bool,
}

/// The convex pieces of facets; facet i has the corners `offsets[i]..offsets[i + 1]`.
///
/// # Errors
/// `Shape` if the offsets do not count up to the number of corners or a facet has too few or too many
/// corners; `Degenerate`, `NonPlanar`, `NotSimple`; each with the facet.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "offsets are checked first"
)]
pub fn facets(
    dimension: usize,
    corners: &[Lattice],
    offsets: &[i64],
    lenience: Lenience,
) -> Result<Vec<Facet>> {
    check_offsets(offsets, corners.len())?;
    let mut found = Vec::with_capacity(offsets.len());
    for (number, pair) in offsets.windows(2).enumerate() {
        poll();
        // Checked above: they count upwards from zero to the number of corners.
        let own = &corners[pair[0] as usize..pair[1] as usize];
        let source = u32::try_from(number).map_err(|_| {
            Error::new(
                ErrorKind::TooLarge,
                "there are more than 2^32 facets, the largest number allowed",
            )
        })?;
        let pieces = match dimension {
            3 => polygon(own, source, lenience.triangulate_nonplanar),
            _ => point_or_segment(dimension, own, source).map(|facet| vec![facet]),
        };
        match pieces {
            Ok(pieces) => found.extend(pieces),
            Err(e) if e.kind() == ErrorKind::Degenerate && lenience.drop_flat => {}
            Err(e) => return Err(e),
        }
    }
    Ok(found)
}

fn check_offsets(offsets: &[i64], count: usize) -> Result<()> {
    let ends = offsets.first() == Some(&0) && offsets.last().copied() == i64::try_from(count).ok();
    if ends && offsets.windows(2).all(|pair| pair[0] <= pair[1]) {
        return Ok(());
    }
    let text = format!("offsets must increase from 0 to the number of corners, {count}");
    Err(Error::new(ErrorKind::Shape, text))
}

fn facet_error(kind: ErrorKind, source: u32, text: &str) -> Error {
    Error::at(kind, vec![source.into()], format!("facet {source} {text}"))
}

fn point_or_segment(dimension: usize, corners: &[Lattice], source: u32) -> Result<Facet> {
    match corners {
        [_] if dimension == 1 => {}
        [a, b] if dimension == 2 && a != b => {}
        [_, _] if dimension == 2 => {
            let text = "is a segment of zero length on the lattice";
            return Err(facet_error(ErrorKind::Degenerate, source, text));
        }
        _ => {
            return Err(facet_error(
                ErrorKind::Shape,
                source,
                "has a wrong number of corners for its dimension",
            ))
        }
    }
    Ok(Facet {
        corners: corners.to_vec(),
        seams: vec![false; corners.len()],
        source,
    })
}

fn polygon(given: &[Lattice], source: u32, lenient: bool) -> Result<Vec<Facet>> {
    if given.len() < 3 || given.len() > MAX_CORNERS_PER_FACET {
        let text = "must have from 3 to 16384 corners";
        return Err(facet_error(ErrorKind::Shape, source, text));
    }
    let corners = without_flat_corners(given);
    let plane = newell_plane(&corners).ok_or_else(|| without_normal(&corners, source))?;
    let planar = corners.iter().all(|p| plane.side_of_lattice(p) == Side::On);
    if !planar && !lenient {
        let text = "is not planar on the lattice";
        return Err(facet_error(ErrorKind::NonPlanar, source, text));
    }
    let axes = projection(&plane);
    if planar && is_convex(&corners, axes) {
        let seams = vec![false; corners.len()];
        return Ok(vec![Facet {
            corners,
            seams,
            source,
        }]);
    }
    let crossed = || facet_error(ErrorKind::NotSimple, source, "crosses or touches itself");
    let parts = triangles(&corners, axes).ok_or_else(crossed)?;
    Ok(parts
        .iter()
        .map(|t| part_of_facet(&corners, t, source))
        .collect())
}

/// Returns the error that says why a polygon has no normal: it is flat, or its areas of opposite orientation
/// cancel.
fn without_normal(corners: &[Lattice], source: u32) -> Error {
    let (kind, text) = match corners {
        // Flat corners are removed: if more than three remain, the first three are not on one line.
        [a, b, c, _, ..] => match Plane::through(a, b, c) {
            Some(plane) if corners.iter().all(|p| plane.side_of_lattice(p) == Side::On) => {
                let text = "crosses itself, so that its signed area is zero";
                (ErrorKind::NotSimple, text)
            }
            _ => (ErrorKind::NonPlanar, "is not planar on the lattice"),
        },
        _ => (ErrorKind::Degenerate, "has no area on the lattice"),
    };
    facet_error(kind, source, text)
}

fn part_of_facet(corners: &[Lattice], triangle: &[usize; 3], source: u32) -> Facet {
    let is_seam = |i: usize| triangle[(i + 1) % 3] != (triangle[i] + 1) % corners.len();
    Facet {
        corners: triangle.map(|k| corners[k]).to_vec(),
        seams: (0..3).map(is_seam).collect(),
        source,
    }
}

/// The corners of a polygon without repeated corners and without corners on the line through their
/// neighbours; at least three remain.
fn without_flat_corners(given: &[Lattice]) -> Vec<Lattice> {
    let mut corners = given.to_vec();
    loop {
        let n = corners.len();
        let is_flat = |&i: &usize| {
            let [a, b, c] = [corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]];
            normal(&a, &b, &c) == [0; 3]
        };
        match (0..n).find(is_flat) {
            Some(flat) if n > 3 => {
                corners.remove(flat);
            }
            _ => return corners,
        }
    }
}

/// The plane through the first corner of a polygon whose normal is the sum of a fan's cross products: if all
/// corners lie in one plane, this plane, with the polygon counterclockwise. `None` if the sum is zero.
///
/// # Bits
/// A product of differences is below 2^108, two of them for each of 2^14 corners below 2^123.
fn newell_plane(corners: &[Lattice]) -> Option<Plane> {
    let first = corners.first()?;
    let mut sum = [0i128; 3];
    for pair in corners.windows(2) {
        poll();
        let n = normal(first, &pair[0], &pair[1]);
        for i in 0..3 {
            sum[i] += n[i];
        }
    }
    Plane::through_point(sum, first)
}

/// Two axes such that a counterclockwise polygon of this plane, projected to them, is counterclockwise.
fn projection(plane: &Plane) -> (usize, usize) {
    let axis = plane.main_axis();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    if plane.normal()[axis] > 0 {
        (u, v)
    } else {
        (v, u)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(corners: &[Lattice]) -> Option<ErrorKind> {
        let offsets = [0, i64::try_from(corners.len()).unwrap()];
        facets(3, corners, &offsets, Lenience::default())
            .err()
            .map(|e| e.kind())
    }

    #[test]
    fn a_square_stays_whole_and_loses_flat_corners() {
        let square = [
            [0, 0, 7],
            [2, 0, 7],
            [4, 0, 7],
            [4, 4, 7],
            [4, 4, 7],
            [0, 4, 7],
        ];
        let found = facets(3, &square, &[0, 6], Lenience::default()).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(
            found[0].corners,
            [[0, 0, 7], [4, 0, 7], [4, 4, 7], [0, 4, 7]]
        );
    }

    #[test]
    fn a_concave_polygon_keeps_its_source_and_marks_its_diagonal() {
        let arrow = [[0, 0, 0], [4, 2, 0], [0, 4, 0], [1, 2, 0]];
        let found = facets(3, &arrow, &[0, 4], Lenience::default()).unwrap();
        assert_eq!(found.len(), 2);
        for piece in &found {
            assert_eq!(piece.source, 0);
            assert_eq!(piece.seams.iter().filter(|s| **s).count(), 1);
        }
    }

    #[test]
    fn faults_are_named() {
        let line = [[0, 0, 0], [1, 1, 1], [2, 2, 2]];
        assert_eq!(kind(&line), Some(ErrorKind::Degenerate));
        let bent = [[0, 0, 0], [4, 0, 0], [4, 4, 1], [0, 4, 0]];
        assert_eq!(kind(&bent), Some(ErrorKind::NonPlanar));
        let bow = [[0, 0, 0], [4, 4, 0], [5, 1, 0], [0, 4, 0]];
        assert_eq!(kind(&bow), Some(ErrorKind::NotSimple));
        // The two halves of the figure have equal areas.
        let even = [[0, 0, 0], [4, 4, 0], [4, 0, 0], [0, 4, 0]];
        assert_eq!(kind(&even), Some(ErrorKind::NotSimple));
        let skew = [
            [1, 0, 2],
            [1, 0, 1],
            [0, 2, 2],
            [0, 0, 2],
            [1, 2, 1],
            [1, 2, 0],
        ];
        assert_eq!(kind(&skew), Some(ErrorKind::NonPlanar));
        let there_and_back = [[0, 0, 0], [4, 0, 0], [8, 0, 0], [4, 0, 0]];
        assert_eq!(kind(&there_and_back), Some(ErrorKind::Degenerate));
        assert_eq!(kind(&[[0, 0, 0], [1, 0, 0]]), Some(ErrorKind::Shape));
        let lenience = Lenience {
            triangulate_nonplanar: true,
            drop_flat: true,
        };
        assert_eq!(facets(3, &bent, &[0, 4], lenience).unwrap().len(), 2);
        assert!(facets(3, &line, &[0, 3], lenience).unwrap().is_empty());
    }

    #[test]
    fn the_pitch_suits_the_largest_coordinate() {
        let exponent = |x: f64| suited_pitch(&[[x, 0.0, 0.0]; 2]).unwrap().exponent();
        assert_eq!([5.0, 500.0, 1e9].map(exponent), [-9, -9, -6]);
    }
}
