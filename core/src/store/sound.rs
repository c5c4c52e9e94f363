//! Checks that a stored boundary bounds a set, which is all that the core assumes of it.
//!
//! A closed boundary gives every point a winding number that does not depend on the path to it. More need not
//! be checked: set operations find faces that overlap or cross each other.

use std::sync::Arc;

use crate::arith::convert::as_double;
use crate::extract::boundary::leaves::{Fate, Fates};
use crate::extract::boundary::rim::{half_edge_ends, FrontierEdge, Rims};
use crate::geometry::edge::LatticeEdge;
use crate::geometry::outline::{cancel, OutlineEdge};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::side::{Orientation, Side};
use crate::geometry::vertex::Vertex;
use crate::merge::lists::list::Sources;
use crate::mesh::grid::Pitch;
use crate::mesh::handle::{OrientedFace, SourceFace};
use crate::mesh::source::Source;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{DeferredLeaf, Node, Part, PartElement};
use crate::tree::solid::Solid;

/// Returns true if the leaf of a one-leaf solid, whose indices and ranges are checked already, is the
/// boundary of a set.
pub fn is_sound(solid: &Solid) -> bool {
    let Node::Deferred(leaf) = &*solid.root().node else {
        return true;
    };
    let sources = Sources::new(solid.sources().clone());
    let proper = sources.table().iter().all(|s| is_proper(s));
    proper
        && leaf.parts.iter().all(|p| lies_on_face(&p.part))
        && fates(leaf, &sources).is_some_and(|fates| is_closed(leaf, &fates, &sources))
}

/// Returns true if a source could be the result of an import followed by lattice motions and refinements.
fn is_proper(source: &Source) -> bool {
    let Some(mesh) = source.mesh() else {
        return true;
    };
    let numbers = mesh.numbers.iter();
    let ascending = |n: &Vec<u32>| n.is_sorted_by(|a, b| a < b);
    numbers.into_iter().all(ascending) && doubles_fit(mesh, source.pitch()) && source.is_closed()
}

/// Returns true if the doubles of each vertex snap to its lattice point, on this lattice or on a coarser one
/// that contains all coordinates.
fn doubles_fit(mesh: &TriangleMesh, pitch: Pitch) -> bool {
    (0..3).all(|axis| {
        let slack = as_double(coarsest_step(&mesh.vertices, axis)) * 0.5;
        let near = |(vertex, double): (&Lattice, &[f64; 3])| {
            let (k, x) = (as_double(vertex[axis]), pitch.steps(double[axis]));
            // Both are rounded to three units in the last place.
            (x - k).abs() <= slack + (k.abs() + slack) * 4.0 * f64::EPSILON
        };
        mesh.vertices.iter().zip(&mesh.doubles).all(near)
    })
}

/// The largest power of ten, up to 10^18, that divides all coordinates along an axis.
fn coarsest_step(vertices: &[Lattice], axis: usize) -> i64 {
    let mut step = 10i64.pow(18);
    for vertex in vertices {
        while vertex[axis] % step != 0 {
            step /= 10;
        }
    }
    step
}

/// Returns true if the outline of a part bounds a subset of the part's face, on the left of each edge.
///
/// The convex pieces are disjoint parts of the face. If their edges cancel the outline's edges, the outline
/// bounds exactly these pieces.
fn lies_on_face(part: &Part) -> bool {
    let Some(face) = part.source.clip(part.face, &part.home) else {
        return false;
    };
    if !is_within(part, &face) {
        return false;
    }
    let pieces = part.pieces();
    let bounds = pieces.iter().flat_map(OutlineEdge::edges_of);
    let outline = part.outline();
    let reversed = outline.iter().map(OutlineEdge::reversed);
    !pieces.is_empty() && cancel(bounds.chain(reversed).collect()).is_empty()
}

/// Returns true if all corners of a part's outline lie in a face, and each outline edge between lattice
/// points lies on an edge of the face.
fn is_within(part: &Part, face: &Polygon) -> bool {
    let own: Vec<&Carrier> = face.edges().map(|(_, _, carrier)| carrier).collect();
    let walls: Vec<Plane> = own.iter().map(|c| c.plane(face.support())).collect();
    let inside = |vertex: &Vertex| walls.iter().all(|wall| vertex.side_of(wall) != Side::Plus);
    let known = |carrier: &Carrier| match carrier {
        Carrier::Edge(edge) => own
            .iter()
            .any(|c| matches!(c, Carrier::Edge(own) if own.ends() == edge.ends())),
        Carrier::Cut(..) => true,
    };
    let edges = part.edges.iter();
    edges
        .into_iter()
        .all(|e| inside(&e.from) && known(&e.carrier))
}

/// Returns for each face whether it is whole, cut or gone, from the leaf's lists; `None` if a face or part is
/// listed twice.
fn fates(leaf: &DeferredLeaf, sources: &Sources) -> Option<Fates> {
    let gone = |s: &Arc<Source>| vec![Fate::Gone; s.face_count()];
    let mut fates = Fates::new(sources.table().iter().map(gone).collect());
    for group in &leaf.groups {
        let slot = sources.slot(&group.source);
        for face in &group.faces {
            let fate = &mut fates[SourceFace::new(slot, *face)];
            if *fate != Fate::Gone {
                return None;
            }
            *fate = Fate::Whole(group.orientation);
        }
    }
    let face = |p: &PartElement| {
        let face = SourceFace::new(sources.slot(&p.part.source), p.part.face);
        face.oriented(p.orientation)
    };
    let mut parts: Vec<OrientedFace> = leaf.parts.iter().map(face).collect();
    parts.sort_unstable();
    for part in &parts {
        let fate = &mut fates[part.face];
        match fate {
            Fate::Whole(whole) if *whole == part.orientation => return None,
            Fate::Whole(_) => {}
            Fate::Cut | Fate::Gone => *fate = Fate::Cut,
        }
    }
    let once = parts.is_sorted_by(|a, b| a < b);
    once.then_some(fates)
}

/// Returns true if all edges of whole faces and parts cancel, except at the border of the universe.
fn is_closed(leaf: &DeferredLeaf, fates: &Fates, sources: &Sources) -> bool {
    let rims = Rims::of(fates, sources);
    let frontier = rims.frontier(fates, sources).into_iter();
    let rim = frontier.filter_map(|edge| rim_edge(edge, fates, sources));
    let parts = leaf.parts.iter().flat_map(|p| {
        let edges = p.part.outline().into_iter();
        let inner = edges.filter(|e| !e.carrier.is_border());
        inner.map(|e| match p.orientation {
            Orientation::Same => e,
            Orientation::Opposite => e.reversed(),
        })
    });
    cancel(rim.chain(parts).collect()).is_empty()
}

/// Returns an edge of a whole face as an outline edge, in the direction of the face's orientation.
fn rim_edge(edge: FrontierEdge, fates: &Fates, sources: &Sources) -> Option<OutlineEdge> {
    let mesh = sources.get(edge.slot).mesh()?;
    let [from, to] = half_edge_ends(mesh, edge.half).map(|v| mesh.vertices[v.index()]);
    let forward = OutlineEdge {
        from: Arc::new(Vertex::lattice(from)),
        to: Arc::new(Vertex::lattice(to)),
        carrier: Carrier::Edge(LatticeEdge::new(from, to)),
        line: edge.line(sources),
    };
    let turned = fates[edge.face()] == Fate::Whole(Orientation::Opposite);
    Some(if turned { forward.reversed() } else { forward })
}
