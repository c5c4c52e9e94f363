//! Computes the segments in which faces of different operands cross.

use std::sync::Arc;

use super::contact::{Degenerate, Face};
use super::points::Points;
use super::Labels;
use crate::arith::Sign;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon, Sides};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::determinant;
use crate::merge::division::PositionInPolygon;

/// The segment in which a face of one operand crosses a face of another; the minus side of the crossing face
/// is on the segment's left.
pub(super) struct Segment {
    pub(super) ends: [SegmentEnd; 2],
    /// The index of the operand that has the crossing face.
    pub(super) operand: usize,
    /// The plane of the crossing face.
    pub(super) plane: Arc<Plane>,
    /// True if the inside of the crossing face's operand is on the plus side of this plane.
    pub(super) plus: bool,
}

/// An end of the segment in which a face of another operand crosses a face.
#[derive(Clone)]
pub(super) struct SegmentEnd {
    pub(super) at: Arc<Vertex>,
    /// Whether the end is a corner of the crossed face, on one of its sides, or inside.
    pub(super) position: PositionInPolygon,
}

/// A face of one operand that may cross the face or piece in a [`CrossedElement`], which belongs to another
/// operand.
pub(super) struct CrossingFace<'a> {
    pub(super) face: &'a Face<'a>,
    /// The number of the face among the faces and pieces of faces in the cell.
    pub(super) number: u32,
    pub(super) operand: usize,
    /// The winding number on the minus side of the face, minus the number on its plus side.
    pub(super) weight: i32,
    /// The sides of this face's plane on which the corners of the crossed face lie.
    pub(super) ours: Sides,
    /// The sides of the crossed face's plane on which the corners of this face lie.
    pub(super) theirs: Sides,
}

impl Segment {
    /// Returns the label with the bit of the operand that has the crossing face.
    pub(super) fn bit(&self) -> Labels {
        1 << self.operand
    }
}

/// A whole face, or a convex piece of a cut face, of one operand in a cell, which faces of other operands may
/// cross.
pub(super) struct CrossedElement<'a> {
    pub(super) polygon: &'a Polygon,
    pub(super) number: u32,
}

impl CrossedElement<'_> {
    /// Returns the segment in which a face of another operand crosses this face; `None` if it does not, an
    /// error if the two touch in a degenerate position.
    pub(super) fn segment(
        &self,
        other: &CrossingFace,
        points: &mut Points,
    ) -> Result<Option<Segment>, Degenerate> {
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

    /// Returns the ends of the segment in which a face of another operand crosses this face, if no corner of
    /// either lies in the other's plane; `None` if it does not cross.
    ///
    /// Along the common line of both planes, with the crossing face's minus side on the left, this face
    /// reaches from x to x′ and the crossing face from y to y′. If both borders meet in a point, the segment
    /// ends on the border of this face. A single point is no segment.
    fn ends(
        &self,
        other: &CrossingFace,
        points: &mut Points,
    ) -> Result<Option<[SegmentEnd; 2]>, Degenerate> {
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
            let position = if here {
                PositionInPolygon::Side(own)
            } else {
                PositionInPolygon::Inside
            };
            at.map(|at| SegmentEnd { at, position }).ok_or(Degenerate)
        };
        Ok(Some([
            end(starts_here, x, y)?,
            end(ends_here, x_end, y_end)?,
        ]))
    }

    /// Returns the ends of the segment in which a face of another operand crosses this face, if corners may
    /// lie in the other's plane; `None` if it does not cross. It compares the order of points along the
    /// common line.
    fn ends_by_order(
        &self,
        other: &CrossingFace,
        points: &mut Points,
    ) -> Result<Option<[SegmentEnd; 2]>, Degenerate> {
        let ours = (self.polygon, self.number);
        let theirs = (&*other.face.polygon, other.number);
        let mut end = |change: Change, of: (&Polygon, u32), across: (&Polygon, u32)| {
            let plane = (across.0.support(), across.1);
            change.point(of.0, plane, points).ok_or(Degenerate)
        };
        let (rises, falls) = (rise(&other.ours)?, fall(&other.ours)?);
        let own = [end(rises, ours, theirs)?, end(falls, ours, theirs)?];
        let (falls, rises) = (fall(&other.theirs)?, rise(&other.theirs)?);
        let others = [end(falls, theirs, ours)?, end(rises, theirs, ours)?];
        let axis = own[0].at.axis_to(&own[1].at);
        let order = |p: &SegmentEnd, q: &SegmentEnd| p.at.compare_along(&q.at, axis);
        let onward = order(&own[0], &own[1]);
        let [x, x_end] = own;
        let [y, y_end] = others.map(|end| SegmentEnd {
            position: PositionInPolygon::Inside,
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

    /// Returns the side of the other face's edge `rim` on which an edge of this face crosses the other face's
    /// plane: positive on the inner side, zero on the edge. The flag says whether this face's edge leads to
    /// the plus side of the plane.
    fn inside(
        &self,
        (edge, rises): (usize, bool),
        other: &CrossingFace,
        rim: usize,
        points: &mut Points,
    ) -> Result<Sign, Degenerate> {
        let face = &other.face.polygon;
        let carriers = (
            &self.polygon.corners()[edge].edge,
            &face.corners()[rim].edge,
        );
        if let (Carrier::Edge(edge), Carrier::Edge(rim)) = carriers {
            let turn = passing_side(edge.ends(), rim.ends());
            return Ok(if rises { turn } else { -turn });
        }
        let plane = (face.support(), other.number);
        let at = points.at((self.polygon, edge), plane).ok_or(Degenerate)?;
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
    ) -> Option<SegmentEnd> {
        let edge = self.edge;
        Some(if self.is_at_corner {
            let at = Arc::clone(&polygon.corners()[edge].at);
            let position = PositionInPolygon::Corner(edge);
            SegmentEnd { at, position }
        } else {
            let at = points.at((polygon, edge), plane)?;
            let position = PositionInPolygon::Side(edge);
            SegmentEnd { at, position }
        })
    }
}

/// Returns where a polygon, whose corners lie on these sides of a plane, changes to the plus side.
fn rise(sides: &[Side]) -> Result<Change, Degenerate> {
    change(sides, (Side::Minus, Side::Plus))
}

/// Returns where a polygon, whose corners lie on these sides of a plane, changes to the minus side.
fn fall(sides: &[Side]) -> Result<Change, Degenerate> {
    change(sides, (Side::Plus, Side::Minus))
}

fn change(sides: &[Side], (from, to): (Side, Side)) -> Result<Change, Degenerate> {
    let n = sides.len();
    let at = |edge: usize| {
        let (here, next) = (sides[edge], sides[(edge + 1) % n]);
        let is_at_corner = here == Side::On && sides[(edge + n - 1) % n] == from;
        let changes = next == to && (here == from || is_at_corner);
        changes.then_some(Change { edge, is_at_corner })
    };
    (0..n).find_map(at).ok_or(Degenerate)
}

/// Returns the side on which the line from a to b passes the directed edge from c to d: the sign of the
/// determinant of d − c, a − c and b − c.
fn passing_side((a, b): (&Lattice, &Lattice), (c, d): (&Lattice, &Lattice)) -> Sign {
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
        let crossing_face = CrossingFace {
            face: &face,
            number: 1,
            operand: 1,
            weight: 1,
            ours,
            theirs,
        };
        let element = CrossedElement {
            polygon: &crossed,
            number: 0,
        };
        let found = element.segment(&crossing_face, &mut Points::default()).ok();
        let segment = found.flatten().expect("they cross");
        let ends = segment.ends;
        // The segment begins on an edge of the face, inside the element, and ends on the element's border.
        let [inner, outer] = [[1, 1, 0], [1, 7, 0]].map(Vertex::lattice);
        let at_outer = ends.each_ref().map(|end| end.at.equals(&outer));
        assert!(ends.iter().any(|end| end.at.equals(&inner)) && at_outer.contains(&true));
        assert_eq!(
            ends.map(|end| end.position != PositionInPolygon::Inside),
            at_outer
        );
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
