//! The stages of the evaluation of an expression, with their durations.

use super::division::Defect;
use std::time::Instant;

/// One stage of the evaluation of an expression, with its duration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// The name of the stage, such as "candidates" or "descent".
    pub name: &'static str,
    /// The duration of the stage in seconds.
    pub seconds: f64,
    /// The number of items that the stage found or made: faces, contacts or cells, depending on the stage.
    pub count: usize,
}

/// A reason why a Boolean expression over a few meshes cannot be evaluated by comparing all their faces at
/// once, so that the descent through cells evaluates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Declined {
    /// The expression is not over two to four different meshes as they were imported.
    Operands,
    /// The bounding boxes of all meshes are disjoint.
    Apart,
    /// Two of the meshes touch nearly everywhere, as revisions of one mesh do.
    AllOver,
    /// The boxes of faces overlap in too many pairs.
    Crowded,
    /// The operand with this index overlaps itself in too many places to compare its faces with each other.
    Overlap(usize),
    /// A face is too thin to choose a point in front of it at which to count the winding number.
    Thin,
    /// A computed intersection segment left its face: a defect of this program.
    Defect,
}

impl From<Defect> for Declined {
    /// Where assertions are on, as in tests and fuzz targets, a defect ends the evaluation; users get the
    /// result of the descent.
    fn from(_: Defect) -> Self {
        debug_assert!(false, "an intersection segment left its face");
        Self::Defect
    }
}

impl Declined {
    /// Returns the index of the operand that overlaps itself, if the reason is `Declined::Overlap`.
    pub fn overlapping(self) -> Option<usize> {
        match self {
            Self::Overlap(operand) => Some(operand),
            _ => None,
        }
    }

    /// Returns the reason as a text for people.
    pub fn text(self) -> &'static str {
        match self {
            Self::Operands => "the operands are not two to four different, unchanged input meshes",
            Self::Apart => "the bounding boxes of the meshes do not overlap",
            Self::AllOver => "the meshes touch nearly everywhere",
            Self::Crowded => "the faces are too dense: their bounding boxes do not separate them",
            Self::Overlap(_) => "a mesh overlaps itself in too many places",
            Self::Thin => "faces are too thin to count winding numbers in front of them",
            Self::Defect => "a segment left its face, which is a defect",
        }
    }
}

/// How often a kernel was asked in the evaluation of an expression, and why it refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KernelCount {
    /// The name of the kernel, such as "arrangement" or "trees".
    pub name: &'static str,
    /// The number of requests that the kernel solved.
    pub took: u64,
    /// The reasons why it refused, as texts for people, each with the number of requests refused for it.
    pub refused: Vec<(&'static str, u64)>,
}

impl KernelCount {
    /// Returns how often the kernel was asked.
    pub fn asked(&self) -> u64 {
        self.took + self.refused.iter().map(|(_, count)| count).sum::<u64>()
    }
}

/// The stages of the evaluation of an expression, in the order in which they ran.
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
    /// The finished stages, in the order in which they ran.
    pub stages: Vec<Stage>,
    /// The reason why the arrangement of all faces at once was not possible; `None` if it was, or was not
    /// tried.
    pub declined: Option<Declined>,
}

impl Profile {
    /// Returns whether the arrangement, which each evaluation asks once, solved it, and if not, why.
    pub fn arrangement(&self) -> KernelCount {
        KernelCount {
            name: "arrangement",
            took: u64::from(self.declined.is_none()),
            refused: self
                .declined
                .map(|why| (why.text(), 1))
                .into_iter()
                .collect(),
        }
    }

    /// Runs `work`, records it as a stage with its duration, and returns its result; `count` extracts the
    /// recorded number of items.
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
