//! Fragments: convex pieces of an operand's faces in a cell.

use crate::geometry::polygon::Polygon;
use crate::mesh::handle::SourceFace;

/// A convex piece of an operand's boundary in a cell.
#[derive(Clone, Debug)]
pub struct Fragment {
    /// The polygon of the fragment.
    pub polygon: Polygon,
    /// The winding number on the minus side of the polygon's plane, minus the number on its plus side.
    pub weight: i32,
    /// The face that the fragment is a piece of.
    pub face: SourceFace,
    /// True if the fragment is all of a whole face inside the cell.
    pub intact: bool,
}
