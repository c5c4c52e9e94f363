//! Handles: numbers typed by what they number.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::arith::convert::as_number;
use crate::geometry::side::Orientation;

/// A source by its place in the table of a solid or an evaluation.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct Slot(pub u32);

impl Slot {
    /// The first slot, and all after it.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The slot in this place of a table.
    ///
    /// # Panics
    /// Never for tables: none has 2³² sources.
    pub fn of(place: usize) -> Self {
        Self(u32::try_from(place).expect("a table of less than 2^32 sources"))
    }

    /// The place in a table.
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

/// A face by its number in its source.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct FaceId(pub u32);

impl FaceId {
    /// The only face of a half-space.
    pub const ONLY: Self = Self(0);

    /// The first face, and all after it.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The place in a list of all faces.
    pub fn place(self) -> usize {
        self.0 as usize
    }

    /// The half-edges of a triangle: the first runs from its first corner to its second.
    pub fn half_edges(self) -> std::ops::Range<u32> {
        3 * self.0..3 * self.0 + 3
    }

    /// The triangle that a half-edge bounds.
    pub fn beside(half_edge: u32) -> Self {
        Self(half_edge / 3)
    }
}

/// A vertex by its number in its mesh.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[repr(transparent)]
pub struct VertexId(pub u32);

impl VertexId {
    /// The first vertex, and all after it.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The vertex in this place of a list.
    #[inline]
    pub fn of(place: usize) -> Self {
        Self(as_number(place))
    }

    /// Triangles or other rows of plain numbers, as rows of vertices.
    pub fn rows<const N: usize>(rows: impl IntoIterator<Item = [u32; N]>) -> Vec<[Self; N]> {
        rows.into_iter().map(|row| row.map(Self)).collect()
    }

    /// The place in a list of all vertices.
    #[inline]
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

impl From<VertexId> for i64 {
    fn from(vertex: VertexId) -> Self {
        Self::from(vertex.0)
    }
}

impl From<VertexId> for u64 {
    fn from(vertex: VertexId) -> Self {
        Self::from(vertex.0)
    }
}

impl fmt::Display for VertexId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// A node by its place in the list that holds its tree.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[repr(transparent)]
pub struct NodeId(pub u32);

impl NodeId {
    /// The root, in lists that begin with it.
    pub const ROOT: Self = Self(0);

    /// The first node of a list, and all after it.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The node in this place of a list.
    ///
    /// # Panics
    /// Never for lists of nodes: 2³² of them would fill a hundred gigabytes.
    #[inline]
    pub fn of(place: usize) -> Self {
        Self(u32::try_from(place).expect("a tree of less than 2^32 nodes"))
    }

    /// The place in the list.
    #[inline]
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

impl From<NodeId> for i64 {
    fn from(node: NodeId) -> Self {
        Self::from(node.0)
    }
}

/// A face of one of several sources.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceFace {
    /// The source.
    pub slot: Slot,
    /// The face.
    pub id: FaceId,
}

impl SourceFace {
    /// A face of a source.
    pub fn new(slot: Slot, id: FaceId) -> Self {
        Self { slot, id }
    }

    /// The face with this orientation.
    pub fn oriented(self, orientation: Orientation) -> OrientedFace {
        OrientedFace {
            face: self,
            orientation,
        }
    }
}

/// A face of one of several sources, as the source has it or turned around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OrientedFace {
    /// The face.
    pub face: SourceFace,
    /// The orientation of the face.
    pub orientation: Orientation,
}

impl OrientedFace {
    /// The source.
    pub fn slot(self) -> Slot {
        self.face.slot
    }

    /// The number in the source.
    pub fn id(self) -> FaceId {
        self.face.id
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_edges_know_their_triangle() {
        let faces: Vec<FaceId> = FaceId::all().take(3).collect();
        assert_eq!(faces[2].half_edges().collect::<Vec<_>>(), [6, 7, 8]);
        assert!(faces
            .iter()
            .all(|f| f.half_edges().all(|h| FaceId::beside(h) == *f)));
    }

    #[test]
    fn faces_are_ordered_by_source_first() {
        let face = |slot, id| SourceFace::new(Slot(slot), FaceId(id));
        assert!(face(0, 9) < face(1, 0));
        assert!(face(1, 0) < face(1, 1));
    }
}
