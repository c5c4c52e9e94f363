//! Motions that map the lattice into itself, in one to three dimensions, and images of points and
//! hyperplanes.

use super::dim1::{Direction, Point1};
use super::dim2::Line2;
use crate::arith::bounds::{is_coordinate, MAX_COORDINATE};
use crate::geometry::plane::{Lattice, Plane};

/// A map of the lattice into itself: a signed permutation of the axes, a scale and a shift.
///
/// On the line and in the plane, the motion leaves the missing axes unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Motion {
    /// For each new axis, the old axis whose coordinates it takes, and their sign.
    pub axes: [(usize, i64); 3],
    /// The translation that is applied last, in lattice steps.
    pub shift: Lattice,
    /// A positive factor that is applied first.
    pub scale: i64,
}

impl Motion {
    /// The motion that changes nothing.
    pub const IDENTITY: Self = Self {
        axes: [(0, 1), (1, 1), (2, 1)],
        shift: [0; 3],
        scale: 1,
    };

    /// Return, for each old axis, whether its coordinates are shifted.
    pub fn shifted(&self) -> [bool; 3] {
        let mut shifted = [false; 3];
        for ((axis, _), shift) in self.axes.iter().zip(self.shift) {
            shifted[*axis] = shift != 0;
        }
        shifted
    }

    /// The motion that takes, for each new axis, the coordinates of an old axis, counted from 1 and with its
    /// sign, and then shifts them.
    ///
    /// `None` if `axes` is not a signed permutation of at most three axes, or `shift` has another length.
    pub fn of_axes(axes: &[i64], shift: &[i64]) -> Option<Self> {
        let mut sorted: Vec<u64> = axes.iter().map(|a| a.unsigned_abs()).collect();
        sorted.sort_unstable();
        let permutes = (1..).zip(&sorted).all(|(i, a)| i == *a);
        if axes.len() > 3 || axes.len() != shift.len() || !permutes {
            return None;
        }
        let mut motion = Self::IDENTITY;
        for (i, (axis, shift)) in axes.iter().zip(shift).enumerate() {
            let old = sorted.iter().position(|a| *a == axis.unsigned_abs())?;
            motion.axes[i] = (old, axis.signum());
            motion.shift[i] = *shift;
        }
        Some(motion)
    }

    /// Return whether the motion reverses orientation, as a mirror does.
    pub fn mirrors(&self) -> bool {
        let order = self.axes.map(|a| a.0);
        let even = matches!(order, [0, 1, 2] | [1, 2, 0] | [2, 0, 1]);
        let signs: i64 = self.axes.iter().map(|a| a.1).product();
        even != (signs > 0)
    }

    /// The image of a lattice point; `None` if a coordinate leaves the lattice.
    pub fn point(&self, p: &Lattice) -> Option<Lattice> {
        let mut image = [0; 3];
        for (i, (axis, sign)) in self.axes.into_iter().enumerate() {
            image[i] = self
                .coordinate(p[axis], sign, i)
                .filter(|k| is_coordinate(*k))?;
        }
        Some(image)
    }

    fn coordinate(&self, old: i64, sign: i64, axis: usize) -> Option<i64> {
        let turned = old.checked_mul(self.scale * sign)?;
        turned.checked_add(self.shift[axis])
    }

    /// The image of an oriented point of the line; `None` if it exceeds [`MAX_COORDINATE`].
    pub fn end(&self, p: &Point1) -> Option<Point1> {
        let (_, sign) = self.axes[0];
        let turned = match (p.inside(), sign < 0) {
            (Direction::Below, false) | (Direction::Above, true) => Direction::Below,
            _ => Direction::Above,
        };
        self.coordinate(p.at(), sign, 0)
            .filter(|at| at.unsigned_abs() <= MAX_COORDINATE.unsigned_abs())
            .map(|at| Point1::new(at, turned))
    }

    /// The image of a line of the plane; `None` if its coefficients become too wide.
    pub fn line(&self, line: &Line2) -> Option<Line2> {
        let (old, c) = line.coefficients();
        let normal = [0, 1].map(|i| old[self.axes[i].0] * self.axes[i].1);
        let shifted = |i: usize| i128::from(normal[i]) * i128::from(self.shift[i]);
        c.checked_mul(i128::from(self.scale))
            .and_then(|c| c.checked_sub(shifted(0) + shifted(1)))
            .and_then(|c| Line2::new(normal[0], normal[1], c))
    }

    /// The image of a plane of space; `None` if its coefficients become too wide.
    pub fn plane(&self, plane: &Plane) -> Option<Plane> {
        plane.scaled(self.scale)?.moved(&self.axes, &self.shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn about z and a step along x.
    fn turned() -> Motion {
        Motion::of_axes(&[-2, 1, 3], &[1, 0, 0]).expect("a motion")
    }

    #[test]
    fn points_and_planes_go_together() {
        let corners = [[3, 0, 0], [0, 5, 0], [0, 0, 7]];
        let plane = |c: &[Lattice; 3]| Plane::through(&c[0], &c[1], &c[2]).expect("a plane");
        let image = turned().plane(&plane(&corners)).expect("it fits");
        assert_eq!(turned().point(&corners[0]), Some([1, 3, 0]));
        assert_eq!(
            image,
            plane(&corners.map(|p| turned().point(&p).expect("near")))
        );
    }

    #[test]
    fn a_mirror_is_told_from_a_turn() {
        assert!(!turned().mirrors());
        assert!(Motion::of_axes(&[1, 2, -3], &[0; 3])
            .expect("a motion")
            .mirrors());
        assert!(Motion::of_axes(&[2, 1, 3], &[0; 3])
            .expect("a motion")
            .mirrors());
    }

    #[test]
    fn what_is_no_motion_is_refused() {
        assert!(Motion::of_axes(&[1, 1, 3], &[0; 3]).is_none());
        assert!(Motion::of_axes(&[1, 0], &[0; 2]).is_none());
        assert!(Motion::of_axes(&[1, 2, 3], &[0; 2]).is_none());
    }

    #[test]
    fn nothing_leaves_the_lattice() {
        let far = Motion::of_axes(&[1, 2, 3], &[MAX_COORDINATE - 1, 0, 0]).expect("a motion");
        assert_eq!(far.point(&[0; 3]), Some([MAX_COORDINATE - 1, 0, 0]));
        assert_eq!(far.point(&[1, 0, 0]), None);
    }
}
