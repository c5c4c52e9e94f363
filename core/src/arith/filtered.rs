//! Results of floating-point filters.

/// The answer of a filter: rounded arithmetic settles a question, or leaves it to an exact computation.
///
/// # Example
/// ```
/// use bspcsg::arith::{Filtered, Sign};
///
/// let near = |value: f64, error: f64| Filtered::when(value.abs() > error, Sign::of(value));
/// assert_eq!(near(2.0, 0.1), Filtered::Certain(Sign::Positive));
/// assert_eq!(near(1e-9, 0.1).or_exact(|| Sign::Zero), Sign::Zero);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub enum Filtered<T> {
    /// The exact answer.
    Certain(T),
    /// Undecided: ask an exact computation.
    Doubtful,
}

impl<T> Filtered<T> {
    /// This answer, if it is certain.
    #[inline]
    pub fn when(certain: bool, answer: T) -> Self {
        if certain {
            Self::Certain(answer)
        } else {
            Self::Doubtful
        }
    }

    /// The answer, computed exactly if necessary.
    #[inline]
    pub fn or_exact(self, exact: impl FnOnce() -> T) -> T {
        match self {
            Self::Certain(answer) => answer,
            Self::Doubtful => exact(),
        }
    }

    /// The answer of this filter, or of another one if it is doubtful.
    #[inline]
    pub fn or_else(self, other: impl FnOnce() -> Self) -> Self {
        match self {
            Self::Certain(_) => self,
            Self::Doubtful => other(),
        }
    }

    /// Return whether the filter settles the question.
    #[inline]
    pub fn is_certain(&self) -> bool {
        matches!(self, Self::Certain(_))
    }
}
