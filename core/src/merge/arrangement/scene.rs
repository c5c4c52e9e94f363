//! Builds the leaf that results from meshes, from the contacts of their faces.

use std::sync::Arc;

use super::candidates::Operand;
use super::contacts::{Contacts, Cover, Edge, MeetingPoint, Segment};
use super::faces::{Arrangement, Face, Planes, SharedGeometry};
use super::facets::{FacetId, Facets};
use super::keep_rule::{KeepRule, Numbers};
use super::labels::Labels;
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

/// Meshes to be combined, or one to be united with itself.
#[derive(Debug)]
pub(super) struct Scene<'a> {
    pub(super) facets: Facets<'a>,
    /// For each operand, the faces in front of which a winding number may differ from 0.
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
        let operands = (0..self.facets.operands.len()).collect();
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
            facets: &self.facets,
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
            |block: &[FacetId]| {
                let planes = block
                    .iter()
                    .map(|f| self.facets.operand(*f).source.plane(self.facets.face(*f)));
                planes.collect::<Vec<_>>()
            },
        );
        faces.into_iter().zip(planes.concat()).collect()
    }

    /// Returns the facets that others divide or cover, and those whose corners all lie on faces of an operand,
    /// ascending.
    fn arranged_faces(&self, found: &Contacts) -> Vec<FacetId> {
        let segments = found.segments.iter().map(|s| s.facet);
        let covered = found.covers.iter().map(|c| c.facet);
        let mut facets: Vec<FacetId> = segments.chain(covered).collect();
        facets.dedup();
        for (k, near) in self.near.iter().enumerate() {
            for touching in found.touching.all_of(k) {
                let touches = |v: &VertexId| touching[v.index()];
                let vertices = |id: &FaceId| self.facets.operands[k].mesh.vertices_of(*id);
                let between_others = near.iter().filter(|id| vertices(id).iter().all(touches));
                facets.extend(between_others.map(|id| self.facets.number(k, *id)));
            }
        }
        facets.sort_unstable();
        facets.dedup();
        facets
    }

    fn vertex(&self, point: &MeetingPoint, planes: &Planes) -> Vertex {
        let edge = |(operand, ends): &Edge| {
            let points = &self.facets.operands[*operand].mesh.vertices;
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
        let mut facets: Vec<FacetId> = shared.planes.keys().copied().collect();
        facets.retain(|f| self.facets.operand_of(*f) == operand);
        facets.sort_unstable();
        let arranged = |facet: FacetId| {
            let face = Face {
                facet,
                operand,
                corners: self.facets.corners(facet),
                vertices: self.facets.vertices(facet),
                plane: &shared.planes[&facet],
                segments: rows_of_facet(&found.segments, facet, |s: &Segment| s.facet),
                covers: rows_of_facet(&found.covers, facet, |c: &Cover| c.facet),
            };
            Arrangement::new(face, shared)
        };
        let found = each(
            self.work_size,
            facets.chunks(ITEMS_PER_TASK).collect(),
            |block: &[FacetId]| {
                let block = block.iter().map(|facet| arranged(*facet));
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
        let count = self.facets.operands[operand].mesh.faces.len();
        let stays = self.kept.at(operand, self.zeros())?;
        let mut fates = vec![Fate::of(stays, false); count];
        let mut parts = Vec::new();
        if self.kept.depends_on_numbers(operand) {
            let mut arranged = self.arrangements(operand, found, shared)?;
            for arrangement in &arranged {
                fates[self.facets.face(arrangement.face.facet).index()] = Fate::Cut;
            }
            let mut firsts = vec![self.zeros(); arranged.len()];
            self.decide(operand, (&mut arranged, &mut firsts), found, &mut fates)?;
            for facet in &found.touched {
                if self.facets.operand_of(*facet) == operand {
                    fates[self.facets.face(*facet).index()].touch();
                }
            }
            parts = self.parts(operand, arranged, firsts, &mut fates)?;
        }
        Ok((self.groups(operand, &fates), parts))
    }

    /// Returns the winding numbers of a point that is outside all operands.
    fn zeros(&self) -> Numbers {
        Numbers::from_elem(0, self.facets.operands.len())
    }

    /// Finds the winding numbers in front of the faces of an operand in `near`: decides whether undivided faces
    /// stay, and writes the numbers in front of the first cells of divided faces.
    fn decide(
        &self,
        operand: usize,
        (arranged, firsts): (&mut [Arrangement], &mut [Numbers]),
        found: &Contacts,
        fates: &mut [Fate],
    ) -> Result<(), Declined> {
        let mesh = self.facets.operands[operand].mesh;
        let mut all = self.labels(operand, arranged, fates, found)?;
        for (arrangement, first) in arranged.iter_mut().zip(firsts) {
            for labels in &mut all {
                first[labels.around()] = labels.number_in_front(arrangement)?;
            }
        }
        // Consecutive faces mostly have the same numbers.
        let mut numbers = self.zeros();
        let mut last = (numbers.clone(), self.kept.at(operand, numbers.clone())?);
        for id in &self.near[operand] {
            poll();
            if fates[id.index()] == Fate::Cut {
                continue;
            }
            for labels in &mut all {
                let number = labels.number_at_corners(mesh.vertices_of(*id));
                numbers[labels.around()] = number.ok_or(Declined::Thin)?;
            }
            if numbers != last.0 {
                last = (numbers.clone(), self.kept.at(operand, numbers.clone())?);
            }
            fates[id.index()] = Fate::of(last.1, false);
        }
        Ok(())
    }

    /// Prepares the winding numbers of each operand in front of one operand's faces; its own numbers only if
    /// its faces were compared with each other.
    fn labels<'b>(
        &self,
        operand: usize,
        arranged: &mut [Arrangement],
        fates: &[Fate],
        found: &'b Contacts,
    ) -> Result<Vec<Labels<'b>>, Declined>
    where
        'a: 'b,
    {
        let others =
            (0..self.facets.operands.len()).filter(|k| *k != operand || self.kept.is_resolved(*k));
        let of = self.facets.operands[operand];
        let is_whole = |id: &&FaceId| fates[id.index()] != Fate::Cut;
        let whole = || self.near[operand].iter().filter(is_whole);
        let joined = |around: usize| {
            let windings = (around, self.facets.operands[around]);
            let mut labels = Labels::new(of, windings, found.touching.of(operand, around));
            for arrangement in arranged.iter() {
                labels.join_cells(arrangement)?;
            }
            for id in whole() {
                poll();
                labels.join_corners(of.mesh.vertices_of(*id))?;
            }
            if around == operand {
                labels.count_at_widest_faces(arranged, whole())?;
            } else {
                labels.record_zero_outside();
            }
            Ok(labels)
        };
        others.map(joined).collect()
    }

    /// Returns the faces of an operand that stay whole, grouped by orientation and by whether others touch
    /// them.
    fn groups(&self, operand: usize, fates: &[Fate]) -> Vec<FaceGroup> {
        let Operand { mesh, source, .. } = self.facets.operands[operand];
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
        firsts: Vec<Numbers>,
        fates: &mut [Fate],
    ) -> Result<Vec<PartElement>, Declined> {
        let numbered = arranged.iter_mut().zip(firsts);
        let mut all: Vec<(FaceId, &mut Arrangement, Numbers)> = numbered
            .map(|(a, first)| (self.facets.face(a.face.facet), a, first))
            .collect();
        all.sort_unstable_by_key(|(id, ..)| *id);
        let ids: Vec<FaceId> = all.iter().map(|(id, ..)| *id).collect();
        let blocks = all.chunks_mut(ITEMS_PER_TASK).collect();
        let found = each(
            self.work_size,
            blocks,
            |block: &mut [(FaceId, &mut Arrangement, Numbers)]| {
                let left = block
                    .iter_mut()
                    .map(|(_, a, first)| self.remaining_parts(operand, a, first));
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

    /// Returns the parts of a divided face that bound the result, given the winding numbers in front of its
    /// first cell.
    fn remaining_parts(
        &self,
        operand: usize,
        arrangement: &mut Arrangement,
        first: &Numbers,
    ) -> Result<RemainingParts, Declined> {
        let cells = 0..arrangement.len();
        let stays = cells.map(|cell| self.stays(operand, arrangement, cell, first));
        let stays = stays.collect::<Result<Vec<_>, Declined>>()?;
        if stays.iter().all(|s| *s == stays[0]) {
            return Ok(RemainingParts::Whole(stays[0]));
        }
        let id = self.facets.face(arrangement.face.facet);
        let mut part = |orientation: Orientation| {
            let is_kept: Vec<bool> = stays.iter().map(|s| *s == Some(orientation)).collect();
            let edges = arrangement.outline(&is_kept);
            (!edges.is_empty()).then(|| {
                let source = Arc::clone(self.facets.operands[operand].source);
                let part = Arc::new(Part::new(source, id, self.cell, edges));
                PartElement { part, orientation }
            })
        };
        Ok(RemainingParts::Parts(Orientation::BOTH.map(&mut part)))
    }

    /// Returns the orientation in which a cell of a divided face stays; `None` if it does not stay.
    ///
    /// # Errors
    /// `Overlap` if another operand that is not resolved overlaps itself at the cell.
    fn stays(
        &self,
        operand: usize,
        arrangement: &Arrangement,
        cell: usize,
        first: &Numbers,
    ) -> Result<Option<Orientation>, Declined> {
        let is_doubtful = |k: &usize| {
            *k != operand && !self.kept.is_resolved(*k) && arrangement.covers(*k, cell) > 1
        };
        if let Some(k) = (0..self.facets.operands.len()).find(is_doubtful) {
            return Err(Declined::Overlap(k));
        }
        let stays = self
            .kept
            .between(operand, &arrangement.sides(cell, first))?;
        Ok(stays.filter(|_| !arrangement.is_of_earlier(cell)))
    }
}

/// Returns the rows that belong to one facet, from a table sorted by facet; `of` returns the facet of a row.
fn rows_of_facet<T>(rows: &[T], facet: FacetId, of: impl Fn(&T) -> FacetId) -> &[T] {
    let first = rows.partition_point(|row| of(row) < facet);
    let count = rows[first..]
        .iter()
        .take_while(|row| of(row) == facet)
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
