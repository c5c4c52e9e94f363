//! Closed curves on an element beside others: whether each has on its outside what surrounds it.
//!
//! From the point of a curve that lies farthest along an axis a ray goes on along that axis. The
//! first wall that it meets borders the region around the curve. If the two agree for each curve,
//! all agree: walls that are met lie farther along, so the way from wall to wall ends at the border.

use super::curves::turns_left;
use super::cutting::Special;
use super::segment::Segment;
use crate::geometry::outline::BareEdge;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// Points are within two units in the last place, differences of them within four; the rest is room
/// for the bound's own rounding.
const DOUBT: f64 = 16.0 * f64::EPSILON;

/// So many curves times segments are compared: some milliseconds, more than halving the cell costs.
const MOST: usize = 1 << 18;

/// An element seen along an axis.
pub(super) struct View<'a> {
    polygon: &'a Polygon,
    axes: [usize; 2],
    /// By how much differences of coordinates may be off.
    doubt: f64,
}

/// A wall that a ray meets: how far away, by how much that may be off, and whether the side that
/// the ray comes from is inside.
struct Met {
    at: f64,
    doubt: f64,
    inside: bool,
}

impl<'a> View<'a> {
    pub(super) fn of(polygon: &'a Polygon) -> Self {
        let axis = polygon.support().main_axis();
        let (low, high) = polygon.bounds();
        let size = low.iter().chain(&high).fold(0.0f64, |m, x| m.max(x.abs()));
        Self {
            polygon,
            axes: [(axis + 1) % 3, (axis + 2) % 3],
            doubt: DOUBT * size,
        }
    }

    /// The point of a curve that lies farthest along the first axis.
    fn farthest<'s>(&self, curve: &[&'s Segment]) -> &'s Vertex {
        let along = |s: &&&Segment| s.from.at.approx()[self.axes[0]];
        let first = curve.iter().max_by(|s, t| along(s).total_cmp(&along(t)));
        &first.unwrap_or(&curve[0]).from.at
    }

    /// Return whether the border of the element is inside, where no curve ends on it.
    pub(super) fn border_is_inside(&self, curves: &[Vec<&Segment>]) -> Result<bool, Special> {
        let along = |c: &&Vec<&Segment>| self.farthest(c).approx()[self.axes[0]];
        let outermost = curves.iter().max_by(|c, d| along(c).total_cmp(&along(d)));
        Ok(!turns_left(self.polygon, outermost.ok_or(Special)?)?)
    }

    /// Check that each closed curve has on its outside what surrounds it, given the parts of the
    /// border outside and inside.
    pub(super) fn check(
        &self,
        segments: &[Segment],
        border: &[Vec<BareEdge>; 2],
        curves: &[Vec<&Segment>],
    ) -> Result<(), Special> {
        if curves.len().saturating_mul(segments.len()) > MOST {
            return Err(Special);
        }
        for curve in curves {
            poll();
            let outside = !turns_left(self.polygon, curve)?;
            if self.around(self.farthest(curve), curve, segments, border)? != outside {
                return Err(Special);
            }
        }
        Ok(())
    }

    /// Return whether the region around a curve, beyond its farthest point, is inside.
    fn around(
        &self,
        from: &Vertex,
        own: &[&Segment],
        segments: &[Segment],
        border: &[Vec<BareEdge>; 2],
    ) -> Result<bool, Special> {
        let mut own: Vec<*const Segment> = own.iter().map(|s| std::ptr::from_ref(*s)).collect();
        own.sort_unstable();
        let is_own = |s: &Segment| own.binary_search(&std::ptr::from_ref(s)).is_ok();
        let mut met: Vec<Met> = Vec::new();
        for segment in segments.iter().filter(|s| !is_own(s)) {
            let [a, b] = [&segment.from.at, &segment.to.at];
            met.extend(self.meet(from, [a, b], true)?);
            met.extend(self.meet(from, [b, a], false)?);
        }
        for (inside, edges) in [false, true].into_iter().zip(border) {
            for edge in edges {
                met.extend(self.meet(from, [&edge.from, &edge.to], inside)?);
            }
        }
        let first = met.iter().min_by(|a, b| a.at.total_cmp(&b.at));
        let first = first.ok_or(Special)?;
        let rivals = |m: &Met| m.at - m.doubt <= first.at + first.doubt && m.inside != first.inside;
        if met.iter().any(rivals) {
            return Err(Special);
        }
        Ok(first.inside)
    }

    /// The wall between two points, with a region on its left, as a ray meets it from that side.
    fn meet(
        &self,
        from: &Vertex,
        wall: [&Vertex; 2],
        inside: bool,
    ) -> Result<Option<Met>, Special> {
        let origin = from.approx();
        let [a, b] = wall.map(|p| {
            let p = p.approx();
            self.axes.map(|i| p[i] - origin[i])
        });
        if a[0].max(b[0]) < -self.doubt {
            return Ok(None);
        }
        if a[1].abs() <= self.doubt || b[1].abs() <= self.doubt {
            return Err(Special);
        }
        let support = self.polygon.support();
        let faces_up = support.normal()[support.main_axis()] > 0;
        if (a[1] > 0.0) == (b[1] > 0.0) || (b[1] > 0.0) != faces_up {
            return Ok(None);
        }
        let slope = (b[0] - a[0]) / (b[1] - a[1]);
        let at = a[0] - a[1] * slope;
        let doubt = self.doubt * (2.0 + 4.0 * slope.abs());
        if at.abs() <= doubt {
            return Err(Special);
        }
        Ok((at > 0.0).then_some(Met { at, doubt, inside }))
    }
}
