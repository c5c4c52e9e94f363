//! Faces that may overlap others, cut up so that nothing crosses the pieces.

use std::borrow::Cow;

use crate::arith::convert::as_number;
use crate::geometry::polygon::{straddle, Polygon};
use crate::interrupt::poll;
use crate::merge::kernels::general::Face;
use crate::merge::kernels::trees::{disjoint, Fragment};
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::{FaceId, Slot, SourceFace};
use crate::mesh::source::Source;

/// The faces of a mesh that may overlap others, and with which.
pub(super) struct Tangle<'a> {
    /// The faces, ascending.
    pub(super) faces: Vec<FaceId>,
    triangles: Vec<Face<'a>>,
    /// Pairs of places in the list of faces, each both ways, ascending.
    pairs: Vec<[u32; 2]>,
}

/// The rest of a face, disjoint from all others of its plane, and its pieces.
pub(super) struct CutUp {
    pub(super) fragment: Fragment,
    pub(super) pieces: Vec<Polygon>,
}

impl Tangle<'_> {
    /// The faces of some pairs, each both ways, ascending.
    pub(super) fn new(source: &Source, pairs: &[[FaceId; 2]]) -> Option<Self> {
        let mut faces: Vec<FaceId> = pairs.iter().map(|p| p[0]).collect();
        faces.dedup();
        let mesh = source.mesh()?;
        let triangle = |f: &FaceId| Polygon::triangle(&mesh.corners(*f), source.plane(*f));
        let triangles = faces.iter().map(|f| Face::new(Cow::Owned(triangle(f))));
        let triangles = triangles.collect();
        let place = |f: &FaceId| as_number(faces.partition_point(|g| g < f));
        let pairs = pairs.iter().map(|p| p.each_ref().map(place)).collect();
        Some(Self {
            faces,
            triangles,
            pairs,
        })
    }

    /// The faces, those that overlap in one plane made disjoint, cut up by all that reach them.
    pub(super) fn cut_up(&self, slot: Slot) -> Vec<CutUp> {
        let groups = self.flat_groups();
        let fragment = |i: &u32| Fragment {
            polygon: self.polygon(*i).clone(),
            weight: 1,
            face: SourceFace::new(slot, self.faces[*i as usize]),
            intact: true,
        };
        let fragments = groups.iter().flat_map(|group| match group.as_slice() {
            [alone] => vec![fragment(alone)],
            group => disjoint(group.iter().map(fragment).collect()).0,
        });
        let cut = |fragment: Fragment| {
            let pieces = self.pieces(&fragment);
            CutUp { fragment, pieces }
        };
        fragments.map(cut).collect()
    }

    fn polygon(&self, place: u32) -> &Polygon {
        &self.triangles[place as usize].polygon
    }

    /// The faces in groups: those that may overlap each other in one plane are together.
    fn flat_groups(&self) -> Vec<Vec<u32>> {
        let mut sets = DisjointSets::with_capacity(self.faces.len());
        while (sets.end() as usize) < self.faces.len() {
            sets.push();
        }
        for [a, b] in &self.pairs {
            let planes = [*a, *b].map(|i| self.polygon(i).support());
            if a < b && planes[0].coincides(planes[1]).is_some() {
                sets.join(*a, *b);
            }
        }
        let mut groups = vec![Vec::new(); self.faces.len()];
        for i in 0..as_number(self.faces.len()) {
            groups[sets.least(i) as usize].push(i);
        }
        groups.retain(|group| !group.is_empty());
        groups
    }

    /// The pieces into which the faces that reach a fragment cut it.
    fn pieces(&self, fragment: &Fragment) -> Vec<Polygon> {
        let own = as_number(self.faces.partition_point(|f| *f < fragment.face.id));
        let first = self.pairs.partition_point(|p| p[0] < own);
        let others = self.pairs[first..].iter().take_while(|p| p[0] == own);
        let mut pieces = vec![fragment.polygon.clone()];
        for [_, other] in others {
            poll();
            let cut = |piece| halves(piece, &self.triangles[*other as usize]);
            pieces = pieces.into_iter().flat_map(cut).collect();
        }
        pieces
    }
}

/// A piece, or its halves if a face reaches it.
fn halves(piece: Polygon, other: &Face) -> Vec<Polygon> {
    let plane = other.polygon.support();
    let sides = piece.sides(plane);
    if !boxes_meet(&piece, &other.polygon) || straddle(&sides) != (true, true) {
        return vec![piece];
    }
    let chord = piece.chord(plane, &sides);
    if !other.is_reached_by(&chord) {
        return vec![piece];
    }
    let (minus, plus) = piece.divided(plane, &sides, &chord);
    vec![minus, plus]
}

/// Return whether the boxes around two polygons meet; errs on yes.
fn boxes_meet(a: &Polygon, b: &Polygon) -> bool {
    let ((low, high), (others_low, others_high)) = (a.bounds(), b.bounds());
    (0..3).all(|i| low[i] <= others_high[i] && others_low[i] <= high[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;

    /// The lids of two boxes of which the second stands on the first and is wider.
    #[test]
    fn faces_of_one_plane_are_made_disjoint_and_cut_where_others_reach_them() {
        let solid = cuboids([[[0; 3], [8; 3]], [[2, 2, 2], [6, 6, 12]]]);
        let source = solid.sources().get(Slot(0));
        // The lid of the first box and a side of the second.
        let (lid, side) = (FaceId(2), FaceId(12 + 4));
        let tangle = Tangle::new(source, &[[lid, side], [side, lid]]).expect("a mesh");
        let cut = tangle.cut_up(Slot(0));
        let counts: Vec<usize> = cut.iter().map(|c| c.pieces.len()).collect();
        assert_eq!(counts, [2, 2]);
        let twice = Tangle::new(source, &[[lid, FaceId(3)], [FaceId(3), lid]]).expect("a mesh");
        assert!(twice.cut_up(Slot(0)).iter().all(|c| c.pieces.len() == 1));
    }
}
