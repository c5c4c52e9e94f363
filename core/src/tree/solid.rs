//! Solids: sets of points in space, as a partition tree and the sources whose faces it lists.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use super::node::{Branch, DeferredLeaf, FaceGroup, Node};
use super::table::SourceTable;
use crate::geometry::cell::Cell;
use crate::geometry::side::{Half, Orientation};
use crate::mesh::cached::Cached;
use crate::mesh::grid::Pitch;
use crate::mesh::source::{Shape, Source};

/// The number of sources by which a table may exceed twice the number that the tree uses, so that operands of
/// short expressions stay in the table.
const SPARE_SOURCES: usize = 64;

/// A set of points of space as a partition tree; immutable, and clones share all data.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::node::Node;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let solid = Solid::of_source(Arc::new(import(&vertices, &faces, None)?), false);
/// // Nothing is divided yet: one leaf lists all faces.
/// let Node::Deferred(leaf) = &*solid.root().node else {
///     panic!("a mesh is one deferred leaf");
/// };
/// assert_eq!(leaf.len(), 4);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solid {
    root: Branch,
    pitch: Pitch,
    sources: SourceTable,
    /// The number of sources that the tree used when they were last counted.
    used_sources: usize,
    reduced: bool,
    /// True if stored data, which may be forged, say that the solid or an operand is reduced.
    reduced_by_claim: bool,
    /// Solids of unchecked meshes: this solid is reduced if all these solids are. `None` if they are not
    /// known.
    unchecked_meshes: Option<Arc<[Solid]>>,
    simple: Arc<Cached<bool>>,
    united: Arc<Cached<Solid>>,
    /// The number of faces and parts in all cells that kernels solved to make the solid.
    effort: u64,
}

impl Solid {
    /// A solid from its tree and its sources; `reduced` is true if the listed faces and parts are its reduced
    /// boundary.
    pub fn new(root: Branch, pitch: Pitch, sources: SourceTable, reduced: bool) -> Self {
        let used_sources = sources.len();
        Self {
            root,
            pitch,
            sources,
            used_sources,
            reduced,
            reduced_by_claim: false,
            unchecked_meshes: None,
            simple: Arc::default(),
            united: Arc::default(),
            effort: 0,
        }
    }

    /// The same solid, with the number of faces and parts in all cells that kernels solved to make it.
    #[must_use]
    pub fn with_effort(self, effort: u64) -> Self {
        Self { effort, ..self }
    }

    /// The number of faces and parts in all cells that kernels solved to make the solid: in a chain of
    /// operations, the next step takes about as long as the last one.
    pub fn effort(&self) -> u64 {
        self.effort
    }

    /// The same solid, noted as reduced only by the word of stored data, which may be forged.
    #[must_use]
    pub fn marked_as_claimed(mut self) -> Self {
        self.reduced_by_claim = self.reduced;
        self
    }

    /// Return whether the solid is known to be reduced only from stored data.
    pub fn is_reduced_by_claim(&self) -> bool {
        self.reduced_by_claim
    }

    /// The same solid as the result of operations on these operands: reduced if all operands are.
    ///
    /// If that is not known yet, the solid stores the meshes that decide it, unless they are too many.
    #[must_use]
    pub fn resulting_from(mut self, operands: &[Self]) -> Self {
        let open: Vec<&Self> = operands.iter().filter(|o| !o.is_reduced()).collect();
        self.reduced = open.is_empty();
        self.reduced_by_claim = self.reduced && operands.iter().any(|o| o.reduced_by_claim);
        if !self.reduced && open.iter().all(|o| o.is_settled_by_meshes()) {
            let unchecked_meshes = open.iter().flat_map(|o| {
                o.unchecked_meshes
                    .as_deref()
                    .unwrap_or(std::slice::from_ref(*o))
            });
            let unchecked_meshes: Vec<Self> = unchecked_meshes
                .filter(|d| !d.is_reduced())
                .take(SPARE_SOURCES + 1)
                .cloned()
                .collect();
            self.unchecked_meshes =
                (unchecked_meshes.len() <= SPARE_SOURCES).then(|| unchecked_meshes.into());
        }
        self
    }

    /// The meshes that decide whether the solid is reduced: the solid is reduced if all these meshes are.
    /// `None` if the meshes are not known.
    pub fn unchecked_meshes(&self) -> Option<&[Self]> {
        self.unchecked_meshes.as_deref()
    }

    /// Return whether it is known which meshes decide if the solid is reduced.
    fn is_settled_by_meshes(&self) -> bool {
        self.unchecked_meshes.is_some() || self.whole_mesh().is_some()
    }

    /// The same solid with another tree over other sources that are equal to its own.
    pub(super) fn of_others(&self, root: Branch, sources: SourceTable) -> Self {
        Self {
            root,
            sources,
            simple: self.simple.clone(),
            united: Arc::default(),
            ..self.clone()
        }
    }

    /// The mesh, if the solid is an unchanged mesh; else `None`.
    pub fn whole_mesh(&self) -> Option<&Arc<Source>> {
        let Node::Deferred(leaf) = &*self.root.node else {
            return None;
        };
        let [group] = leaf.groups.as_slice() else {
            return None;
        };
        let whole = leaf.parts.is_empty()
            && leaf.corner == 0
            && group.orientation == Orientation::Same
            && group.faces.len() == group.source.face_count();
        (whole && group.source.mesh().is_some()).then_some(&group.source)
    }

    /// The same solid, given that no operand from which it was made used more than `used_sources` sources.
    ///
    /// Once the table has far more sources, drops those that the tree does not use; the others remain in
    /// order. So chains of operations do not collect the sources that they cut away, and counting costs
    /// little per operation.
    #[must_use]
    pub fn without_unused_sources(mut self, used_sources: usize) -> Self {
        self.used_sources = used_sources;
        if self.sources.len() > 2 * used_sources + SPARE_SOURCES {
            let ids = self.source_ids();
            let kept = |s: &&Arc<Source>| ids.contains(&s.id());
            self.sources = self.sources.iter().filter(kept).collect();
            self.used_sources = self.sources.len();
        }
        self
    }

    /// The ids of the sources whose faces the tree lists; no other source bounds the solid.
    pub fn source_ids(&self) -> HashSet<u64> {
        source_ids(&self.root)
    }

    /// Return the number of sources that the tree used when they were last counted.
    pub fn used_sources(&self) -> usize {
        self.used_sources
    }

    /// The empty set, or all of space if `inside`.
    pub fn uniform(pitch: Pitch, inside: bool) -> Self {
        let cell = Cell::around(&[0; 3], &[0; 3]);
        let root = Branch::uniform(cell, i32::from(inside));
        Self::new(root, pitch, SourceTable::default(), true)
    }

    /// The solid that a source bounds, with all its faces in one deferred leaf; `trusted` says that a mesh is
    /// reduced.
    pub fn of_source(source: Arc<Source>, trusted: bool) -> Self {
        let pitch = source.pitch();
        let Some(cell) = source.cell() else {
            return Self::uniform(pitch, false);
        };
        let (corner, reduced) = match source.shape() {
            Shape::Mesh(_) => (0, trusted),
            Shape::HalfSpace(plane) => {
                let inside = plane.side_of_corner(&cell.corner()) == Half::Minus;
                (i32::from(inside), true)
            }
        };
        let sources = [&source].into_iter().collect();
        let faces = source.face_ids().collect();
        let group = FaceGroup {
            touching: false,
            source,
            orientation: Orientation::Same,
            faces,
        };
        let leaf = DeferredLeaf {
            groups: vec![group],
            corner,
            ..DeferredLeaf::default()
        };
        let node = Arc::new(Node::Deferred(leaf));
        let root = Branch {
            cell,
            outside: corner,
            complement: false,
            node,
        };
        Self::new(root, pitch, sources, reduced)
    }

    /// The root of the tree.
    pub fn root(&self) -> &Branch {
        &self.root
    }

    /// The lattice step of all sources.
    pub fn pitch(&self) -> Pitch {
        self.pitch
    }

    /// The sources of the solid, in the order of the expression.
    pub fn sources(&self) -> &SourceTable {
        &self.sources
    }

    /// Return whether the solid is known to be reduced: its faces and parts list each wall between inside and
    /// outside once, and nothing else.
    pub fn is_reduced(&self) -> bool {
        self.reduced || self.simple.get() == Some(&true)
    }

    /// The same solid, noted as reduced or not, with empty caches.
    #[must_use]
    pub fn with_reduced(mut self, reduced: bool) -> Self {
        self.reduced = reduced;
        self.reduced_by_claim = false;
        self.unchecked_meshes = None;
        // The caches of the old solid do not apply: this one is unchecked.
        self.simple = Arc::default();
        self.united = Arc::default();
        self
    }

    /// The cached answer whether the solid is reduced (each wall between inside and outside is listed once,
    /// and nothing else); empty until checked, shared by clones.
    pub fn simple(&self) -> &Cached<bool> {
        &self.simple
    }

    /// Whether the solid is reduced, if this is known; else `None`.
    pub fn known_simple(&self) -> Option<bool> {
        let known = || self.is_reduced().then_some(true);
        self.simple.get().copied().or_else(known)
    }

    /// The union of the solid with itself, for solids that overlap themselves, once it is computed; shared by
    /// clones.
    pub fn united(&self) -> &Cached<Self> {
        &self.united
    }
}

fn source_ids(root: &Branch) -> HashSet<u64> {
    let mut ids = HashSet::default();
    let mut open = vec![root];
    while let Some(branch) = open.pop() {
        match &*branch.node {
            Node::Leaf(_) => {}
            Node::Deferred(leaf) => {
                ids.extend(leaf.groups.iter().map(|g| g.source.id()));
                ids.extend(leaf.parts.iter().map(|p| p.part.source.id()));
            }
            Node::Cut(halves) => open.extend(&halves.children),
        }
    }
    ids
}
