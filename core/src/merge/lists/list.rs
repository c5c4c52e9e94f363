//! The list of elements (faces and parts of faces) that meet a cell, and its division with the cell.

use std::sync::{Arc, OnceLock};

use super::separation::misses;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::{Cell, Cut};
use crate::geometry::plane::Lattice;
use crate::geometry::side::{Half, Orientation};
use crate::geometry::winding::crossing::{plane_change, polygon_change, triangle_change, Segment};
use crate::interrupt::spend;
use crate::mesh::cached::Cached;
use crate::mesh::handle::{FaceId, Slot};
use crate::mesh::source::{Shape, Source};
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node, PartElement};
use crate::tree::pieces::{pieces, Piece};
use crate::tree::table::SourceTable;

/// Coordinates relative to a cell, divided by a power of two so that they fit into 32 bits.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    origin: Lattice,
    shift: u32,
}

impl Frame {
    fn of(cell: &Cell) -> Self {
        let largest = cell.size().into_iter().max().unwrap_or(0);
        Self {
            origin: *cell.low(),
            shift: u32::from(largest).saturating_sub(30),
        }
    }

    #[inline]
    #[allow(clippy::cast_possible_truncation, reason = "clamped before")]
    fn index(&self, axis: usize, k: i64) -> i32 {
        let index = (k - self.origin[axis]) >> self.shift;
        index.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
    }

    /// Returns the first 32-bit index whose lattice coordinates are all at least `k`.
    fn index_beyond(&self, axis: usize, k: i64) -> i32 {
        self.index(axis, k + (1 << self.shift) - 1)
    }

    #[inline]
    fn indices(&self, p: &Lattice) -> [i32; 3] {
        [
            self.index(0, p[0]),
            self.index(1, p[1]),
            self.index(2, p[2]),
        ]
    }

    fn resolves(&self, cell: &Cell) -> bool {
        cell.size().into_iter().all(|s| u32::from(s) > self.shift)
    }
}

/// A whole face of an operand with its bounding box relative to a cell, rounded outwards.
#[derive(Clone, Copy, Debug)]
pub struct FaceRecord {
    low: [i32; 3],
    high: [i32; 3],
    /// The number of the face in its source.
    pub face: FaceId,
    tag: GroupTag,
}

/// The source (its slot), the orientation and the mark `TOUCHING` of a group of faces in one 32-bit word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct GroupTag(u32);

impl GroupTag {
    /// The bit that is set for faces turned around; the bits below 2³⁰ are the slot, as there are fewer than
    /// 2³⁰ sources.
    const OPPOSITE: u32 = 1 << 31;

    /// The bit that is set for faces that may touch other elements (faces or parts of faces) anywhere, not
    /// only along edges.
    const TOUCHING: u32 = 1 << 30;

    fn new(slot: Slot, orientation: Orientation, touching: bool) -> Self {
        let bit = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        let opposite = bit(orientation.is_opposite(), Self::OPPOSITE);
        Self(slot.0 | opposite | bit(touching, Self::TOUCHING))
    }

    fn slot(self) -> Slot {
        Slot(self.0 & !(Self::OPPOSITE | Self::TOUCHING))
    }

    fn is_touching(self) -> bool {
        self.0 & Self::TOUCHING != 0
    }

    fn orientation(self) -> Orientation {
        Orientation::turned_around(self.0 & Self::OPPOSITE != 0)
    }
}

impl FaceRecord {
    /// Returns the index of the face's source in the evaluation's table of sources.
    pub fn slot(&self) -> Slot {
        self.tag.slot()
    }

    /// Returns the orientation of the face relative to its source.
    pub fn orientation(&self) -> Orientation {
        self.tag.orientation()
    }
}

/// A part of a face with its bounding box relative to a cell, rounded outwards, and its cached convex pieces.
#[derive(Clone, Debug)]
pub struct PartRecord {
    low: [i32; 3],
    high: [i32; 3],
    /// The part of a face, with its orientation.
    pub element: PartElement,
    pieces: OnceLock<Arc<[Piece]>>,
}

impl PartRecord {
    /// Returns the convex pieces of the part; the first call computes them.
    pub fn pieces(&self) -> &[Piece] {
        self.pieces.get_or_init(|| pieces(&self.element.part))
    }
}

/// The faces and parts of faces of one operand that meet a cell, and the operand's winding number at the
/// cell's low corner.
#[derive(Clone, Debug)]
pub struct List {
    frame: Frame,
    /// The whole faces that meet the cell.
    pub records: Vec<FaceRecord>,
    /// The parts of faces that meet the cell.
    pub parts: Vec<PartRecord>,
    /// The operand's winding number at the cell's low corner.
    pub corner: i32,
    by_kernel: bool,
}

/// The sources (meshes and half-spaces) of an evaluation, in the order in which operands first name them.
#[derive(Debug)]
pub struct Sources(SourceTable);

impl Sources {
    /// Makes the sources of an evaluation from a table.
    pub fn new(table: SourceTable) -> Self {
        Self(table)
    }

    /// Returns the table of sources.
    pub fn table(&self) -> &SourceTable {
        &self.0
    }

    /// Returns the source with this index in the table.
    pub fn get(&self, slot: Slot) -> &Arc<Source> {
        self.0.get(slot)
    }

    /// Returns the index of a source in the table.
    ///
    /// # Panics
    /// If the table does not contain the source.
    pub fn slot(&self, source: &Source) -> Slot {
        self.0.slot(source).expect("a source of the table")
    }
}

impl List {
    /// Returns the low and the high corner of a box around all listed faces and parts of faces, rounded
    /// outwards.
    pub fn bounds(&self) -> [Lattice; 2] {
        let records = self.records.iter().map(|r| (&r.low, &r.high));
        let parts = self.parts.iter().map(|p| (&p.low, &p.high));
        let nothing = ([i32::MAX; 3], [i32::MIN; 3]);
        let (low, high) = records.chain(parts).fold(nothing, |(low, high), (l, h)| {
            let low = each_axis(|i| low[i].min(l[i]));
            (low, each_axis(|i| high[i].max(h[i])))
        });
        let place = |at: [i32; 3], more: i64| {
            each_axis(|i| ((i64::from(at[i]) + more) << self.frame.shift) + self.frame.origin[i])
        };
        [place(low, 0), place(high, 1)]
    }

    /// Makes the list of a deferred leaf in the cell of its branch, complemented if the branch is.
    pub fn open(leaf: &DeferredLeaf, branch: &Branch, sources: &Sources) -> Self {
        spend(leaf.len());
        let frame = Frame::of(&branch.cell);
        let mut list = Self {
            frame,
            records: Vec::with_capacity(leaf.groups.iter().map(|g| g.faces.len()).sum()),
            parts: Vec::with_capacity(leaf.parts.len()),
            corner: branch.oriented(leaf.corner),
            by_kernel: leaf.by_kernel,
        };
        for group in &leaf.groups {
            let orientation = group.orientation.turned_if(branch.complement);
            let tag = GroupTag::new(sources.slot(&group.source), orientation, group.touching);
            let record = |face: &FaceId| frame.record(&group.source, *face, tag);
            list.records.extend(group.faces.iter().map(record));
        }
        for element in &leaf.parts {
            let turned = element.turned_if(branch.complement);
            list.parts.push(frame.part_record(turned, OnceLock::new()));
        }
        list
    }

    /// Makes the list of a deferred leaf in a cell that contains the cell of its branch. `None` if a face or
    /// part extends out of the branch's cell, because outside it may not bound the solid.
    pub fn of_larger_cell(branch: &Branch, cell: &Cell, sources: &Sources) -> Option<Self> {
        let Node::Deferred(leaf) = &*branch.node else {
            return None;
        };
        let held = |source: &Source, face: &FaceId| {
            let (low, high) = source.face_box(*face);
            branch.cell.contains_box(&low, &high)
        };
        let faces = |g: &FaceGroup| g.faces.iter().all(|face| held(&g.source, face));
        let parts = |p: &PartElement| branch.cell.contains(&p.part.home);
        let all_held = || leaf.groups.iter().all(faces) && leaf.parts.iter().all(parts);
        if branch.cell != *cell && !all_held() {
            return None;
        }
        let mut list = Self::open(leaf, branch, sources);
        if branch.cell.low() != cell.low() {
            list.corner = branch.outside;
        }
        Some(list)
    }

    /// Returns the number of listed faces and parts of faces.
    pub fn len(&self) -> usize {
        self.records.len() + self.parts.len()
    }

    /// Returns true if a kernel made the listed faces and parts; false if they are the unchanged boundary of
    /// an operand.
    pub fn is_by_kernel(&self) -> bool {
        self.by_kernel
    }

    /// Returns true if the list has a face that may touch other listed faces anywhere, not only along edges.
    pub fn is_touching(&self) -> bool {
        self.records.iter().any(|r| r.tag.is_touching())
    }

    /// Returns true if no face and no part of a face is listed.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Divides the list of `cell` at `cut` into the lists of the minus and the plus half; a face may be in
    /// both.
    pub fn divide(mut self, cell: &Cell, cut: Cut, sources: &Sources) -> (Self, Self) {
        spend(self.len());
        if !self.frame.resolves(cell) {
            self.reframe(cell, sources);
        }
        let at = self.frame.index(cut.axis, cut.at);
        let change = self.change_along_edge(cell, cut, sources);
        let plus = Self {
            frame: self.frame,
            records: self.divide_records(cell, cut, sources),
            parts: above(&self.parts, cut.axis, at),
            corner: self.corner + change,
            by_kernel: self.by_kernel,
        };
        self.parts.retain(|p| p.low[cut.axis] < at);
        (self, plus)
    }

    /// Restricts the list to a smaller cell. No listed face may meet the other part of the larger cell, so
    /// that the winding number at the low corner does not change.
    pub fn shrink(&mut self, inner: &Cell, sources: &Sources) {
        if !self.frame.resolves(inner) {
            spend(self.len());
            self.reframe(inner, sources);
        }
    }

    /// Returns the winding number in `cell` outside of the smaller cell `inner`; no listed face may meet this
    /// region.
    pub fn winding_number_outside(&self, cell: &Cell, inner: &Cell, sources: &Sources) -> i32 {
        match cell.cut() {
            Some(cut) if inner.low() == cell.low() => {
                self.corner + self.change_along_edge(cell, cut, sources)
            }
            _ => self.corner,
        }
    }

    /// Removes the faces that miss the minus half of `cell`, and returns the faces that may meet its plus
    /// half.
    fn divide_records(&mut self, cell: &Cell, cut: Cut, sources: &Sources) -> Vec<FaceRecord> {
        let (axis, at) = (cut.axis, self.frame.index(cut.axis, cut.at));
        let halves = Half::BOTH.map(|half| cell.half(cut, half));
        let missed =
            |r: &FaceRecord, plus: usize| misses(sources.get(r.slot()), r.face, &halves[plus]);
        let count = self.records.iter().filter(|r| r.high[axis] >= at).count();
        let mut plus = Vec::with_capacity(count);
        let frame = self.frame;
        self.records.retain(|r| {
            let (below, above) = (r.low[axis] < at, r.high[axis] >= at);
            let large = below && above && frame.is_as_long_as(r, cell);
            if above && !(large && missed(r, 1)) {
                plus.push(*r);
            }
            below && !(large && missed(r, 0))
        });
        plus
    }

    /// Returns the number of listed faces and parts that extend out of the cell, which halving cannot
    /// separate soon.
    pub fn count_reaching_out(&self, cell: &Cell) -> usize {
        let high = cell.high();
        let (low, high) = (self.frame.indices(cell.low()), self.frame.indices(&high));
        let out = |a: &[i32; 3], b: &[i32; 3]| (0..3).any(|i| a[i] < low[i] || b[i] > high[i]);
        self.records.iter().filter(|r| out(&r.low, &r.high)).count()
            + self.parts.iter().filter(|p| out(&p.low, &p.high)).count()
    }

    fn reframe(&mut self, cell: &Cell, sources: &Sources) {
        let frame = Frame::of(cell);
        for r in &mut self.records {
            *r = frame.record(sources.get(r.slot()), r.face, r.tag);
        }
        for p in &mut self.parts {
            *p = frame.part_record(p.element.clone(), p.pieces.clone());
        }
        self.frame = frame;
    }

    /// Returns the change of the winding number from the low corner of `cell` to the low corner of its plus
    /// half.
    fn change_along_edge(&self, cell: &Cell, cut: Cut, sources: &Sources) -> i32 {
        let from = cell.corner();
        let segment = Segment {
            from,
            axis: cut.axis,
            to: 2 * cut.at - 1,
        };
        let low = *cell.low();
        let at = self.frame.indices(&low);
        let end = self.frame.index_beyond(cut.axis, cut.at);
        let near = |low: &[i32; 3], high: &[i32; 3]| {
            (0..3).all(|i| high[i] >= at[i] && low[i] < if i == cut.axis { end } else { at[i] })
        };
        let mut change = 0;
        for r in self.records.iter().filter(|r| near(&r.low, &r.high)) {
            let across = match sources.get(r.slot()).shape() {
                Shape::Mesh(mesh) => triangle_change(&mesh.corners(r.face), &segment),
                Shape::HalfSpace(plane) => plane_change(plane, &segment),
            };
            change += r.orientation().signed(across);
        }
        let widened = |p: &&PartRecord| {
            (0..3).all(|i| {
                p.high[i] >= at[i] - 1 && p.low[i] <= if i == cut.axis { end } else { at[i] }
            })
        };
        for p in self.parts.iter().filter(widened) {
            spend(p.pieces().len());
            let pieces = p.pieces().iter();
            let changes = pieces.map(|q| polygon_change(&q.polygon, &segment));
            let across: i32 = changes.sum();
            change += p.element.orientation.signed(across);
        }
        change
    }

    /// Returns the list as a deferred leaf, complemented if `complement` is true; an empty list becomes a
    /// leaf with one winding number.
    pub fn close(self, complement: bool, sources: &Sources) -> Node {
        let corner = if complement {
            1 - self.corner
        } else {
            self.corner
        };
        if self.is_empty() {
            return Node::Leaf(corner);
        }
        let mut groups: Vec<FaceGroup> = Vec::new();
        let mut open = None;
        for r in &self.records {
            if open != Some(r.tag) {
                open = Some(r.tag);
                let source = Arc::clone(sources.get(r.slot()));
                groups.push(FaceGroup {
                    touching: r.tag.is_touching(),
                    source,
                    orientation: r.orientation().turned_if(complement),
                    faces: Vec::new(),
                });
            }
            if let Some(group) = groups.last_mut() {
                group.faces.push(r.face);
            }
        }
        let turned = |p: PartRecord| p.element.turned_if(complement);
        let parts = self.parts.into_iter().map(turned).collect();
        Node::Deferred(DeferredLeaf {
            groups,
            parts,
            corner,
            by_kernel: self.by_kernel,
            share: Cached::new(),
        })
    }
}

fn above(parts: &[PartRecord], axis: usize, at: i32) -> Vec<PartRecord> {
    parts
        .iter()
        .filter(|p| p.high[axis] >= at)
        .cloned()
        .collect()
}

impl Frame {
    fn record(&self, source: &Source, face: FaceId, tag: GroupTag) -> FaceRecord {
        let (low, high) = match source.shape() {
            Shape::Mesh(mesh) => {
                let (low, high) = mesh.face_box(face);
                (self.indices(&low), self.indices(&high))
            }
            Shape::HalfSpace(_) => ([i32::MIN; 3], [i32::MAX; 3]),
        };
        FaceRecord {
            low,
            high,
            face,
            tag,
        }
    }

    fn part_record(&self, element: PartElement, pieces: OnceLock<Arc<[Piece]>>) -> PartRecord {
        let [low, high] = element.part.around.map(|p| self.indices(&p));
        PartRecord {
            low,
            high,
            element,
            pieces,
        }
    }

    /// Returns true if a face's bounding box is at least as long as `cell` on an axis; such a face may miss a
    /// half of the cell that its box meets.
    fn is_as_long_as(&self, r: &FaceRecord, cell: &Cell) -> bool {
        let size = cell.size();
        (0..3).any(|i| {
            let extent = i64::from(r.high[i]) - i64::from(r.low[i]);
            extent << self.shift >= 1i64 << size[i]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::{cuboid, Shared};

    #[test]
    fn halving_keeps_what_meets_a_half_and_counts_to_its_corner() {
        let scene = Shared::of(&[cuboid([0; 3], [20; 3])]);
        let (mut cell, mut list) = (scene.cell, scene.lists[0].clone());
        assert_eq!((list.len(), list.corner), (12, 0));
        for _ in 0..3 {
            let cut = cell.cut().expect("more than one point");
            list = list.divide(&cell, cut, &scene.sources).1;
            cell = cell.half(cut, Half::Plus);
        }
        // The cell begins at 16: its low corner is inside the box, and the faces at zero are not in it.
        assert_eq!((*cell.low(), list.corner), ([16; 3], 1));
        let mesh = scene.sources.get(Slot(0)).mesh().expect("a mesh");
        let meets = |f: FaceId| mesh.face_box(f).1.iter().all(|c| *c == 20);
        assert!(!list.is_empty() && list.records.iter().all(|r| meets(r.face)));
    }

    /// Boxes around the low corner of a large cell, near this corner, and far from it.
    #[test]
    fn shrinking_counts_what_halving_counts() {
        let ends = [[-100, 20], [3, 20], [12 << 30, (12 << 30) + 9]];
        for [low, high] in ends {
            let far = cuboid([1 << 41; 3], [(1 << 41) + 1; 3]);
            let scene = Shared::of(&[cuboid([low; 3], [high; 3]), far]);
            let cell = Cell::around(&[0; 3], &[(1 << 41) - 1; 3]);
            let inner = Cell::around(&[low.max(0); 3], &[high; 3]);
            let list = down(scene.lists[0].clone(), scene.cell, &cell, &scene.sources).0;
            let mut shrunk = list.clone();
            let beside = shrunk.winding_number_outside(&cell, &inner, &scene.sources);
            shrunk.shrink(&inner, &scene.sources);
            let (list, others) = down(list, cell, &inner, &scene.sources);
            assert_eq!((shrunk.corner, shrunk.len()), (list.corner, list.len()));
            assert!(shrunk.frame.resolves(&inner) && !others.is_empty());
            assert!(others.iter().all(|o| o.is_empty() && o.corner == beside));
        }
    }

    /// Halves a list from a cell down to an inner one; returns its list, and the lists of the other halves.
    fn down(list: List, from: Cell, inner: &Cell, sources: &Sources) -> (List, Vec<List>) {
        let (mut list, mut cell, mut others) = (list, from, Vec::new());
        while let Some(cut) = cell.cut().filter(|_| cell != *inner) {
            let (minus, plus) = list.divide(&cell, cut, sources);
            let lower = cell.half(cut, Half::Minus);
            let is_lower = lower.contains(inner);
            cell = if is_lower {
                lower
            } else {
                cell.half(cut, Half::Plus)
            };
            let (half, other) = if is_lower {
                (minus, plus)
            } else {
                (plus, minus)
            };
            others.push(other);
            list = half;
        }
        (list, others)
    }

    #[test]
    fn a_closed_list_opens_again() {
        let scene = Shared::of(&[cuboid([0; 3], [20; 3])]);
        let node = scene.lists[0].clone().close(true, &scene.sources);
        let Node::Deferred(leaf) = &node else {
            panic!("faces are listed");
        };
        assert_eq!((leaf.len(), leaf.corner), (12, 1));
        assert!(leaf.groups.iter().all(|g| g.orientation.is_opposite()));
    }
}
