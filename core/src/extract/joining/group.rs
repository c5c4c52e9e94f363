//! Polygons with holes in one plane, and the source faces that make them up.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{BareEdge, Outline};
use crate::geometry::plane::Plane;
use crate::mesh::handle::OrientedFace;

/// The faces of a solid's boundary in one oriented plane that were cut or adjoin cut faces, with their common
/// outline.
#[derive(Debug)]
pub struct PlaneGroup {
    /// The plane, with the inside of the solid on its minus side.
    pub plane: Arc<Plane>,
    /// The faces that lie in the plane, ascending.
    pub faces: SmallVec<[OrientedFace; 2]>,
    /// The outline of all faces together, counterclockwise as seen from outside the solid.
    pub outline: Outline,
}

impl PlaneGroup {
    /// The edges of the polygon's outline.
    pub fn edges(&self) -> &[BareEdge] {
        self.outline.edges()
    }

    /// The keys of the lines that contain the edges, in the order of the edges.
    pub fn lines(&mut self) -> &[LineKey] {
        self.outline.lines(&PlaneResidues::of(&self.plane))
    }
}
