//! Hyperplanes with integer coefficients, or through lattice points.

use std::sync::Arc;

use crate::arith::bounds::is_coordinate;
use crate::arith::Int;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;
use crate::geometry::spaces::dim1::{Direction, Point1};
use crate::geometry::spaces::dim2::Line2;
use crate::mesh::half_space::{bounding_plane, out_of_reach};

/// Makes the point normal·x = offset of the line, with its minus side where normal·x is smaller.
///
/// # Errors
/// `BadNormal` if the normal is not ±1, `TooLarge` if the point is beyond the lattice.
pub fn point(normal: i128, offset: &Int<3>) -> Result<Point1> {
    let inside = match normal {
        1 => Direction::Below,
        -1 => Direction::Above,
        _ => {
            return Err(bad_normal(
                "the normal of a point on the line must be 1 or −1",
            ))
        }
    };
    let at = offset.to_i128().map(|offset| normal * offset);
    at.and_then(|at| i64::try_from(at).ok())
        .filter(|at| is_coordinate(*at))
        .map(|at| Point1::new(at, inside))
        .ok_or_else(out_of_reach)
}

/// Makes the line normal·x = offset of the plane, with its minus side where normal·x is smaller.
///
/// # Errors
/// `BadNormal` if the normal is zero, `TooLarge` if it is too wide or the line misses the lattice.
pub fn line(normal: [i128; 2], offset: &Int<3>) -> Result<Line2> {
    if normal == [0; 2] {
        return Err(bad_normal("the normal of a hyperplane is the zero vector"));
    }
    let narrow = |n: i128| i64::try_from(n).ok();
    let line =
        || Line2::across_lattice([narrow(normal[0])?, narrow(normal[1])?], offset.to_i128()?);
    line().ok_or_else(out_of_reach)
}

/// Makes the plane normal·x = offset, with its minus side where normal·x is smaller.
///
/// # Errors
/// `BadNormal` if the normal is zero, `TooLarge` if it is too wide or the plane misses the lattice.
pub fn plane(normal: [i128; 3], offset: &Int<3>) -> Result<Arc<Plane>> {
    bounding_plane(normal, offset).map(Arc::new)
}

/// Makes the line through a lattice point in a direction (−b, a), for a normal (a, b); the direction is
/// rounded to 53 bits.
///
/// # Errors
/// `BadNormal`.
pub fn line_along(origin: [i64; 2], direction: [f64; 2]) -> Result<Line2> {
    let size = direction[0].abs().max(direction[1].abs());
    if !(size > 0.0 && size.is_finite()) {
        return Err(bad_normal(
            "a direction must be finite and not the zero vector",
        ));
    }
    let power = 2f64.powf(size.log2().floor());
    let [x, y] = direction.map(|c| (c / power * 2f64.powi(52)).round() as i64);
    Line2::with_normal([y, -x], origin).ok_or_else(|| bad_normal("the direction is too short"))
}

fn bad_normal(text: &str) -> Error {
    Error::new(ErrorKind::BadNormal, text)
}
