//! Fragments: what a cell cuts out of an operand's faces.

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
    /// True if the fragment is all of a whole face inside the cell.
    pub intact: bool,
}
