//! Hyperplanes from Python: rows of integers, the normal and then the offset, in lattice steps.

use std::sync::Arc;

use num_bigint::{BigInt, Sign};

use crate::arith::Int;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;
use crate::geometry::spaces::affine::Affine;
use crate::geometry::spaces::dim1::{Dim1, Point1};
use crate::geometry::spaces::dim2::{Dim2, Line2};
use crate::geometry::spaces::dim3::Dim3;
use crate::mesh::half_space::out_of_reach;
use crate::query::region::hyperplane::{line, plane, point};

/// An error about the form of an input.
pub fn shape(text: impl Into<String>) -> Error {
    Error::new(ErrorKind::Shape, text)
}

/// A normal and an offset: the hyperplane normal·x = offset.
pub type Row = Vec<BigInt>;

/// The normal and the offset of a row.
///
/// # Errors
/// `Shape` for a row of another length, `TooLarge` for numbers that no hyperplane has.
pub fn coefficients<const N: usize>(row: &[BigInt]) -> Result<([i128; N], Int<3>)> {
    let wrong = || {
        shape(format!(
            "a hyperplane must have {} numbers, not {}",
            N + 1,
            row.len()
        ))
    };
    let (offset, normal) = row.split_last().ok_or_else(wrong)?;
    let normal: &[BigInt; N] = normal.try_into().map_err(|_| wrong())?;
    let mut narrow = [0; N];
    for (narrow, wide) in narrow.iter_mut().zip(normal) {
        *narrow = i128::try_from(wide).map_err(|_| out_of_reach())?;
    }
    Ok((narrow, integer(offset).ok_or_else(out_of_reach)?))
}

/// The number in three limbs, if it fits.
fn integer(value: &BigInt) -> Option<Int<3>> {
    let (sign, digits) = value.to_u64_digits();
    let mut limbs = [0; 4];
    limbs.get_mut(..digits.len())?.copy_from_slice(&digits);
    let size = Int::<4>::from_limbs(limbs);
    let fits = !size.is_negative();
    let signed = if sign == Sign::Minus { -size } else { size };
    fits.then(|| signed.narrow())?
}

/// A row as a point of the line.
pub fn on_line(row: &[BigInt]) -> Result<Point1> {
    let ([n], offset) = coefficients(row)?;
    point(n, &offset)
}

/// A row as a line of the plane.
pub fn in_plane(row: &[BigInt]) -> Result<Line2> {
    let (normal, offset) = coefficients(row)?;
    line(normal, &offset)
}

/// A row as a plane of space.
pub fn in_space(row: &[BigInt]) -> Result<Arc<Plane>> {
    let (normal, offset) = coefficients(row)?;
    plane(normal, &offset)
}

/// A space whose hyperplanes come as rows.
pub trait FromRow: Affine {
    /// A row as a hyperplane.
    ///
    /// # Errors
    /// `Shape`, `BadNormal`, `TooLarge`.
    fn from_row(row: &[BigInt]) -> Result<Self::Hyperplane>;
}

impl FromRow for Dim1 {
    fn from_row(row: &[BigInt]) -> Result<Point1> {
        on_line(row)
    }
}

impl FromRow for Dim2 {
    fn from_row(row: &[BigInt]) -> Result<Line2> {
        in_plane(row)
    }
}

impl FromRow for Dim3 {
    fn from_row(row: &[BigInt]) -> Result<Arc<Plane>> {
        in_space(row)
    }
}

/// A hyperplane as a row: the normal and the offset.
pub fn row_of<S: Affine>(cut: &S::Hyperplane) -> Row {
    let [a, b, c, d] = S::exact(cut);
    let mut row: Row = [a, b, c].into_iter().take(S::DIM).collect();
    row.push(-d);
    row
}
