//! The stages of an evaluation and their costs.

use super::division::Defect;
use std::time::Instant;

/// A stage of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: &'static str,
    /// Its duration.
    pub seconds: f64,
    /// The number of things that it found or made.
    pub count: usize,
}

/// A reason why an arrangement leaves the work to the descent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declined {
    /// The operands are not two different unchanged meshes, or the solid is not an unchanged mesh.
    Operands,
    /// The boxes around the meshes are apart.
    Apart,
    /// The meshes touch nearly everywhere.
    AllOver,
    /// Faces are crowded: boxes do not separate them.
    Crowded,
    /// The operand with this number overlaps itself where the other meets it.
    Overlap(usize),
    /// Faces are too thin to count winding numbers in front of them.
    Thin,
    /// A segment left its face: a defect.
    Defect,
}

impl From<Defect> for Declined {
    fn from(_: Defect) -> Self {
        Self::Defect
    }
}

impl Declined {
    /// The operand known to overlap itself, if any.
    pub fn overlapping(self) -> Option<usize> {
        match self {
            Self::Overlap(operand) => Some(operand),
            _ => None,
        }
    }

    /// The reason in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::Operands => "the operands are not two different, unchanged input meshes",
            Self::Apart => "the bounding boxes of the meshes do not overlap",
            Self::AllOver => "the meshes touch nearly everywhere",
            Self::Crowded => "the faces are too dense: their bounding boxes do not separate them",
            Self::Overlap(_) => "a mesh overlaps itself where the other one meets it",
            Self::Thin => "faces are too thin to count winding numbers in front of them",
            Self::Defect => "a segment left its face, which is a defect",
        }
    }
}

/// The stages of an evaluation, in order.
///
/// # Example
/// ```
/// use bspcsg::merge::profile::Profile;
///
/// let mut profile = Profile::default();
/// let squares = profile.timed("squares", || vec![1, 4, 9], Vec::len);
/// assert_eq!((squares[2], profile.stages[0].count), (9, 3));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// The stages done.
    pub stages: Vec<Stage>,
    /// The reason why the arrangement left the work to the descent, if it did.
    pub declined: Option<Declined>,
}

impl Profile {
    /// Runs and records a stage.
    pub fn timed<T>(
        &mut self,
        name: &'static str,
        work: impl FnOnce() -> T,
        count: impl FnOnce(&T) -> usize,
    ) -> T {
        let start = Instant::now();
        let done = work();
        let seconds = start.elapsed().as_secs_f64();
        let count = count(&done);
        self.stages.push(Stage {
            name,
            seconds,
            count,
        });
        done
    }
}
