//! Collects, in one pass, the faces and parts of faces that the leaves of a solid's tree list.

use std::ops::{Index, IndexMut};
use std::sync::atomic::{AtomicU8, Ordering};

use rayon::prelude::*;
use rustc_hash::FxHashMap as HashMap;
use smallvec::{smallvec, SmallVec};

use crate::arith::convert::{as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::outline::{cancel, Outline, OutlineEdge};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::interrupt::{carried, poll};
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{FaceId, OrientedFace, Slot, SourceFace};
use crate::mesh::source::Source;
use crate::mesh::tasks::{in_pool, CHUNK};
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node, Part};

/// A face that a leaf lists, though it extends beyond the leaf's cell.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Spanning {
    /// The face and its orientation in the boundary.
    pub face: OrientedFace,
    /// The number of the leaf that lists the face.
    pub leaf: u32,
}

/// A part of a face that belongs to the boundary of a solid.
pub struct Piece<'a> {
    /// The face and its orientation in the boundary.
    pub face: OrientedFace,
    extent: Extent<'a>,
}

/// The outline of a boundary part of a face, as data from which it is computed only on demand.
enum Extent<'a> {
    /// The part of the face in the cell of the leaf with this number.
    Face(u32),
    /// All of a part of the face that the tree stores.
    Part(&'a Part),
    /// The region inside these edges.
    Edges(Vec<OutlineEdge>),
}

impl From<&Spanning> for Piece<'_> {
    fn from(s: &Spanning) -> Self {
        Self {
            face: s.face,
            extent: Extent::Face(s.leaf),
        }
    }
}

impl Piece<'_> {
    /// Returns the outline of this boundary part, if the face has no other boundary part.
    pub fn outline(&mut self, sources: &Sources, cells: &[Cell]) -> Outline {
        match self.extent {
            Extent::Part(part) => Outline::of_bare(&part.edges),
            _ => Outline::of(self.take_edges(sources, cells)),
        }
    }

    /// Returns the edges around this boundary part of a face, and removes them from the part if it stores
    /// them.
    pub fn take_edges(&mut self, sources: &Sources, cells: &[Cell]) -> Vec<OutlineEdge> {
        match &mut self.extent {
            Extent::Face(leaf) => {
                let source = sources.get(self.face.slot());
                let polygon = source.clip(self.face.id(), &cells[*leaf as usize]);
                polygon.map_or_else(Vec::new, |p| OutlineEdge::edges_of(&p).collect())
            }
            Extent::Part(part) => part.outline(),
            Extent::Edges(edges) => std::mem::take(edges),
        }
    }
}

/// The faces and parts that the leaves of a tree list, in the order of the leaves.
#[derive(Default)]
pub struct Listed<'a> {
    /// The faces whose fate a single leaf decides: `Whole` for a face inside the cell of a leaf that lists
    /// it, `Cut` for a face of which a leaf lists a part.
    pub fates: Fates,
    /// The faces that extend beyond the cell of a leaf that lists them, once for each such leaf.
    pub spanning: Vec<Spanning>,
    /// The boundary parts of faces that the leaves list, sorted by face.
    pub parts: Vec<Piece<'a>>,
    /// Faces in cells where several operands met, so that they may touch other faces.
    pub near: Vec<SourceFace>,
    /// The cell of each leaf.
    pub cells: Vec<Cell>,
}

/// The contents of one leaf: faces that extend beyond its cell, parts of faces, and faces that may touch
/// other operands.
#[derive(Default)]
struct Found<'a> {
    spanning: Vec<Spanning>,
    parts: Vec<Listing<'a>>,
    near: Vec<SourceFace>,
}

/// A part of a face that a leaf lists.
struct Listing<'a> {
    face: OrientedFace,
    leaf: u32,
    part: &'a Part,
}

/// A leaf of a tree, with its number, its cell, and whether its content is complemented.
struct Leaf<'a> {
    number: u32,
    cell: Cell,
    complement: bool,
    content: &'a DeferredLeaf,
}

/// Collects the faces and parts that all leaves of a tree list.
pub fn listed<'a>(root: &'a Branch, sources: &Sources) -> Listed<'a> {
    let leaves = leaves_of(root);
    let fates = AtomicFates::of(&leaves, sources);
    let visit = carried(|leaf: &Leaf<'a>| leaf.visit(sources, &fates));
    let size: usize = leaves.iter().map(|l| l.content.len()).sum();
    let found: Vec<Found> = if in_pool() && size > CHUNK {
        leaves.par_iter().map(visit).collect()
    } else {
        leaves.iter().map(visit).collect()
    };
    let mut all = Listed {
        cells: leaves.iter().map(|l| l.cell).collect(),
        ..Listed::default()
    };
    let mut parts: Vec<Listing> = Vec::new();
    for leaf in found {
        poll();
        all.spanning.extend(leaf.spanning);
        parts.extend(leaf.parts);
        all.near.extend(leaf.near);
    }
    parts.sort_by_key(|listing| listing.face);
    all.parts = pieces(&parts, &all.cells);
    for piece in &all.parts {
        fates.0[piece.face.slot().index()][piece.face.id().index()].store(CUT, Ordering::Relaxed);
    }
    all.fates = fates.into_plain();
    all
}

/// The boundary parts of one face; usually there is only one.
type Pieces<'a> = SmallVec<[Piece<'a>; 1]>;

type Extents<'a> = SmallVec<[Extent<'a>; 1]>;

/// Turns the parts of faces that leaves list, sorted by face, into the boundary parts of each face.
fn pieces<'a>(parts: &[Listing<'a>], cells: &[Cell]) -> Vec<Piece<'a>> {
    let runs: Vec<&[Listing]> = parts.chunk_by(|a, b| a.face == b.face).collect();
    let face = carried(|run: &&[Listing<'a>]| pieces_of_face(run, cells));
    let pieces: Vec<Pieces> = if in_pool() && parts.len() > CHUNK {
        runs.par_iter().map(face).collect()
    } else {
        runs.iter().map(face).collect()
    };
    pieces.into_iter().flatten().collect()
}

/// Returns the boundary parts of one face: a stored part if the leaves that list it contain all of it, else
/// the part clipped to each leaf.
fn pieces_of_face<'a>(run: &[Listing<'a>], cells: &[Cell]) -> Pieces<'a> {
    let extents = match run {
        [single] => extents(single.part, &[single.leaf], cells),
        _ => extents_by_part(run, cells),
    };
    let face = run[0].face;
    let piece = |extent| Piece { face, extent };
    extents.into_iter().map(piece).collect()
}

fn extents_by_part<'a>(run: &[Listing<'a>], cells: &[Cell]) -> Extents<'a> {
    let mut places: HashMap<*const Part, usize> = HashMap::default();
    let mut by_part: Vec<(&'a Part, SmallVec<[u32; 4]>)> = Vec::new();
    for listing in run {
        poll();
        let next = by_part.len();
        let place = *places.entry(listing.part).or_insert(next);
        if place == next {
            by_part.push((listing.part, SmallVec::new()));
        }
        by_part[place].1.push(listing.leaf);
    }
    let by_part = by_part.into_iter();
    by_part
        .flat_map(|(part, leaves)| extents(part, &leaves, cells))
        .collect()
}

/// Returns a stored part of a face as one extent if the leaves that list it contain all of it, else clipped
/// to each leaf.
fn extents<'a>(part: &'a Part, leaves: &[u32], cells: &[Cell]) -> Extents<'a> {
    if is_whole(part, leaves, cells) {
        return smallvec![Extent::Part(part)];
    }
    let edges = leaves.iter().map(|l| part_edges(part, &cells[*l as usize]));
    edges.filter(|e| !e.is_empty()).map(Extent::Edges).collect()
}

/// Returns true only if the leaves that list a part of a face together contain all of the part; may return
/// false negatives.
fn is_whole(part: &Part, leaves: &[u32], cells: &[Cell]) -> bool {
    if let [leaf] = leaves
        && cells[*leaf as usize] == part.home
    {
        return !part.edges.is_empty();
    }
    let once = leaves.windows(2).all(|pair| pair[0] != pair[1]);
    once && fill(part_box(part), leaves.iter().copied(), cells)
}

/// The lattice box of a part of a face, clipped to the cell in which the part was made.
fn part_box(part: &Part) -> (Lattice, Lattice) {
    let ((low, high), home) = (part.bounds(), (part.home.low(), part.home.high()));
    (
        each_axis(|i| as_whole(low[i].floor()).max(home.0[i])),
        each_axis(|i| as_whole(high[i].ceil()).min(home.1[i])),
    )
}

/// Returns true only if the cells of the given leaves together fill a box; may return false negatives.
///
/// Leaves are disjoint, so counting lattice points suffices.
pub fn fill(
    (low, high): (Lattice, Lattice),
    leaves: impl Iterator<Item = u32>,
    cells: &[Cell],
) -> bool {
    let Some(mut rest) = count(&low, &high).filter(|all| *all > 0) else {
        return false;
    };
    for leaf in leaves {
        poll();
        let cell = &cells[leaf as usize];
        let (bottom, top) = (cell.low(), cell.high());
        let a = each_axis(|i| low[i].max(bottom[i]));
        let b = each_axis(|i| high[i].min(top[i]));
        let Some(remaining) = count(&a, &b).and_then(|part| rest.checked_sub(part)) else {
            return false;
        };
        rest = remaining;
    }
    rest == 0
}

/// Counts the lattice points of a box; `None` if the count exceeds 128 bits.
fn count(low: &Lattice, high: &Lattice) -> Option<u128> {
    let extent = |i: usize| u64::try_from(high[i] - low[i] + 1).unwrap_or(0);
    let area = u128::from(extent(0)) * u128::from(extent(1));
    area.checked_mul(u128::from(extent(2)))
}

fn leaves_of(root: &Branch) -> Vec<Leaf<'_>> {
    let mut leaves = Vec::new();
    let mut open = vec![(root, root.complement)];
    while let Some((branch, complement)) = open.pop() {
        poll();
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(content) => leaves.push(Leaf {
                number: as_number(leaves.len()),
                cell: branch.cell,
                complement,
                content,
            }),
            Node::Cut(halves) => {
                let [minus, plus] = &halves.children;
                for child in [plus, minus] {
                    open.push((child, complement ^ child.complement));
                }
            }
        }
    }
    leaves
}

/// How much of a source face belongs to the boundary of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// No part of the face is boundary.
    Gone,
    /// All of the face is boundary, in this orientation. Never used for the face of a half-space, which only
    /// ends at the border of the universe.
    Whole(Orientation),
    /// Part of the face is boundary, or the face is joined to a polygon of its plane.
    Cut,
}

/// For each source, by its index (slot), the fate of each face: whole, cut or gone. A source that no leaf
/// names has an empty list.
#[derive(Debug, Default)]
pub struct Fates(Vec<Vec<Fate>>);

impl Fates {
    /// Takes one list of fates (whole, cut or gone, for each face) for each source, by its index (slot).
    pub fn new(by_slot: Vec<Vec<Fate>>) -> Self {
        Self(by_slot)
    }

    /// The fate (whole, cut or gone) of each face of the source with the index `slot`.
    pub fn of(&self, slot: Slot) -> &[Fate] {
        &self.0[slot.index()]
    }

    /// Yields the index (slot) of each source, with the fate (whole, cut or gone) of each of its faces.
    pub fn by_slot(&self) -> impl Iterator<Item = (Slot, &[Fate])> {
        Slot::all().zip(self.0.iter().map(Vec::as_slice))
    }

    /// The number of sources of the solid.
    pub fn sources(&self) -> usize {
        self.0.len()
    }

    /// The number of faces of all sources that some leaf names.
    pub fn faces(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }
}

impl Index<SourceFace> for Fates {
    type Output = Fate;

    fn index(&self, face: SourceFace) -> &Fate {
        &self.0[face.slot.index()][face.id.index()]
    }
}

impl IndexMut<SourceFace> for Fates {
    fn index_mut(&mut self, face: SourceFace) -> &mut Fate {
        &mut self.0[face.slot.index()][face.id.index()]
    }
}

/// The fate (whole, cut or gone) of each source face, by the index (slot) of the source, as a byte that
/// several threads may set.
struct AtomicFates(Vec<Vec<AtomicU8>>);

const GONE: u8 = 0;
const WHOLE: u8 = 1;
const TURNED: u8 = 2;
const CUT: u8 = 3;

impl AtomicFates {
    fn of(leaves: &[Leaf], sources: &Sources) -> Self {
        let mut fates: Vec<Vec<AtomicU8>> = Vec::new();
        fates.resize_with(sources.table().len(), Vec::new);
        let mut enter = |source: &Source, slot: Slot| {
            let fates = &mut fates[slot.index()];
            if fates.is_empty() {
                fates.resize_with(source.face_count(), || AtomicU8::new(GONE));
            }
        };
        for leaf in leaves {
            poll();
            for group in &leaf.content.groups {
                enter(&group.source, sources.slot(&group.source));
            }
            for element in &leaf.content.parts {
                enter(&element.part.source, sources.slot(&element.part.source));
            }
        }
        Self(fates)
    }

    fn into_plain(self) -> Fates {
        let plain = |mark: AtomicU8| match mark.into_inner() {
            GONE => Fate::Gone,
            WHOLE => Fate::Whole(Orientation::Same),
            TURNED => Fate::Whole(Orientation::Opposite),
            _ => Fate::Cut,
        };
        let slots = self.0.into_iter();
        Fates(slots.map(|s| s.into_iter().map(plain).collect()).collect())
    }
}

impl<'a> Leaf<'a> {
    fn visit(&self, sources: &Sources, fates: &AtomicFates) -> Found<'a> {
        let mut found = Found::default();
        for group in &self.content.groups {
            let slot = sources.slot(&group.source);
            if group.touching {
                let faces = group.faces.iter();
                found.near.extend(faces.map(|f| SourceFace::new(slot, *f)));
            }
            self.visit_group(group, slot, &fates.0[slot.index()], &mut found);
        }
        for element in &self.content.parts {
            let part = &*element.part;
            let face = SourceFace::new(sources.slot(&part.source), part.face);
            found.parts.push(Listing {
                face: face.oriented(element.orientation.turned_if(self.complement)),
                leaf: self.number,
                part,
            });
        }
        found
    }

    fn visit_group(
        &self,
        group: &FaceGroup,
        slot: Slot,
        fates: &[AtomicU8],
        found: &mut Found<'a>,
    ) {
        let orientation = group.orientation.turned_if(self.complement);
        let mark = match orientation {
            Orientation::Same => WHOLE,
            Orientation::Opposite => TURNED,
        };
        let mesh = group.source.mesh();
        let holds_all =
            mesh.is_some() && group.source.cell().is_some_and(|c| self.cell.contains(&c));
        let holds = mesh.map(|mesh| holder(mesh, &self.cell));
        for &face in &group.faces {
            if holds_all || holds.as_ref().is_some_and(|holds| holds(face)) {
                fates[face.index()].store(mark, Ordering::Relaxed);
            } else {
                found.spanning.push(Spanning {
                    face: SourceFace::new(slot, face).oriented(orientation),
                    leaf: self.number,
                });
            }
        }
    }
}

/// Returns a test that is true for a face whose three corners lie in a cell.
fn holder<'a>(mesh: &'a TriangleMesh, cell: &Cell) -> impl Fn(FaceId) -> bool + 'a {
    let (low, high) = (*cell.low(), cell.high());
    move |face| {
        mesh.vertices_of(face).iter().all(|v| {
            let p = &mesh.vertices[v.index()];
            (0..3).all(|i| low[i] <= p[i] && p[i] <= high[i])
        })
    }
}

/// Returns the edges around the intersection of a part of a face with a leaf's cell.
fn part_edges(part: &Part, cell: &Cell) -> Vec<OutlineEdge> {
    if part.home == *cell {
        return part.outline();
    }
    let clipped = part.pieces().into_iter().filter_map(|p| p.clipped(cell));
    cancel(
        clipped
            .flat_map(|p| OutlineEdge::edges_of(&p).collect::<Vec<_>>())
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::side::Half;

    #[test]
    fn cells_that_make_up_a_box_fill_it() {
        let whole = Cell::around(&[0; 3], &[7; 3]);
        let cut = whole.cut().expect("more than one point");
        let halves = Half::BOTH.map(|half| whole.half(cut, half));
        let fills = |leaves: &[u32]| fill(([1; 3], [6; 3]), leaves.iter().copied(), &halves);
        assert!(fills(&[0, 1]));
        assert!(!fills(&[0]) && !fills(&[1]));
    }
}
