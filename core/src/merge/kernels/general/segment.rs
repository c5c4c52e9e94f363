//! Computes the segments in which faces of different operands cross.

use std::sync::Arc;

use super::contact::{Face, Special};
use super::points::Points;
use super::Labels;
use crate::arith::Sign;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon, Sides};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::determinant;
use crate::merge::division::Spot;

/// The segment in which a face of another operand crosses an element; the minus side of that face is on its
/// left.
pub(super) struct Segment {
    pub(super) ends: [End; 2],
    /// The index of the other operand.
    pub(super) operand: usize,
    /// The plane of the crossing face.
    pub(super) plane: Arc<Plane>,
    /// True if the other operand's inside is on the plus side of this plane.
    pub(super) plus: bool,
}

/// An end of a segment on an element.
#[derive(Clone)]
pub(super) struct End {
    pub(super) at: Arc<Vertex>,
    /// Whether the end is a corner of the element, on one of its sides, or inside.
    pub(super) spot: Spot,
}

/// A face of another operand that may cross a given element.
pub(super) struct Crosser<'a> {
    pub(super) face: &'a Face<'a>,
    /// The number of the face among the elements of the cell.
    pub(super) number: u32,
    pub(super) operand: usize,
    /// The winding number on the minus side of the face, minus the number on its plus side.
    pub(super) weight: i32,
    /// The sides of the face's plane on which the element's corners lie.
    pub(super) ours: Sides,
    /// The sides of the element's plane on which the face's corners lie.
    pub(super) theirs: Sides,
}

impl Segment {
    /// Returns the bit of the other operand in labels.
    pub(super) fn bit(&self) -> Labels {
        1 << self.operand
    }
}

/// An element that faces of other operands may cross.
pub(super) struct Crossed<'a> {
    pub(super) polygon: &'a Polygon,
    pub(super) number: u32,
}

impl Crossed<'_> {
    /// Returns the segment in which a face crosses the element; `None` if it does not, an error if their
    /// position is degenerate.
    pub(super) fn segment(
        &self,
        other: &Crosser,
        points: &mut Points,
    ) -> Result<Option<Segment>, Special> {
        let has_corner = other.ours.contains(&Side::On) || other.theirs.contains(&Side::On);
        let ends = if has_corner {
            self.ends_by_order(other, points)?
        } else {
            self.ends(other, points)?
        };
        Ok(ends.map(|ends| Segment {
            ends,
            operand: other.operand,
            plane: Arc::clone(other.face.polygon.support()),
            plus: other.weight < 0,
        }))
    }

    /// Returns the ends of the segment in which a face crosses the element, if no corner of either lies in
    /// the other's plane; `None` if it does not cross.
    ///
    /// Along the common line of both planes, with the face's minus side on the left, the element reaches from
    /// x to x′ and the face from y to y′. If both borders meet in a point, the segment ends on the element's
    /// border. A single point is no segment.
    fn ends(&self, other: &Crosser, points: &mut Points) -> Result<Option<[End; 2]>, Special> {
        let face = &other.face.polygon;
        let [x, x_end] = [rise(&other.ours)?, fall(&other.ours)?].map(|p| p.edge);
        let [y, y_end] = [fall(&other.theirs)?, rise(&other.theirs)?].map(|p| p.edge);
        let mut inside = |edge: (usize, bool), rim: usize| self.inside(edge, other, rim, points);
        let no = |inside: Sign| inside != Sign::Positive;
        if no(inside((x_end, false), y)?) || no(inside((x, true), y_end)?) {
            return Ok(None);
        }
        let starts_here = inside((x, true), y)? != Sign::Negative;
        let ends_here = inside((x_end, false), y_end)? != Sign::Negative;
        let mut end = |here: bool, own: usize, theirs: usize| {
            let plane = (face.support(), other.number);
            let at = if here {
                points.at((self.polygon, own), plane)
            } else {
                points.at((face, theirs), (self.polygon.support(), self.number))
            };
            let spot = if here { Spot::Side(own) } else { Spot::Inside };
            at.map(|at| End { at, spot }).ok_or(Special)
        };
        Ok(Some([
            end(starts_here, x, y)?,
            end(ends_here, x_end, y_end)?,
        ]))
    }

    /// Returns the ends of the segment in which a face crosses the element, if corners may lie in the other's
    /// plane; `None` if it does not cross. It compares the order of points along the common line.
    fn ends_by_order(
        &self,
        other: &Crosser,
        points: &mut Points,
    ) -> Result<Option<[End; 2]>, Special> {
        let ours = (self.polygon, self.number);
        let theirs = (&*other.face.polygon, other.number);
        let mut end = |change: Change, of: (&Polygon, u32), across: (&Polygon, u32)| {
            let plane = (across.0.support(), across.1);
            change.point(of.0, plane, points).ok_or(Special)
        };
        let (rises, falls) = (rise(&other.ours)?, fall(&other.ours)?);
        let own = [end(rises, ours, theirs)?, end(falls, ours, theirs)?];
        let (falls, rises) = (fall(&other.theirs)?, rise(&other.theirs)?);
        let others = [end(falls, theirs, ours)?, end(rises, theirs, ours)?];
        let axis = own[0].at.axis_to(&own[1].at);
        let order = |p: &End, q: &End| p.at.compare_along(&q.at, axis);
        let onward = order(&own[0], &own[1]);
        let [x, x_end] = own;
        let [y, y_end] = others.map(|end| End {
            spot: Spot::Inside,
            ..end
        });
        let from = if order(&x, &y) == onward { y } else { x };
        let to = if order(&y_end, &x_end) == onward {
            y_end
        } else {
            x_end
        };
        Ok((order(&from, &to) == onward).then_some([from, to]))
    }

    /// Returns the side of the face's edge `rim` on which an edge of the element crosses the face's plane:
    /// positive on the inner side, zero on the edge. The flag says whether the element's edge leads to the
    /// plus side of the plane.
    fn inside(
        &self,
        (edge, rises): (usize, bool),
        other: &Crosser,
        rim: usize,
        points: &mut Points,
    ) -> Result<Sign, Special> {
        let face = &other.face.polygon;
        let carriers = (
            &self.polygon.corners()[edge].edge,
            &face.corners()[rim].edge,
        );
        if let (Carrier::Edge(edge), Carrier::Edge(rim)) = carriers {
            let turn = passes(edge.ends(), rim.ends());
            return Ok(if rises { turn } else { -turn });
        }
        let plane = (face.support(), other.number);
        let at = points.at((self.polygon, edge), plane).ok_or(Special)?;
        Ok(-at.side_of(&other.face.rims()[rim]).sign())
    }
}

/// A point at which the border of a polygon changes from one side of a plane to the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Change {
    /// The index of the edge that crosses the plane, or that begins at the corner in the plane.
    edge: usize,
    is_at_corner: bool,
}

impl Change {
    fn point(
        self,
        polygon: &Polygon,
        plane: (&Arc<Plane>, u32),
        points: &mut Points,
    ) -> Option<End> {
        let edge = self.edge;
        Some(if self.is_at_corner {
            let at = Arc::clone(&polygon.corners()[edge].at);
            let spot = Spot::Corner(edge);
            End { at, spot }
        } else {
            let at = points.at((polygon, edge), plane)?;
            let spot = Spot::Side(edge);
            End { at, spot }
        })
    }
}

/// Returns where a polygon, whose corners lie on these sides of a plane, changes to the plus side.
fn rise(sides: &[Side]) -> Result<Change, Special> {
    change(sides, (Side::Minus, Side::Plus))
}

/// Returns where a polygon, whose corners lie on these sides of a plane, changes to the minus side.
fn fall(sides: &[Side]) -> Result<Change, Special> {
    change(sides, (Side::Plus, Side::Minus))
}

fn change(sides: &[Side], (from, to): (Side, Side)) -> Result<Change, Special> {
    let n = sides.len();
    let at = |edge: usize| {
        let (here, next) = (sides[edge], sides[(edge + 1) % n]);
        let is_at_corner = here == Side::On && sides[(edge + n - 1) % n] == from;
        let changes = next == to && (here == from || is_at_corner);
        changes.then_some(Change { edge, is_at_corner })
    };
    (0..n).find_map(at).ok_or(Special)
}

/// Returns the side on which the line from a to b passes the directed edge from c to d: the sign of the
/// determinant of d − c, a − c and b − c.
fn passes((a, b): (&Lattice, &Lattice), (c, d): (&Lattice, &Lattice)) -> Sign {
    let from = |p: &Lattice| each_axis(|i| p[i] - c[i]);
    determinant(&from(d), &from(a), &from(b))
}

#[cfg(test)]
mod tests {
    use super::super::contact::{contact, Contact};
    use super::*;
    use crate::merge::scenes::triangle;
    use std::borrow::Cow;

    #[test]
    fn a_segment_is_what_both_have_of_the_line_in_which_their_planes_meet() {
        let crossed = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let face = Face::new(Cow::Owned(triangle([[1, 1, -4], [1, 1, 4], [1, 20, 1]])));
        let Contact::Crossing(ours, theirs) = contact(&crossed, &face) else {
            panic!("the face crosses the element");
        };
        let crosser = Crosser {
            face: &face,
            number: 1,
            operand: 1,
            weight: 1,
            ours,
            theirs,
        };
        let element = Crossed {
            polygon: &crossed,
            number: 0,
        };
        let found = element.segment(&crosser, &mut Points::default()).ok();
        let segment = found.flatten().expect("they cross");
        let ends = segment.ends;
        // The segment begins on an edge of the face, inside the element, and ends on the element's border.
        let [inner, outer] = [[1, 1, 0], [1, 7, 0]].map(Vertex::lattice);
        let at_outer = ends.each_ref().map(|end| end.at.same(&outer));
        assert!(ends.iter().any(|end| end.at.same(&inner)) && at_outer.contains(&true));
        assert_eq!(ends.map(|end| end.spot != Spot::Inside), at_outer);
    }

    #[test]
    fn a_polygon_changes_sides_twice_or_is_special() {
        let at = |edge: usize, is_at_corner: bool| Some(Change { edge, is_at_corner });
        let sides = [Side::Minus, Side::Plus, Side::Plus];
        assert_eq!(rise(&sides).ok(), at(0, false));
        assert_eq!(fall(&sides).ok(), at(2, false));
        let sides = [Side::On, Side::Plus, Side::Minus];
        assert_eq!(rise(&sides).ok(), at(0, true));
        assert_eq!(fall(&sides).ok(), at(1, false));
        assert!(rise(&[Side::Plus; 3]).is_err());
    }
}
