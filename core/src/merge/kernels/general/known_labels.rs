//! The known labels at anchors: points that several elements of an operand share.

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use super::anchors::Anchor;
use super::cut_status::CutStatus;
use super::scene::{Element, ElementKind, PointName, Scene};
use super::Labels;
use crate::arith::convert::as_number;
use crate::geometry::cell::Cell;
use crate::interrupt::poll;
use crate::mesh::disjoint::DisjointSets;
use crate::mesh::handle::Slot;

/// The number that stands for no anchor (a point that faces of one operand may share); it exceeds the numbers
/// of all anchors.
const NONE: u32 = u32::MAX;

/// The most vertices of a mesh for each of its faces in the cell for which a table of all vertices is used
/// instead of a hash map. A face looks up three names in the map, and each look-up costs as much as clearing
/// about fifty entries of the table.
const MAX_VERTICES_PER_ELEMENT: usize = 16;

/// Anchors (points that several faces of an operand share) with the known labels there, which say in which
/// other operands the point lies. All anchors of a face that nothing crosses have the same label.
pub(super) struct KnownLabels {
    /// For each operand the numbers of its anchors (shared points) at the vertices of one mesh, if enough of
    /// the mesh is in the cell.
    of_vertices: Vec<Option<(Slot, Vec<u32>)>>,
    /// The numbers of all other anchors (points that faces of an operand share), by operand and name.
    numbers: HashMap<(u32, PointName), u32>,
    sets: DisjointSets,
    /// The label at each anchor (shared point) that represents its class of anchors with equal labels, if
    /// known.
    pub(super) labels: Vec<Option<Labels>>,
    /// For each face that nothing crosses the number of one of its anchors (points that it shares with other
    /// faces); otherwise `NONE`.
    anchors: Vec<u32>,
    /// The divided faces at anchors (shared points), sorted: the anchor that represents the class, the number
    /// of the face, and the index of the anchor among the face's anchors.
    cuts: Vec<(u32, u32, u32)>,
}

impl KnownLabels {
    /// Unites the anchors (shared points) of each face that nothing crosses into classes; no label is known
    /// yet.
    pub(super) fn new(scene: &Scene, statuses: &[CutStatus]) -> Self {
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
        for (element, status) in scene.elements.iter().zip(statuses) {
            poll();
            let anchor = known.enter(scene.cell, element, status);
            known.anchors.push(anchor);
        }
        for (i, (element, status)) in (0u32..).zip(scene.elements.iter().zip(statuses)) {
            poll();
            if let CutStatus::Cut(cut) = status {
                for (index, anchor) in (0u32..).zip(&cut.anchors) {
                    let root = known.root_of(element.operand, anchor.name);
                    known.cuts.push((root, i, index));
                }
            }
        }
        known.cuts.sort_unstable();
        known
    }

    /// Unites the anchors (shared points) of a face that nothing crosses into one class and returns the
    /// number of one of them; `NONE` for other faces.
    fn enter(&mut self, cell: &Cell, element: &Element, status: &CutStatus) -> u32 {
        let operand = element.operand;
        match (status, &element.kind) {
            (CutStatus::Untouched, ElementKind::Face(triangle)) => {
                let names = element.vertices_in(cell).map(|i| triangle.point_name(i));
                self.unite(operand, names)
            }
            (CutStatus::Uncut(anchors), _) => self.unite(operand, anchors.iter().map(|a| a.name)),
            _ => NONE,
        }
    }

    fn unite(&mut self, operand: usize, names: impl Iterator<Item = PointName>) -> u32 {
        names.fold(NONE, |a, name| {
            let b = self.root_of(operand, name);
            if a == NONE {
                b
            } else {
                self.sets.join_named(a, b)
            }
        })
    }

    /// Returns the number of the anchor that represents the class of the anchor (point shared by faces) with
    /// this name; adds the anchor if it is new.
    pub(super) fn root_of(&mut self, operand: usize, name: PointName) -> u32 {
        let next = self.sets.end();
        let at = match (name, &mut self.of_vertices[operand]) {
            (PointName::Vertex(slot, vertex), Some((own, numbers))) if slot == *own => {
                let number = &mut numbers[vertex.index()];
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

    /// Returns the divided faces at an anchor (shared point), each with its part at the anchor and the label
    /// `label` there; `None` if an anchor is no corner of its face.
    pub(super) fn cut_elements_at(
        &self,
        root: usize,
        statuses: &[CutStatus],
        label: Labels,
    ) -> Option<Vec<(usize, usize, Labels)>> {
        let start = self.cuts.partition_point(|c| (c.0 as usize) < root);
        let here = self.cuts[start..].iter();
        let here = here.take_while(|c| c.0 as usize == root);
        here.map(|(_, i, index)| {
            let CutStatus::Cut(cut) = &statuses[*i as usize] else {
                return None;
            };
            let part = cut.part_at(&cut.anchors[*index as usize])?;
            Some((*i as usize, part, label))
        })
        .collect()
    }

    /// Returns the label at an anchor of an operand (a point that its faces share): in which other operands
    /// the point lies. Counts winding numbers if the label is not known; `None` if counting is doubtful.
    pub(super) fn label(
        &mut self,
        scene: &Scene,
        operand: usize,
        anchor: &Anchor,
    ) -> Option<Labels> {
        let root = self.root_of(operand, anchor.name);
        self.known_or_counted(root, || scene.count_label_at(operand, &anchor.position))
    }

    /// Returns the label of a face that nothing crosses: in which other operands it lies. Counts winding
    /// numbers if the label is not known; `None` if counting is doubtful.
    pub(super) fn label_of(
        &mut self,
        scene: &Scene,
        i: usize,
        status: &CutStatus,
    ) -> Option<Labels> {
        let element = &scene.elements[i];
        let root = self.sets.least(self.anchors[i]);
        self.known_or_counted(root, || match (status, &element.kind) {
            (CutStatus::Uncut(anchors), _) => {
                let count =
                    |anchor: &Anchor| scene.count_label_at(element.operand, &anchor.position);
                anchors.iter().find_map(count)
            }
            (_, ElementKind::Face(triangle)) => {
                let corners = &triangle.corners;
                let count = |i: usize| scene.count_label_at_lattice(element.operand, &corners[i]);
                element.vertices_in(scene.cell).find_map(count)
            }
            _ => None,
        })
    }

    fn known_or_counted(
        &mut self,
        root: u32,
        count: impl FnOnce() -> Option<Labels>,
    ) -> Option<Labels> {
        let known = &mut self.labels[root as usize];
        if known.is_none() {
            *known = Some(count()?);
        }
        *known
    }
}

/// Makes an empty table of anchor numbers for the vertices of the mesh of an operand's first face in the
/// cell; `None` if this mesh has too many vertices for its faces in the cell.
fn numbers_of_vertices(elements: &[Element]) -> Option<(Slot, Vec<u32>)> {
    let ElementKind::Face(triangle) = &elements.first()?.kind else {
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
            let statuses = scene.cut_statuses().expect("general position");
            let mut known = KnownLabels::new(&scene, &statuses);
            let vertex = |v: u32| PointName::Vertex(Slot(0), VertexId(v));
            [0, 1, 2, 3].map(|v| known.root_of(0, vertex(v)))
        };
        assert_eq!(roots(1), [0; 4]);
        // Three faces of the first tetrahedron stay whole beside the second.
        assert_eq!(roots(2), [0; 4]);
    }
}
