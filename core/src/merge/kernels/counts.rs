//! Counts of the cells that each kernel solved or refused.

use std::array::from_fn;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::merge::profile::KernelCount;

/// The names of the kernels, in the order in which they are asked to solve a small cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KernelName {
    /// The kernel for faces perpendicular to axes.
    Orthogonal,
    /// The kernel for operands in general position.
    General,
    /// The kernel that solves every cell by local trees.
    Trees,
}

impl KernelName {
    const ALL: [(Self, &'static str); 3] = [
        (Self::Orthogonal, "orthogonal"),
        (Self::General, "general"),
        (Self::Trees, "trees"),
    ];
}

/// A reason why a kernel refuses a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The rule that says which winding numbers are inside is not w > 0.
    Rule,
    /// One operand alone has surface in the cell, or too many have.
    Operands,
    /// An operand overlaps itself in the cell.
    Overlap,
    /// A face is not perpendicular to an axis.
    Slanted,
    /// The planes of the faces form too fine a grid.
    Fine,
    /// Faces of different operands touch without crossing.
    Touching,
    /// Winding numbers cannot be counted, or contradict each other.
    Doubtful,
}

impl Refusal {
    const ALL: [(Self, &'static str); 7] = [
        (Self::Rule, "another rule than w > 0"),
        (Self::Operands, "one operand, or too many"),
        (Self::Overlap, "an operand overlaps itself"),
        (Self::Slanted, "faces not perpendicular to axes"),
        (Self::Fine, "too fine a grid"),
        (Self::Touching, "faces touch without crossing"),
        (Self::Doubtful, "winding numbers not certain"),
    ];
}

/// The number of answers that are counted for each kernel: the reasons to refuse a cell, and the result.
const ANSWERS: usize = Refusal::ALL.len() + 1;

/// The place of results among the answers that are counted.
const RESULT: usize = Refusal::ALL.len();

/// The numbers of cells that each kernel solved or refused.
///
/// # Example
/// ```
/// use bspcsg::merge::kernels::counts::{KernelCounters, KernelName, Refusal};
///
/// let counters = KernelCounters::default();
/// counters.record(KernelName::General, Some(Refusal::Rule));
/// counters.record(KernelName::General, None);
/// let [_, general, _] = counters.counts();
/// assert_eq!((general.asked(), general.took, general.refused.len()), (2, 1, 1));
/// ```
#[derive(Debug, Default)]
pub struct KernelCounters([[AtomicU64; ANSWERS]; KernelName::ALL.len()]);

impl KernelCounters {
    /// Adds one cell that the kernel solved, or refused for a reason.
    pub fn record(&self, kernel: KernelName, refusal: Option<Refusal>) {
        let answer = refusal.map_or(RESULT, |why| why as usize);
        self.0[kernel as usize][answer].fetch_add(1, Ordering::Relaxed);
    }

    /// Adds the counts of another descent to these.
    pub(in crate::merge) fn add(&self, other: &Self) {
        for (count, more) in self.0.iter().flatten().zip(other.0.iter().flatten()) {
            count.fetch_add(more.load(Ordering::Relaxed), Ordering::Relaxed);
        }
    }

    /// Returns the counts of each kernel, in the order in which kernels are asked.
    pub fn counts(&self) -> [KernelCount; KernelName::ALL.len()] {
        KernelName::ALL.map(|(kernel, name)| {
            let counts: [u64; ANSWERS] =
                from_fn(|answer| self.0[kernel as usize][answer].load(Ordering::Relaxed));
            let refused = Refusal::ALL.map(|(why, text)| (text, counts[why as usize]));
            KernelCount {
                name,
                took: counts[RESULT],
                refused: refused.into_iter().filter(|(_, n)| *n > 0).collect(),
            }
        })
    }
}
