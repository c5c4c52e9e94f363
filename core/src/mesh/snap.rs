//! Snaps many points to the lattice at once, with the same results as for single points.

use super::grid::{snap_point, Pitch};
use super::tasks::fill_chunks;
use crate::error::{Error, Result};
use crate::geometry::plane::Lattice;

/// The doubles around 1.5·2^52 are exactly the integers, so adding this number rounds to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Below this magnitude, the sum with [`ROUNDER`] stays in the range where doubles are exactly the integers.
#[allow(clippy::cast_precision_loss, reason = "a small constant")]
const ROUNDER_LIMIT: f64 = (1u64 << 51) as f64;

/// The lattice points nearest to points in model units.
///
/// # Errors
/// As [`Pitch::snap`], with the first row whose point does not fit.
pub fn snap_all(points: &[[f64; 3]], pitch: Pitch) -> Result<Vec<Lattice>> {
    let mut lattice = vec![[0; 3]; points.len()];
    let snap = |first: usize, points: &[[f64; 3]], lattice: &mut [Lattice]| {
        snap_chunk(points, pitch, first, lattice)
    };
    let chunks = fill_chunks(points, &mut lattice, snap);
    chunks.into_iter().collect::<Result<()>>()?;
    Ok(lattice)
}

fn snap_chunk(
    points: &[[f64; 3]],
    pitch: Pitch,
    first_row: usize,
    lattice: &mut [Lattice],
) -> Result<()> {
    if let Some(power) = pitch.steps_per_unit()
        && snap_clear(points, power, lattice)
    {
        return Ok(());
    }
    for (row, (point, place)) in points.iter().zip(lattice).enumerate() {
        *place = snap_point(pitch, point).map_err(|e| at_row(&e, first_row + row))?;
    }
    Ok(())
}

fn at_row(error: &Error, row: usize) -> Error {
    let text = format!("vertex {row}: {}", error.message());
    Error::at(error.kind(), vec![row as u64], text)
}

/// Rounds coordinates times `power` to integers; returns whether all of them are certain.
///
/// The rounded product is within `f64::EPSILON / 2` of the exact one, relatively. If its distance to an
/// integer is below one half by more than that, this integer is nearest to the exact product.
fn snap_clear(points: &[[f64; 3]], power: f64, lattice: &mut [Lattice]) -> bool {
    let mut clear = true;
    for (point, place) in points.as_flattened().iter().zip(lattice.as_flattened_mut()) {
        let product = point * power;
        let sum = product + ROUNDER;
        let rest = product - (sum - ROUNDER);
        clear &= product.abs() < ROUNDER_LIMIT;
        clear &= rest.abs() + product.abs() * f64::EPSILON < 0.5;
        *place = sum
            .to_bits()
            .cast_signed()
            .wrapping_sub(ROUNDER.to_bits().cast_signed());
    }
    clear
}

#[cfg(test)]
mod tests {
    use super::{snap_all, ROUNDER_LIMIT};
    use crate::arith::convert::as_double;
    use crate::mesh::grid::{snap_point, Pitch};
    use proptest::prelude::*;

    /// Doubles at the middle between two lattice points, next to it, and anywhere else.
    fn coordinate() -> impl Strategy<Value = f64> {
        let middle = |k: i64, ulps: i64| {
            let x = (as_double(k) + 0.5) / 1e9;
            f64::from_bits((x.to_bits().cast_signed() + ulps).cast_unsigned())
        };
        prop_oneof![
            (-(1i64 << 40)..1 << 40, -2i64..3).prop_map(move |(k, u)| middle(k, u)),
            (-(1i64 << 53)..1 << 53, -2i64..3).prop_map(move |(k, u)| middle(k, u)),
            -1e3..1e3,
            -9e6..9e6,
            Just(-0.0),
        ]
    }

    proptest! {
        #[test]
        fn points_snap_as_one_by_one(
            rows in prop::collection::vec([coordinate(), coordinate(), coordinate()], 1..40),
            exponent in -9i64..3,
        ) {
            let pitch = Pitch::new(exponent).unwrap();
            let singly: Result<Vec<_>, _> = rows.iter().map(|p| snap_point(pitch, p)).collect();
            match (snap_all(&rows, pitch), singly) {
                (Ok(lattice), Ok(expected)) => prop_assert_eq!(lattice, expected),
                (Err(e), Err(expected)) => prop_assert_eq!(e.kind(), expected.kind()),
                (all, singly) => prop_assert!(false, "{:?} against {:?}", all, singly),
            }
        }
    }

    #[test]
    fn the_first_row_that_does_not_fit_is_named() {
        let pitch = Pitch::DEFAULT;
        let rows = [[0.0; 3], [ROUNDER_LIMIT, 0.0, 0.0], [f64::NAN; 3]];
        assert_eq!(snap_all(&rows, pitch).unwrap_err().place(), [1]);
        let rows = [[1.0, 0.0, f64::NAN], [ROUNDER_LIMIT, 0.0, 0.0]];
        assert_eq!(snap_all(&rows, pitch).unwrap_err().place(), [0]);
    }
}
