//! The known labels at anchors: points that several elements of an operand share.

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use super::anchors::Anchor;
use super::fates::Fate;
use super::scene::{Element, Name, Place, Scene};
use super::Labels;
use crate::arith::convert::as_number;
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::Slot;

/// The number that stands for no anchor; it exceeds the numbers of all anchors.
const NONE: u32 = u32::MAX;

/// The most vertices of a mesh for each of its elements in the cell for which a table of all vertices is used
/// instead of a hash map. An element looks up three names in the map, and each look-up costs as much as
/// clearing about fifty entries of the table.
const MAX_VERTICES_PER_ELEMENT: usize = 16;

/// Anchors (points that several elements of an operand share) with the known labels of the other operands
/// there. All anchors of an element that nothing crosses have the same label.
pub(super) struct Known {
    /// For each operand the numbers of its anchors at the vertices of one mesh, if enough of the mesh is in
    /// the cell.
    of_vertices: Vec<Option<(Slot, Vec<u32>)>>,
    /// The numbers of all other anchors, by operand and name.
    numbers: HashMap<(u32, Name), u32>,
    sets: DisjointSets,
    /// The label at each anchor that represents its class of anchors with equal labels, if known.
    pub(super) labels: Vec<Option<Labels>>,
    /// For each element that nothing crosses the number of one of its anchors; otherwise `NONE`.
    anchors: Vec<u32>,
    /// The divided elements at anchors, sorted: the anchor that represents the class, the element, and the
    /// index of the anchor among the element's anchors.
    cuts: Vec<(u32, u32, u32)>,
}

impl Known {
    /// Unites the anchors of each element that nothing crosses into classes; no label is known yet.
    pub(super) fn new(scene: &Scene, fates: &[Fate]) -> Self {
        // A closed surface has half as many vertices as triangles.
        let count = scene.elements.len();
        let of_vertices: Vec<_> = (0..scene.corners.len())
            .map(|operand| numbers_of_vertices(scene.of_operand(operand)))
            .collect();
        let listed = of_vertices.iter().all(Option::is_some);
        let others = if listed { 0 } else { count };
        let mut known = Self {
            of_vertices,
            numbers: HashMap::with_capacity_and_hasher(others, FxBuildHasher),
            sets: DisjointSets::with_capacity(count),
            labels: Vec::with_capacity(count),
            anchors: Vec::with_capacity(count),
            cuts: Vec::new(),
        };
        for (element, fate) in scene.elements.iter().zip(fates) {
            poll();
            let anchor = known.enter(scene.cell, element, fate);
            known.anchors.push(anchor);
        }
        for (i, (element, fate)) in (0u32..).zip(scene.elements.iter().zip(fates)) {
            poll();
            if let Fate::Cut(cut) = fate {
                for (place, anchor) in (0u32..).zip(&cut.anchors) {
                    let root = known.root_of(element.operand, anchor.name);
                    known.cuts.push((root, i, place));
                }
            }
        }
        known.cuts.sort_unstable();
        known
    }

    /// Unites the anchors of an element that nothing crosses into one class and returns a number of it;
    /// `NONE` for other elements.
    fn enter(&mut self, cell: &Cell, element: &Element, fate: &Fate) -> u32 {
        let operand = element.operand;
        match (fate, &element.place) {
            (Fate::Untouched, Place::Face(triangle)) => {
                let names = element.vertices_in(cell).map(|i| triangle.name(i));
                self.unite(operand, names)
            }
            (Fate::Uncut(anchors), _) => self.unite(operand, anchors.iter().map(|a| a.name)),
            _ => NONE,
        }
    }

    fn unite(&mut self, operand: usize, names: impl Iterator<Item = Name>) -> u32 {
        names.fold(NONE, |a, name| {
            let b = self.root_of(operand, name);
            if a == NONE {
                b
            } else {
                self.sets.join_named(a, b)
            }
        })
    }

    /// Returns the number of the anchor that represents the class of the anchor with this name; adds the
    /// anchor if it is new.
    pub(super) fn root_of(&mut self, operand: usize, name: Name) -> u32 {
        let next = self.sets.end();
        let at = match (name, &mut self.of_vertices[operand]) {
            (Name::Vertex(slot, vertex), Some((own, numbers))) if slot == *own => {
                let number = &mut numbers[vertex.place()];
                *number = next.min(*number);
                *number
            }
            _ => {
                let name = (as_number(operand), name);
                *self.numbers.entry(name).or_insert(next)
            }
        };
        if at == next {
            self.sets.push();
            self.labels.push(None);
        }
        self.sets.least(at)
    }

    /// Returns the divided elements at an anchor, each with its part at the anchor and the label `label`
    /// there; `None` if an anchor is no corner of its element.
    pub(super) fn cut_at(
        &self,
        root: usize,
        fates: &[Fate],
        label: Labels,
    ) -> Option<Vec<(usize, usize, Labels)>> {
        let start = self.cuts.partition_point(|c| (c.0 as usize) < root);
        let here = self.cuts[start..].iter();
        let here = here.take_while(|c| c.0 as usize == root);
        here.map(|(_, i, place)| {
            let Fate::Cut(cut) = &fates[*i as usize] else {
                return None;
            };
            let part = cut.part_at(&cut.anchors[*place as usize])?;
            Some((*i as usize, part, label))
        })
        .collect()
    }

    /// Returns the label of all other operands at an anchor of an operand; counts it if it is not known.
    /// `None` if counting is doubtful.
    pub(super) fn label(
        &mut self,
        scene: &Scene,
        operand: usize,
        anchor: &Anchor,
    ) -> Option<Labels> {
        let root = self.root_of(operand, anchor.name);
        self.known_or(root, || scene.count_at(operand, &anchor.place))
    }

    /// Returns the label of all other operands on an element that nothing crosses; counts it if it is not
    /// known. `None` if counting is doubtful.
    pub(super) fn label_of(&mut self, scene: &Scene, i: usize, fate: &Fate) -> Option<Labels> {
        let element = &scene.elements[i];
        let root = self.sets.least(self.anchors[i]);
        self.known_or(root, || match (fate, &element.place) {
            (Fate::Uncut(anchors), _) => {
                let count = |anchor: &Anchor| scene.count_at(element.operand, &anchor.place);
                anchors.iter().find_map(count)
            }
            (_, Place::Face(triangle)) => {
                let corners = &triangle.corners;
                let count = |i: usize| scene.count_at_lattice(element.operand, &corners[i]);
                element.vertices_in(scene.cell).find_map(count)
            }
            _ => None,
        })
    }

    fn known_or(&mut self, root: u32, count: impl FnOnce() -> Option<Labels>) -> Option<Labels> {
        let known = &mut self.labels[root as usize];
        if known.is_none() {
            *known = Some(count()?);
        }
        *known
    }
}

/// Makes an empty table of anchor numbers for the vertices of the mesh of an operand's first element; `None`
/// if this mesh has too many vertices for its elements in the cell.
fn numbers_of_vertices(elements: &[Element]) -> Option<(Slot, Vec<u32>)> {
    let Place::Face(triangle) = &elements.first()?.place else {
        return None;
    };
    let count = triangle.mesh_size();
    (count <= MAX_VERTICES_PER_ELEMENT * elements.len())
        .then(|| (triangle.face.slot, vec![NONE; count]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::crossing;
    use crate::mesh::handle::VertexId;

    #[test]
    fn what_is_known_at_a_vertex_is_known_at_all_that_nothing_separates() {
        let shared = crossing();
        let operands = shared.operands();
        let roots = |count: usize| {
            let scene = Scene::new(&shared.cell, &operands[..count], &shared.sources);
            let fates = scene.fates().expect("general position");
            let mut known = Known::new(&scene, &fates);
            let vertex = |v: u32| Name::Vertex(Slot(0), VertexId(v));
            [0, 1, 2, 3].map(|v| known.root_of(0, vertex(v)))
        };
        assert_eq!(roots(1), [0; 4]);
        // Three faces of the first tetrahedron stay whole beside the second.
        assert_eq!(roots(2), [0; 4]);
    }
}
