//! The segments in which elements cross each other.

use std::sync::Arc;

use super::cutting::{Cutter, Face, Special};
use super::points::Points;
use super::Labels;
use crate::arith::Sign;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon, Sides};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::determinant;

/// A directed segment on an element, with the inside of another operand on its left.
pub(super) struct Segment {
    pub(super) from: End,
    pub(super) to: End,
    /// The other operand.
    pub(super) operand: usize,
    /// The plane of the face in which it lies.
    pub(super) plane: Arc<Plane>,
    /// The number of that face.
    pub(super) number: u32,
    /// True if that operand's inside is on the plus side of the plane.
    pub(super) plus: bool,
}

/// An end of a segment.
#[derive(Clone)]
pub(super) struct End {
    pub(super) at: Arc<Vertex>,
    /// The edge of the element on which it lies, if it lies on its border.
    pub(super) edge: Option<usize>,
}

/// A face of another operand that may cross an element.
pub(super) struct Crosser<'a> {
    pub(super) face: &'a Face<'a>,
    /// The element it is.
    pub(super) number: u32,
    pub(super) operand: usize,
    /// By how much the winding number on its minus side exceeds that on its plus side.
    pub(super) weight: i32,
    /// On which sides of its plane the element's corners lie.
    pub(super) ours: Sides,
    /// On which sides of the element's plane its corners lie.
    pub(super) theirs: Sides,
}

impl Segment {
    /// The bit of its operand in labels.
    pub(super) fn bit(&self) -> Labels {
        1 << self.operand
    }
}

impl<'a> Crosser<'a> {
    /// The face as the autopartition sees it.
    pub(super) fn cutter(&self) -> Cutter<'a> {
        Cutter {
            face: self.face,
            operand: self.operand,
            weight: self.weight,
        }
    }
}

/// An element that is crossed.
pub(super) struct Crossed<'a> {
    pub(super) polygon: &'a Polygon,
    pub(super) number: u32,
}

impl Crossed<'_> {
    /// The segment in which a face crosses the element, if it does.
    ///
    /// Along the line in which the planes meet, with the face's minus side on the left, the element
    /// reaches from x to x′ and the face from y to y′; the segment is what both have. Where both
    /// borders meet in a point, it ends on the element's; what is no longer than a point is none.
    pub(super) fn segment(
        &self,
        other: &Crosser,
        points: &mut Points,
    ) -> Result<Option<Segment>, Special> {
        if other.ours.contains(&Side::On) || other.theirs.contains(&Side::On) {
            return Err(Special);
        }
        let face = &other.face.polygon;
        let [x, x_end] = [rise(&other.ours)?, fall(&other.ours)?];
        let [y, y_end] = [fall(&other.theirs)?, rise(&other.theirs)?];
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
            let edge = here.then_some(own);
            at.map(|at| End { at, edge }).ok_or(Special)
        };
        let (from, to) = (end(starts_here, x, y)?, end(ends_here, x_end, y_end)?);
        let plus = other.weight < 0;
        let (from, to) = if plus { (to, from) } else { (from, to) };
        let plane = Arc::clone(face.support());
        Ok(Some(Segment {
            from,
            to,
            operand: other.operand,
            plane,
            number: other.number,
            plus,
        }))
    }

    /// Return where the point in which an edge of the element, on its way to the face's plus side
    /// or back, crosses the face's plane lies: positive on the inner side of one of the face's own
    /// edges, zero on it.
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

/// The edge on which a polygon with corners on these sides changes to the plus side.
fn rise(sides: &[Side]) -> Result<usize, Special> {
    change(sides, (Side::Minus, Side::Plus))
}

/// The edge on which it changes back.
fn fall(sides: &[Side]) -> Result<usize, Special> {
    change(sides, (Side::Plus, Side::Minus))
}

fn change(sides: &[Side], wanted: (Side, Side)) -> Result<usize, Special> {
    let n = sides.len();
    let found = (0..n).find(|i| (sides[*i], sides[(i + 1) % n]) == wanted);
    found.ok_or(Special)
}

/// On which side of a directed edge another one passes: positive if it rises on its left.
fn passes((a, b): (&Lattice, &Lattice), (c, d): (&Lattice, &Lattice)) -> Sign {
    let from = |p: &Lattice| each_axis(|i| p[i] - c[i]);
    determinant(&from(d), &from(a), &from(b))
}

#[cfg(test)]
mod tests {
    use super::super::cutting::{contact, Contact};
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
        let ends = [&segment.from, &segment.to];
        // It begins on the face's own edge, inside the element, and ends on the element's border.
        let [inner, outer] = [[1, 1, 0], [1, 7, 0]].map(Vertex::lattice);
        let at_outer = ends.map(|end| end.at.same(&outer));
        assert!(ends.iter().any(|end| end.at.same(&inner)) && at_outer.contains(&true));
        assert_eq!(ends.map(|end| end.edge.is_some()), at_outer);
    }

    #[test]
    fn a_polygon_changes_sides_twice_or_is_special() {
        let sides = [Side::Minus, Side::Plus, Side::Plus];
        assert_eq!((rise(&sides).ok(), fall(&sides).ok()), (Some(0), Some(2)));
        assert!(rise(&[Side::Plus; 3]).is_err());
    }
}
