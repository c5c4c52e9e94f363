//! A polygon cut up by the faces that truly cross it, and how winding numbers differ on the pieces.
//!
//! A planar autopartition: each cut is the supporting plane of a face that meets the piece at hand,
//! so that a polygon is divided by what crosses it and by nothing else. Pieces on the two sides of
//! a face are tied by the jump of the winding number across it; the ties connect all pieces.
//!
//! Everything is for general position. Faces that touch the polygon in edges, in one plane with it,
//! or that meet it in one and the same segment are for the local trees: the answer is `None`.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

use smallvec::SmallVec;

use crate::arith::convert::as_number;
use crate::arith::Filtered;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{straddle, Chord, Corner, Polygon, Sides};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::polygon_on_path;
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A convex polygon and the planes that bound it within its own, once somebody asks for them.
#[derive(Debug)]
pub struct Face<'a> {
    /// The polygon.
    pub polygon: Cow<'a, Polygon>,
    rims: OnceCell<Vec<Plane>>,
}

impl<'a> Face<'a> {
    /// A face.
    pub fn new(polygon: Cow<'a, Polygon>) -> Self {
        let rims = OnceCell::new();
        Self { polygon, rims }
    }

    /// The planes of its border, the face on their minus sides.
    pub fn rims(&self) -> &[Plane] {
        let rim = |c: &Corner| c.edge.rim(self.polygon.support());
        self.rims
            .get_or_init(|| self.polygon.corners().iter().map(rim).collect())
    }

    /// The change of the winding number across the face along a path; see `geometry::winding::path`.
    pub fn on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        polygon_on_path(self.polygon.support(), || self.rims(), from, to)
    }

    /// Return whether a segment in the plane of the face meets its interior, for a segment whose
    /// plane has corners of the face strictly on both sides.
    fn meets(&self, segment: &Chord) -> bool {
        let beyond = |rim: &Plane| segment.iter().all(|end| end.side_of(rim) != Side::Minus);
        !self.rims().iter().any(beyond)
    }

    /// Return whether a point in the plane of the face lies in it or on its border.
    fn holds(&self, point: &Vertex) -> bool {
        self.rims()
            .iter()
            .all(|rim| point.side_of(rim) != Side::Plus)
    }
}

/// A face of another operand.
#[derive(Clone, Copy, Debug)]
pub struct Cutter<'a> {
    /// The face, or a convex piece of it.
    pub face: &'a Face<'a>,
    /// The operand that it belongs to.
    pub operand: usize,
    /// By how much the winding number on its minus side exceeds that on its plus side.
    pub weight: i32,
}

/// The winding number of an operand on piece `plus` exceeds that on piece `minus` by `change`.
#[derive(Clone, Copy, Debug)]
pub struct Tie {
    /// A piece.
    pub minus: u32,
    /// Another piece.
    pub plus: u32,
    /// The operand.
    pub operand: usize,
    /// The change.
    pub change: i32,
}

/// The pieces of a polygon, and ties that connect them all.
#[derive(Debug, Default)]
pub struct Cutting {
    /// The pieces.
    pub pieces: Vec<Polygon>,
    /// The ties.
    pub ties: Vec<Tie>,
}

#[derive(Clone, Copy)]
enum Child {
    Knot(NodeId),
    Piece(u32),
}

struct Knot {
    children: [Child; 2],
    chord: Chord,
    cutter: u32,
}

type Cutters = SmallVec<[u32; 8]>;

struct Task {
    polygon: Polygon,
    cutters: Cutters,
    parent: Option<(NodeId, usize)>,
}

/// A cutter that divides a piece.
struct Crossing {
    cutter: u32,
    sides: Sides,
    chord: Chord,
}

/// A special position, for which there is no rule here: a corner lies in another plane, a face runs
/// along a cut that another one made, or curves may touch themselves.
///
/// This is exact, unlike `Filtered::Doubtful`, and about places rather than a solid, unlike
/// `Simplicity`: no further digits settle it, only a way that needs no rule.
pub(super) struct Special;

struct Partition<'a> {
    support: Arc<Plane>,
    cutters: &'a [Cutter<'a>],
    knots: Vec<Knot>,
    pieces: Vec<Polygon>,
}

/// Cuts a polygon up by those of the given faces that cross it.
pub fn cut_up(polygon: Polygon, cutters: &[Cutter]) -> Option<Cutting> {
    let partition = Partition::of(polygon, cutters)?;
    let ties = partition.ties()?;
    let pieces = partition.pieces;
    Some(Cutting { pieces, ties })
}

impl<'a> Partition<'a> {
    /// A polygon divided by some faces; `None` where something is special.
    fn of(polygon: Polygon, cutters: &'a [Cutter<'a>]) -> Option<Self> {
        let mut partition = Self {
            support: Arc::clone(polygon.support()),
            cutters,
            knots: Vec::new(),
            pieces: Vec::new(),
        };
        let mut open = vec![Task {
            polygon,
            cutters: (0..as_number(cutters.len())).collect(),
            parent: None,
        }];
        while let Some(task) = open.pop() {
            poll();
            let parent = task.parent;
            let child = partition.grow(task, &mut open)?;
            if let Some((knot, side)) = parent {
                partition.knots[knot.place()].children[side] = child;
            }
        }
        Some(partition)
    }
}

impl Partition<'_> {
    fn polygon(&self, cutter: u32) -> &Polygon {
        &self.cutters[cutter as usize].face.polygon
    }

    fn plane(&self, cutter: u32) -> &Arc<Plane> {
        self.polygon(cutter).support()
    }

    fn grow(&mut self, task: Task, open: &mut Vec<Task>) -> Option<Child> {
        let mut rest = task.cutters;
        let whole = task.parent.is_none();
        let found = self.first_crossing(&task.polygon, &mut rest, whole);
        let Some(found) = found.ok()? else {
            self.pieces.push(task.polygon);
            return Some(Child::Piece(as_number(self.pieces.len()) - 1));
        };
        self.leave_coplanar(&found, &mut rest)?;
        let cut = self.plane(found.cutter);
        let (minus, plus) = task.polygon.divided(cut, &found.sides, &found.chord);
        let knot = NodeId::of(self.knots.len());
        self.knots.push(Knot {
            children: [Child::Piece(0); 2],
            chord: found.chord,
            cutter: found.cutter,
        });
        for (side, polygon) in [(1, plus), (0, minus)] {
            open.push(Task {
                polygon,
                cutters: rest.clone(),
                parent: Some((knot, side)),
            });
        }
        Some(Child::Knot(knot))
    }

    /// The first cutter that divides a piece; those before it are taken off the list.
    fn first_crossing(
        &self,
        piece: &Polygon,
        list: &mut Cutters,
        whole: bool,
    ) -> Result<Option<Crossing>, Special> {
        while let Some(cutter) = list.pop() {
            poll();
            let plane = self.plane(cutter);
            let sides = piece.sides(plane);
            if straddle(&sides) != (true, true) {
                if !whole && sides.iter().filter(|s| **s == Side::On).count() > 1 {
                    return Err(Special);
                }
                continue;
            }
            let chord = piece.chord(plane, &sides);
            if self.cutters[cutter as usize].face.meets(&chord) {
                return Ok(Some(Crossing {
                    cutter,
                    sides,
                    chord,
                }));
            }
        }
        Ok(None)
    }

    /// Takes the cutters in the plane of a crossing off the list; they must not overlap it.
    fn leave_coplanar(&self, crossing: &Crossing, list: &mut Cutters) -> Option<()> {
        let cutter = self.cutters[crossing.cutter as usize];
        let mut link = None;
        let mut general = true;
        list.retain(|other| {
            let other = self.cutters[*other as usize];
            let plane = other.face.polygon.support();
            if plane.coincides(cutter.face.polygon.support()).is_none() {
                return true;
            }
            if other.face.meets(&crossing.chord) {
                let link = link.get_or_insert_with(|| self.link(crossing.cutter, &crossing.chord));
                general &= other.operand == cutter.operand
                    && link.as_ref().is_some_and(|l| !other.face.meets(l));
            }
            false
        });
        general.then_some(())
    }

    /// The part of a chord on its cutter.
    fn link(&self, cutter: u32, chord: &Chord) -> Option<Chord> {
        let face = self.cutters[cutter as usize].face;
        let mut rims = face.rims().iter();
        rims.try_fold(chord.clone(), |link, rim| {
            self.clipped(link, face.polygon.support(), rim, Side::Minus)
        })
    }

    /// The part of a segment in a cutter's plane on one side of another plane.
    fn clipped(
        &self,
        segment: Chord,
        plane: &Arc<Plane>,
        cut: &Plane,
        keep: Side,
    ) -> Option<Chord> {
        let inside = |v: &Vertex| [keep, Side::On].contains(&v.side_of(cut));
        let stay = [inside(&segment[0]), inside(&segment[1])];
        if stay == [true, true] {
            return Some(segment);
        }
        let cut = Arc::new(cut.clone());
        let at = Arc::new(Vertex::meet(&self.support, plane, &cut)?);
        match stay {
            [true, false] => Some(Chord::from_buf([Arc::clone(&segment[0]), at])),
            [false, true] => Some(Chord::from_buf([at, Arc::clone(&segment[1])])),
            _ => None,
        }
    }

    fn ties(&self) -> Option<Vec<Tie>> {
        self.knots.iter().map(|knot| self.tie(knot)).collect()
    }

    fn tie(&self, knot: &Knot) -> Option<Tie> {
        let cutter = self.cutters[knot.cutter as usize];
        let [minus, plus] = match knot.children {
            [Child::Piece(minus), Child::Piece(plus)] => [minus, plus],
            children => {
                let link = self.link(knot.cutter, &knot.chord)?;
                let (minus, link) = self.beside(children[0], link, knot.cutter)?;
                let (plus, _) = self.beside(children[1], link, knot.cutter)?;
                [minus, plus]
            }
        };
        Some(Tie {
            minus,
            plus,
            operand: cutter.operand,
            change: -cutter.weight,
        })
    }

    /// A piece that some part of a link borders, and that part.
    fn beside(&self, from: Child, link: Chord, cutter: u32) -> Option<(u32, Chord)> {
        let (mut at, mut link) = (from, link);
        loop {
            poll();
            let knot = match at {
                Child::Piece(piece) => return Some((piece, link)),
                Child::Knot(knot) => &self.knots[knot.place()],
            };
            let cut = self.plane(knot.cutter);
            let sides = [link[0].side_of(cut), link[1].side_of(cut)];
            match straddle(&sides) {
                (false, false) => return None,
                (false, true) => at = knot.children[1],
                (minus, plus) => {
                    if plus && minus {
                        link = self.clipped(link, self.plane(cutter), cut, Side::Minus)?;
                    }
                    at = knot.children[0];
                }
            }
        }
    }
}

/// The ways in which a face may meet a polygon.
#[derive(Debug)]
pub enum Contact {
    /// Not in a way that matters.
    None,
    /// It may cross it: the sides of its plane on which the polygon's corners lie, and of the
    /// polygon's plane on which its own do.
    Crossing(Sides, Sides),
    /// Its position is special.
    Special,
}

/// Return how a face may meet a polygon whose bounds it shares.
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
            Contact::Special
        };
    }
    let mut corners = ours.iter().zip(polygon.corners());
    if corners.any(|(side, corner)| *side == Side::On && face.holds(&corner.at)) {
        return Contact::Special;
    }
    if crossed && straddle(&ours) == (true, true) {
        return Contact::Crossing(ours, theirs);
    }
    Contact::None
}

/// Return whether an edge of one polygon has the other strictly beyond it; both lie in one plane.
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

    fn cut_by(walls: &[[Lattice; 3]]) -> Option<Cutting> {
        let faces: Vec<Face> = walls
            .iter()
            .map(|c| Face::new(Cow::Owned(triangle(*c))))
            .collect();
        let cutter = |face| Cutter {
            face,
            operand: 1,
            weight: 1,
        };
        let cutters: Vec<Cutter> = faces.iter().map(cutter).collect();
        cut_up(triangle([[0, 0, 0], [16, 0, 0], [0, 16, 0]]), &cutters)
    }

    /// A face through the middle of the triangle.
    const WALL: [Lattice; 3] = [[4, -9, -9], [4, 30, 1], [4, -9, 30]];

    #[test]
    fn a_face_that_crosses_makes_two_pieces_and_a_tie() {
        let cutting = cut_by(&[WALL]).expect("general position");
        assert_eq!((cutting.pieces.len(), cutting.ties.len()), (2, 1));
        assert_eq!(cutting.ties[0].change, -1);
    }

    #[test]
    fn ties_connect_all_pieces() {
        let across = [[-9, 3, -9], [30, 3, 1], [-9, 3, 30]];
        let cutting = cut_by(&[WALL, across]).expect("general position");
        let mut known = vec![false; cutting.pieces.len()];
        known[0] = true;
        for _ in &cutting.pieces {
            for tie in &cutting.ties {
                let both = known[tie.minus as usize] || known[tie.plus as usize];
                (known[tie.minus as usize], known[tie.plus as usize]) = (both, both);
            }
        }
        assert!(known.len() == 4 && known.iter().all(|k| *k));
    }

    #[test]
    fn a_face_in_the_plane_of_the_polygon_is_special() {
        let polygon = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let flat = Face::new(Cow::Owned(triangle([[1, 1, 0], [2, 1, 0], [1, 2, 0]])));
        assert!(matches!(contact(&polygon, &flat), Contact::Special));
    }

    #[test]
    fn faces_in_the_plane_of_the_polygon_that_lie_apart_from_it_are_none() {
        let polygon = triangle([[0, 0, 0], [8, 0, 0], [0, 8, 0]]);
        let meets = |corners| contact(&polygon, &Face::new(Cow::Owned(triangle(corners))));
        let flat = [[9, 1, 0], [12, 1, 0], [9, 4, 0]];
        assert!(matches!(meets(flat), Contact::None));
        let touching = [[8, 0, 0], [12, 1, 0], [9, 4, 0]];
        assert!(matches!(meets(touching), Contact::Special));
        let upright = [[9, 1, 0], [9, 4, 0], [9, 2, 5]];
        assert!(matches!(meets(upright), Contact::None));
        let across = [[4, -1, 0], [4, 2, 0], [4, 1, 5]];
        assert!(matches!(meets(across), Contact::Special));
    }
}
