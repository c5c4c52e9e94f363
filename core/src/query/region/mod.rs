//! Questions to sets of the line and the plane: outlines, measures, lines through them, sections.

pub mod cast;
pub mod condense;
pub mod edges;
pub mod hyperplane;
pub mod moments;
pub mod outlines;
pub mod section;
pub mod solid;
