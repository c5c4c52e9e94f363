//! The elements of a cell: whole faces, faces of half-spaces, and parts of faces or their convex pieces.

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
use crate::merge::kernels::problem::ListedOperand;
use crate::merge::lists::list::{FaceRecord, List, PartRecord, Sources};
use crate::merge::pairs::BoundedElement;
use crate::mesh::handle::{Slot, SourceFace, VertexId};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::Part;

/// The faces, and convex pieces of cut faces, of all operands in a cell.
pub(super) struct Scene<'a> {
    pub(super) cell: &'a Cell,
    /// The cell's low corner, in half lattice steps.
    pub(super) corner: Lattice,
    /// The operands' winding numbers at the cell's low corner.
    pub(super) corners: Vec<i32>,
    /// The faces and convex pieces of cut faces, sorted by operand.
    pub(super) elements: Vec<Element<'a>>,
    /// For each operand the index in `elements` after its last face or piece.
    ends: Vec<usize>,
    /// For each operand the low and the high corner of a box around its faces.
    pub(super) boxes: Vec<[Lattice; 2]>,
    /// The parts of cut faces that the operands list, with the slots of their sources.
    pub(super) parts: Vec<(&'a Arc<Part>, Slot)>,
    /// The index of an operand for which a winding number other than 0 and 1 was found.
    pub(super) overlapping: OnceCell<usize>,
}

/// A whole face of an operand, or a part of a cut face, or a convex piece of such a part, in a cell.
pub(super) struct Element<'a> {
    pub(super) operand: usize,
    /// The winding number behind the face minus the number in front of it.
    pub(super) weight: i32,
    pub(super) kind: ElementKind<'a>,
    /// True if the whole face, part or piece is known to lie in the cell.
    inside: bool,
    pub(super) low: Lattice,
    pub(super) high: Lattice,
}

/// The geometry of a whole face of an operand, or of a part or piece of a cut face.
pub(super) enum ElementKind<'a> {
    Face(Triangle<'a>),
    /// The face of a half-space: the slot of the half-space, and the part of its plane in the cell.
    Plane(Slot, Box<Face<'a>>),
    /// A convex piece of a part of a cut face: the part's number in `Scene::parts`, and the piece.
    Piece(usize, Box<Face<'a>>),
    /// A part of a cut face whose box meets no box of another operand: the part's number in `Scene::parts`,
    /// and the part.
    Part(usize, ApartPart<'a>),
}

/// A part of a cut face that no face of another operand can cross; its convex pieces are computed only if a
/// path may cross it.
pub(super) struct ApartPart<'a> {
    record: &'a PartRecord,
    pieces: OnceCell<Vec<Face<'a>>>,
}

/// A whole face of a mesh.
pub(super) struct Triangle<'a> {
    source: &'a Source,
    pub(super) face: SourceFace,
    pub(super) vertices: [VertexId; 3],
    pub(super) corners: [Lattice; 3],
    shape: OnceCell<Box<Face<'a>>>,
}

impl<'a> Scene<'a> {
    pub(super) fn new(cell: &'a Cell, operands: &'a [ListedOperand], sources: &'a Sources) -> Self {
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
            let inside = self.cell.contains(&p.element.part.home);
            if self.is_apart(operand, &p.element.part) {
                let pieces = OnceCell::new();
                let [low, high] = p.element.part.enclosing();
                self.elements.push(Element {
                    operand,
                    weight: p.element.orientation.signed(1),
                    kind: ElementKind::Part(part, ApartPart { record: p, pieces }),
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
                    kind: ElementKind::Piece(
                        part,
                        Box::new(Face::new(Cow::Borrowed(&piece.polygon))),
                    ),
                    inside,
                    low,
                    high,
                });
            }
        }
    }

    /// Returns true if the box around a part of a cut face meets no other operand's box, and the part has a
    /// corner that certainly lies in the cell.
    fn is_apart(&self, operand: usize, part: &Part) -> bool {
        let [low, high] = part.enclosing();
        let meets =
            |[least, most]: &[Lattice; 2]| (0..3).all(|i| low[i] <= most[i] && high[i] >= least[i]);
        let others = self.boxes.iter().enumerate().filter(|(k, _)| *k != operand);
        let mut corners = part.edges.iter().map(|e| &e.from);
        !others.map(|(_, other)| other).any(meets) && corners.any(|c| is_well_inside(c, self.cell))
    }

    /// Returns, for quick tests, a triangle that contains the face or piece: the whole face that a piece was
    /// cut from. For the face of a half-space returns a value that no quick test finds to be apart from
    /// another face.
    pub(super) fn near_triangle(&self, element: &Element) -> NearTriangle {
        let corners = match &element.kind {
            ElementKind::Face(triangle) => Some(triangle.corners),
            ElementKind::Piece(part, _) | ElementKind::Part(part, _) => {
                let part = self.parts[*part].0;
                part.source.mesh().map(|mesh| mesh.corners(part.face))
            }
            ElementKind::Plane(..) => None,
        };
        corners.map_or(NearTriangle::UNKNOWN, |c| NearTriangle::of(&c))
    }

    /// Returns the label at the cell's low corner: a bit for each operand that is inside there.
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

/// The name of a point that several faces of an operand may share.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum PointName {
    /// A vertex of a mesh, by the mesh's slot and the vertex's number.
    Vertex(Slot, VertexId),
    /// A corner of a part of a cut face that is no vertex of the face, by a number for its exact position.
    Point(u32),
    /// The point in which an edge of a mesh leaves the cell: the mesh's slot, the edge's ends, and the number
    /// of the wall, which is twice its axis, plus one for the upper wall.
    Crossing(Slot, [VertexId; 2], u8),
}

/// Returns the bounding box of the listed faces and parts of faces; if there are none, a box with low above
/// high.
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

/// Returns true if a point certainly lies in a cell.
pub(super) fn is_well_inside(vertex: &Vertex, cell: &Cell) -> bool {
    let ((least, most), low, high) = (vertex.bounds(), cell.low(), cell.high());
    (0..3).all(|i| least[i] >= as_double(low[i]) && most[i] <= as_double(high[i]))
}

impl ApartPart<'_> {
    /// Returns the part of a cut face.
    pub(super) fn part(&self) -> &Part {
        &self.record.element.part
    }

    fn change_on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        let pieces = self.pieces.get_or_init(|| {
            let pieces = self.record.pieces().iter();
            pieces
                .map(|p| Face::new(Cow::Borrowed(&p.polygon)))
                .collect()
        });
        let mut sum = 0;
        for piece in pieces {
            poll();
            let Filtered::Certain(change) = piece.change_on_path(from, to) else {
                return Filtered::Doubtful;
            };
            sum += change;
        }
        Filtered::Certain(sum)
    }
}

impl Triangle<'_> {
    /// Returns the name of the vertex at a corner.
    pub(super) fn point_name(&self, corner: usize) -> PointName {
        PointName::Vertex(self.face.slot, self.vertices[corner])
    }

    /// Returns the number of vertices of the face's mesh.
    pub(super) fn mesh_size(&self) -> usize {
        self.source.mesh().map_or(0, |mesh| mesh.vertices.len())
    }

    /// Returns the vertices at the ends of one of the face's edges, given by its end points; `None` if an end
    /// is no corner of the face.
    pub(super) fn ends_of(&self, edge: [&Lattice; 2]) -> Option<[VertexId; 2]> {
        let at = |point: &Lattice| self.corners.iter().position(|c| c == point);
        Some([self.vertices[at(edge[0])?], self.vertices[at(edge[1])?]])
    }
}

impl<'a> Element<'a> {
    /// Makes the entry of a listed face for a scene; `None` for the face of a half-space that misses the
    /// cell.
    fn of_record(
        operand: usize,
        record: &FaceRecord,
        cell: &Cell,
        sources: &'a Sources,
    ) -> Option<Self> {
        let source = sources.get(record.slot());
        let kind = match source.shape() {
            Shape::Mesh(mesh) => ElementKind::Face(Triangle {
                source,
                face: SourceFace::new(record.slot(), record.face),
                vertices: mesh.vertices_of(record.face),
                corners: mesh.corners(record.face),
                shape: OnceCell::new(),
            }),
            Shape::HalfSpace(plane) => {
                let polygon = Polygon::span(plane, cell)?;
                ElementKind::Plane(record.slot(), Box::new(Face::new(Cow::Owned(polygon))))
            }
        };
        let (low, high) = source.face_box(record.face);
        Some(Self {
            operand,
            weight: record.orientation().signed(1),
            kind,
            inside: cell.contains_box(&low, &high),
            low,
            high,
        })
    }

    /// Returns the indices of the corners of a whole face that lie in the cell; none for a part or piece of a
    /// face.
    pub(super) fn vertices_in(&self, cell: &Cell) -> impl Iterator<Item = usize> {
        let inside = match &self.kind {
            ElementKind::Face(_) if self.inside => [true; 3],
            ElementKind::Face(triangle) => triangle.corners.map(|p| cell.contains_box(&p, &p)),
            ElementKind::Plane(..) | ElementKind::Piece(..) | ElementKind::Part(..) => [false; 3],
        };
        (0..3).filter(move |i| inside[*i])
    }

    /// Returns the low and the high corner of the box around the face or piece, clipped to the cell extended
    /// by one step, relative to the cell's low corner.
    pub(super) fn extent(&self, cell: &Cell) -> [Lattice; 2] {
        if self.inside && matches!(self.kind, ElementKind::Face(_)) {
            return [&self.low, &self.high].map(|p| each_axis(|i| p[i] - cell.low()[i]));
        }
        let (low, high) = (cell.low(), cell.high());
        let within = |p: &Lattice, i: usize| p[i].clamp(low[i] - 1, high[i] + 1) - low[i];
        [&self.low, &self.high].map(|p| each_axis(|i| within(p, i)))
    }

    /// Returns the face or piece in the form that the search for pairs uses.
    pub(super) fn bounded(&self, cell: &Cell) -> BoundedElement {
        let origin = cell.low();
        let relative = |p: &Lattice| each_axis(|i| as_double(p[i] - origin[i]));
        let [low, high] = self.extent(cell);
        BoundedElement {
            operand: self.operand,
            low,
            high,
            corners: match &self.kind {
                ElementKind::Face(t) => Some(each_axis(|i| relative(&t.corners[i]))),
                ElementKind::Plane(..) | ElementKind::Piece(..) | ElementKind::Part(..) => None,
            },
        }
    }

    /// Returns true if this is a part of a cut face whose box meets no box of another operand.
    pub(super) fn is_apart(&self) -> bool {
        matches!(self.kind, ElementKind::Part(..))
    }

    /// Returns the change of the winding number where a path crosses the face or piece, or that it is
    /// doubtful, as [`Face::change_on_path`].
    pub(super) fn change_on_path(&self, from: &Lattice, to: &Vertex) -> Filtered<i32> {
        match &self.kind {
            ElementKind::Part(_, part) => part.change_on_path(from, to),
            _ => self
                .shape()
                .map_or(Filtered::Certain(0), |s| s.change_on_path(from, to)),
        }
    }

    /// Returns the face or piece as a convex polygon; `None` for a part that is apart from all other
    /// operands.
    pub(super) fn shape(&self) -> Option<&Face<'a>> {
        Some(match &self.kind {
            ElementKind::Face(t) => t.shape.get_or_init(|| {
                let plane = t.source.plane(t.face.id);
                Box::new(Face::new(Cow::Owned(Polygon::triangle(&t.corners, plane))))
            }),
            ElementKind::Plane(_, shape) | ElementKind::Piece(_, shape) => shape,
            ElementKind::Part(..) => return None,
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
    use crate::merge::kernels::general::cut_status::CutStatus;
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
        // Only the second operand is inside at the corner.
        assert_eq!(scene.at_corner(), 0b10);
    }

    #[test]
    fn parts_away_from_other_operands_are_not_taken_apart() {
        let union = made_of(&tetrahedra(), Term::Or);
        let small = tetrahedron([[-3, -3, -3], [1, -2, -1], [-2, 1, -2], [-1, -1, 1]]);
        let shared = Shared::of(&[union, small]);
        let operands = shared.operands();
        let scene = Scene::new(&shared.cell, &operands, &shared.sources);
        // The parts that are apart come from the three cut faces of the second tetrahedron; the cut face of
        // the first may meet the small one.
        let apart = |e: &&Element| e.is_apart();
        assert_eq!(scene.elements.iter().filter(apart).count(), 3);
        let statuses = scene.cut_statuses().expect("general position");
        let uncut = scene
            .elements
            .iter()
            .zip(&statuses)
            .filter(|(e, _)| e.is_apart());
        assert!(uncut
            .clone()
            .all(|(_, status)| matches!(status, CutStatus::Uncut(_))));
        let winding = |point: Lattice| {
            let point = Vertex::lattice(point);
            let crossed = scene.of_operand(0).iter().map(|e| {
                let Filtered::Certain(change) = e.change_on_path(&scene.corner, &point) else {
                    panic!("the path is in general position");
                };
                e.weight * change
            });
            scene.corners[0] + crossed.sum::<i32>()
        };
        assert_eq!([[11, 9, 7], [3, 2, 5], [7, 20, 19]].map(winding), [1, 1, 0]);
    }
}
