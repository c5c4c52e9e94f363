//! Counters of the work of an evaluation.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::merge::kernels::counts::KernelCounters;
use crate::merge::profile::{KernelCount, Profile};

/// Counts of the cells visited, faces sorted and cells solved by kernels in an evaluation.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::merge::evaluate::evaluate;
/// use bspcsg::merge::expression::{Expression, Term};
/// use bspcsg::mesh::import::import;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let at = |x: f64| vertices.map(|[a, b, c]| [a + x, b, c]);
/// let solid = |x: f64| -> Result<Solid, bspcsg::error::Error> {
///     Ok(Solid::of_source(Arc::new(import(&at(x), &faces, None)?), false))
/// };
/// let either = vec![Term::Operand(0), Term::Operand(1), Term::Or(vec![0, 1])];
/// let (_, counters) = evaluate(&Expression::new(either)?, &[solid(0.0)?, solid(0.5)?])?;
/// // Two meshes as they were given: all faces were arranged at once.
/// assert!(counters.named().contains(&("kernels", 1)));
/// assert_eq!(counters.profile.stages[0].name, "candidates");
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Counters {
    /// The number of cells that the descent visited.
    pub cells: AtomicU64,
    /// The number of faces sorted into bins.
    pub binned: AtomicU64,
    /// The number of elements (faces or parts of faces) in lists that were halved, counted once for each
    /// halving.
    pub halved: AtomicU64,
    /// The number of cells solved by kernels.
    pub leaves: AtomicU64,
    /// The number of elements (faces or parts of faces) in cells solved by kernels.
    pub leaf_elements: AtomicU64,
    /// The numbers of cells that each kernel solved or refused.
    pub kernels: KernelCounters,
    /// The stages of the evaluation with their durations; empty until it has ended.
    pub profile: Profile,
}

impl Counters {
    /// Adds the counts of another descent to these.
    pub(super) fn add(&self, other: &Self) {
        let pairs = [
            (&self.cells, &other.cells),
            (&self.binned, &other.binned),
            (&self.halved, &other.halved),
            (&self.leaves, &other.leaves),
            (&self.leaf_elements, &other.leaf_elements),
        ];
        for (count, more) in pairs {
            count.fetch_add(more.load(Ordering::Relaxed), Ordering::Relaxed);
        }
        self.kernels.add(&other.kernels);
    }

    /// Returns these counts with the stages of the evaluation.
    #[must_use]
    pub(in crate::merge) fn with(self, profile: Profile) -> Self {
        Self { profile, ..self }
    }

    /// Adds one cell solved by a kernel, with this number of elements (faces or parts of faces).
    pub(in crate::merge) fn count_leaf(&self, elements: usize) {
        self.leaves.fetch_add(1, Ordering::Relaxed);
        self.leaf_elements
            .fetch_add(elements as u64, Ordering::Relaxed);
    }

    /// Returns the number of elements (faces or parts of faces) in cells solved by kernels.
    pub fn elements_solved(&self) -> u64 {
        self.leaf_elements.load(Ordering::Relaxed)
    }

    /// Returns the number of cells that the descent visited.
    pub(in crate::merge) fn cells_visited(&self) -> usize {
        usize::try_from(self.cells.load(Ordering::Relaxed)).unwrap_or(usize::MAX)
    }

    /// Returns how often the arrangement, and each kernel in the cells of the descent, was asked and refused.
    pub fn kernel_counts(&self) -> [KernelCount; 4] {
        let [orthogonal, general, trees] = self.kernels.counts();
        [self.profile.arrangement(), orthogonal, general, trees]
    }

    /// Returns the counts, each with its name.
    pub fn named(&self) -> [(&'static str, u64); 5] {
        [
            ("cells", &self.cells),
            ("binned", &self.binned),
            ("halved", &self.halved),
            ("kernels", &self.leaves),
            ("kernel_elements", &self.leaf_elements),
        ]
        .map(|(name, count)| (name, count.load(Ordering::Relaxed)))
    }
}
