//! The volume of a solid's tree as a sum over its leaves, cached in the nodes.
//!
//! The volume of a bounded solid is the flux of the field (0, 0, z) through its boundary. Each node stores
//! the flux through the boundary in its cell, so that after an operation only the changed nodes are summed
//! again.

use std::sync::Arc;

use smallvec::SmallVec;

use super::node::{Branch, DeferredLeaf, Node, Part};
use super::share::VolumeShare;
use crate::arith::Int;
use crate::geometry::cell::Cell;
use crate::geometry::flux::fixed::{
    flux_through_ring, from_cubic_steps, minor, of_vertex, sixfold_flux, through, CoordinateExtent,
    Fixed, FixedPolygon, Flux, Triangle, Walls,
};
use crate::geometry::flux::trim::{trimmed, TrimmedFlux};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
use crate::mesh::source::{Shape, Source};

/// Return the flux through a branch's boundary; computes only nodes without a cached share (the node's
/// contribution to the flux).
pub fn share(root: &Branch) -> VolumeShare {
    for branch in branches_without_share(root).into_iter().rev() {
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(leaf) => {
                leaf.share.get_or_make(|| leaf_share(leaf, &branch.cell));
            }
            Node::Cut(halves) => {
                halves.share.get_or_make(|| {
                    let mut sum = VolumeShare::NONE;
                    for child in &halves.children {
                        sum.add(
                            &cached_share(child).unwrap_or(VolumeShare::NONE),
                            child.complement,
                        );
                    }
                    sum
                });
            }
        }
    }
    let mut sum = VolumeShare::NONE;
    sum.add(
        &cached_share(root).unwrap_or(VolumeShare::NONE),
        root.complement,
    );
    sum
}

/// The cached share of a branch's node, disregarding whether the branch is complemented; `None` if not yet
/// computed.
fn cached_share(branch: &Branch) -> Option<VolumeShare> {
    match &*branch.node {
        Node::Leaf(_) => Some(VolumeShare::NONE),
        Node::Deferred(leaf) => leaf.share.get().copied(),
        Node::Cut(halves) => halves.share.get().copied(),
    }
}

/// The branches under a root without a cached share (contribution to the solid's volume), each before its
/// children.
fn branches_without_share(root: &Branch) -> Vec<&Branch> {
    let mut found = Vec::new();
    let mut open = vec![root];
    while let Some(branch) = open.pop() {
        if cached_share(branch).is_some() {
            continue;
        }
        found.push(branch);
        if let Node::Cut(halves) = &*branch.node {
            open.extend(&halves.children);
        }
    }
    found
}

/// The sum of fluxes over the faces and parts of a leaf, clipped to its cell.
struct Sum {
    walls: Walls,
    cell: Cell,
    /// Six times the flux through the whole faces inside the cell, in cubic steps.
    inside: Int<4>,
    /// The contribution of all other faces, and of parts of faces, to the volume.
    rest: VolumeShare,
}

fn leaf_share(leaf: &DeferredLeaf, cell: &Cell) -> VolumeShare {
    let mut sum = Sum {
        walls: Walls::of(cell),
        cell: *cell,
        inside: Int::ZERO,
        rest: VolumeShare::NONE,
    };
    for group in &leaf.groups {
        match group.source.shape() {
            Shape::Mesh(mesh) => {
                for face in &group.faces {
                    poll();
                    sum.add_face(&mesh.corners(*face), group.orientation);
                }
            }
            Shape::HalfSpace(_) => sum.add_plane(&group.source, group.orientation),
        }
    }
    for element in &leaf.parts {
        poll();
        sum.add_part(&element.part, element.orientation);
    }
    sum.rest.flux.value += from_cubic_steps(&sum.inside);
    sum.rest
}

impl Sum {
    /// Adds the flux through the part of a mesh face inside the cell.
    fn add_face(&mut self, corners: &[Lattice; 3], orientation: Orientation) {
        let area = minor(corners, 0, 1);
        if area == 0 {
            return;
        }
        match trimmed(corners, area, &self.walls) {
            TrimmedFlux::All => {
                let flux = sixfold_flux(corners);
                self.inside += orientation.signed(flux);
            }
            TrimmedFlux::Part(flux) => self.rest.flux.add(&flux, orientation),
            TrimmedFlux::Nothing => {}
            TrimmedFlux::Undecided => self.add_clipped(corners, area, orientation),
        }
    }

    /// Adds the flux through the part of a mesh face inside the cell, for a face that is cut by cell walls
    /// perpendicular to different axes.
    fn add_clipped(&mut self, corners: &[Lattice; 3], area: i128, orientation: Orientation) {
        let normal = [minor(corners, 1, 2), minor(corners, 2, 0), area];
        if let Some(ring) = Triangle::new(corners, normal).clipped(&self.walls) {
            let error = CoordinateExtent::of_triangle(corners).error(ring.len(), 1, slope(&normal));
            let value = flux_through_ring(&ring);
            self.rest.flux.add(&Flux { value, error }, orientation);
        }
    }

    /// Adds the flux through the part of a half-space's boundary plane inside the cell.
    fn add_plane(&mut self, source: &Source, orientation: Orientation) {
        let Some(polygon) = source.clip(FaceId::ONLY, &self.cell) else {
            return;
        };
        self.rest.open |= polygon.edges().any(|(_, _, carrier)| carrier.is_border());
        let ring: FixedPolygon = polygon.corners().iter().map(|c| of_vertex(&c.at)).collect();
        let error = CoordinateExtent::of(&ring).error(ring.len(), 1, 0.0);
        let value = flux_through_ring(&ring);
        self.rest.flux.add(&Flux { value, error }, orientation);
    }

    /// Adds the flux through a part of a face, clipped to the cell.
    fn add_part(&mut self, part: &Part, orientation: Orientation) {
        let bounded = part.source.mesh().is_some();
        self.rest.open |= !bounded && part.edges.iter().any(|e| e.carrier.is_border());
        if self.surely_contains(part) {
            let flux = part.flux.get_or_make(|| part_flux(part));
            self.rest.flux.add(flux, orientation);
        } else if let Some(slope) = part_slope(part) {
            let flux = fan_flux(&fixed_ends(part), Some(&self.walls), slope);
            self.rest.flux.add(&flux, orientation);
        }
    }

    /// Return whether a part of a face lies entirely in the cell; may return false negatives.
    fn surely_contains(&self, part: &Part) -> bool {
        self.cell.contains(&part.home) || {
            let mut corners = part.edges.iter().map(|e| e.from.approx());
            corners.all(|p| self.walls.surely_contain(&p))
        }
    }
}

/// The flux through a part of a face, without clipping.
fn part_flux(part: &Part) -> Flux {
    part_slope(part).map_or(Flux::ZERO, |slope| fan_flux(&fixed_ends(part), None, slope))
}

/// The flux through an outline, clipped by a cell's walls if given: a sum over signed triangles from one
/// corner to all edges.
fn fan_flux(ends: &[[Fixed; 2]], walls: Option<&Walls>, slope: f64) -> Flux {
    let Some([apex, _]) = ends.first() else {
        return Flux::ZERO;
    };
    let walls = walls.filter(|w| !w.contain(ends.iter().flatten()));
    let mut rounds = 1;
    let mut value = Int::ZERO;
    for [from, to] in ends.iter().filter(|e| !e.contains(apex)) {
        poll();
        if let Some(walls) = walls {
            let mut ring: FixedPolygon = [*apex, *from, *to].into_iter().collect();
            rounds = rounds.max(1 + walls.clip(&mut ring));
            value += flux_through_ring(&ring);
        } else {
            value += through(apex, from, to);
        }
    }
    let error = CoordinateExtent::of(ends.as_flattened()).error(9 * ends.len(), rounds, slope);
    Flux { value, error }
}

/// The edges of a part's outline in fixed-point binary; computes each corner once.
fn fixed_ends(part: &Part) -> SmallVec<[[Fixed; 2]; 8]> {
    let mut seen: SmallVec<[(&Arc<Vertex>, Fixed); 8]> = SmallVec::new();
    let mut fixed = |vertex| {
        if let Some((_, at)) = seen.iter().find(|(v, _)| Arc::ptr_eq(v, vertex)) {
            return *at;
        }
        let at = of_vertex(vertex);
        seen.push((vertex, at));
        at
    };
    let edges = part.edges.iter();
    edges.map(|e| [fixed(&e.from), fixed(&e.to)]).collect()
}

/// The ratio |z| / max(|x|, |y|) of a normal's components; 0 for a face perpendicular to z, which no wall
/// across z cuts.
// The ratio is a factor of an error bound; rounding changes it by less than the bound's own slack.
#[allow(clippy::cast_precision_loss)]
fn slope([x, y, z]: &[i128; 3]) -> f64 {
    match x.unsigned_abs().max(y.unsigned_abs()) {
        0 => 0.0,
        flat => z.unsigned_abs() as f64 / flat as f64,
    }
}

/// The slope |z| / max(|x|, |y|) of the normal of a part's plane; `None` if the plane is parallel to z, so
/// that the field has no flux through it.
fn part_slope(part: &Part) -> Option<f64> {
    let normal = match part.source.shape() {
        Shape::Mesh(mesh) => {
            let c = mesh.corners(part.face);
            [minor(&c, 1, 2), minor(&c, 2, 0), minor(&c, 0, 1)]
        }
        Shape::HalfSpace(plane) => *plane.normal(),
    };
    (normal[2] != 0).then(|| slope(&normal))
}
