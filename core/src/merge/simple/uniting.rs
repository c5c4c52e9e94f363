//! A mesh that overlaps itself, united with itself where it does.
//!
//! Most faces are clear of all others. Across an edge at which two such faces meet nothing else
//! bounds anything, so all faces of a *patch*, connected by such edges, have one winding number in
//! front of them. The other faces are cut up by those that reach them. One count tells the number
//! of a patch or of a piece, and with it whether that stays. What stays is one leaf again.

use super::cuts::{CutUp, KnownBy, Tangle};
use super::only_mesh;
use super::probes::{sides, Probed, Sides};
use super::unclear::{Unclear, View};
use crate::arith::convert::as_number;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::merge::descent::join;
use crate::merge::kernels::kept::{assemble, Kept};
use crate::merge::kernels::trees::{keep, orientation, Piece};
use crate::merge::lists::list::{List, Sources};
use crate::merge::rule::Rule;
use crate::mesh::handle::{FaceId, Slot, SourceFace};
use crate::mesh::topology::NONE;
use crate::tree::node::{Branch, Node};
use crate::tree::solid::Solid;

/// The slot of the only source.
const ONLY: Slot = Slot(0);

/// The faces of a mesh that are clear of all others, by patch.
struct Patches {
    /// For each face the number of its patch; `NONE` if it may overlap others.
    of_faces: Vec<u32>,
    /// For each patch its first face.
    firsts: Vec<FaceId>,
}

/// The root of a mesh united with itself; `None` if the solid is not one closed mesh, if too many
/// faces may overlap, or if a piece is too thin to tell its winding number.
///
/// The pairs of faces that may overlap are looked for, unless they are given.
pub fn united_where_it_overlaps(
    solid: &Solid,
    sources: &Sources,
    pairs: Option<Unclear>,
) -> Option<Branch> {
    let (leaf, source, mesh) = only_mesh(solid)?;
    let root = solid.root();
    let whole = solid.whole_mesh().is_some() && !root.complement && root.outside == 0;
    if !whole || !source.open_vertices().is_empty() {
        return None;
    }
    let within = (root.cell, List::open(leaf, root, sources));
    let faces = leaf.groups[0].faces.as_slice();
    let looked_for = || Unclear::among(&View::new(source, mesh), [faces]);
    let unclear = pairs.or_else(looked_for)?;
    let tangle = Tangle::new(source, &unclear.pairs)?;
    let patches = Patches::beside(&tangle.faces, source.topology()?.mates());
    let cut = tangle.cut_up(ONLY);
    let of_patch = |f: &FaceId| Polygon::triangle(&mesh.corners(*f), source.plane(*f));
    let faces: Vec<Polygon> = patches.firsts.iter().map(of_patch).collect();
    let of_faces = faces.iter().map(|polygon| Probed { polygon, weight: 1 });
    let probed: Vec<Probed> = of_faces.chain(cut.iter().flat_map(CutUp::probed)).collect();
    let sides = sides(&probed, &within, sources)?;
    let (of_patches, of_pieces) = sides.split_at(patches.firsts.len());
    let mut kept: Vec<Kept> = patches.staying(of_patches).collect();
    let mut rest = of_pieces.iter();
    for cut in cut {
        let sides = cut.sides(rest.by_ref())?;
        kept.extend(cut.kept(&sides));
    }
    let mut node = assemble(kept, 0, false, &root.cell, sources);
    if let Node::Deferred(leaf) = &mut node {
        // All of it is one operand's boundary still.
        leaf.worked = false;
    }
    Some(join::around(root.cell, Branch::of_node(root.cell, node), 0))
}

impl CutUp {
    /// The pieces whose numbers tell those of all others.
    fn probed(&self) -> impl Iterator<Item = Probed<'_>> {
        let weight = self.fragment.weight;
        let probed = move |polygon| Probed { polygon, weight };
        let tells = |(i, known): (usize, &KnownBy)| known.piece == i;
        let telling = self.known_by.iter().enumerate().filter(move |k| tells(*k));
        telling.map(move |(i, _)| probed(&self.pieces[i]))
    }

    /// The numbers of all pieces, given the next ones of those that tell them.
    fn sides<'a>(&self, told: &mut impl Iterator<Item = &'a Sides>) -> Option<Vec<Sides>> {
        let tells = |i: usize| self.known_by[i].piece == i;
        let own = (0..self.pieces.len()).map(|i| tells(i).then(|| told.next().copied()).flatten());
        let own: Vec<Option<Sides>> = own.collect();
        let all = self.known_by.iter();
        all.map(|k| Some(own[k.piece]?.map(|w| w + k.more)))
            .collect()
    }

    /// Keep the pieces of the fragment that bound the points inside, given their numbers.
    fn kept(self, sides: &[Sides]) -> Vec<Kept> {
        let piece = |(polygon, sides): (Polygon, &Sides)| {
            let [minus, plus] = sides.map(|w| vec![Rule::Positive.inside(w)]);
            Piece {
                polygon,
                minus,
                plus,
            }
        };
        let pieces = self.pieces.into_iter().zip(sides).map(piece).collect();
        keep(&self.fragment, pieces, |piece| {
            orientation([piece.minus[0], piece.plus[0]])
        })
    }
}

impl Patches {
    /// The faces beside some, ascending, that edges connect.
    fn beside(some: &[FaceId], mates: &[u32]) -> Self {
        let count = mates.len() / 3;
        let mut patches = Self {
            of_faces: vec![NONE; count],
            firsts: Vec::new(),
        };
        let mut is_left = vec![true; count];
        for face in some {
            is_left[face.place()] = false;
        }
        for first in 0..count {
            if std::mem::replace(&mut is_left[first], false) {
                patches.spread(first, mates, &mut is_left);
            }
        }
        patches
    }

    /// Numbers a patch.
    fn spread(&mut self, first: usize, mates: &[u32], is_left: &mut [bool]) {
        let patch = as_number(self.firsts.len());
        self.firsts.push(FaceId(as_number(first)));
        let mut open = vec![first];
        while let Some(face) = open.pop() {
            poll();
            self.of_faces[face] = patch;
            let beside = mates[3 * face..3 * face + 3].iter();
            for mate in beside.filter(|m| **m != NONE).map(|m| *m as usize / 3) {
                if std::mem::replace(&mut is_left[mate], false) {
                    open.push(mate);
                }
            }
        }
    }

    /// The faces of patches that bound the points inside.
    fn staying<'a>(&'a self, sides: &'a [Sides]) -> impl Iterator<Item = Kept> + 'a {
        let inside = |w: i32| Rule::Positive.inside(w);
        let stays = move |patch: &u32| {
            let sides = sides.get(*patch as usize);
            sides.is_some_and(|[minus, plus]| inside(*minus) && !inside(*plus))
        };
        let faces = FaceId::all().zip(&self.of_faces);
        faces
            .filter(move |(_, patch)| stays(patch))
            .map(|(face, _)| Kept::whole(SourceFace::new(ONLY, face), Orientation::Same))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{counts, cuboids};

    fn united(boxes: [[[i64; 3]; 2]; 2]) -> Option<(usize, usize)> {
        let solid = cuboids(boxes);
        let sources = Sources::new(solid.sources().clone());
        united_where_it_overlaps(&solid, &sources, None).map(|root| counts(&root.node))
    }

    #[test]
    fn only_what_overlaps_is_cut() {
        // An edge of the second box is parted by the first one, and so are the four faces there.
        let found = united([[[0; 3], [9; 3]], [[3, 3, 3], [6, 6, 15]]]).expect("wide pieces");
        assert!(found.0 >= 12 && found.1 >= 4, "{found:?}");
    }

    #[test]
    fn what_lies_inside_goes() {
        assert_eq!(united([[[0; 3], [9; 3]], [[3; 3], [6; 3]]]), Some((12, 0)));
    }
}
