//! Patches: the faces of one plane that may become one polygon, and where it is divided.

use super::chords::EdgeContact;
use crate::mesh::handle::SourceFace;
use crate::mesh::source::Source;

/// The patch of each face, by its source's slot and its number in the input.
///
/// Faces of different patches are never joined, so that each triangle lies in one of the faces
/// whose data differ. Without patches all faces in a plane are joined.
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
    by_slot: Vec<Option<Vec<u32>>>,
    contacts: Vec<EdgeContact>,
}

/// The patch of faces of sources without patches.
const COMMON: u32 = u32::MAX;

impl Patches {
    /// The patches of the faces of each source; `None` for a source without patches.
    pub fn new(patches: Vec<Option<Vec<u32>>>) -> Self {
        Self {
            by_slot: patches,
            contacts: Vec::new(),
        }
    }

    /// The same patches, with each polygon divided at the edges in the middle of it.
    #[must_use]
    pub fn divided(&self, contacts: &[EdgeContact]) -> Self {
        Self {
            by_slot: self.by_slot.clone(),
            contacts: contacts.to_vec(),
        }
    }

    /// The edges in the middle of polygons, which are divided there.
    pub fn contacts(&self) -> &[EdgeContact] {
        &self.contacts
    }

    /// Return the patch of a face.
    pub fn of(&self, face: SourceFace, source: &Source) -> u32 {
        let own = self.by_slot.get(face.slot.index()).and_then(Option::as_ref);
        let found = own.and_then(|own| own.get(source.number(face.id) as usize));
        found.copied().unwrap_or(COMMON)
    }
}
