//! Emits the faces that are boundary as a whole, the bulk of most meshes, in linear passes.

use std::ops::Range;

use rayon::prelude::*;

use crate::arith::convert::as_number;
use crate::extract::boundary::leaves::Fate;
use crate::geometry::side::Orientation;
use crate::interrupt::{carried, spend};
use crate::mesh::handle::{FaceId, OrientedFace, Slot, SourceFace, VertexId};
use crate::mesh::tasks::{each_chunk, in_pool, CHUNK};
use crate::mesh::triangles::TriangleMesh;

/// The triangles of a mesh that are whole, unchanged faces of sources; they come first in the mesh.
#[derive(Debug, Default)]
pub struct Untouched {
    /// The vertices that only triangles of untouched faces use.
    pub vertices: Range<VertexId>,
    /// The number of triangles of untouched faces.
    pub count: usize,
    /// The triangles of untouched faces with a vertex outside `vertices`, which other triangles may use,
    /// ascending.
    pub special: Vec<u32>,
}

/// A chunk of a source's faces, and the output slices for their triangles.
struct Task<'a> {
    first_face: usize,
    first_triangle: u32,
    fates: &'a [Fate],
    triangles: &'a mut [[VertexId; 3]],
    faces: &'a mut [OrientedFace],
}

/// A source whose whole faces are to be emitted.
pub struct Emitted<'a> {
    /// The slot of the source.
    pub slot: Slot,
    /// The triangle mesh of the source.
    pub mesh: &'a TriangleMesh,
    /// The output vertex of each vertex of the source.
    pub images: &'a [VertexId],
}

impl Untouched {
    /// Starts without triangles; `vertices` are the output vertices that only untouched faces will use.
    pub fn new(vertices: Range<VertexId>) -> Self {
        Self {
            vertices,
            ..Self::default()
        }
    }

    /// The number of vertices that only untouched faces use.
    pub fn own_count(&self) -> usize {
        self.vertices.end.index() - self.vertices.start.index()
    }

    /// Appends the triangles of a source's whole faces.
    pub fn emit(
        &mut self,
        source: &Emitted,
        fates: &[Fate],
        triangles: &mut Vec<[VertexId; 3]>,
        faces: &mut Vec<OrientedFace>,
    ) {
        let is_whole = |fate: &&Fate| matches!(fate, Fate::Whole(_));
        let counts = each_chunk(fates, |_, fates| fates.iter().filter(is_whole).count());
        let start = triangles.len();
        self.count = start + counts.iter().sum::<usize>();
        triangles.resize(self.count, [VertexId(0); 3]);
        faces.resize(self.count, OrientedFace::default());
        let mut tasks = Vec::with_capacity(counts.len());
        let mut rest = (&mut triangles[start..], &mut faces[start..]);
        let mut first_triangle = as_number(start);
        let chunks = fates.chunks(CHUNK).enumerate();
        for ((chunk, fates), count) in chunks.zip(counts) {
            let (triangles, later) = rest.0.split_at_mut(count);
            let (faces, later_faces) = rest.1.split_at_mut(count);
            rest = (later, later_faces);
            tasks.push(Task {
                first_face: chunk * CHUNK,
                first_triangle,
                fates,
                triangles,
                faces,
            });
            first_triangle += as_number(count);
        }
        let emit = carried(|task: Task| {
            spend(task.fates.len());
            task.run(source, &self.vertices)
        });
        let special: Vec<Vec<u32>> = if in_pool() && tasks.len() > 1 {
            tasks.into_par_iter().map(emit).collect()
        } else {
            tasks.into_iter().map(emit).collect()
        };
        self.special.extend(special.concat());
    }
}

impl Task<'_> {
    /// Writes the triangles of the whole faces; returns the numbers of those with a vertex outside `own`.
    fn run(self, source: &Emitted, own: &Range<VertexId>) -> Vec<u32> {
        let mut special = Vec::new();
        let out = self.triangles.iter_mut().zip(self.faces.iter_mut());
        let mut out = out.zip(self.first_triangle..);
        let faces = source.mesh.faces[self.first_face..].iter().zip(self.fates);
        for (id, (&[a, b, c], fate)) in (as_number(self.first_face)..).zip(faces) {
            let Fate::Whole(orientation) = *fate else {
                continue;
            };
            let Some(((triangle, origin), number)) = out.next() else {
                break;
            };
            let image = |v: VertexId| source.images[v.index()];
            let (a, b, c) = (image(a), image(b), image(c));
            *triangle = match orientation {
                Orientation::Same => [a, b, c],
                Orientation::Opposite => [a, c, b],
            };
            *origin = SourceFace::new(source.slot, FaceId(id)).oriented(orientation);
            if !(own.contains(&a) && own.contains(&b) && own.contains(&c)) {
                special.push(number);
            }
        }
        special
    }
}
