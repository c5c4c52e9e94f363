//! The elements of a cell: whole faces, faces of half-spaces, and parts or their convex pieces.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

use super::contact::Face;
use super::Labels;
use crate::arith::convert::as_double;
use crate::arith::Filtered;
use crate::geometry::apart::NearTriangle;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::kernels::problem::Listed;
use crate::merge::lists::list::{List, PartRecord, Record, Sources};
use crate::merge::pairs::Swept;
use crate::mesh::handle::{Slot, SourceFace, VertexId};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::Part;

/// All operands in a cell.
pub(super) struct Scene<'a> {
    pub(super) cell: &'a Cell,
    /// The cell's low corner, doubled.
    pub(super) corner: Lattice,
    /// The operands' winding numbers there.
    pub(super) corners: Vec<i32>,
    /// The elements by operand.
    pub(super) elements: Vec<Element<'a>>,
    /// For each operand where its elements end.
    ends: Vec<usize>,
    /// For each operand a box around its elements.
    pub(super) boxes: Vec<[Lattice; 2]>,
    /// The parts that pieces belong to, and the slots of their sources.
    pub(super) parts: Vec<(&'a Arc<Part>, Slot)>,
    /// An operand that winds around some point neither once nor not at all.
    pub(super) overlapping: OnceCell<usize>,
}

/// A whole face, or a part or a convex piece of one.
pub(super) struct Element<'a> {
    pub(super) operand: usize,
    /// By how much the winding number behind the face exceeds that in front of it.
    pub(super) weight: i32,
    pub(super) place: Place<'a>,
    /// True if all of it is known to lie in the cell.
    inside: bool,
    pub(super) low: Lattice,
    pub(super) high: Lattice,
}

/// An element and its place.
pub(super) enum Place<'a> {
    Face(Triangle<'a>),
    /// The face of a half-space: its slot, and its part in the cell.
    Plane(Slot, Box<Face<'a>>),
    /// A piece of a part: the part's number in the scene.
    Piece(usize, Box<Face<'a>>),
    /// A part of which a box is apart from all other operands.
    Part(usize, ApartPart<'a>),
}

/// A part that nothing can cross: its pieces are made if a path may.
pub(super) struct ApartPart<'a> {
    record: &'a PartRecord,
    pieces: OnceCell<Vec<Face<'a>>>,
}

/// A whole face.
pub(super) struct Triangle<'a> {
    source: &'a Source,
    pub(super) face: SourceFace,
    pub(super) vertices: [VertexId; 3],
    pub(super) corners: [Lattice; 3],
    shape: OnceCell<Box<Face<'a>>>,
}

impl<'a> Scene<'a> {
    pub(super) fn new(cell: &'a Cell, operands: &'a [Listed], sources: &'a Sources) -> Self {
        let mut scene = Self {
            cell,
            corner: cell.corner(),
            corners: operands.iter().map(|l| l.list.corner).collect(),
            elements: Vec::with_capacity(operands.iter().map(|l| l.list.len()).sum()),
            ends: Vec::with_capacity(operands.len()),
            boxes: operands
                .iter()
                .map(|l| box_around(&l.list, sources))
                .collect(),
            parts: Vec::new(),
            overlapping: OnceCell::new(),
        };
        for (operand, listed) in operands.iter().enumerate() {
            let list = &*listed.list;
            let faces = list.records.iter();
            let faces = faces.filter_map(|r| Element::of_record(operand, r, cell, sources));
            scene.elements.extend(faces);
            scene.add_parts(operand, list, sources);
            scene.ends.push(scene.elements.len());
        }
        scene
    }

    fn add_parts(&mut self, operand: usize, list: &'a List, sources: &Sources) {
        for p in &list.parts {
            poll();
            let part = self.parts.len();
            let slot = sources.slot(&p.element.part.source);
            self.parts.push((&p.element.part, slot));
            let inside = self.cell.holds(&p.element.part.home);
            if self.is_apart(operand, &p.element.part) {
                let pieces = OnceCell::new();
                let [low, high] = p.element.part.enclosing();
                self.elements.push(Element {
                    operand,
                    weight: p.element.orientation.signed(1),
                    place: Place::Part(part, ApartPart { record: p, pieces }),
                    inside,
                    low,
                    high,
                });
                continue;
            }
            for piece in p.pieces().iter().filter(|p| p.may_meet(self.cell)) {
                poll();
                let [low, high] = piece.around;
                self.elements.push(Element {
                    operand,
                    weight: p.element.orientation.signed(1),
                    place: Place::Piece(part, Box::new(Face::new(Cow::Borrowed(&piece.polygon)))),
                    inside,
                    low,
                    high,
                });
            }
        }
    }

    /// Return whether other operands keep out of a box around a part that has a corner in the cell.
    fn is_apart(&self, operand: usize, part: &Part) -> bool {
        let [low, high] = part.enclosing();
        let meets =
            |[least, most]: &[Lattice; 2]| (0..3).all(|i| low[i] <= most[i] && high[i] >= least[i]);
        let others = self.boxes.iter().enumerate().filter(|(k, _)| *k != operand);
        let mut corners = part.edges.iter().map(|e| &e.from);
        !others.map(|(_, other)| other).any(meets) && corners.any(|c| is_well_inside(c, self.cell))
    }

    /// An element to be compared with others: what keeps clear of a face does so of its pieces. The
    /// face of a half-space is apart from nothing.
    pub(super) fn near(&self, element: &Element) -> NearTriangle {
        let corners = match &element.place {
            Place::Face(triangle) => Some(triangle.corners),
            Place::Piece(part, _) | Place::Part(part, _) => {
                let part = self.parts[*part].0;
                part.source.mesh().map(|mesh| mesh.corners(part.face))
            }
            Place::Plane(..) => None,
        };
        corners.map_or(NearTriangle::UNKNOWN, |c| NearTriangle::of(&c))
    }

    /// The labels at the cell's low corner.
    pub(super) fn at_corner(&self) -> Labels {
        let numbers = self.corners.iter().enumerate();
        numbers.fold(0, |all, (i, w)| all | Labels::from(*w > 0) << i)
    }

    pub(super) fn of_operand(&self, operand: usize) -> &[Element<'a>] {
        let start = match operand {
            0 => 0,
            _ => self.ends[operand - 1],
        };
        &self.elements[start..self.ends[operand]]
    }
}

/// The name of a point that several elements may have in common.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Name {
    /// A vertex of a source.
    Vertex(Slot, VertexId),
    /// A corner of a part that is no vertex of its face, by its number.
    Point(u32),
    /// The point in which an edge of a source leaves the cell: the edge's ends, and twice the axis
    /// of the wall, with one more for the upper one.
    Crossing(Slot, [VertexId; 2], u8),
}

/// The bounding box of the listed elements; empty if there are none.
fn box_around(list: &List, sources: &Sources) -> [Lattice; 2] {
    let faces = list.records.iter();
    let faces = faces.map(|r| sources.get(r.slot()).face_box(r.face));
    let faces = faces.map(|(low, high)| [low, high]);
    let parts = list.parts.iter().map(|p| p.element.part.enclosing());
    let nothing = [[i64::MAX; 3], [i64::MIN; 3]];
    faces
        .chain(parts)
        .fold(nothing, |[least, most], [low, high]| {
            [
                each_axis(|i| least[i].min(low[i])),
                each_axis(|i| most[i].max(high[i])),
            ]
        })
}

/// Return whether a point certainly lies in a cell.
pub(super) fn is_well_inside(vertex: &Vertex, cell: &Cell) -> bool {
    let ((least, most), low, high) = (vertex.bounds(), cell.low(), cell.high());
    (0..3).all(|i| least[i] >= as_double(low[i]) && most[i] <= as_double(high[i]))
}

impl ApartPart<'_> {
    /// The part.
    pub(super) fn part(&self) -> &Part {
        &self.record.element.part
    }

    fn on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        let pieces = self.pieces.get_or_init(|| {
            let pieces = self.record.pieces().iter();
            pieces
                .map(|p| Face::new(Cow::Borrowed(&p.polygon)))
                .collect()
        });
        let mut sum = 0;
        for piece in pieces {
            poll();
            let Filtered::Certain(change) = piece.on_path(from, to) else {
                return Filtered::Doubtful;
            };
            sum += change;
        }
        Filtered::Certain(sum)
    }
}

impl Triangle<'_> {
    /// The name of a vertex.
    pub(super) fn name(&self, corner: usize) -> Name {
        Name::Vertex(self.face.slot, self.vertices[corner])
    }

    /// The number of vertices of the mesh that the face is of.
    pub(super) fn mesh_size(&self) -> usize {
        self.source.mesh().map_or(0, |mesh| mesh.vertices.len())
    }

    /// The vertices at the ends of an edge that is given by its places.
    pub(super) fn ends_of(&self, edge: [&Lattice; 2]) -> Option<[VertexId; 2]> {
        let at = |place: &Lattice| self.corners.iter().position(|c| c == place);
        Some([self.vertices[at(edge[0])?], self.vertices[at(edge[1])?]])
    }
}

impl<'a> Element<'a> {
    /// A listed face; `None` for the face of a half-space that misses the cell.
    fn of_record(
        operand: usize,
        record: &Record,
        cell: &Cell,
        sources: &'a Sources,
    ) -> Option<Self> {
        let source = sources.get(record.slot());
        let place = match source.shape() {
            Shape::Mesh(mesh) => Place::Face(Triangle {
                source,
                face: SourceFace::new(record.slot(), record.face),
                vertices: mesh.vertices_of(record.face),
                corners: mesh.corners(record.face),
                shape: OnceCell::new(),
            }),
            Shape::HalfSpace(plane) => {
                let polygon = Polygon::span(plane, cell)?;
                Place::Plane(record.slot(), Box::new(Face::new(Cow::Owned(polygon))))
            }
        };
        let (low, high) = source.face_box(record.face);
        Some(Self {
            operand,
            weight: record.orientation().signed(1),
            place,
            inside: cell.holds_box(&low, &high),
            low,
            high,
        })
    }

    /// Return the vertices of a whole face that lie in the cell.
    pub(super) fn vertices_in(&self, cell: &Cell) -> impl Iterator<Item = usize> {
        let inside = match &self.place {
            Place::Face(_) if self.inside => [true; 3],
            Place::Face(triangle) => triangle.corners.map(|p| cell.holds_box(&p, &p)),
            Place::Plane(..) | Place::Piece(..) | Place::Part(..) => [false; 3],
        };
        (0..3).filter(move |i| inside[*i])
    }

    /// The ends of the element's box inside the cell, relative to its low corner: at most a step
    /// outside, even if the element misses the cell.
    pub(super) fn extent(&self, cell: &Cell) -> [Lattice; 2] {
        if self.inside && matches!(self.place, Place::Face(_)) {
            return [&self.low, &self.high].map(|p| each_axis(|i| p[i] - cell.low()[i]));
        }
        let (low, high) = (cell.low(), cell.high());
        let within = |p: &Lattice, i: usize| p[i].clamp(low[i] - 1, high[i] + 1) - low[i];
        [&self.low, &self.high].map(|p| each_axis(|i| within(p, i)))
    }

    /// The element as a sweep sees it.
    pub(super) fn swept(&self, cell: &Cell) -> Swept {
        let origin = cell.low();
        let relative = |p: &Lattice| each_axis(|i| as_double(p[i] - origin[i]));
        let [low, high] = self.extent(cell);
        Swept {
            operand: self.operand,
            low,
            high,
            corners: match &self.place {
                Place::Face(t) => Some(each_axis(|i| relative(&t.corners[i]))),
                Place::Plane(..) | Place::Piece(..) | Place::Part(..) => None,
            },
        }
    }

    /// Return whether the element is a part that is apart from all other operands.
    pub(super) fn is_apart(&self) -> bool {
        matches!(self.place, Place::Part(..))
    }

    /// The change of the winding number across the element along a path, as [`Face::on_path`].
    pub(super) fn on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        match &self.place {
            Place::Part(_, part) => part.on_path(from, to),
            _ => self
                .shape()
                .map_or(Filtered::Certain(0), |s| s.on_path(from, to)),
        }
    }

    /// The convex shape; none of a part that is apart.
    pub(super) fn shape(&self) -> Option<&Face<'a>> {
        Some(match &self.place {
            Place::Face(t) => t.shape.get_or_init(|| {
                let plane = t.source.plane(t.face.id);
                Box::new(Face::new(Cow::Owned(Polygon::triangle(&t.corners, plane))))
            }),
            Place::Plane(_, shape) | Place::Piece(_, shape) => shape,
            Place::Part(..) => return None,
        })
    }

    pub(super) fn polygon_in(&self, cell: &Cell) -> Option<Polygon> {
        let polygon = self.shape()?.polygon.as_ref().clone();
        if self.inside {
            return Some(polygon);
        }
        polygon.clipped(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::kernels::general::fates::Fate;
    use crate::merge::scenes::{crossing, made_of, tetrahedra, tetrahedron, Shared};

    #[test]
    fn elements_stand_by_operand_in_a_box_around_them() {
        let mut shared = crossing();
        shared.lists[1].corner = 1;
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        assert_eq!(scene.elements.len(), 8);
        assert!(scene.of_operand(1).iter().all(|e| e.operand == 1));
        assert_eq!(scene.of_operand(1).len(), 4);
        assert_eq!(scene.boxes[0], [[0; 3], [16; 3]]);
        // Only the second is inside at the corner.
        assert_eq!(scene.at_corner(), 0b10);
    }

    #[test]
    fn parts_away_from_other_operands_are_not_taken_apart() {
        let union = made_of(&tetrahedra(), Term::Or);
        let small = tetrahedron([[-3, -3, -3], [1, -2, -1], [-2, 1, -2], [-1, -1, 1]]);
        let shared = Shared::of(&[union, small]);
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        // The three cut faces of the second tetrahedron; that of the first may meet the small one.
        let apart = |e: &&Element| e.is_apart();
        assert_eq!(scene.elements.iter().filter(apart).count(), 3);
        let fates = scene.fates().expect("general position");
        let uncut = scene
            .elements
            .iter()
            .zip(&fates)
            .filter(|(e, _)| e.is_apart());
        assert!(uncut
            .clone()
            .all(|(_, fate)| matches!(fate, Fate::Uncut(_))));
        let winding = |point: Lattice| {
            let point = Vertex::lattice(point);
            let crossed = scene.of_operand(0).iter().map(|e| {
                let Filtered::Certain(change) = e.on_path(&scene.corner, &point) else {
                    panic!("the path is in general position");
                };
                e.weight * change
            });
            scene.corners[0] + crossed.sum::<i32>()
        };
        assert_eq!([[11, 9, 7], [3, 2, 5], [7, 20, 19]].map(winding), [1, 1, 0]);
    }
}
