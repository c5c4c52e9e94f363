//! Builds the leaf that results from one or two meshes, from the contacts of their faces.

use std::sync::Arc;

use super::candidates::Operand;
use super::faces::{Arrangement, CellNumbers, Face, Planes, SharedGeometry};
use super::keep_rule::KeepRule;
use super::labels::Labels;
use super::segments::{Contacts, Cover, Edge, MeetingPoint, Segment};
use super::surfaces::Surfaces;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::plane::{normal, Plane};
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::profile::Declined;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::tasks::{each, WorkSize};
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node, Part, PartElement};

/// The number of faces or points in a task for another thread.
const ITEMS_PER_TASK: usize = 32;

/// Two meshes to be combined, or one to be united with itself.
#[derive(Debug)]
pub(super) struct Scene<'a> {
    pub(super) surfaces: Surfaces<'a>,
    /// For each operand, the faces in front of which the winding number may differ from 0.
    pub(super) near: Vec<Vec<FaceId>>,
    /// The cell of the resulting leaf.
    pub(super) cell: Cell,
    pub(super) kept: KeepRule,
    pub(super) work_size: WorkSize,
}

/// The form of an operand's face in the result: absent, whole or cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Gone,
    /// The face stays whole in this orientation; the flag is true if other faces may touch it anywhere.
    Whole(Orientation, bool),
    Cut,
}

impl Fate {
    fn of(stays: Option<Orientation>, touches: bool) -> Self {
        stays.map_or(Self::Gone, |orientation| Self::Whole(orientation, touches))
    }

    /// Records, for a face that stays whole, that other faces may touch it.
    fn touch(&mut self) {
        if let Self::Whole(_, touches) = self {
            *touches = true;
        }
    }
}

/// The parts of a divided face that bound the result: none or the whole face in one orientation, or a part in
/// each orientation.
enum RemainingParts {
    Whole(Option<Orientation>),
    Parts([Option<PartElement>; 2]),
}

impl<'a> Scene<'a> {
    /// Returns the branch with the leaf of all faces and parts of faces that bound the result, given the
    /// contacts of faces.
    ///
    /// # Errors
    /// The reason why the contacts do not determine the result.
    pub(super) fn root(&self, found: &Contacts) -> Result<Branch, Declined> {
        let shared = self.shared(found);
        let mut leaf = DeferredLeaf {
            corner: i32::from(self.kept.outside()),
            by_kernel: true,
            ..DeferredLeaf::default()
        };
        let operands = (0..self.surfaces.operands.len()).collect();
        for left in each(self.work_size, operands, |k| {
            self.remaining_faces(k, found, &shared)
        }) {
            let (groups, parts) = left?;
            leaf.groups.extend(groups);
            leaf.parts.extend(parts);
        }
        if leaf.is_empty() {
            return Ok(Branch::uniform(self.cell, leaf.corner));
        }
        Ok(Branch {
            cell: self.cell,
            outside: leaf.corner,
            complement: false,
            node: Arc::new(Node::Deferred(leaf)),
        })
    }

    /// Computes the exact points of all contacts, and the planes of the faces that meet others.
    fn shared<'b>(&'b self, found: &'b Contacts) -> SharedGeometry<'b> {
        let planes = self.planes(found);
        let blocks = found.points.chunks(ITEMS_PER_TASK).collect();
        let vertices = each(self.work_size, blocks, |block: &[MeetingPoint]| {
            let vertex = |point: &MeetingPoint| Arc::new(self.vertex(point, &planes));
            block.iter().map(vertex).collect::<Vec<_>>()
        });
        SharedGeometry {
            surfaces: &self.surfaces,
            points: &found.points,
            vertices: vertices.concat(),
            planes,
        }
    }

    /// Computes the planes of the faces that have to be divided or examined singly.
    fn planes(&self, found: &Contacts) -> Planes {
        let faces = self.arranged_faces(found);
        let planes = each(
            self.work_size,
            faces.chunks(ITEMS_PER_TASK).collect(),
            |block: &[u32]| {
                let planes = block
                    .iter()
                    .map(|f| self.surfaces.operand(*f).source.plane(self.surfaces.id(*f)));
                planes.collect::<Vec<_>>()
            },
        );
        faces.into_iter().zip(planes.concat()).collect()
    }

    /// Returns the faces that other faces divide or cover, and the faces whose corners all lie on other
    /// faces, by ascending number (faces of both operands are numbered together).
    fn arranged_faces(&self, found: &Contacts) -> Vec<u32> {
        let segments = found.segments.iter().map(|s| s.face);
        let covered = found.covers.iter().map(|c| c.face);
        let mut faces: Vec<u32> = segments.chain(covered).collect();
        faces.dedup();
        let operands = 0..self.surfaces.operands.len();
        for k in operands.filter(|k| !found.touching[*k].is_empty()) {
            let touches = |v: &VertexId| found.touching[k][v.index()];
            let of_operand = self.surfaces.of_operand(k);
            faces.extend(of_operand.filter(|f| self.surfaces.vertices(*f).iter().all(touches)));
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    fn vertex(&self, point: &MeetingPoint, planes: &Planes) -> Vertex {
        let edge = |(operand, ends): &Edge| {
            let points = &self.surfaces.operands[*operand].mesh.vertices;
            let [from, to] = ends.map(|v| points[v.index()]);
            LatticeEdge::new(from, to)
        };
        match point {
            MeetingPoint::Corner(point) => Vertex::lattice(*point),
            MeetingPoint::Through(through, face) => Vertex::on_edge(&edge(through), &planes[face])
                .expect("an edge with ends on both sides of a plane meets it"),
            MeetingPoint::Edges([first, second]) => crossing(&edge(first), &edge(second)),
        }
    }

    /// Divides each face of an operand that meets other faces into cells.
    fn arrangements<'b>(
        &self,
        operand: usize,
        found: &'b Contacts,
        shared: &'b SharedGeometry,
    ) -> Result<Vec<Arrangement<'b>>, Declined> {
        let mut faces: Vec<u32> = shared.planes.keys().copied().collect();
        faces.retain(|f| self.surfaces.operand_of(*f) == operand);
        faces.sort_unstable();
        let arranged = |number: u32| {
            let face = Face {
                number,
                operand,
                corners: self.surfaces.corners(number),
                vertices: self.surfaces.vertices(number),
                plane: &shared.planes[&number],
                segments: rows_of_face(&found.segments, number, |s: &Segment| s.face),
                covers: rows_of_face(&found.covers, number, |c: &Cover| c.face),
            };
            Arrangement::new(face, shared)
        };
        let found = each(
            self.work_size,
            faces.chunks(ITEMS_PER_TASK).collect(),
            |block: &[u32]| {
                let block = block.iter().map(|number| arranged(*number));
                block.collect::<Result<Vec<_>, Declined>>()
            },
        );
        let found: Result<Vec<Vec<_>>, Declined> = found.into_iter().collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// Returns the faces of an operand that bound the result: groups of whole faces, and parts of divided
    /// faces.
    fn remaining_faces(
        &self,
        operand: usize,
        found: &Contacts,
        shared: &SharedGeometry,
    ) -> Result<(Vec<FaceGroup>, Vec<PartElement>), Declined> {
        let count = self.surfaces.operands[operand].mesh.faces.len();
        let mut fates = vec![Fate::of(self.kept.at(operand, 0)?, false); count];
        let mut parts = Vec::new();
        if self.kept.is_divided(operand) {
            let mut arranged = self.arrangements(operand, found, shared)?;
            for arrangement in &arranged {
                fates[self.surfaces.id(arrangement.face.number).index()] = Fate::Cut;
            }
            let mut labels = self.labels(operand, &mut arranged, &fates, found)?;
            let firsts = arranged.iter_mut().map(|a| labels.number_in_front(a));
            let firsts = firsts.collect::<Result<Vec<i32>, Declined>>()?;
            self.decide(operand, &mut labels, &mut fates)?;
            for face in &found.touched {
                if self.surfaces.operand_of(*face) == operand {
                    fates[self.surfaces.id(*face).index()].touch();
                }
            }
            parts = self.parts(operand, arranged, firsts, &mut fates)?;
        }
        Ok((self.groups(operand, &fates), parts))
    }

    /// Decides whether each face of an operand in `near` stays, except faces that are divided.
    fn decide(
        &self,
        operand: usize,
        labels: &mut Labels,
        fates: &mut [Fate],
    ) -> Result<(), Declined> {
        let mesh = self.surfaces.operands[operand].mesh;
        for id in &self.near[operand] {
            poll();
            if fates[id.index()] != Fate::Cut {
                let number = labels
                    .number_at_corners(mesh.vertices_of(*id))
                    .ok_or(Declined::Thin)?;
                fates[id.index()] = Fate::of(self.kept.at(operand, number)?, false);
            }
        }
        Ok(())
    }

    /// Prepares the winding numbers at an operand's vertices (of the other operand, or of the mesh itself if
    /// there is only one): relates the numbers of vertices connected by faces, and counts the numbers that
    /// must be known in advance.
    fn labels<'b>(
        &self,
        operand: usize,
        arranged: &mut [Arrangement],
        fates: &[Fate],
        found: &'b Contacts,
    ) -> Result<Labels<'b>, Declined>
    where
        'a: 'b,
    {
        let operands = &self.surfaces.operands;
        let (of, around) = (operands[operand], operands.len() - 1 - operand);
        let touching = &found.touching[operand];
        let mut labels = Labels::new(of, (around, operands[around]), touching);
        for arrangement in arranged.iter() {
            labels.join_cells(arrangement)?;
        }
        let others = || {
            self.near[operand]
                .iter()
                .filter(|id| fates[id.index()] != Fate::Cut)
        };
        for id in others() {
            poll();
            labels.join_corners(of.mesh.vertices_of(*id))?;
        }
        match self.kept {
            KeepRule::Pair(_) => labels.record_zero_outside(),
            KeepRule::Single(_) => labels.count_at_widest_faces(arranged, others())?,
        }
        Ok(labels)
    }

    /// Returns the faces of an operand that stay whole, grouped by orientation and by whether others touch
    /// them.
    fn groups(&self, operand: usize, fates: &[Fate]) -> Vec<FaceGroup> {
        let Operand { mesh, source, .. } = self.surfaces.operands[operand];
        let group = |(touching, orientation)| FaceGroup {
            touching,
            source: Arc::clone(source),
            orientation,
            faces: Vec::new(),
        };
        let kinds = [false, true].map(|touching| Orientation::BOTH.map(|o| (touching, o)));
        let mut groups = kinds
            .as_flattened()
            .iter()
            .copied()
            .map(group)
            .collect::<Vec<_>>();
        for (id, fate) in mesh.face_ids().zip(fates) {
            if let Fate::Whole(orientation, touching) = fate {
                let kind = 2 * usize::from(*touching) + usize::from(orientation.is_opposite());
                groups[kind].faces.push(id);
            }
        }
        groups.retain(|g| !g.faces.is_empty());
        groups
    }

    /// Returns the parts that stay of an operand's divided faces, in the order of a leaf: by orientation,
    /// then by face. Records in `fates` the divided faces that stay or go as a whole.
    fn parts(
        &self,
        operand: usize,
        mut arranged: Vec<Arrangement>,
        firsts: Vec<i32>,
        fates: &mut [Fate],
    ) -> Result<Vec<PartElement>, Declined> {
        let numbered = arranged.iter_mut().zip(firsts);
        let mut all: Vec<(FaceId, &mut Arrangement, i32)> = numbered
            .map(|(a, first)| (self.surfaces.id(a.face.number), a, first))
            .collect();
        all.sort_unstable_by_key(|(id, ..)| *id);
        let ids: Vec<FaceId> = all.iter().map(|(id, ..)| *id).collect();
        let blocks = all.chunks_mut(ITEMS_PER_TASK).collect();
        let found = each(
            self.work_size,
            blocks,
            |block: &mut [(FaceId, &mut Arrangement, i32)]| {
                let left = block
                    .iter_mut()
                    .map(|(_, a, first)| self.remaining_parts(operand, a, *first));
                left.collect::<Result<Vec<_>, Declined>>()
            },
        );
        let found: Vec<Vec<RemainingParts>> = found.into_iter().collect::<Result<_, _>>()?;
        let mut parts = [Vec::new(), Vec::new()];
        for (id, left) in ids.into_iter().zip(found.into_iter().flatten()) {
            match left {
                RemainingParts::Whole(stays) => fates[id.index()] = Fate::of(stays, true),
                RemainingParts::Parts(of_face) => {
                    for (all, part) in parts.iter_mut().zip(of_face) {
                        all.extend(part);
                    }
                }
            }
        }
        Ok(parts.concat())
    }

    /// Returns the parts of a divided face that bound the result, given the winding number in front of its
    /// first cell.
    fn remaining_parts(
        &self,
        operand: usize,
        arrangement: &mut Arrangement,
        first: i32,
    ) -> Result<RemainingParts, Declined> {
        let stays = |cell: &CellNumbers| self.kept.of_cell(operand, cell, first);
        let all = arrangement
            .cells
            .iter()
            .map(stays)
            .collect::<Result<Vec<_>, Declined>>()?;
        if all.iter().all(|s| *s == all[0]) {
            return Ok(RemainingParts::Whole(all[0]));
        }
        let id = self.surfaces.id(arrangement.face.number);
        let mut part = |orientation: Orientation| {
            let edges = arrangement.outline(|cell| stays(cell) == Ok(Some(orientation)));
            (!edges.is_empty()).then(|| {
                let source = Arc::clone(self.surfaces.operands[operand].source);
                let part = Arc::new(Part::new(source, id, self.cell, edges));
                PartElement { part, orientation }
            })
        };
        Ok(RemainingParts::Parts(Orientation::BOTH.map(&mut part)))
    }
}

/// Returns the rows that belong to one face, from a table sorted by face number; `of` returns the face number
/// of a row.
fn rows_of_face<T>(rows: &[T], face: u32, of: impl Fn(&T) -> u32) -> &[T] {
    let first = rows.partition_point(|row| of(row) < face);
    let count = rows[first..]
        .iter()
        .take_while(|row| of(row) == face)
        .count();
    &rows[first..first + count]
}

/// Returns the point in which two edges of one plane cross.
fn crossing(first: &LatticeEdge, second: &LatticeEdge) -> Vertex {
    let ((a, b), (c, d)) = (first.ends(), second.ends());
    let point = each_axis(|i| a[i] + d[i] - c[i]);
    let normal = normal(a, b, &point);
    let axis = (0..3).max_by_key(|i| normal[*i].abs()).unwrap_or(0);
    let plane = Arc::new(Plane::beside_edge(c, d, axis));
    Vertex::on_edge(first, &plane).expect("edges that cross have different directions")
}
