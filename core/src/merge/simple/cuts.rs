//! Faces that may overlap others, cut up so that nothing crosses the pieces.

use std::borrow::Cow;

use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::geometry::polygon::{straddle, Polygon};
use crate::geometry::side::Side;
use crate::interrupt::poll;
use crate::merge::kernels::general::{cut_up_by_any, Cutter, Cutting, Face};
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
    /// For each piece.
    pub(super) known_by: Vec<KnownBy>,
}

/// The piece of a face whose winding numbers tell those of another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct KnownBy {
    pub(super) piece: usize,
    /// By how much the numbers of the other exceed its own.
    pub(super) more: i32,
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
            let cutting = self.cut(&fragment);
            CutUp::new(fragment, cutting)
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

    /// The pieces into which the faces that have a line in common with a fragment cut it, the first
    /// one first.
    fn cut(&self, fragment: &Fragment) -> Cutting {
        let own = as_number(self.faces.partition_point(|f| *f < fragment.face.id));
        let first = self.pairs.partition_point(|p| p[0] < own);
        let others = self.pairs[first..].iter().take_while(|p| p[0] == own);
        let support = fragment.polygon.support();
        let has_line = |face: &&Face| {
            let sides = face.polygon.sides(support);
            let on = sides.iter().filter(|s| **s == Side::On).count();
            straddle(&sides) == (true, true) || on > 1
        };
        let cutter = |face| Cutter {
            face,
            operand: 0,
            weight: 1,
        };
        let faces = others.map(|[_, other]| &self.triangles[*other as usize]);
        let mut cutters: Vec<Cutter> = faces.filter(has_line).map(cutter).collect();
        cutters.reverse();
        cut_up_by_any(fragment.polygon.clone(), &cutters)
    }
}

impl CutUp {
    fn new(fragment: Fragment, cutting: Cutting) -> Self {
        let known_by = known_by(&cutting);
        Self {
            fragment,
            pieces: cutting.pieces,
            known_by,
        }
    }
}

/// For each piece the one whose numbers tell its own, the widest of those that ties connect.
fn known_by(cutting: &Cutting) -> Vec<KnownBy> {
    let count = cutting.pieces.len();
    let mut neighbours = vec![Vec::new(); count];
    for tie in &cutting.ties {
        neighbours[tie.minus as usize].push((tie.plus as usize, tie.change));
        neighbours[tie.plus as usize].push((tie.minus as usize, -tie.change));
    }
    let areas: Vec<f64> = cutting.pieces.iter().map(area).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|i, j| areas[*j].total_cmp(&areas[*i]));
    let mut known = vec![None; count];
    for piece in order {
        let mut open = vec![(piece, 0)];
        while let Some((at, more)) = open.pop() {
            poll();
            if known[at].is_none() {
                known[at] = Some(KnownBy { piece, more });
                open.extend(neighbours[at].iter().map(|(next, by)| (*next, more + by)));
            }
        }
    }
    known.into_iter().flatten().collect()
}

/// About how large a polygon is, to tell wide ones from narrow ones.
fn area(polygon: &Polygon) -> f64 {
    let corners: Vec<Point> = polygon.corners().iter().map(|c| c.at.approx()).collect();
    let from = |p: &Point| each_axis(|i| p[i] - corners[0][i]);
    let mut normal = [0.0; 3];
    for pair in corners[1..].windows(2) {
        let (u, v) = (from(&pair[0]), from(&pair[1]));
        let add = |i: usize| u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
        normal = each_axis(|i| normal[i] + add(i));
    }
    normal.iter().map(|x| x * x).sum()
}

#[cfg(test)]
mod tests {
    use super::super::unclear::{Unclear, View};
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

    /// A plank and posts through it: however often its faces are cut, one piece tells the numbers
    /// of all others.
    #[test]
    fn one_piece_tells_the_numbers_of_all_pieces_of_a_face() {
        let told = |count: i64| {
            let post = |i: i64| [[10 * i + 3, 2, -7], [10 * i + 7, 6, 11]];
            let plank = [[0, 0, 0], [10 * count, 9, 5]];
            let solid = cuboids([plank].into_iter().chain((0..count).map(post)));
            let source = solid.sources().get(Slot(0));
            let view = View::new(source, source.mesh().expect("a mesh"));
            let faces: Vec<FaceId> = view.mesh.face_ids().collect();
            let unclear = Unclear::among(&view, [faces.as_slice()]).expect("few pairs");
            let tangle = Tangle::new(source, &unclear.pairs).expect("a mesh");
            let cut = tangle.cut_up(Slot(0));
            let tells = |cut: &CutUp| {
                let all = cut.known_by.iter().enumerate();
                all.filter(|(i, known)| known.piece == *i).count()
            };
            let pieces: usize = cut.iter().map(|c| c.pieces.len()).sum();
            let alone: usize = cut.iter().map(tells).sum();
            (cut.len(), alone, pieces)
        };
        for count in [4, 8] {
            let (faces, alone, pieces) = told(count);
            assert!(pieces > 2 * faces && alone == faces, "{alone} of {pieces}");
        }
    }
}
