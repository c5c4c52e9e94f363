//! Slabs: intervals of triangles along diagonals of the axes. Slanted triangles overlap less often in slabs
//! than in boxes.
//!
//! Rounding keeps the order of numbers, and so do rounded sums and differences. So two slabs that overlap
//! still overlap after rounding.
//!
//! # Source
//! Klosowski, Held, Mitchell, Sowizral, Zikan 1998, "Efficient collision detection using bounding volume
//! hierarchies of k-DOPs".

use super::{Point, Triangle};

/// The number of lanes in which slabs are compared: six directions and two of padding.
const LANES: usize = 8;

/// The intervals that a triangle covers along six diagonals of the axes, in single precision.
#[derive(Clone, Copy, Debug)]
pub struct Slabs {
    low: [f32; LANES],
    high: [f32; LANES],
}

impl Slabs {
    /// The slabs of a triangle, relative to an origin near it; two triangles can be compared only if they
    /// have the same origin.
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounding keeps the order of numbers"
    )]
    pub fn of(triangle: &Triangle, origin: &Point) -> Self {
        let from = across(origin);
        let [a, b, c] = triangle.map(|p| across(&p));
        let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..6 {
            low[i] = (a[i].min(b[i]).min(c[i]) - from[i]) as f32;
            high[i] = (a[i].max(b[i]).max(c[i]) - from[i]) as f32;
        }
        Self { low, high }
    }

    /// Return whether the intervals of two triangles are disjoint along some diagonal; the triangles then
    /// have no point in common.
    #[inline]
    pub fn miss(&self, others: &Self) -> bool {
        let word = |b: bool| if b { !0u32 } else { 0 };
        let mut miss = [0; LANES];
        for (i, miss) in miss.iter_mut().enumerate() {
            *miss = word(self.low[i] > others.high[i]) | word(others.low[i] > self.high[i]);
        }
        miss.iter().fold(0, |all, one| all | one) != 0
    }
}

/// The coordinates of a point along the six diagonals.
fn across([x, y, z]: &Point) -> [f64; 6] {
    [x + y, x - y, y + z, y - z, z + x, z - x]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_side_by_side_miss_each_other_though_boxes_overlap() {
        let needle = |at: f64| [[at, -at, 0.0], [9.0 + at, 9.0 - at, 0.0], [9.0, 9.0, 0.1]];
        let slabs = [0.0, 1.0, 2.0].map(|at| Slabs::of(&needle(at), &[0.5; 3]));
        let apart = Slabs::of(
            &[[2.0, 0.0, 0.0], [9.0, 6.0, 0.0], [9.0, 5.0, 1.0]],
            &[0.5; 3],
        );
        assert!(slabs[0].miss(&apart) && apart.miss(&slabs[0]));
        assert!(!slabs[0].miss(&slabs[1]) && !slabs[1].miss(&slabs[2]));
    }

    #[test]
    fn triangles_with_a_point_in_common_do_not_miss_each_other() {
        for at in [0.1, 7e6 + 0.3, 1e-300, 1e300] {
            let corner = [at, at / 3.0, -at];
            let [one, other] = [0.7, 1.3].map(|x| [corner, corner.map(|c| c * x), [at * x; 3]]);
            let [one, other] = [one, other].map(|t| Slabs::of(&t, &[at; 3]));
            assert!(!one.miss(&other) && !other.miss(&one));
        }
    }
}
