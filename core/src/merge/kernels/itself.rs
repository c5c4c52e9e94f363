//! One mesh united with itself in a cell in which most faces are clear of all others.
//!
//! Local trees divide a cell by the planes of all faces. Here only faces that may overlap others are
//! cut, and only by those of them that reach them. The winding number in front of a piece is counted
//! along a path from the cell's corner to a point inside the piece, on which no other face lies.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::general::Face;
use super::kept::{assemble, Kept};
use super::trees::{disjoint, keep, Fragment, Piece};
use crate::arith::convert::{as_double, as_whole};
use crate::arith::Filtered;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::{straddle, Polygon};
use crate::geometry::side::{Half, Side};
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::Way;
use crate::interrupt::poll;
use crate::merge::lists::list::{List, Record, Sources};
use crate::merge::rule::Rule;
use crate::mesh::handle::{FaceId, SourceFace};
use crate::tree::node::{Node, Work};

/// What is known of a face of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It may overlap others.
    Doubtful,
    /// It is clear of all others, and bounds the points inside.
    Stays,
    /// It is clear of all others, with points on both sides that are inside, or none.
    Goes,
}

/// A mesh in a cell.
struct Scene<'a> {
    cell: &'a Cell,
    list: &'a List,
    sources: &'a Sources,
    /// By record, its face, once a path comes near it.
    faces: Vec<OnceCell<Face<'static>>>,
}

/// The tree that a mesh united with itself leaves in a cell; `None` if a piece holds no point that
/// tells its winding number.
pub fn united(
    cell: &Cell,
    list: &List,
    sources: &Sources,
    fate: impl Fn(FaceId) -> Fate,
) -> Option<Node> {
    let scene = Scene::new(cell, list, sources);
    let fate = &fate;
    let of_fate = |wanted: Fate| list.records.iter().filter(move |r| fate(r.face) == wanted);
    let stays = of_fate(Fate::Stays).map(|r| Kept::whole(named(r), r.orientation()));
    let mut kept: Vec<Kept> = stays.collect();
    let doubtful = of_fate(Fate::Doubtful).filter_map(|r| scene.fragment(r));
    let (fragments, _) = disjoint(doubtful.collect());
    let faces: Vec<Face> = fragments
        .iter()
        .map(|f| Face::new(Cow::Borrowed(&f.polygon)))
        .collect();
    for (i, fragment) in fragments.iter().enumerate() {
        let cut = cut_up(i, &faces);
        let numbered = |polygon| scene.numbered(polygon, fragment.weight);
        let pieces: Option<Vec<Piece>> = cut.into_iter().map(numbered).collect();
        kept.extend(keep(fragment, 0, pieces?, &mut |labels: &[bool]| labels[0]));
    }
    let corner = i32::from(Rule::Positive.inside(list.corner));
    Some(assemble(kept, corner, Work::Trees, cell, sources))
}

/// The winding number in front of a face that is clear of all others; `None` if it has no part in
/// the cell, or none that holds a point that tells.
pub fn number_before(cell: &Cell, list: &List, sources: &Sources, face: FaceId) -> Option<i32> {
    let scene = Scene::new(cell, list, sources);
    let record = list.records.iter().find(|r| r.face == face)?;
    let fragment = scene.fragment(record)?;
    let sides = scene.sides(&Face::new(Cow::Owned(fragment.polygon)), fragment.weight)?;
    Some(sides[1])
}

fn named(record: &Record) -> SourceFace {
    SourceFace::new(record.slot(), record.face)
}

impl<'a> Scene<'a> {
    fn new(cell: &'a Cell, list: &'a List, sources: &'a Sources) -> Self {
        Self {
            cell,
            list,
            sources,
            faces: list.records.iter().map(|_| OnceCell::new()).collect(),
        }
    }

    /// The part of a face in the cell.
    fn fragment(&self, record: &Record) -> Option<Fragment> {
        poll();
        let polygon = self
            .sources
            .get(record.slot())
            .clip(record.face, self.cell)?;
        Some(Fragment {
            polygon,
            weight: record.orientation().signed(1),
            face: named(record),
            intact: true,
        })
    }

    /// A piece with what is known of its two sides.
    fn numbered(&self, polygon: Polygon, weight: i32) -> Option<Piece> {
        let sides = self.sides(&Face::new(Cow::Borrowed(&polygon)), weight)?;
        let [minus, plus] = sides.map(|w| vec![Rule::Positive.inside(w)]);
        Some(Piece {
            polygon,
            minus,
            plus,
        })
    }

    /// The winding numbers behind and in front of a piece that nothing crosses.
    fn sides(&self, piece: &Face, weight: i32) -> Option<[i32; 2]> {
        let reached = inner_points(piece).find_map(|point| self.number_at(&point))?;
        let from = piece.polygon.support().side_of_corner(&self.cell.corner());
        Some(match from {
            Half::Minus => [reached, reached - weight],
            Half::Plus => [reached + weight, reached],
        })
    }

    /// The winding number where the path from the cell's corner to a point arrives; `None` if the
    /// path is not generic.
    ///
    /// A face in whose plane the point lies is not met before.
    fn number_at(&self, point: &Vertex) -> Option<i32> {
        let from = self.cell.corner();
        let way = Way::new(from.map(|x| 0.5 * as_double(x)), point.approx());
        let mut number = self.list.corner;
        for (i, record) in self.list.records.iter().enumerate() {
            poll();
            let (low, high) = self.sources.get(record.slot()).face_box(record.face);
            if !way.may_meet(&low, &high) {
                continue;
            }
            let face = self.face(i)?;
            if point.side_of(face.polygon.support()) == Side::On {
                continue;
            }
            let Filtered::Certain(change) = face.on_path(&from, point) else {
                return None;
            };
            number += record.orientation().signed(change);
        }
        Some(number)
    }

    fn face(&self, record: usize) -> Option<&Face<'static>> {
        let record_of = || &self.list.records[record];
        if self.faces[record].get().is_none() {
            let source = self.sources.get(record_of().slot());
            let corners = source.mesh()?.corners(record_of().face);
            let polygon = Polygon::triangle(&corners, source.plane(record_of().face));
            let _ = self.faces[record].set(Face::new(Cow::Owned(polygon)));
        }
        self.faces[record].get()
    }
}

/// The pieces into which the others that reach one of some faces cut it.
fn cut_up(own: usize, faces: &[Face]) -> Vec<Polygon> {
    let mut pieces = vec![faces[own].polygon.as_ref().clone()];
    let near = |other: &&Face| boxes_meet(&faces[own].polygon, &other.polygon);
    for other in faces.iter().filter(near) {
        poll();
        let mut cut = Vec::with_capacity(pieces.len());
        for piece in pieces {
            match halves(&piece, other) {
                Some(halves) => cut.extend(halves),
                None => cut.push(piece),
            }
        }
        pieces = cut;
    }
    pieces
}

/// The halves of a piece along the plane of a face that reaches it.
fn halves(piece: &Polygon, other: &Face) -> Option<[Polygon; 2]> {
    let plane = other.polygon.support();
    if !boxes_meet(piece, &other.polygon) {
        return None;
    }
    let sides = piece.sides(plane);
    if straddle(&sides) != (true, true) {
        return None;
    }
    let chord = piece.chord(plane, &sides);
    let (minus, plus) = other
        .is_reached_by(&chord)
        .then(|| piece.divided(plane, &sides, &chord))?;
    Some([minus, plus])
}

/// Return whether the boxes around two polygons meet; errs on yes.
fn boxes_meet(a: &Polygon, b: &Polygon) -> bool {
    let ((low, high), (others_low, others_high)) = (a.bounds(), b.bounds());
    (0..3).all(|i| low[i] <= others_high[i] && others_low[i] <= high[i])
}

/// Some points inside a piece: where lines along an axis between lattice points meet it.
fn inner_points<'a>(piece: &'a Face) -> impl Iterator<Item = Vertex> + 'a {
    let corners: Vec<[f64; 3]> = piece
        .polygon
        .corners()
        .iter()
        .map(|c| c.at.approx())
        .collect();
    let count = as_double(corners.len());
    let middle = each_axis(|i| corners.iter().map(|c| c[i] / count).sum::<f64>());
    let nearer = move |c: &[f64; 3]| each_axis(|i| 0.5 * (middle[i] + c[i]));
    let aims: Vec<[f64; 3]> = std::iter::once(middle)
        .chain(corners.iter().map(nearer))
        .collect();
    aims.into_iter().filter_map(|aim| inner_point(piece, &aim))
}

/// The point inside a piece on a line along an axis through about a given place.
fn inner_point(piece: &Face, aim: &[f64; 3]) -> Option<Vertex> {
    let support = piece.polygon.support();
    let from: Lattice = each_axis(|i| as_whole(aim[i].floor()));
    let mut to = from;
    to[support.main_axis()] += 1;
    let point = Vertex::on_edge(&LatticeEdge::new(from, to), support)?;
    let is_inside = piece
        .rims()
        .iter()
        .all(|rim| point.side_of(rim) == Side::Minus);
    is_inside.then_some(point)
}
