//! Tests whether two faces cross, or touch in a degenerate position.

use std::borrow::Cow;
use std::cell::OnceCell;

use crate::arith::Filtered;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{straddle, Corner, Polygon, Sides};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::polygon_change_on_path;

/// A convex polygon and, computed at first use, the planes through its sides.
#[derive(Debug)]
pub struct Face<'a> {
    /// The polygon of the face.
    pub polygon: Cow<'a, Polygon>,
    rims: OnceCell<Vec<Plane>>,
}

impl<'a> Face<'a> {
    /// Makes a face from a polygon.
    pub fn new(polygon: Cow<'a, Polygon>) -> Self {
        let rims = OnceCell::new();
        Self { polygon, rims }
    }

    /// Returns for each side of the polygon a plane through it, with the polygon on its minus side.
    pub fn rims(&self) -> &[Plane] {
        let rim = |c: &Corner| c.edge.rim(self.polygon.support());
        self.rims
            .get_or_init(|| self.polygon.corners().iter().map(rim).collect())
    }

    /// Returns the change of the winding number where a path crosses the face, or that it is doubtful;
    /// `geometry::winding::path` describes the path.
    pub fn change_on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        polygon_change_on_path(self.polygon.support(), || self.rims(), from, to)
    }

    /// Returns true if a point of the face's plane lies in the face or on its border.
    fn contains(&self, point: &Vertex) -> bool {
        self.rims()
            .iter()
            .all(|rim| point.side_of(rim) != Side::Plus)
    }
}

/// The error that faces lie in a special (degenerate) position: a face touches another one without crossing
/// it, or segments contradict each other. Local trees solve such cells.
///
/// The position is certain, unlike `Filtered::Doubtful`: computing with more digits would not change it.
pub(super) struct Degenerate;

/// How a face meets a polygon.
#[derive(Debug)]
pub enum Contact {
    /// The face and the polygon neither cross nor touch.
    None,
    /// The face may cross the polygon: the sides of the face's plane on which the polygon's corners lie, and
    /// the sides of the polygon's plane on which the face's corners lie.
    Crossing(Sides, Sides),
    /// The face may touch the polygon without crossing it.
    Degenerate,
}

/// Returns how a face meets a polygon, by the sides of each plane on which the other's corners lie.
pub fn contact(polygon: &Polygon, face: &Face<'_>) -> Contact {
    let theirs = face.polygon.sides(polygon.support());
    let crossed = straddle(&theirs) == (true, true);
    let ours = polygon.sides(face.polygon.support());
    if !crossed && theirs.iter().filter(|s| **s == Side::On).count() > 1 {
        let apart = straddle(&ours) != (true, true) && !ours.contains(&Side::On);
        let flat = theirs.iter().all(|s| *s == Side::On);
        return if apart || flat && lie_apart(polygon, &face.polygon) {
            Contact::None
        } else {
            Contact::Degenerate
        };
    }
    let mut corners = ours.iter().zip(polygon.corners());
    if corners.any(|(side, corner)| *side == Side::On && face.contains(&corner.at)) {
        return Contact::Degenerate;
    }
    if crossed && straddle(&ours) == (true, true) {
        return Contact::Crossing(ours, theirs);
    }
    Contact::None
}

/// Returns true if the line of an edge of one polygon strictly separates two polygons of one plane.
fn lie_apart(polygon: &Polygon, other: &Polygon) -> bool {
    let beyond_an_edge = |a: &Polygon, b: &Polygon| {
        let rims = a.corners().iter().map(|c| c.edge.rim(a.support()));
        let beyond = |rim: Plane| b.corners().iter().all(|c| c.at.side_of(&rim) == Side::Plus);
        rims.into_iter().any(beyond)
    };
    beyond_an_edge(polygon, other) || beyond_an_edge(other, polygon)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::triangle;

    #[test]
    fn a_face_in_the_plane_of_the_polygon_is_special() {
        let polygon = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let flat = Face::new(Cow::Owned(triangle([[1, 1, 0], [2, 1, 0], [1, 2, 0]])));
        assert!(matches!(contact(&polygon, &flat), Contact::Degenerate));
    }

    #[test]
    fn faces_in_the_plane_of_the_polygon_that_lie_apart_from_it_are_none() {
        let polygon = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let meets = |corners| contact(&polygon, &Face::new(Cow::Owned(triangle(corners))));
        let flat = [[9, 1, 0], [12, 1, 0], [9, 4, 0]];
        assert!(matches!(meets(flat), Contact::None));
        let touching = [[8, 0, 0], [12, 1, 0], [9, 4, 0]];
        assert!(matches!(meets(touching), Contact::Degenerate));
        let upright = [[9, 1, 0], [9, 4, 0], [9, 2, 5]];
        assert!(matches!(meets(upright), Contact::None));
        let across = [[4, -1, 0], [4, 2, 0], [4, 1, 5]];
        assert!(matches!(meets(across), Contact::Degenerate));
    }
}
