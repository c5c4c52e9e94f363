//! Polygons with holes in one plane, and the faces that make them up.

use std::sync::Arc;

use smallvec::SmallVec;

use crate::geometry::line::{LineKey, PlaneResidues};
use crate::geometry::outline::{BareEdge, Outline};
use crate::geometry::plane::Plane;
use crate::mesh::handle::OrientedFace;

/// All boundary in one oriented plane except for untouched faces.
#[derive(Debug)]
pub struct PlaneGroup {
    /// The plane, inside on its minus side.
    pub plane: Arc<Plane>,
    /// The faces that lie in it, ascending.
    pub faces: SmallVec<[OrientedFace; 2]>,
    /// The outline, counterclockwise as seen from outside.
    pub outline: Outline,
}

impl PlaneGroup {
    /// The edges of the outline.
    pub fn edges(&self) -> &[BareEdge] {
        self.outline.edges()
    }

    /// The keys of the lines that the edges lie on.
    pub fn lines(&mut self) -> &[LineKey] {
        self.outline.lines(&PlaneResidues::of(&self.plane))
    }
}
