//! A set of the plane, as a boundary or a tree; computes each from the other on demand.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Arc;

use once_cell::sync::OnceCell;

use super::boundary::Boundary;
use crate::error::Result;
use crate::geometry::spaces::dim2::Dim2;
use crate::tree::partition::{enclosed, is_bounded, stats, Facet, Label, PartitionTree, Plan};

/// An immutable set of points of the plane, stored as its boundary or as a tree.
///
/// # Example
/// ```
/// use bspcsg::tree::partition::PartitionTree;
/// use bspcsg::tree::plane::PlaneSet;
///
/// let everything = PlaneSet::from(PartitionTree::FULL);
/// assert!(everything.boundary()?.edges.is_empty());
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PlaneSet {
    form: Form,
    size: usize,
    /// The work of the operations that made this set.
    pub spent: WorkSinceRebuild,
    /// The number of requests to locate fewer points than the set has edges that were answered by sweeps over
    /// all edges.
    queried_points: Arc<AtomicUsize>,
}

/// The number of sweeps over n edges that cost about as much as building a tree of these edges: 16 µs against
/// half a microsecond for each edge.
pub const SWEEPS_PER_TREE: usize = 32;

/// The work of the operations that made a set, since its tree was last rebuilt.
#[derive(Clone, Copy, Debug, Default)]
pub struct WorkSinceRebuild {
    /// The number of edges of larger operands that sweeps visited to combine them with smaller operands.
    pub swept: usize,
    /// The number of nodes of the tree with which merging started; 0 without merging.
    pub built: usize,
}

/// The form from which a set was made, boundary or tree, and the other form once it is computed.
#[derive(Clone, Debug)]
enum Form {
    Boundary(Arc<Boundary>, OnceCell<PartitionTree<Dim2>>),
    Tree(PartitionTree<Dim2>, OnceCell<Arc<Boundary>>),
}

impl From<PartitionTree<Dim2>> for PlaneSet {
    fn from(tree: PartitionTree<Dim2>) -> Self {
        let size = stats(&tree).cuts;
        Self::of(Form::Tree(tree, OnceCell::new()), size)
    }
}

impl From<Boundary> for PlaneSet {
    fn from(boundary: Boundary) -> Self {
        let size = boundary.edges.len();
        Self::of(Form::Boundary(Arc::new(boundary), OnceCell::new()), size)
    }
}

impl PlaneSet {
    fn of(form: Form, size: usize) -> Self {
        Self {
            form,
            size,
            spent: WorkSinceRebuild::default(),
            queried_points: Arc::default(),
        }
    }

    /// The boundary of the set, computed on first use if the set was made from a tree.
    ///
    /// # Errors
    /// `Internal` for a broken tree.
    pub fn boundary(&self) -> Result<&Arc<Boundary>> {
        match &self.form {
            Form::Boundary(boundary, _) => Ok(boundary),
            Form::Tree(tree, made) => made.get_or_try_init(|| Boundary::of(tree).map(Arc::new)),
        }
    }

    /// The boundary if it is closed, so that the set or its complement is bounded; else `None`.
    ///
    /// # Errors
    /// `Internal` for a broken tree.
    pub fn closed(&self) -> Result<Option<&Boundary>> {
        let boundary = self.boundary()?;
        Ok(boundary.is_closed().then_some(boundary))
    }

    /// The tree of the set: the tree from which it was made, or a balanced tree of the boundary's edges.
    ///
    /// # Errors
    /// `Internal` for a defect.
    pub fn tree(&self) -> Result<&PartitionTree<Dim2>> {
        match &self.form {
            Form::Boundary(boundary, made) => made.get_or_try_init(|| tree_of(boundary)),
            Form::Tree(tree, _) => Ok(tree),
        }
    }

    /// The boundary, if the set was made from it and it is closed; else `None`.
    pub fn own_boundary(&self) -> Option<&Boundary> {
        match &self.form {
            Form::Boundary(boundary, _) if boundary.is_closed() => Some(boundary),
            _ => None,
        }
    }

    /// Return whether to locate this number of points by the tree: true if the tree exists, or if there are
    /// fewer points than edges and at least `SWEEPS_PER_TREE` such requests came before. Counts the request.
    pub fn should_build_tree(&self, points: usize) -> bool {
        if self.known_tree().is_some() {
            return true;
        }
        let few = points < self.size;
        few && self.queried_points.fetch_add(1, Ordering::Relaxed) >= SWEEPS_PER_TREE
    }

    /// The tree if it is already computed, else `None`.
    pub fn known_tree(&self) -> Option<&PartitionTree<Dim2>> {
        match &self.form {
            Form::Boundary(_, made) => made.get(),
            Form::Tree(tree, _) => Some(tree),
        }
    }

    /// The number of edges, or of inner nodes if the set was made from a tree.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Return the label of all points if the set is known to be empty or the whole plane, else `None`.
    pub fn label(&self) -> Option<Label> {
        match &self.form {
            Form::Boundary(boundary, _) => boundary.edges.is_empty().then_some(boundary.outer),
            Form::Tree(tree, _) => tree.label(),
        }
    }

    /// Return whether the set is bounded.
    pub fn is_bounded(&self) -> bool {
        match &self.form {
            Form::Boundary(boundary, _) => boundary.outer == Label::Out && boundary.is_closed(),
            Form::Tree(tree, _) => is_bounded(tree),
        }
    }

    /// The complement of the set in the plane.
    #[must_use]
    pub fn complement(&self) -> Self {
        match &self.form {
            Form::Boundary(boundary, made) => {
                let tree = made.get().map(PartitionTree::complement);
                let tree = tree.map_or_else(OnceCell::new, OnceCell::with_value);
                self.with(Form::Boundary(Arc::new(boundary.complement()), tree))
            }
            Form::Tree(tree, _) => self.with(Form::Tree(tree.complement(), OnceCell::new())),
        }
    }

    fn with(&self, form: Form) -> Self {
        Self {
            form,
            queried_points: Arc::default(),
            ..*self
        }
    }
}

/// A balanced tree of the set with this boundary.
pub fn tree_of(boundary: &Boundary) -> Result<PartitionTree<Dim2>> {
    let base = i32::from(boundary.outer == Label::In);
    let segments = boundary.edges.iter().map(|edge| boundary.segment(edge));
    let facets = (0..).zip(segments);
    let facets = facets.map(|(source, fragment)| Facet { fragment, source });
    enclosed(facets.collect(), base, |number| number > 0, &Plan::BALANCED)
}
