//! Images of boundaries of plane sets under lattice motions.

use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::convert::as_number;
use crate::geometry::spaces::dim2::Point2;
use crate::geometry::spaces::motion::Motion;
use crate::interrupt::poll;

use super::boundary::{Boundary, Corner, Edge};

impl Boundary {
    /// The image of the boundary of a bounded set, or of a set with a bounded complement, under a motion;
    /// `None` if it leaves the lattice.
    pub fn moved(&self, motion: &Motion) -> Option<Self> {
        let corners = self.corners.iter().map(|corner| corner.moved(motion));
        let corners: Vec<Corner> = corners.collect::<Option<_>>()?;
        let mut order: Vec<usize> = (0..corners.len()).collect();
        order.sort_by(|i, j| corners[*i].point.order(&corners[*j].point));
        let mut places = vec![0; corners.len()];
        for (place, old) in order.iter().enumerate() {
            places[*old] = as_number(place);
        }
        let edges = self.edges.iter().map(|edge| {
            poll();
            let [first, last] = edge.ends.map(|end| places[end as usize]);
            let ends = if motion.mirrors() {
                [last, first]
            } else {
                [first, last]
            };
            let line = motion.line(&edge.line)?;
            Some(Edge {
                line,
                ends,
                ..*edge
            })
        });
        let edges = edges.collect::<Option<_>>()?;
        let corners = order.iter().map(|old| corners[*old]).collect();
        Some(Self::sorted(self.outer, corners, edges))
    }
}

impl Corner {
    fn moved(&self, motion: &Motion) -> Option<Self> {
        let image = if let Some([x, y]) = self.point.as_lattice() {
            let [x, y, _] = motion.point(&[x, y, 0])?;
            Self::lattice([x, y])
        } else {
            let [p, q] = self.lines();
            Self::crossing(motion.line(p)?, motion.line(q)?)?
        };
        is_near(&image.point).then_some(image)
    }
}

/// Return whether a point lies in the square |x|, |y| ≤ [`MAX_COORDINATE`].
fn is_near(point: &Point2) -> bool {
    let [low, high] = [-MAX_COORDINATE, MAX_COORDINATE].map(|k| Point2::lattice([k, k]));
    let near =
        |axis: usize| point.compare(&low, axis).is_ge() && point.compare(&high, axis).is_le();
    near(0) && near(1)
}
