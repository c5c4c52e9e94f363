//! Closed curves on an element beside others: whether each has on its outside what surrounds it.
//!
//! From the point of a curve that lies farthest along an axis a ray goes on along that axis. The
//! first wall that it meets borders the region around the curve. If the two agree for each curve,
//! all agree: walls that are met lie farther along, so the way from wall to wall ends at the border.

use std::sync::Arc;

use super::border::Border;
use super::curves::turns_left;
use super::cutting::Special;
use super::walls::Walls;
use super::Labels;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// Points are within two units in the last place, sums of them aslant within four, and differences
/// of these within ten; the rest is room for the bound's own rounding.
const DOUBT: f64 = 16.0 * f64::EPSILON;

/// Curves times segments that are compared, at most: some milliseconds, more than halving the cell costs.
const MAX_CURVES_TIMES_SEGMENTS: usize = 1 << 20;

/// Rays run aslant by so much: things stand in rows along axes, and a ray along a
/// row would pass through corners.
const ASLANT: f64 = 0.137;

/// A point in two coordinates.
type Seen = [f64; 2];

/// The lines that rays meet.
struct Lines {
    /// The walls on the element, in their order.
    walls: Vec<[Seen; 2]>,
    /// The arcs of its border, with the labels on their left.
    border: Vec<(Labels, [Seen; 2])>,
}

/// An element seen along an axis.
pub(super) struct View<'a> {
    polygon: &'a Polygon,
    axes: [usize; 2],
    /// By how much differences of coordinates may be off.
    doubt: f64,
}

/// A closed curve.
struct Loop {
    /// The largest first coordinate of its points.
    reach: f64,
    /// The segment that begins there.
    first: usize,
    /// The bit of its operand in labels.
    bit: Labels,
    /// True if the inside of its operand is outside of it.
    is_outside: bool,
    /// Its segments.
    curve: Vec<usize>,
}

/// A wall that a ray meets: how far away, by how much that may be off, and the labels on the side
/// that the ray comes from, if they are known.
struct Met {
    at: f64,
    doubt: f64,
    labels: Option<Labels>,
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

    /// A point as the rays see it, which run along the first coordinate.
    fn place(&self, at: &Vertex) -> Seen {
        let [x, y] = self.axes.map(|i| at.approx()[i]);
        [x, y + ASLANT * x]
    }

    fn line(&self, ends: [&Arc<Vertex>; 2]) -> [Seen; 2] {
        ends.map(|end| self.place(end))
    }

    /// The closed curves, from the one that reaches farthest along the first axis on.
    fn loops(&self, walls: &Walls) -> Result<Vec<Loop>, Special> {
        let segments = &walls.segments;
        let mut loops = Vec::new();
        for curve in walls.joints.loops(segments) {
            poll();
            let at = |i: &usize| (segments[*i].from.at.approx()[self.axes[0]], *i);
            let last = curve.iter().map(at).max_by(|a, b| a.0.total_cmp(&b.0));
            let (reach, first) = last.ok_or(Special)?;
            loops.push(Loop {
                reach,
                first,
                bit: segments[first].bit(),
                is_outside: !turns_left(self.polygon, segments, &curve)?,
                curve,
            });
        }
        loops.sort_by(|a, b| b.reach.total_cmp(&a.reach));
        Ok(loops)
    }

    /// Labels what divides an element.
    pub(super) fn label(&self, walls: &mut Walls, border: &mut Border) -> Result<(), Special> {
        let loops = self.loops(walls)?;
        if loops.len().saturating_mul(walls.segments.len()) > MAX_CURVES_TIMES_SEGMENTS {
            return Err(Special);
        }
        let ending = border.operands();
        border.label(self.polygon, around_all(&loops, ending));
        for (segment, labels) in border.beginnings() {
            walls.spread(segment, labels)?;
        }
        if let ([only], 0) = (&loops[..], ending) {
            return walls.spread(only.first, border.corners[0] & !only.bit);
        }
        if loops.is_empty() {
            return Ok(());
        }
        let lines = self.lines(walls, border);
        for curve in &loops {
            poll();
            if walls.is_known(curve.first) {
                continue;
            }
            let labels = self.around(curve, &lines, walls)?;
            if (labels & curve.bit != 0) != curve.is_outside {
                return Err(Special);
            }
            walls.spread(curve.first, labels & !curve.bit)?;
        }
        Ok(())
    }

    fn lines(&self, walls: &Walls, border: &Border) -> Lines {
        let arcs = border.arcs(self.polygon);
        let arcs = arcs.iter();
        Lines {
            walls: walls.walls().map(|w| self.line([w.from, w.to])).collect(),
            border: arcs
                .map(|arc| (arc.labels, self.line([arc.from, arc.to])))
                .collect(),
        }
    }

    /// The labels of the region around a curve, beyond its farthest point.
    fn around(&self, curve: &Loop, lines: &Lines, walls: &Walls) -> Result<Labels, Special> {
        let from = self.place(&walls.segments[curve.first].from.at);
        let mut own = curve.curve.clone();
        own.sort_unstable();
        let mut met: Vec<Met> = Vec::new();
        for (wall, line) in walls.walls().zip(&lines.walls) {
            if self.may_meet(&from, line) && own.binary_search(&wall.segment).is_err() {
                let sides = wall.sides.map_or([None; 2], |sides| sides.map(Some));
                met.extend(self.meet(&from, line, sides)?);
            }
        }
        for (labels, line) in &lines.border {
            if self.may_meet(&from, line) {
                met.extend(self.meet(&from, line, [Some(*labels), None])?);
            }
        }
        let first = met.iter().min_by(|a, b| a.at.total_cmp(&b.at));
        let first = first.ok_or(Special)?;
        let rivals = |m: &Met| m.at - m.doubt <= first.at + first.doubt && m.labels != first.labels;
        if met.iter().any(rivals) {
            return Err(Special);
        }
        first.labels.ok_or(Special)
    }

    /// Return whether a ray from a point may meet a line, or pass so close that it is in doubt.
    fn may_meet(&self, from: &Seen, [a, b]: &[Seen; 2]) -> bool {
        let beside = |i: usize| a[i].max(b[i]) < from[i] - self.doubt;
        !(beside(0) || beside(1) || a[1].min(b[1]) > from[1] + self.doubt)
    }

    /// A wall with the labels on its left and on its right, as a ray meets it.
    fn meet(
        &self,
        from: &Seen,
        line: &[Seen; 2],
        sides: [Option<Labels>; 2],
    ) -> Result<Option<Met>, Special> {
        let [a, b] = line.map(|p| [p[0] - from[0], p[1] - from[1]]);
        if a[1].abs() <= self.doubt || b[1].abs() <= self.doubt {
            return Err(Special);
        }
        if (a[1] > 0.0) == (b[1] > 0.0) {
            return Ok(None);
        }
        let slope = (b[0] - a[0]) / (b[1] - a[1]);
        let at = a[0] - a[1] * slope;
        let doubt = self.doubt * (2.0 + 4.0 * slope.abs());
        if at.abs() <= doubt {
            return Err(Special);
        }
        let support = self.polygon.support();
        let faces_up = support.normal()[support.main_axis()] > 0;
        let labels = sides[usize::from((b[1] > 0.0) != faces_up)];
        Ok((at > 0.0).then_some(Met { at, doubt, labels }))
    }
}

/// Inside which of the operands the border lies, of those whose curves are all closed, farthest
/// first: the outermost curve of each has the border on its outside.
fn around_all(loops: &[Loop], ending: Labels) -> Labels {
    let (mut seen, mut labels) = (ending, 0);
    for curve in loops {
        if seen & curve.bit == 0 && curve.is_outside {
            labels |= curve.bit;
        }
        seen |= curve.bit;
    }
    labels
}
