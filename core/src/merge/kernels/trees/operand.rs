//! One operand in a small cell: its fragments (convex pieces of faces) and its local tree.

use super::fragment::Fragment;
use super::local_tree::{LocalTree, WeightedPolygon};
use super::overlay::disjoint;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Polygon;
use crate::interrupt::poll;
use crate::merge::lists::list::{List, Sources};
use crate::mesh::handle::{FaceId, SourceFace};

/// One operand inside a small cell.
pub(super) struct Operand {
    /// The number of the operand in the expression.
    pub(super) number: u32,
    /// The operand's winding number at the cell's low corner.
    pub(super) corner: i32,
    pub(super) fragments: Vec<Fragment>,
    pub(super) tree: LocalTree,
    /// True if no fragments overlap in the cell and all winding numbers are 0 or 1.
    pub(super) simple: bool,
}

impl Operand {
    pub(super) fn new(number: u32, list: &List, cell: &Cell, sources: &Sources) -> Self {
        let corner = list.corner;
        let (fragments, overlap) = disjoint(fragments(list, cell, sources));
        let weighted = fragments
            .iter()
            .map(|f| WeightedPolygon {
                polygon: f.polygon.clone(),
                weight: f.weight,
            })
            .collect();
        let tree = if fragments.is_empty() {
            LocalTree::uniform(corner)
        } else {
            LocalTree::build(weighted, &cell.corner(), corner)
        };
        let simple = !overlap
            && fragments.iter().all(|f| f.weight.abs() == 1)
            && tree.labels().iter().all(|w| (0..=1).contains(w));
        Self {
            number,
            corner,
            fragments,
            tree,
            simple,
        }
    }
}

/// Returns the listed faces and the convex pieces of listed parts, clipped to the cell.
fn fragments(list: &List, cell: &Cell, sources: &Sources) -> Vec<Fragment> {
    let mut found = Vec::with_capacity(list.len());
    for r in &list.records {
        poll();
        if let Some(polygon) = sources.get(r.slot()).clip(r.face, cell) {
            let weight = r.orientation().signed(1);
            let face = SourceFace::new(r.slot(), r.face);
            found.push(Fragment {
                polygon,
                weight,
                face,
                intact: true,
            });
        }
    }
    for p in &list.parts {
        poll();
        let weight = p.element.orientation.signed(1);
        let part = &p.element.part;
        let face = SourceFace::new(sources.slot(&part.source), part.face);
        let clipped = p.pieces().iter().filter_map(|q| q.clipped(cell));
        found.extend(clipped.map(|polygon| Fragment {
            polygon,
            weight,
            face,
            intact: false,
        }));
    }
    found
}

/// The local tree of one operand in a small cell, for queries of points and polygons.
pub struct LeafTree(Operand);

impl LeafTree {
    /// Builds the local tree of the listed faces and parts inside a cell.
    pub fn new(list: &List, cell: &Cell, sources: &Sources) -> Self {
        Self(Operand::new(0, list, cell, sources))
    }

    /// Returns the convex pieces of the operand's boundary in the cell.
    pub fn polygons(&self) -> impl Iterator<Item = &Polygon> {
        self.0.fragments.iter().map(|f| &f.polygon)
    }

    /// Returns true if no faces overlap in the cell and all winding numbers are 0 or 1.
    pub fn is_simple(&self) -> bool {
        self.0.simple
    }

    /// Returns for each fragment in the cell the number of its face.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.0.fragments.iter().map(|f| f.face.id)
    }

    /// Returns the winding numbers behind and in front of a polygon that crosses no face of the operand;
    /// always `Some`.
    pub fn sides_of(&self, polygon: Polygon) -> Option<[i32; 2]> {
        let sides = self.0.tree.sides(polygon);
        sides.first().map(|s| [s.minus, s.plus])
    }

    /// Returns the winding number at a lattice point that lies on no face.
    pub fn label_at(&self, point: &Lattice) -> i32 {
        self.0.tree.label_at(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn faces_that_are_listed_twice_are_no_simple_boundary() {
        let mut scene = Shared::of(&[cuboid([1; 3], [3; 3])]);
        let operand =
            |scene: &Shared| Operand::new(0, &scene.lists[0], &scene.cell, &scene.sources);
        let once = operand(&scene);
        assert!(once.simple && once.fragments.len() == 12);
        let again = scene.lists[0].records.clone();
        scene.lists[0].records.extend(again);
        let twice = operand(&scene);
        assert!(!twice.simple && twice.fragments.len() == 12);
        assert!(twice.fragments.iter().all(|f| f.weight == 2));
    }
}
