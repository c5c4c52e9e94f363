//! Fragments: the parts of an operand's faces in a cell.

use crate::geometry::polygon::Polygon;
use crate::mesh::handle::SourceFace;

/// A fragment of an operand's boundary in a cell.
#[derive(Clone, Debug)]
pub struct Fragment {
    /// The fragment.
    pub polygon: Polygon,
    /// The jump of the winding number from the support's plus to its minus side.
    pub weight: i32,
    /// The face.
    pub face: SourceFace,
    /// Whether the fragment is all of a whole face inside the cell.
    pub intact: bool,
}
