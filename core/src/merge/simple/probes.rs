//! Winding numbers on both sides of pieces of surface that nothing crosses.
//!
//! Each is counted in a small cell, along a path from the cell's corner to a point inside the piece,
//! on which no other face lies.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::places::any_small_cell;
use crate::arith::convert::{as_double, as_whole};
use crate::arith::Filtered;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::Polygon;
use crate::geometry::side::{Half, Side};
use crate::geometry::vertex::Vertex;
use crate::geometry::winding::path::Way;
use crate::interrupt::poll;
use crate::merge::kernels::general::Face;
use crate::merge::kernels::trees::LeafTree;
use crate::merge::lists::list::{List, Sources};

/// A piece of surface that nothing crosses, and the jump of the winding number from its plus to its
/// minus side.
#[derive(Clone, Copy)]
pub(super) struct Probed<'a> {
    pub(super) polygon: &'a Polygon,
    pub(super) weight: i32,
}

/// The winding numbers behind a piece and in front of it.
pub(super) type Sides = [i32; 2];

/// A point inside a piece, and the lattice point nearest to it.
struct Probe {
    point: Vertex,
    place: Lattice,
}

/// A small cell, in which winding numbers are counted.
struct Count<'a> {
    cell: &'a Cell,
    list: &'a List,
    sources: &'a Sources,
    /// By record, its face, once a path comes near it.
    faces: Vec<OnceCell<Option<Face<'static>>>>,
}

/// For each piece the winding numbers on its sides; `None` if they cannot be told.
///
/// # Cost
/// Lists are divided where pieces are, and each path is compared with the faces of a small cell.
pub(super) fn sides(
    pieces: &[Probed],
    within: &(Cell, List),
    sources: &Sources,
) -> Option<Vec<Sides>> {
    let mut found: Vec<Option<Sides>> = vec![None; pieces.len()];
    for attempt in 0..ATTEMPTS {
        probe(pieces, &mut found, within, sources, attempt);
    }
    grow_trees_for(pieces, &mut found, within, sources);
    found.into_iter().collect()
}

/// Tells the numbers of pieces by points inside.
fn probe(
    pieces: &[Probed],
    found: &mut [Option<Sides>],
    within: &(Cell, List),
    sources: &Sources,
    attempt: usize,
) {
    let open = (0..pieces.len()).filter(|i| found[*i].is_none());
    let probes = open.filter_map(|i| {
        let probe = Probe::inside(pieces[i].polygon, attempt)?;
        Some((probe.place, (i, probe.point)))
    });
    let probes: Vec<(Lattice, (usize, Vertex))> = probes.collect();
    any_small_cell(
        sources,
        within,
        probes,
        MOST_PASSED,
        |cell, list, probes| {
            let count = Count::new(cell, list, sources);
            for (_, (i, point)) in probes {
                found[*i] = count.sides_at(&pieces[*i], point);
            }
            false
        },
    );
}

/// Tells the numbers of pieces that are too thin to hold a point: a local tree is grown around each.
fn grow_trees_for(
    pieces: &[Probed],
    found: &mut [Option<Sides>],
    within: &(Cell, List),
    sources: &Sources,
) {
    let open = (0..pieces.len()).filter(|i| found[*i].is_none());
    let middle = |i: usize| aim(pieces[i].polygon, 0).map(|x| as_whole(x.round()));
    let places: Vec<(Lattice, usize)> = open.map(|i| (middle(i), i)).collect();
    any_small_cell(sources, within, places, 0, |cell, list, places| {
        let leaf = LeafTree::new(list, cell, sources);
        for (_, i) in places {
            let part = pieces[*i].polygon.clone().clipped(cell);
            found[*i] = part.and_then(|part| leaf.sides_of(part));
        }
        false
    });
}

/// Faces that a path may be compared with where halvings do not part them, as in sheets of which each
/// covers all others: that costs less than the fifty lists down to the least cell.
const MOST_PASSED: usize = 1 << 14;

/// So many points are tried inside a piece: its middle, and others nearer to a corner.
const ATTEMPTS: usize = 4;

impl<'a> Count<'a> {
    fn new(cell: &'a Cell, list: &'a List, sources: &'a Sources) -> Self {
        let faces = list.records.iter().map(|_| OnceCell::new()).collect();
        Self {
            cell,
            list,
            sources,
            faces,
        }
    }

    /// The winding numbers on the sides of a piece, counted on the way to a point inside.
    fn sides_at(&self, piece: &Probed, point: &Vertex) -> Option<Sides> {
        let support = piece.polygon.support();
        let reached = self.number_at(point, support)?;
        Some(match support.side_of_corner(&self.cell.corner()) {
            Half::Minus => [reached, reached - piece.weight],
            Half::Plus => [reached + piece.weight, reached],
        })
    }

    /// The winding number where the path from the cell's corner to a point of a piece's plane
    /// arrives; `None` if the path is not generic.
    fn number_at(&self, point: &Vertex, plane: &Plane) -> Option<i32> {
        let from = self.cell.corner();
        let way = Way::new(from.map(|x| 0.5 * as_double(x)), point.approx());
        let mut number = self.list.corner;
        for (i, record) in self.list.records.iter().enumerate() {
            poll();
            let (low, high) = self.sources.get(record.slot()).face_box(record.face);
            if way.may_meet(&low, &high) {
                let change = change_across(self.face(i)?, &from, point, plane)?;
                number += record.orientation().signed(change);
            }
        }
        Some(number)
    }

    fn face(&self, record: usize) -> Option<&Face<'static>> {
        let made = || {
            let record = &self.list.records[record];
            let source = self.sources.get(record.slot());
            let corners = source.mesh()?.corners(record.face);
            let polygon = Polygon::triangle(&corners, source.plane(record.face));
            Some(Face::new(Cow::Owned(polygon)))
        };
        self.faces[record].get_or_init(made).as_ref()
    }
}

/// The change of the winding number across a face on a path that ends inside a piece of a plane;
/// `None` if the path is not generic.
///
/// A face in whose plane the path ends is not met before. If it touches the piece there, what it
/// bounds may hold the end of the path and nothing else near the piece.
fn change_across(face: &Face, from: &Lattice, to: &Vertex, plane: &Plane) -> Option<i32> {
    let support = face.polygon.support();
    if to.side_of(support) == Side::On {
        let is_beside = face.rims().iter().any(|rim| to.side_of(rim) == Side::Plus);
        return (is_beside || support.coincides(plane).is_some()).then_some(0);
    }
    match face.on_path(from, to) {
        Filtered::Certain(change) => Some(change),
        Filtered::Doubtful => None,
    }
}

impl Probe {
    /// The point inside a piece on a line along an axis between lattice points, which passes near
    /// the middle, or between that and a corner.
    fn inside(piece: &Polygon, attempt: usize) -> Option<Self> {
        let support = piece.support();
        let axis = support.main_axis();
        let from: Lattice = aim(piece, attempt).map(|x| as_whole(x.floor()));
        let mut to = from;
        to[axis] += 1;
        let point = Vertex::on_edge(&LatticeEdge::new(from, to), support)?;
        let mut place = from;
        place[axis] = as_whole(point.approx()[axis].round());
        let face = Face::new(Cow::Borrowed(piece));
        let is_inside = |rim: &Plane| point.side_of(rim) == Side::Minus;
        let is_sound = is_nearest(&point, &place, axis) && face.rims().iter().all(is_inside);
        is_sound.then_some(Self { point, place })
    }
}

/// Return whether a point on a line along an axis is nearest to a lattice point of the line, so
/// that both lie in the same cells.
fn is_nearest(point: &Vertex, place: &Lattice, axis: usize) -> bool {
    let side = |doubled: i64| point.side_of(&Plane::axis_cut(axis, doubled));
    side(2 * place[axis] - 1) == Side::Plus && side(2 * place[axis] + 1) == Side::Minus
}

/// About the middle of a piece at first, then points between that and the corners.
fn aim(piece: &Polygon, attempt: usize) -> [f64; 3] {
    let corners = piece.corners();
    let share = 1.0 / as_double(corners.len());
    let middle = corners.iter().fold([0.0; 3], |sum: [f64; 3], c| {
        let at = c.at.approx();
        each_axis(|i| sum[i] + share * at[i])
    });
    let Some(corner) = attempt.checked_sub(1) else {
        return middle;
    };
    let corner = corners[corner % corners.len()].at.approx();
    each_axis(|i| 0.5 * (middle[i] + corner[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{cuboid, cuboids, tetrahedron, triangle, Shared};

    #[test]
    fn numbers_are_counted_on_both_sides() {
        let scene = Shared::of(&[cuboids([[[0; 3], [40; 3]], [[-9; 3], [60; 3]]])]);
        let within = (scene.cell, scene.lists[0].clone());
        let top = triangle([[0, 0, 40], [40, 0, 40], [0, 40, 40]]);
        let probed = Probed {
            polygon: &top,
            weight: 1,
        };
        let found = sides(&[probed], &within, &scene.sources);
        assert_eq!(found, Some(vec![[2, 1]]));
    }

    // Found: a tip that touches the middle of a face could hide what lies behind the rest of it.
    /// A pyramid stands with its tip near the middle of half a lid.
    #[test]
    fn a_tip_that_touches_a_piece_does_not_hide_the_rest() {
        let pyramid = [[-30, -37, 10], [64, -25, 10], [-33, 60, 10], [10, 10, 31]];
        let mut scene = Shared::of(&[cuboid([-5, -9, -60], [31; 3]), tetrahedron(pyramid)]);
        let below = scene.lists.pop().expect("two lists");
        let mut list = scene.lists.remove(0);
        list.records.extend(below.records);
        let half = triangle([[0, 0, 31], [31, 0, 31], [0, 31, 31]]);
        let probed = Probed {
            polygon: &half,
            weight: 1,
        };
        let found = sides(&[probed], &(scene.cell, list), &scene.sources);
        assert_eq!(found, Some(vec![[1, 0]]));
    }

    #[test]
    fn a_piece_between_lattice_lines_tells_nothing() {
        let narrow = triangle([[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
        assert!((0..ATTEMPTS).all(|attempt| Probe::inside(&narrow, attempt).is_none()));
    }
}
