//! Handles: indices of sources, faces, vertices and nodes, each as a type of its own.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::arith::convert::as_number;
use crate::geometry::side::Orientation;

/// The index of a source in the table of a solid or an evaluation.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct Slot(pub u32);

impl Slot {
    /// All slots (indices in a table of sources) in order, from 0 on.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The slot for an index in a table of sources.
    ///
    /// # Panics
    /// Never for tables: none has 2³² sources.
    pub fn of(index: usize) -> Self {
        Self(u32::try_from(index).expect("a table of less than 2^32 sources"))
    }

    /// The index in a table of sources.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The number of a face in its source.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct FaceId(pub u32);

impl FaceId {
    /// The only face of a half-space.
    pub const ONLY: Self = Self(0);

    /// All face numbers in order, from 0 on.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The index in a list of all faces.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The half-edges of a triangle: number 3 f + i runs from corner i of face f to the next corner.
    pub fn half_edges(self) -> std::ops::Range<u32> {
        3 * self.0..3 * self.0 + 3
    }

    /// The triangle that a half-edge bounds.
    pub fn of_half_edge(half_edge: u32) -> Self {
        Self(half_edge / 3)
    }
}

/// The number of a vertex in its mesh.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[repr(transparent)]
pub struct VertexId(pub u32);

impl VertexId {
    /// All vertex numbers in order, from 0 on.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The vertex at this index of a list.
    #[inline]
    pub fn of(index: usize) -> Self {
        Self(as_number(index))
    }

    /// Triangles or other rows of plain integers, as rows of vertex numbers.
    pub fn rows<const N: usize>(rows: impl IntoIterator<Item = [u32; N]>) -> Vec<[Self; N]> {
        rows.into_iter().map(|row| row.map(Self)).collect()
    }

    /// The index in a list of all vertices.
    #[inline]
    pub fn index(self) -> usize {
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

/// The index of a node in the list that stores its tree.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[repr(transparent)]
pub struct NodeId(pub u32);

impl NodeId {
    /// The root, in lists that begin with the root.
    pub const ROOT: Self = Self(0);

    /// All node numbers in order, from 0 on.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..).map(Self)
    }

    /// The node at this index of a list.
    ///
    /// # Panics
    /// Never for lists of nodes: 2³² nodes would fill a hundred gigabytes.
    #[inline]
    pub fn of(index: usize) -> Self {
        Self(u32::try_from(index).expect("a tree of less than 2^32 nodes"))
    }

    /// The index in the list of nodes.
    #[inline]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl From<NodeId> for i64 {
    fn from(node: NodeId) -> Self {
        Self::from(node.0)
    }
}

/// A face of one of several sources, by the slot (index in a table of sources) of the source and the number
/// of the face in the source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceFace {
    /// The slot of the source: its index in a table of sources.
    pub slot: Slot,
    /// The number of the face in the source.
    pub id: FaceId,
}

impl SourceFace {
    /// The face with the number `id` in the source at `slot`.
    pub fn new(slot: Slot, id: FaceId) -> Self {
        Self { slot, id }
    }

    /// The face, together with this orientation relative to its source.
    pub fn oriented(self, orientation: Orientation) -> OrientedFace {
        OrientedFace {
            face: self,
            orientation,
        }
    }
}

/// A face of one of several sources, in the source's orientation or turned around.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OrientedFace {
    /// The face without its orientation.
    pub face: SourceFace,
    /// `Same` if the face is oriented as in its source, else `Opposite`.
    pub orientation: Orientation,
}

impl OrientedFace {
    /// The slot of the face's source: the index in a table of sources.
    pub fn slot(self) -> Slot {
        self.face.slot
    }

    /// The number of the face in its source.
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
            .all(|f| f.half_edges().all(|h| FaceId::of_half_edge(h) == *f)));
    }

    #[test]
    fn faces_are_ordered_by_source_first() {
        let face = |slot, id| SourceFace::new(Slot(slot), FaceId(id));
        assert!(face(0, 9) < face(1, 0));
        assert!(face(1, 0) < face(1, 1));
    }
}
