//! Joins the pieces of faces that stay in a cell into the elements of a deferred leaf.

use std::borrow::Cow;
use std::sync::Arc;

use crate::arith::convert::as_double;
use crate::geometry::cell::Cell;
use crate::geometry::line::LineKey;
use crate::geometry::outline::{cancel, BareEdge, OutlineEdge};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::side::{Orientation, Side};
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{FaceId, SourceFace};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::{DeferredLeaf, FaceGroup, Node, Part, PartElement};
use crate::tree::pieces::pieces;

/// The part of a face that bounds the result of a cell in one orientation.
#[derive(Debug)]
pub struct KeptPart {
    face: SourceFace,
    orientation: Orientation,
    region: KeptRegion,
}

#[derive(Debug)]
enum KeptRegion {
    /// All of a face that is inside the cell.
    Whole,
    /// All of an earlier part of a face that is inside the cell.
    Part(Arc<Part>),
    /// Convex pieces of a face, and a further region bounded by these edges.
    Pieces(Vec<Polygon>, Vec<BareEdge>),
    /// The region inside an outline, which is complete and not all of the face in the cell.
    Outline(Vec<BareEdge>),
}

impl KeptPart {
    /// Keeps all of a face that is in the cell.
    pub fn whole(face: SourceFace, orientation: Orientation) -> Self {
        let region = KeptRegion::Whole;
        Self {
            face,
            orientation,
            region,
        }
    }

    /// Keeps all of an earlier part of a face that is in the cell.
    pub fn part(face: SourceFace, orientation: Orientation, part: Arc<Part>) -> Self {
        let region = KeptRegion::Part(part);
        Self {
            face,
            orientation,
            region,
        }
    }

    /// Keeps convex pieces of a face.
    pub fn pieces(face: SourceFace, orientation: Orientation, pieces: Vec<Polygon>) -> Self {
        Self::joined(face, orientation, pieces, Vec::new())
    }

    /// Keeps convex pieces of a face, and a further region of the face bounded by `edges`.
    pub fn joined(
        face: SourceFace,
        orientation: Orientation,
        pieces: Vec<Polygon>,
        edges: Vec<BareEdge>,
    ) -> Self {
        let region = KeptRegion::Pieces(pieces, edges);
        Self {
            face,
            orientation,
            region,
        }
    }

    /// Keeps the region inside an outline, which must not be all of the face in the cell. No two consecutive
    /// edges may lie on one line.
    pub fn outlined(face: SourceFace, orientation: Orientation, edges: Vec<BareEdge>) -> Self {
        let region = KeptRegion::Outline(edges);
        Self {
            face,
            orientation,
            region,
        }
    }

    /// Returns the edges that bound the kept region, apart from its convex pieces.
    fn edges(&self) -> &[BareEdge] {
        match &self.region {
            KeptRegion::Pieces(_, edges) | KeptRegion::Outline(edges) => edges,
            KeptRegion::Whole | KeptRegion::Part(_) => &[],
        }
    }

    /// Returns the kept region inside the cell as convex pieces, apart from a region given by edges.
    fn polygons(&self, source: &Source, cell: &Cell) -> Cow<'_, [Polygon]> {
        match &self.region {
            KeptRegion::Whole => source.clip(self.face.id, cell).into_iter().collect(),
            KeptRegion::Part(part) => {
                let pieces = pieces(part);
                let clipped = pieces.iter().filter_map(|p| p.clipped(cell));
                clipped.collect()
            }
            KeptRegion::Pieces(pieces, _) => Cow::Borrowed(pieces),
            KeptRegion::Outline(_) => Cow::Borrowed(&[]),
        }
    }
}

/// Joins the kept pieces of each face, and returns them as a deferred leaf made by a kernel. `corner` is the
/// winding number at the cell's low corner, and `touching` says whether faces may touch each other anywhere.
pub fn assemble(
    mut kept: Vec<KeptPart>,
    corner: i32,
    touching: bool,
    cell: &Cell,
    sources: &Sources,
) -> Node {
    if kept.is_empty() {
        return Node::Leaf(corner);
    }
    kept.sort_by_key(|k| (k.face.slot, k.orientation, k.face.id));
    let mut leaf = DeferredLeaf {
        corner,
        by_kernel: true,
        ..DeferredLeaf::default()
    };
    for run in kept.chunk_by_mut(|a, b| a.face == b.face && a.orientation == b.orientation) {
        poll();
        let SourceFace { slot, id: face } = run[0].face;
        let source = sources.get(slot);
        let orientation = run[0].orientation;
        match run {
            [KeptPart {
                region: KeptRegion::Whole,
                ..
            }] => {
                list_whole(&mut leaf.groups, source, face, orientation, touching);
                continue;
            }
            [KeptPart {
                region: KeptRegion::Part(part),
                ..
            }] => {
                let part = Arc::clone(part);
                leaf.parts.push(PartElement { part, orientation });
                continue;
            }
            [KeptPart {
                region: KeptRegion::Outline(edges),
                ..
            }] => {
                let edges = std::mem::take(edges);
                let part = Arc::new(Part::new(Arc::clone(source), face, *cell, edges));
                leaf.parts.push(PartElement { part, orientation });
                continue;
            }
            _ => {}
        }
        if let Some(edges) = outline(run, source, face, cell) {
            let part = Arc::new(Part::new(Arc::clone(source), face, *cell, edges));
            leaf.parts.push(PartElement { part, orientation });
        } else {
            list_whole(&mut leaf.groups, source, face, orientation, touching);
        }
    }
    Node::Deferred(leaf)
}

/// Returns the outline of the part of a face that stays in one orientation; `None` if all of the face in the
/// cell stays.
fn outline(run: &[KeptPart], source: &Source, face: FaceId, cell: &Cell) -> Option<Vec<BareEdge>> {
    let polygons: Vec<Cow<[Polygon]>> = run.iter().map(|k| k.polygons(source, cell)).collect();
    let polygons: Vec<&Polygon> = polygons.iter().flat_map(|p| p.iter()).collect();
    let mut edges: Vec<BareEdge> = run.iter().flat_map(KeptPart::edges).cloned().collect();
    if let ([single], []) = (&polygons[..], &edges[..]) {
        // No edges of a convex piece cancel.
        if has_inner(single.edges(), source, face, cell) {
            return Some(BareEdge::edges_of(single).collect());
        }
    }
    edges.extend(polygons.iter().flat_map(|p| BareEdge::edges_of(p)));
    let edges = cancel(OutlineEdge::keyed(edges, &source.plane_residues(face)));
    let whole = is_whole(&edges, source, face, cell);
    (!whole).then(|| edges.into_iter().map(BareEdge::from).collect())
}

fn list_whole(
    groups: &mut Vec<FaceGroup>,
    source: &Arc<Source>,
    face: FaceId,
    orientation: Orientation,
    touching: bool,
) {
    match groups.last_mut() {
        Some(g) if Arc::ptr_eq(&g.source, source) && g.orientation == orientation => {
            g.faces.push(face);
        }
        _ => groups.push(FaceGroup {
            touching,
            source: Arc::clone(source),
            orientation,
            faces: vec![face],
        }),
    }
}

/// Returns true if an outline runs only along the face's own edges and the cell's walls. Then it is the
/// border of the whole face inside the cell: a part of a connected set without a border inside the set is all
/// of it.
pub fn is_whole(edges: &[OutlineEdge], source: &Source, face: FaceId, cell: &Cell) -> bool {
    let ends = edges.iter().map(|e| (&e.from, &e.to, &e.carrier));
    if has_inner(ends, source, face, cell) {
        return false;
    }
    let own: Vec<LineKey> = match source.shape() {
        Shape::Mesh(mesh) => {
            let c = mesh.corners(face);
            (0..3)
                .map(|i| LineKey::of_edge(&c[i], &c[(i + 1) % 3]))
                .collect()
        }
        Shape::HalfSpace(_) => Vec::new(),
    };
    let foreign = |e: &&OutlineEdge| !own.contains(&e.line);
    let others: Vec<&OutlineEdge> = edges.iter().filter(foreign).collect();
    if others.is_empty() {
        return !edges.is_empty();
    }
    // The walls of a cell are not slanted.
    let is_slanted = |carrier: &Carrier| match carrier {
        Carrier::Cut(plane, _) => plane.only_axis().is_none(),
        Carrier::Edge(_) => false,
    };
    if others.iter().any(|e| is_slanted(&e.carrier)) {
        return false;
    }
    let border = border_lines(&source.plane(face), cell);
    others.iter().all(|e| border.contains(&e.line))
}

/// Returns true if one of the given edges certainly lies neither on an edge of the face nor in a wall of the
/// cell; false proves nothing.
fn has_inner<'a>(
    mut edges: impl Iterator<Item = (&'a Arc<Vertex>, &'a Arc<Vertex>, &'a Carrier)>,
    source: &Source,
    face: FaceId,
    cell: &Cell,
) -> bool {
    let corners = source.mesh().map(|mesh| mesh.corners(face));
    let holds_own = |plane: &Plane| {
        let on = |p: &&Lattice| plane.side_of_lattice(p) == Side::On;
        corners.is_some_and(|c| c.iter().filter(on).count() >= 2)
    };
    edges.any(|(from, to, carrier)| match carrier {
        Carrier::Cut(plane, _) => !may_share_wall(from, to, cell) && !holds_own(plane),
        Carrier::Edge(_) => false,
    })
}

/// Returns false if two points of a cell certainly do not lie in the same wall of it; true proves nothing.
fn may_share_wall(a: &Vertex, b: &Vertex, cell: &Cell) -> bool {
    let (ends, low, high) = ([a, b].map(Vertex::bounds), cell.low(), cell.high());
    (0..3).any(|i| {
        let below = ends.iter().all(|(least, _)| least[i] < as_double(low[i]));
        below || ends.iter().all(|(_, most)| most[i] > as_double(high[i]))
    })
}

/// Returns the lines in which a plane meets the planes of a cell's walls.
fn border_lines(plane: &Plane, cell: &Cell) -> Vec<LineKey> {
    let crossed = |wall: &Plane| {
        let axis = wall.main_axis();
        (0..3).any(|i| i != axis && plane.normal()[i] != 0)
    };
    cell.walls()
        .iter()
        .filter(|w| crossed(w))
        .map(|w| LineKey::of_planes(plane, w))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::PolygonSplit;
    use crate::merge::scenes::{counts, crossing, Shared};
    use crate::mesh::handle::Slot;

    fn assembled(scene: &Shared, kept: Vec<KeptPart>) -> Node {
        assemble(kept, 1, false, &scene.cell, &scene.sources)
    }

    #[test]
    fn without_faces_the_cell_is_uniform() {
        assert!(matches!(assembled(&crossing(), Vec::new()), Node::Leaf(1)));
    }

    #[test]
    fn whole_faces_stand_in_groups_by_source_and_orientation() {
        let whole = |slot: u32, face: u32, orientation| {
            KeptPart::whole(SourceFace::new(Slot(slot), FaceId(face)), orientation)
        };
        let (same, turned) = (Orientation::Same, Orientation::Opposite);
        let kept = vec![
            whole(1, 2, same),
            whole(0, 3, same),
            whole(0, 1, same),
            whole(0, 0, turned),
        ];
        let Node::Deferred(leaf) = assembled(&crossing(), kept) else {
            panic!("faces stay");
        };
        let faces: Vec<Vec<u32>> = leaf
            .groups
            .iter()
            .map(|g| g.faces.iter().map(|f| f.0).collect())
            .collect();
        assert_eq!(faces, [vec![1, 3], vec![0], vec![2]]);
    }

    #[test]
    fn pieces_that_make_all_of_a_face_are_the_face_again() {
        let scene = crossing();
        let face = SourceFace::default();
        let polygon = scene.sources.get(face.slot).clip(face.id, &scene.cell);
        let polygon = polygon.expect("it is in the cell");
        let cut = Arc::new(Plane::through(&[4, 0, 0], &[4, 1, 0], &[4, 0, 1]).expect("a plane"));
        let PolygonSplit::Both(minus, plus) = polygon.split(&cut) else {
            panic!("the plane crosses the face");
        };
        let pieces =
            |some: &[Polygon]| vec![KeptPart::pieces(face, Orientation::Same, some.to_vec())];
        let all = assembled(&scene, pieces(&[minus.clone(), plus]));
        assert_eq!(counts(&all), (1, 0));
        assert_eq!(counts(&assembled(&scene, pieces(&[minus]))), (0, 1));
    }
}
