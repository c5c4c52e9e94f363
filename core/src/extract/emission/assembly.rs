//! A mesh under construction: its numbered vertices, of any origin, and its triangles.

use std::ops::Range;

use rustc_hash::FxHashMap as HashMap;

use super::untouched::Untouched;
use crate::arith::convert::as_number;
use crate::extract::boundary::leaves::{Fate, Fates};
use crate::extract::mesh::{renumber, Corner, ExactMesh};
use crate::geometry::vertices::VertexTable;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{OrientedFace, Slot, VertexId};
use crate::mesh::triangles::TriangleMesh;

/// A triangle mesh under construction, with exact vertices.
pub(in crate::extract) struct Assembly<'a> {
    pub(in crate::extract) sources: &'a Sources,
    pub(in crate::extract) table: VertexTable,
    /// For each slot, the output vertex of each vertex of its source.
    pub(in crate::extract) images: Vec<Vec<VertexId>>,
    /// For each point of the vertex table, its output vertex.
    pub(in crate::extract) point_images: Vec<VertexId>,
    /// For each point of the vertex table, the first source vertex at the same position.
    pub(in crate::extract) names: HashMap<u32, (Slot, VertexId)>,
    pub(in crate::extract) vertices: Vec<Corner>,
    pub(in crate::extract) triangles: Vec<[VertexId; 3]>,
    pub(in crate::extract) faces: Vec<OrientedFace>,
    /// The triangles at the start of `triangles`, which are untouched faces of sources.
    pub(in crate::extract) untouched: Untouched,
    /// True if areas are compared, because faces of one plane might overlap.
    pub(in crate::extract) verify: bool,
}

/// Stands for a vertex that has no number yet.
pub(in crate::extract) const NONE: VertexId = VertexId(u32::MAX);

impl<'a> Assembly<'a> {
    pub(in crate::extract) fn new(sources: &'a Sources, fates: &Fates) -> Self {
        let image = |(slot, fates): (Slot, &[Fate])| {
            let count = sources.get(slot).mesh().map_or(0, |m| m.vertices.len());
            vec![NONE; if fates.is_empty() { 0 } else { count }]
        };
        Self {
            sources,
            table: VertexTable::default(),
            images: fates.by_slot().map(image).collect(),
            point_images: Vec::new(),
            names: HashMap::default(),
            vertices: Vec::new(),
            triangles: Vec::new(),
            faces: Vec::new(),
            untouched: Untouched::default(),
            verify: false,
        }
    }

    /// Returns the number of a source vertex in the vertex table; from then on this table point is the output
    /// vertex for it.
    pub(in crate::extract) fn point_of(
        &mut self,
        slot: Slot,
        mesh: &TriangleMesh,
        vertex: VertexId,
    ) -> u32 {
        let image = self.images[slot.index()][vertex.index()];
        if let Some(Corner::Point(point)) = self.vertices.get(image.index()) {
            return *point;
        }
        let point = self.table.number_at(mesh.vertices[vertex.index()]);
        self.name(point, (slot, vertex));
        let image = self.image_of_point(point);
        self.images[slot.index()][vertex.index()] = image;
        point
    }

    /// Records that a table point coincides with a source vertex. If several source vertices coincide with
    /// it, the one that is first by source index (slot) and number stays recorded, in any order of calls.
    pub(in crate::extract) fn name(&mut self, point: u32, vertex: (Slot, VertexId)) {
        let name = self.names.entry(point).or_insert(vertex);
        *name = vertex.min(*name);
    }

    pub(in crate::extract) fn image_of_point(&mut self, point: u32) -> VertexId {
        if self.point_images.len() < self.table.len() {
            self.point_images.resize(self.table.len(), NONE);
        }
        let image = &mut self.point_images[point as usize];
        if *image == NONE {
            *image = VertexId::of(self.vertices.len());
            self.vertices.push(Corner::Point(point));
        }
        *image
    }

    /// Yields the triangles with a special vertex. A vertex is special unless only untouched input faces use
    /// it.
    pub(in crate::extract) fn special_triangles(&self) -> impl Iterator<Item = u32> + '_ {
        let last = as_number(self.untouched.count)..as_number(self.triangles.len());
        self.untouched.special.iter().copied().chain(last)
    }

    /// Returns the number of special vertices. A vertex is special unless only untouched input faces use it.
    pub(in crate::extract) fn special_count(&self) -> usize {
        self.vertices.len() - self.untouched.own_count()
    }

    /// Returns the index of a vertex among the special vertices; `None` if it is not special, that is, if
    /// only untouched input faces use it.
    pub(in crate::extract) fn special_place(&self, vertex: VertexId) -> Option<usize> {
        let others = &self.untouched.vertices;
        if vertex < others.start {
            Some(vertex.index())
        } else {
            (vertex >= others.end).then(|| vertex.index() - self.untouched.own_count())
        }
    }

    /// Returns the special vertex with a given index among special vertices. A vertex is special unless only
    /// untouched input faces use it.
    pub(in crate::extract) fn special_vertex(&self, place: usize) -> VertexId {
        let before = place < self.untouched.vertices.start.index();
        VertexId::of(if before {
            place
        } else {
            place + self.untouched.own_count()
        })
    }

    /// Returns the faces that the triangles at a vertex lie in.
    pub(in crate::extract) fn faces_at(&self, vertex: VertexId) -> Vec<OrientedFace> {
        let around = self.triangles.iter().zip(&self.faces);
        let around = around.filter(|(triangle, _)| triangle.contains(&vertex));
        around.map(|(_, face)| *face).collect()
    }

    /// Appends a triangle whose corners are points of the vertex table.
    pub(in crate::extract) fn push(&mut self, triangle: [u32; 3], face: OrientedFace) {
        let triangle = triangle.map(|p| self.image_of_point(p));
        self.triangles.push(triangle);
        self.faces.push(face);
    }

    pub(in crate::extract) fn finish(mut self) -> ExactMesh {
        for vertex in &mut self.vertices {
            if let Corner::Point(point) = *vertex
                && let Some((slot, index)) = self.names.get(&point)
            {
                *vertex = Corner::Source(*slot, *index);
            }
        }
        let order = self.order();
        if order.len() < self.vertices.len() || !order.is_sorted() {
            renumber(&mut self.vertices, &mut self.triangles, &order);
        }
        ExactMesh {
            vertices: self.vertices,
            triangles: self.triangles,
            faces: self.faces,
            untouched: self.untouched.count,
            special: self.untouched.special,
            table: self.table,
            findings: Vec::new(),
            counts: None,
        }
    }

    /// Returns the vertices that triangles use, in output order: first vertices of sources, by source index
    /// (slot) and number, then constructed points.
    fn order(&self) -> Vec<VertexId> {
        let mut given: Vec<(Slot, VertexId, VertexId)> = Vec::new();
        let mut points: Vec<VertexId> = Vec::new();
        for vertex in self.used_special_vertices() {
            match self.vertices[vertex.index()] {
                Corner::Source(slot, number) => given.push((slot, number, vertex)),
                Corner::Point(_) => points.push(vertex),
            }
        }
        given.sort_unstable();
        // The vertices that only untouched faces use are already in order.
        let Range { start, end } = self.untouched.vertices.clone();
        let own = &self.vertices[start.index()..end.index()];
        let mut order = Vec::with_capacity(own.len() + given.len() + points.len());
        let mut done = 0;
        for (slot, number, vertex) in given {
            let is_before = |corner: &Corner| *corner < Corner::Source(slot, number);
            let next = done + own[done..].partition_point(is_before);
            order.extend((start.index() + done..start.index() + next).map(VertexId::of));
            order.push(vertex);
            done = next;
        }
        order.extend((start.index() + done..end.index()).map(VertexId::of));
        order.extend(points);
        order
    }

    /// Yields the special vertices that triangles use, ascending. A vertex is special unless only untouched
    /// input faces use it.
    fn used_special_vertices(&self) -> impl Iterator<Item = VertexId> {
        let mut used = vec![false; self.special_count()];
        for triangle in self.special_triangles() {
            poll();
            for vertex in self.triangles[triangle as usize] {
                if let Some(place) = self.special_place(vertex) {
                    used[place] = true;
                }
            }
        }
        let places = (0..used.len()).filter(move |place| used[*place]);
        places.map(|place| self.special_vertex(place))
    }
}
