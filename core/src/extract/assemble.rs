//! Assembles the closed triangle mesh of a solid from the boundary that its tree lists.

use std::sync::Arc;

use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;

use super::boundary::collect::collect;
use super::boundary::leaves::{Fate, Fates};
use super::boundary::rim::{half_edge_ends, FrontierEdge, Rims};
use super::contacts;
use super::emission::assembly::{Assembly, NONE};
use super::emission::untouched::{Emitted, Untouched};
use super::failure::Failure;
use super::joining::group::PlaneGroup;
use super::joining::patches::Patches;
use super::joining::planes::{group, Joined};
use super::joining::seams::{find_touching, subdivisions, Edge, InnerPoints, LinePoints};
use super::mesh::{Corner, ExactMesh};
use super::order::put_in_order;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::outline::BareEdge;
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;
use crate::interrupt::{carried, poll, spend};
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{OrientedFace, Slot, SourceFace, VertexId};
use crate::mesh::tasks::{in_pool, CHUNK};
use crate::tree::solid::Solid;

/// A face that belongs to a solid's boundary as a whole, and the numbers of the points inserted on each of
/// its three edges.
struct SplitFace {
    face: OrientedFace,
    inner: [Vec<u32>; 3],
}

/// In a plane group (the boundary faces of one plane) of at most this many edges, the ends of edges are
/// searched one by one: making a table of them takes longer.
const MAX_EDGES_SEARCHED: usize = 16;

/// Returns the exact triangle mesh of a bounded solid.
///
/// An input face that no cut touches stays one triangle; cut faces are triangulated anew, together with
/// coplanar faces adjacent to them. Every directed edge of the mesh has exactly one opposite.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::extract::assemble::assemble;
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// let mesh = assemble(&solid)?;
/// assert_eq!((mesh.vertices.len(), mesh.untouched), (4, 4));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
///
/// # Errors
/// `Unbounded` if the solid reaches infinity; `NotReduced` if a trusted mesh overlaps itself.
pub fn assemble(solid: &Solid) -> Result<ExactMesh> {
    assemble_patches(solid, &Patches::default())
}

/// Returns the exact mesh of a bounded solid, and joins coplanar faces only within one patch: so no triangle
/// covers faces of two patches.
///
/// # Errors
/// As for [`assemble`].
pub fn assemble_patches(solid: &Solid, patches: &Patches) -> Result<ExactMesh> {
    let sources = Sources::new(solid.sources().clone());
    if solid.root().outside > 0 {
        return Err(unbounded());
    }
    let made = match attempt(solid, &sources, patches, true) {
        Err(Failure::Overlap(_)) if !solid.is_reduced() => attempt(solid, &sources, patches, false),
        result => result,
    };
    made.map_err(|failure| failure.error(solid))
}

/// Assembles the mesh of a solid; if `join` is true, it first joins the cut faces of each plane to polygons.
///
/// Joining assumes that faces of one plane do not overlap. In a solid that is not known to be reduced they
/// may: then a polygon cannot be triangulated, or its triangles have a wrong area, and the result is
/// `Overlap`.
fn attempt(
    solid: &Solid,
    sources: &Sources,
    patches: &Patches,
    join: bool,
) -> Result<ExactMesh, Failure> {
    let mut boundary = collect(solid, sources);
    let near = std::mem::take(&mut boundary.near);
    let joined = group(boundary, sources, patches, join);
    if joined.groups.iter().any(|g| reaches_infinity(g, sources)) {
        return Err(unbounded().into());
    }
    let mut assembly = Assembly::new(sources, &joined.fates);
    assembly.verify = join && !solid.is_reduced();
    assembly.run(joined, &near)?;
    let is_manifold = contacts::is_manifold(&assembly)?;
    let mut mesh = assembly.finish();
    if !is_manifold {
        // Which faces stay together at a contact may depend on their order.
        let mut positions = mesh.positions(solid);
        put_in_order(&mut mesh, &mut positions);
        contacts::split(&mut mesh, sources)?;
    }
    Ok(mesh)
}

fn unbounded() -> Error {
    let text = "the solid is unbounded and has no mesh; intersect it with a box first";
    Error::new(ErrorKind::Unbounded, text)
}

/// Returns true if an edge of a plane group (the boundary faces of one plane) lies on the border of the
/// universe; only faces of half-spaces reach it.
fn reaches_infinity(group: &PlaneGroup, sources: &Sources) -> bool {
    let mut faces = group.faces.iter();
    faces.any(|f| sources.get(f.slot()).mesh().is_none())
        && group.edges().iter().any(|e| e.carrier.is_border())
}

impl Assembly<'_> {
    fn run(&mut self, joined: Joined, near: &[SourceFace]) -> Result<(), Failure> {
        let Joined {
            mut fates,
            mut groups,
            rims,
            chords,
        } = joined;
        self.mark_irregular(&fates, &rims);
        self.identify_near(near, &fates);
        let frontier = rims.frontier(&fates, self.sources);
        let count: usize = groups.iter().map(|g| g.edges().len()).sum();
        let mut edges = Vec::with_capacity(count + frontier.len());
        let mut starts = Vec::with_capacity(groups.len());
        for group in &groups {
            poll();
            starts.push(edges.len());
            self.number_edges(group, &mut edges);
        }
        let offset = edges.len();
        for e in &frontier {
            edges.extend(self.frontier_edge(*e, &fates));
        }
        let mut touching = self.touching(&mut groups, &edges);
        for line in chords {
            touching.entry(line).or_default();
        }
        let line = |i: usize| {
            if i >= offset {
                return frontier[i - offset].line(self.sources);
            }
            let group = starts.partition_point(|start| *start <= i) - 1;
            groups[group].lines()[i - starts[group]]
        };
        let inner = subdivisions(&edges, line, &touching, &self.table);
        self.name_corners(&groups, &edges, &inner);
        let split = split_faces(&frontier, offset, &inner, &fates);
        self.identify_corners(&split, &mut fates);
        self.emit_whole(&fates, &rims);
        for split in &split {
            poll();
            self.emit_split(split.face, &split.inner)?;
        }
        edges.truncate(offset);
        Ok(self.emit_groups(groups, &edges, &inner)?)
    }

    /// Appends the edges of a plane group (the boundary faces of one plane) as pairs of point numbers; looks
    /// up an end shared by two edges only once.
    fn number_edges(&mut self, group: &PlaneGroup, edges: &mut Vec<Edge>) {
        let start = edges.len();
        if group.edges().len() > MAX_EDGES_SEARCHED {
            let mut known: HashMap<*const Vertex, u32> = HashMap::default();
            for e in group.edges() {
                let [from, to] = [&e.from, &e.to].map(|at| {
                    let entry = known.entry(Arc::as_ptr(at));
                    *entry.or_insert_with(|| self.table.number_of(at))
                });
                edges.push(Edge { from, to });
            }
            return;
        }
        for (i, e) in group.edges().iter().enumerate() {
            let before = group.edges()[..i].iter().zip(&edges[start..]);
            let [from, to] = [&e.from, &e.to].map(|at| known_end(at, before.clone()));
            let from = from.unwrap_or_else(|| self.table.number_of(&e.from));
            let to = to.unwrap_or_else(|| self.table.number_of(&e.to));
            edges.push(Edge { from, to });
        }
    }

    /// Finds, for each line, the points on it at which a polygon (the joined boundary faces of one plane)
    /// touches or crosses its own edges.
    fn touching(&mut self, groups: &mut [PlaneGroup], edges: &[Edge]) -> LinePoints {
        let mut touching = LinePoints::default();
        let mut start = 0;
        for group in groups {
            let own = &edges[start..start + group.edges().len()];
            start += group.edges().len();
            find_touching(own, group, &mut self.table, &mut touching);
        }
        touching
    }

    /// Adds to the vertex table the corners of those faces `near` that are boundary as a whole: they lie in
    /// cells where several operands met, so that the surface may touch itself there.
    fn identify_near(&mut self, near: &[SourceFace], fates: &Fates) {
        for face in near {
            if matches!(fates[*face], Fate::Whole(_)) {
                self.identify(*face);
            }
        }
    }

    /// Adds the corners of a face to the vertex table, which numbers them.
    fn identify(&mut self, face: SourceFace) {
        let source = Arc::clone(self.sources.get(face.slot));
        if let Some(mesh) = source.mesh() {
            for vertex in mesh.vertices_of(face.id) {
                self.point_of(face.slot, mesh, vertex);
            }
        }
    }

    fn frontier_edge(&mut self, e: FrontierEdge, fates: &Fates) -> Option<Edge> {
        let mesh = self.sources.get(e.slot).mesh()?;
        let ends = half_edge_ends(mesh, e.half);
        let [p, q] = ends.map(|v| self.point_of(e.slot, mesh, v));
        let turned = fates[e.face()] == Fate::Whole(Orientation::Opposite);
        let (from, to) = if turned { (q, p) } else { (p, q) };
        Some(Edge { from, to })
    }

    /// Records for each corner of a plane group (the joined boundary faces of one plane) the source vertex at
    /// the same position, whose original doubles the corner gets.
    ///
    /// Only vertices of the group's own faces count, though a vertex of another face may lie at a corner,
    /// too.
    fn name_corners(&mut self, groups: &[PlaneGroup], edges: &[Edge], inner: &InnerPoints) {
        let sources = self.sources;
        let mut group_of = vec![usize::MAX; self.table.len()];
        let mut first = 0;
        for (number, group) in groups.iter().enumerate() {
            let last = first + group.edges().len();
            for (edge, i) in edges[first..last].iter().zip(first..) {
                poll();
                group_of[edge.from as usize] = number;
                for point in inner.get(&i).into_iter().flatten() {
                    group_of[*point as usize] = number;
                }
            }
            first = last;
            for face in &group.faces {
                poll();
                let slot = face.slot();
                let Some(mesh) = sources.get(slot).mesh() else {
                    continue;
                };
                for vertex in mesh.vertices_of(face.id()) {
                    let place = Vertex::lattice(mesh.vertices[vertex.index()]);
                    let found = self.table.find(&place);
                    if let Some(point) = found.filter(|p| group_of[*p as usize] == number) {
                        self.name(point, (slot, vertex));
                    }
                }
            }
        }
    }

    /// Adds to the vertex table the vertices on edges that more than two faces of one source share.
    fn mark_irregular(&mut self, fates: &Fates, rims: &Rims) {
        let irregular = carried(|(slot, fates): (Slot, &[Fate])| {
            let rim = rims.get(slot);
            let source = self.sources.get(slot);
            let found = || source.irregular_among(|v| rim.is_used(v), rim.used_count());
            if fates.is_empty() {
                Vec::new()
            } else {
                found()
            }
        });
        let all: Vec<_> = fates.by_slot().collect();
        let found: Vec<Vec<VertexId>> = if in_pool() && fates.faces() > CHUNK {
            all.into_par_iter().map(irregular).collect()
        } else {
            all.into_iter().map(irregular).collect()
        };
        for (slot, vertices) in Slot::all().zip(found) {
            let source = Arc::clone(self.sources.get(slot));
            let Some(mesh) = source.mesh() else { continue };
            for vertex in vertices {
                self.point_of(slot, mesh, vertex);
            }
        }
    }

    /// Adds the corners of split faces to the vertex table before triangles are emitted, and marks the split
    /// faces as cut.
    fn identify_corners(&mut self, split: &[SplitFace], fates: &mut Fates) {
        for SplitFace { face, .. } in split {
            self.identify(face.face);
            fates[face.face] = Fate::Cut;
        }
    }

    /// Appends the triangles of all whole faces, and the vertices that no other triangle uses.
    fn emit_whole(&mut self, fates: &Fates, rims: &Rims) {
        let first = VertexId::of(self.vertices.len());
        for (slot, images) in Slot::all().zip(&mut self.images) {
            spend(images.len());
            let vertices = images.iter_mut().zip(rims.get(slot).used());
            for (vertex, (image, is_used)) in VertexId::all().zip(vertices) {
                if *image == NONE && is_used {
                    *image = VertexId::of(self.vertices.len());
                    self.vertices.push(Corner::Source(slot, vertex));
                }
            }
        }
        self.untouched = Untouched::new(first..VertexId::of(self.vertices.len()));
        for (slot, fates) in fates.by_slot() {
            let source = self.sources.get(slot);
            let (Some(mesh), images) = (source.mesh(), &self.images[slot.index()]) else {
                continue;
            };
            let source = Emitted { slot, mesh, images };
            let (triangles, faces) = (&mut self.triangles, &mut self.faces);
            self.untouched.emit(&source, fates, triangles, faces);
        }
    }
}

/// Returns the number of the point `end` if one of the numbered edges starts or ends there.
fn known_end<'e>(
    at: &Arc<Vertex>,
    mut numbered: impl Iterator<Item = (&'e BareEdge, &'e Edge)>,
) -> Option<u32> {
    numbered.find_map(|(e, numbers)| {
        if Arc::ptr_eq(at, &e.from) {
            Some(numbers.from)
        } else {
            Arc::ptr_eq(at, &e.to).then_some(numbers.to)
        }
    })
}

/// Returns the whole faces that received points on their edges, ascending.
///
/// The edges of `frontier` are sorted by face; in `inner` they have the numbers from `offset` on.
fn split_faces(
    frontier: &[FrontierEdge],
    offset: usize,
    inner: &InnerPoints,
    fates: &Fates,
) -> Vec<SplitFace> {
    let mut split: Vec<SplitFace> = Vec::new();
    for (edge, number) in frontier.iter().zip(offset..) {
        let (face, Some(points)) = (edge.face(), inner.get(&number)) else {
            continue;
        };
        if split.last().is_none_or(|last| last.face.face != face) {
            let orientation = match fates[face] {
                Fate::Whole(orientation) => orientation,
                Fate::Cut | Fate::Gone => Orientation::Same,
            };
            split.push(SplitFace {
                face: face.oriented(orientation),
                inner: Default::default(),
            });
        }
        if let Some(last) = split.last_mut() {
            last.inner[edge.half as usize % 3].clone_from(points);
        }
    }
    split
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{cuboid, made_of, tetrahedra};
    use crate::mesh::faces::edges;

    /// The directed edges of a mesh, sorted.
    fn sorted_edges(mesh: &ExactMesh) -> Vec<[VertexId; 2]> {
        let mut all: Vec<_> = mesh.triangles.iter().flat_map(|t| edges(*t)).collect();
        all.sort_unstable();
        all
    }

    fn assert_closed(mesh: &ExactMesh) {
        let edges = sorted_edges(mesh);
        assert!(edges.windows(2).all(|pair| pair[0] != pair[1]));
        let has_mate = |[a, b]: &[VertexId; 2]| edges.binary_search(&[*b, *a]).is_ok();
        assert!(edges.iter().all(has_mate));
    }

    #[test]
    fn untouched_faces_come_first_and_the_mesh_is_closed() {
        let mesh = assemble(&made_of(&tetrahedra(), Term::Or)).expect("bounded");
        assert_closed(&mesh);
        assert_eq!(mesh.untouched, 4);
        let is_source = |v: &VertexId| matches!(mesh.vertices[v.index()], Corner::Source(..));
        assert!(mesh.triangles[..4].iter().flatten().all(is_source));
        // The corner inside is gone; its three edges meet the first one's last face.
        assert_eq!(mesh.vertices.len(), 4 + 3 + 3);
    }

    #[test]
    fn solids_that_touch_in_an_edge_have_it_twice() {
        let boxes = [cuboid([0; 3], [4; 3]), cuboid([4, 4, 0], [8, 8, 4])];
        let mesh = assemble(&made_of(&boxes, Term::Or)).expect("bounded");
        assert_closed(&mesh);
        assert_eq!(mesh.vertices.len(), 16);
    }

    #[test]
    fn the_complement_of_a_box_has_no_mesh() {
        let all = cuboid([0; 3], [4; 3]);
        let outside = Solid::new(
            all.root().complemented(),
            all.pitch(),
            all.sources().clone(),
            true,
        );
        let refused = assemble(&outside).expect_err("unbounded");
        assert_eq!(refused.kind(), ErrorKind::Unbounded);
    }
}
