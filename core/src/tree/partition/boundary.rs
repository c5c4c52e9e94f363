//! The boundary of a tree's set: the parts of sub-hyperplanes with In on one side and Out on the other.

use super::node::{Cut, Facet, Label, PartitionTree};
use crate::error::{Error, Result};
use crate::geometry::side::{Half, Orientation, Split};
use crate::geometry::spaces::space::{overlay, Space};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// The boundary of a tree's set as convex pieces, with In on their minus sides.
///
/// The border of the frame is left out.
///
/// # Order
/// By node in preorder, the minus subtree before the plus subtree.
///
/// # Errors
/// `Internal` if a cut lies in the border of its own region.
pub fn boundary<S: Space>(tree: &PartitionTree<S>) -> Result<Vec<S::Fragment>> {
    let mut pieces = Vec::new();
    for_each_cut(tree, |cut| {
        pieces.extend(walls(cut, cut.sub_hyperplane().span.clone())?);
        Ok(())
    })?;
    Ok(pieces)
}

/// The boundary of a tree's set as convex pieces, each with the inner node in whose cut it lies, by its index
/// among the inner nodes in preorder.
///
/// # Order
/// By the index of the inner node.
///
/// # Errors
/// `Internal` if a cut lies in the border of its own region.
pub fn boundary_of<S: Space>(tree: &PartitionTree<S>) -> Result<Vec<(NodeId, S::Fragment)>> {
    let mut pieces = Vec::new();
    let mut nodes = NodeId::all();
    for_each_cut(tree, |cut| {
        let found = walls(cut, cut.sub_hyperplane().span.clone())?;
        let node = nodes.next().unwrap_or_default();
        pieces.extend(found.into_iter().map(|piece| (node, piece)));
        Ok(())
    })?;
    Ok(pieces)
}

/// The boundary of a tree's set as parts of the facets in its coplanar sets, each with its source number.
///
/// Where facets overlap, only the facet with the smallest source number counts. Boundary without facets, such
/// as the boundary of a half-space, is left out.
///
/// # Order
/// By node in preorder, the minus subtree before the plus subtree; within a node by source number.
///
/// # Errors
/// `Internal` if a cut lies in the border of its own region.
pub fn owned_boundary<S: Space>(tree: &PartitionTree<S>) -> Result<Vec<Facet<S>>> {
    let mut pieces = Vec::new();
    for_each_cut(tree, |cut| {
        for Facet { fragment, source } in disjoint_facets(&cut.sub_hyperplane().facets) {
            poll();
            let facet = |fragment| Facet { fragment, source };
            pieces.extend(walls(cut, fragment)?.into_iter().map(facet));
        }
        Ok(())
    })?;
    Ok(pieces)
}

/// Calls `visit` for each inner node in preorder: before its subtrees, minus subtree first.
pub fn for_each_cut<S: Space>(
    tree: &PartitionTree<S>,
    mut visit: impl FnMut(&Cut<S>) -> Result<()>,
) -> Result<()> {
    let mut pending = vec![tree.clone()];
    while let Some(next) = pending.pop() {
        poll();
        if let PartitionTree::Cut(cut) = next {
            visit(&cut)?;
            pending.extend([cut.child(Half::Plus), cut.child(Half::Minus)]);
        }
    }
    Ok(())
}

/// Coplanar facets without the parts that facets of smaller source numbers cover, sorted by source number.
fn disjoint_facets<S: Space>(facets: &[Facet<S>]) -> Vec<Facet<S>> {
    let mut order: Vec<&Facet<S>> = facets.iter().collect();
    order.sort_by_key(|facet| facet.source);
    let mut owned = Vec::new();
    for (i, facet) in order.iter().enumerate() {
        poll();
        let masks = order[..i].iter().map(|mask| &mask.fragment);
        let visible = uncovered::<S>(facet.fragment.clone(), masks);
        owned.extend(visible.into_iter().map(|fragment| Facet {
            fragment,
            source: facet.source,
        }));
    }
    owned
}

/// The parts of a fragment that none of the coplanar masks covers.
fn uncovered<'a, S: Space>(
    piece: S::Fragment,
    masks: impl Iterator<Item = &'a S::Fragment>,
) -> Vec<S::Fragment> {
    masks.fold(vec![piece], |rest, mask| {
        let outside = |part| overlay::<S>(part, mask).1;
        rest.into_iter().flat_map(outside).collect()
    })
}

/// The parts of a fragment in a node's cut with In on one side and Out on the other, oriented with In on
/// their minus sides.
fn walls<S: Space>(cut: &Cut<S>, piece: S::Fragment) -> Result<Vec<S::Fragment>> {
    let mut walls = Vec::new();
    for (part, minus) in cut.child(Half::Minus).labels_beside(piece)? {
        for (part, plus) in cut.child(Half::Plus).labels_beside(part)? {
            if minus != plus {
                walls.push(with_inside_below::<S>(part, cut.hyperplane(), minus));
            }
        }
    }
    Ok(walls)
}

/// A part of the boundary in a cut, oriented with In on its minus side; `minus` is the label on the cut's
/// minus side.
fn with_inside_below<S: Space>(
    part: S::Fragment,
    cut: &S::Hyperplane,
    minus: Label,
) -> S::Fragment {
    let as_cut = S::coincide(S::hyperplane(&part), cut) == Some(Orientation::Same);
    if as_cut == (minus == Label::In) {
        part
    } else {
        S::reversed(&part)
    }
}

impl<S: Space> PartitionTree<S> {
    /// The parts of a fragment in the border of the tree's region, each with the label of the leaf next to
    /// it.
    ///
    /// # Errors
    /// `Internal` if the fragment lies in a cut: no cut lies in the border of its region.
    pub fn labels_beside(&self, piece: S::Fragment) -> Result<Vec<(S::Fragment, Label)>> {
        let mut found = Vec::new();
        let mut pending = vec![(self.clone(), piece)];
        while let Some((tree, piece)) = pending.pop() {
            poll();
            let cut = match tree {
                PartitionTree::Leaf(label) => {
                    found.push((piece, label));
                    continue;
                }
                PartitionTree::Cut(cut) => cut,
            };
            match S::split(&piece, cut.hyperplane()) {
                Split::Minus => pending.push((cut.child(Half::Minus), piece)),
                Split::Plus => pending.push((cut.child(Half::Plus), piece)),
                Split::Both { minus, plus } => {
                    pending.push((cut.child(Half::Plus), plus));
                    pending.push((cut.child(Half::Minus), minus));
                }
                Split::Coplanar(_) => {
                    return Err(Error::internal("a cut lies in its region's border"))
                }
            }
        }
        Ok(found)
    }
}
