//! Cut faces joined by plane, and edges subdivided until they pair.

pub mod chords;
pub mod group;
pub mod patches;
pub mod planes;
pub mod seams;
