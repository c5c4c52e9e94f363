//! Sources of half-spaces whose planes meet the lattice.

use std::sync::Arc;

use super::finding::{Finding, Severity};
use super::grid::Pitch;
use super::source::{Shape, Source};
use crate::arith::Int;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;

/// The source of the half-space of all points with normal·x ≤ offset, in lattice steps.
///
/// If the plane was moved onto the lattice, `rounded` is the text of a finding that says how far.
///
/// # Errors
/// As [`bounding_plane`].
///
/// # Example
/// ```
/// use bspcsg::arith::Int;
/// use bspcsg::geometry::side::Side;
/// use bspcsg::mesh::grid::Pitch;
/// use bspcsg::mesh::half_space::half_space;
/// use bspcsg::mesh::handle::FaceId;
///
/// // All points with z ≤ 7 steps.
/// let below = half_space([0, 0, 1], &Int::from_i64(7), Pitch::DEFAULT, None)?;
/// assert_eq!(below.plane(FaceId::ONLY).side_of_lattice(&[0, 0, 8]), Side::Plus);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn half_space(
    normal: [i128; 3],
    offset: &Int<3>,
    pitch: Pitch,
    rounded: Option<String>,
) -> Result<Source> {
    let plane = bounding_plane(normal, offset)?;
    let note = |text| Finding::about("half_space_rounded", Severity::Note, &[0], text);
    let findings = rounded.map(note).into_iter().collect();
    let shape = Shape::HalfSpace(Arc::new(plane));
    Ok(Source::new(pitch, shape, findings))
}

/// The plane normal·x = offset, in lattice steps, with smaller values on its minus side.
///
/// # Errors
/// `BadNormal` if the normal is zero, `TooLarge` if it is wider than 106 bits or the plane misses the
/// lattice.
pub fn bounding_plane(normal: [i128; 3], offset: &Int<3>) -> Result<Plane> {
    if normal == [0; 3] {
        return Err(Error::new(
            ErrorKind::BadNormal,
            "the normal of a hyperplane is the zero vector",
        ));
    }
    Plane::across_lattice(normal, offset).ok_or_else(out_of_reach)
}

/// The error for a hyperplane that lies outside the lattice.
pub fn out_of_reach() -> Error {
    let text = "the hyperplane is more than 2^53 lattice steps from the origin; choose a hyperplane nearer \
                to the origin";
    Error::new(ErrorKind::TooLarge, text)
}
