//! Homogeneous coordinates as integers of any fixed width.

use crate::arith::{inv_mod, mul_mod, Int, Sign, P1};
use crate::geometry::plane::{Plane, ShortPlane};

/// The homogeneous coordinates of the point (x/w, y/w, z/w), with w > 0.
#[derive(Clone, Debug)]
pub struct Homogeneous<const N: usize = 6> {
    /// The numerators: the point's x, y and z times w.
    pub x: [Int<N>; 3],
    /// The positive denominator.
    pub w: Int<N>,
}

impl<const N: usize> Homogeneous<N> {
    /// The point with these homogeneous coordinates, all negated if w is negative; `None` if w is zero.
    pub(super) fn positive(x: [Int<N>; 3], w: Int<N>) -> Option<Self> {
        match w.sign() {
            Sign::Zero => None,
            Sign::Positive => Some(Self { x, w }),
            Sign::Negative => {
                let x = [-x[0], -x[1], -x[2]];
                Some(Self { x, w: -w })
            }
        }
    }

    /// The coordinates x, y, z and w, each rounded to the nearest double.
    pub fn approx(&self) -> [f64; 4] {
        let [x, y, z] = &self.x;
        [x.to_f64(), y.to_f64(), z.to_f64(), self.w.to_f64()]
    }

    /// The same coordinates as integers of six limbs.
    pub fn widened(&self) -> Homogeneous {
        let [x, y, z] = &self.x;
        Homogeneous {
            x: [x.widen(), y.widen(), z.widen()],
            w: self.w.widen(),
        }
    }

    pub(super) fn residues(&self) -> [u64; 3] {
        let w = self.w.rem_u61(P1);
        if w == 0 {
            return [u64::MAX; 3];
        }
        let inverse = inv_mod(w, P1);
        let over = |x: &Int<N>| mul_mod(x.rem_u61(P1), inverse, P1);
        [over(&self.x[0]), over(&self.x[1]), over(&self.x[2])]
    }
}

impl Homogeneous {
    /// A plane's value at this point, times w.
    pub fn value(&self, plane: &Plane) -> Int<8> {
        let n = plane.normal();
        let term = |i: usize| -> Int<8> { self.x[i].mul_i128(n[i]) };
        let last: Int<8> = self.w.mul(plane.offset());
        term(0) + term(1) + term(2) + last
    }
}

impl Homogeneous<4> {
    pub(super) fn value(&self, plane: &ShortPlane) -> Int<6> {
        let term = |i: usize| -> Int<6> { self.x[i].mul_i64(plane.n[i]) };
        let last: Int<6> = self.w.mul_i128(plane.d);
        term(0) + term(1) + term(2) + last
    }
}
