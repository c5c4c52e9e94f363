//! Patches: sets of faces, such that only coplanar faces of one patch may be joined to a polygon; and the
//! edges at which such polygons are divided.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use super::chords::EdgeContact;
use crate::geometry::line::LineKey;
use crate::merge::lists::list::Sources;
use crate::mesh::handle::{OrientedFace, SourceFace};
use crate::mesh::source::Source;

/// The patch number of each face, by the slot of its source and its number in the input.
///
/// Faces of different patches are never joined, so that a triangle does not lie in faces whose data differ.
/// Without patches all faces in a plane are joined.
///
/// # Example
/// ```
/// use bspcsg::extract::joining::patches::Patches;
/// use bspcsg::mesh::handle::{FaceId, Slot, SourceFace};
/// use bspcsg::mesh::import::import;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let source = import(&vertices, &faces, None)?;
/// // The last face is red, the others are white; of a second source nothing is said.
/// let patches = Patches::new(vec![Some(vec![0, 0, 0, 1]), None]);
/// let patch = |slot, id| patches.of(SourceFace::new(Slot(slot), FaceId(id)), &source);
/// assert_eq!([patch(0, 2), patch(0, 3)], [0, 1]);
/// assert_eq!(patch(1, 2), patch(1, 3));
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Patches {
    by_slot: Arc<[Option<Vec<u32>>]>,
    contacts: Vec<EdgeContact>,
}

/// The patch number of all faces of sources without patches.
const COMMON: u32 = u32::MAX;

impl Patches {
    /// Takes for each source the patch number of each of its faces; `None` for a source without patches.
    pub fn new(patches: Vec<Option<Vec<u32>>>) -> Self {
        Self {
            by_slot: patches.into(),
            contacts: Vec::new(),
        }
    }

    /// Returns the same patches, but each polygon will also be divided at the edges of `contacts` inside it;
    /// `None` if the polygons are already divided at all of them.
    pub fn divided(&self, contacts: &[EdgeContact], sources: &Sources) -> Option<Self> {
        let known = self.contacts.iter().map(|c| c.place(sources));
        let known: HashSet<(OrientedFace, LineKey)> = known.collect();
        let is_new = |contact: &&EdgeContact| !known.contains(&contact.place(sources));
        let new: Vec<EdgeContact> = contacts.iter().filter(is_new).cloned().collect();
        (!new.is_empty()).then(|| Self {
            by_slot: Arc::clone(&self.by_slot),
            contacts: [&self.contacts[..], &new].concat(),
        })
    }

    /// The edges inside polygons at which these polygons are divided.
    pub fn contacts(&self) -> &[EdgeContact] {
        &self.contacts
    }

    /// Returns the patch number of a face.
    pub fn of(&self, face: SourceFace, source: &Source) -> u32 {
        let own = self.by_slot.get(face.slot.index()).and_then(Option::as_ref);
        let found = own.and_then(|own| own.get(source.number(face.id) as usize));
        found.copied().unwrap_or(COMMON)
    }
}
