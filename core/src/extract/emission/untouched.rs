//! Whole faces on their way out: the bulk of most meshes, in linear passes.

use std::ops::Range;

use rayon::prelude::*;

use crate::arith::convert::as_number;
use crate::extract::boundary::leaves::Fate;
use crate::geometry::side::Orientation;
use crate::interrupt::{carried, spend};
use crate::mesh::handle::{FaceId, OrientedFace, Slot, SourceFace};
use crate::mesh::tasks::{each_chunk, in_pool, CHUNK};
use crate::mesh::triangles::TriangleMesh;

/// The triangles at the start of a mesh that are faces of sources as they came.
#[derive(Debug, Default)]
pub struct Untouched {
    /// The vertices that only such triangles have.
    pub vertices: Range<u32>,
    /// How many triangles there are.
    pub count: usize,
    /// Those with other vertices, too, ascending.
    pub special: Vec<u32>,
}

/// The faces of a source, of which the whole ones are to be emitted.
pub struct WholeFaces<'a> {
    /// The source.
    pub slot: Slot,
    /// The fates of its faces.
    pub fates: &'a [Fate],
    /// The whole faces that are left out, ascending.
    pub split: &'a [SourceFace],
}

/// A chunk of faces and the places of its triangles.
struct Task<'a> {
    first_face: usize,
    first_triangle: u32,
    fates: &'a [Fate],
    triangles: &'a mut [[u32; 3]],
    faces: &'a mut [OrientedFace],
}

impl Untouched {
    /// No triangles yet; these are the vertices they have for themselves.
    pub fn new(vertices: Range<u32>) -> Self {
        Self {
            vertices,
            ..Self::default()
        }
    }

    /// Appends the whole faces of a source; `images` has the number of each of its vertices.
    pub fn emit(
        &mut self,
        mesh: &TriangleMesh,
        images: &[u32],
        whole: &WholeFaces,
        triangles: &mut Vec<[u32; 3]>,
        faces: &mut Vec<OrientedFace>,
    ) {
        let counts = each_chunk(whole.fates, |first, fates| whole.kept(first, fates).count());
        let start = triangles.len();
        self.count = start + counts.iter().sum::<usize>();
        triangles.resize(self.count, [0; 3]);
        faces.resize(self.count, OrientedFace::default());
        let mut tasks = Vec::with_capacity(counts.len());
        let mut rest = (&mut triangles[start..], &mut faces[start..]);
        let mut first_triangle = as_number(start);
        let chunks = whole.fates.chunks(CHUNK).enumerate();
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
            task.run(mesh, images, whole, &self.vertices)
        });
        let special: Vec<Vec<u32>> = if in_pool() && tasks.len() > 1 {
            tasks.into_par_iter().map(emit).collect()
        } else {
            tasks.into_iter().map(emit).collect()
        };
        self.special.extend(special.concat());
    }
}

impl WholeFaces<'_> {
    /// The faces to emit among a run of faces, and whether they are turned around.
    fn kept<'a>(
        &'a self,
        first: usize,
        fates: &'a [Fate],
    ) -> impl Iterator<Item = OrientedFace> + 'a {
        let start = self.split.partition_point(|s| s.id.place() < first);
        let mut split = self.split[start..].iter().peekable();
        (as_number(first)..)
            .zip(fates)
            .filter_map(move |(id, fate)| {
                let Fate::Whole(orientation) = *fate else {
                    return None;
                };
                let face = SourceFace::new(self.slot, FaceId(id));
                let is_left_out = split.next_if_eq(&&face).is_some();
                (!is_left_out).then_some(face.oriented(orientation))
            })
    }
}

impl Task<'_> {
    /// Fills in the triangles; returns the numbers of those with other vertices than `own`.
    fn run(
        self,
        mesh: &TriangleMesh,
        images: &[u32],
        whole: &WholeFaces,
        own: &Range<u32>,
    ) -> Vec<u32> {
        let mut special = Vec::new();
        let out = self.triangles.iter_mut().zip(self.faces.iter_mut());
        let kept = whole.kept(self.first_face, self.fates);
        for ((face, (triangle, origin)), number) in kept.zip(out).zip(self.first_triangle..) {
            let [a, b, c] = mesh.vertices_of(face.id()).map(|v| images[v as usize]);
            *triangle = match face.orientation {
                Orientation::Same => [a, b, c],
                Orientation::Opposite => [a, c, b],
            };
            *origin = face;
            if [a, b, c].iter().any(|v| !own.contains(v)) {
                special.push(number);
            }
        }
        special
    }
}
