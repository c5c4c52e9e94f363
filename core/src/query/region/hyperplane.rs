//! Hyperplanes from doubles, on a lattice.

use std::sync::Arc;

use crate::error::{Error, ErrorKind, Result};
use crate::geometry::dim1::{Direction, Point1};
use crate::geometry::dim2::{Line2, REACH};
use crate::geometry::plane::Plane;
use crate::mesh::grid::Pitch;
use crate::mesh::import::oriented_foot;

/// The point at `offset / normal` with its minus side where normal·x < offset.
///
/// # Errors
/// `BadNormal`, `TooLarge`.
pub fn point(normal: f64, offset: f64, pitch: Pitch) -> Result<Point1> {
    let ([n, ..], [at, ..], _) = oriented_foot([normal, 0.0, 0.0], offset, pitch)?;
    let inside = if n > 0 {
        Direction::Below
    } else {
        Direction::Above
    };
    Ok(Point1::new(at, inside))
}

/// The line normal·x = offset with its minus side where normal·x is smaller.
///
/// # Errors
/// `BadNormal`, `TooLarge`.
pub fn line(normal: [f64; 2], offset: f64, pitch: Pitch) -> Result<Line2> {
    let ([a, b, _], [x, y, _], _) = oriented_foot([normal[0], normal[1], 0.0], offset, pitch)?;
    let narrow = |n: i128| i64::try_from(n).ok();
    narrow(a)
        .zip(narrow(b))
        .and_then(|(a, b)| Line2::with_normal([a, b], [x, y]))
        .ok_or_else(|| Error::new(ErrorKind::BadNormal, "the normal is too small"))
}

/// The plane normal·x = offset with its minus side where normal·x is smaller.
///
/// # Errors
/// `BadNormal`, `TooLarge`.
pub fn plane(normal: [f64; 3], offset: f64, pitch: Pitch) -> Result<Arc<Plane>> {
    let (n, foot, _) = oriented_foot(normal, offset, pitch)?;
    Plane::through_point(n, &foot)
        .map(Arc::new)
        .ok_or_else(|| Error::new(ErrorKind::BadNormal, "the normal is too small"))
}

/// A signed permutation of the axes with a positive scale before it and a shift after it.
#[derive(Clone, Debug)]
pub struct LatticeMap {
    /// For each new axis the old one it takes and its sign.
    pub axes: Vec<(usize, i64)>,
    /// Steps added at last.
    pub shift: Vec<i64>,
    /// The factor applied first.
    pub scale: i64,
}

impl LatticeMap {
    /// The image of a point.
    ///
    /// # Errors
    /// `TooLarge`.
    pub fn point(&self, p: &Point1) -> Result<Point1> {
        let (_, sign) = self.axes[0];
        let turned = match (p.inside(), sign < 0) {
            (Direction::Below, false) | (Direction::Above, true) => Direction::Below,
            _ => Direction::Above,
        };
        let at = p.at().checked_mul(self.scale * sign);
        at.and_then(|at| at.checked_add(self.shift[0]))
            .filter(|at| at.unsigned_abs() <= REACH.unsigned_abs())
            .map(|at| Point1::new(at, turned))
            .ok_or_else(too_large)
    }

    /// The image of a line.
    ///
    /// # Errors
    /// `TooLarge`.
    pub fn line(&self, line: &Line2) -> Result<Line2> {
        let (old, c) = line.coefficients();
        let normal = [0, 1].map(|i| old[self.axes[i].0] * self.axes[i].1);
        let shifted = |i: usize| i128::from(normal[i]) * i128::from(self.shift[i]);
        c.checked_mul(i128::from(self.scale))
            .and_then(|c| c.checked_sub(shifted(0) + shifted(1)))
            .and_then(|c| Line2::new(normal[0], normal[1], c))
            .ok_or_else(too_large)
    }

    /// The image of a plane.
    ///
    /// # Errors
    /// `TooLarge`.
    pub fn plane(&self, plane: &Plane) -> Result<Arc<Plane>> {
        let axes = [0, 1, 2].map(|i| self.axes[i]);
        let shift = [0, 1, 2].map(|i| self.shift[i]);
        plane
            .scaled(self.scale)
            .and_then(|p| p.moved(&axes, &shift))
            .map(Arc::new)
            .ok_or_else(too_large)
    }
}

fn too_large() -> Error {
    let text = "the moved or refined set does not fit the lattice of 2^53 steps";
    Error::new(ErrorKind::TooLarge, text)
}
