//! Converts hyperplanes from and to Python, where they are rows of integers: the normal, then the offset, in
//! lattice steps.

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

/// Makes an error about the form of an input.
pub fn shape(text: impl Into<String>) -> Error {
    Error::new(ErrorKind::Shape, text)
}

/// A normal and an offset: the hyperplane normal·x = offset.
pub type Row = Vec<BigInt>;

/// Splits a row into the normal and the offset.
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

/// Converts a number to three 64-bit limbs; `None` if it does not fit.
fn integer(value: &BigInt) -> Option<Int<3>> {
    let (sign, digits) = value.to_u64_digits();
    let mut limbs = [0; 4];
    limbs.get_mut(..digits.len())?.copy_from_slice(&digits);
    let size = Int::<4>::from_limbs(limbs);
    let fits = !size.is_negative();
    let signed = if sign == Sign::Minus { -size } else { size };
    fits.then(|| signed.narrow())?
}

/// Converts a row of two numbers to a point on the line.
pub fn on_line(row: &[BigInt]) -> Result<Point1> {
    let ([n], offset) = coefficients(row)?;
    point(n, &offset)
}

/// Converts a row of three numbers to a line in the plane.
pub fn in_plane(row: &[BigInt]) -> Result<Line2> {
    let (normal, offset) = coefficients(row)?;
    line(normal, &offset)
}

/// Converts a row of four numbers to a plane in space.
pub fn in_space(row: &[BigInt]) -> Result<Arc<Plane>> {
    let (normal, offset) = coefficients(row)?;
    plane(normal, &offset)
}

/// A space whose hyperplanes are made from rows of integers.
pub trait FromRow: Affine {
    /// Converts a row, the normal and the offset, to a hyperplane.
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

/// Converts a hyperplane to a row: the normal and the offset.
pub fn row_of<S: Affine>(cut: &S::Hyperplane) -> Row {
    let [a, b, c, d] = S::exact(cut);
    let mut row: Row = [a, b, c].into_iter().take(S::DIM).collect();
    row.push(-d);
    row
}
