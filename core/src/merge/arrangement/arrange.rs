//! Evaluates an arrangement, and compares the faces of an operand with each other once it turns out to overlap
//! itself where it matters.

use super::contacts::Contacts;
use super::own_pairs::{irregular, own_pairs};
use super::scene::Scene;
use crate::merge::profile::{Declined, Profile};
use crate::tree::node::{Branch, Node};

/// Returns the leaf of all faces and parts of faces that bound the result, given the contacts of faces of
/// different operands. `may_overlap` says of an operand whether it may overlap itself.
///
/// # Errors
/// The reason why the arrangement does not determine the result.
pub(super) fn arrange(
    scene: &mut Scene,
    found: &mut Contacts,
    may_overlap: impl Fn(usize) -> bool,
    profile: &mut Profile,
) -> Result<Branch, Declined> {
    loop {
        match profile.timed("faces", || scene.root(found), leaf_len) {
            Err(Declined::Overlap(k)) if may_overlap(k) && !scene.kept.is_resolved(k) => {
                let count = |found: &Result<usize, Declined>| found.unwrap_or(0);
                profile.timed("own pairs", || scene.resolve(k, found), count)?;
            }
            root => return root,
        }
    }
}

impl Scene<'_> {
    /// Compares the faces of an operand with each other, and returns the number of pairs that may overlap.
    ///
    /// # Errors
    /// `Overlap` if there are too many pairs.
    pub(super) fn resolve(&mut self, k: usize, found: &mut Contacts) -> Result<usize, Declined> {
        let operand = self.facets.operands[k];
        let pairs = own_pairs(&operand).ok_or(Declined::Overlap(k))?;
        let irregular = irregular(operand.source);
        found.add_own(&self.facets, k, (pairs, &irregular), self.work_size);
        self.near[k] = operand.mesh.face_ids().collect();
        self.kept.resolve(k);
        Ok(pairs.len())
    }
}

/// Returns the number of elements (whole faces and parts) if the root is a deferred leaf; otherwise 0.
fn leaf_len(root: &Result<Branch, Declined>) -> usize {
    match root.as_ref().map(|branch| &*branch.node) {
        Ok(Node::Deferred(leaf)) => leaf.len(),
        _ => 0,
    }
}
