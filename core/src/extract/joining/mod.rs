//! Joins the cut faces of each plane, and subdivides edges until each has an opposite.

pub mod chords;
pub mod group;
pub mod patches;
pub mod planes;
pub mod seams;
