//! Results of floating-point filters: certain, or doubtful and left to an exact computation.

/// The result of a filter, which computes in rounded arithmetic: certain, or doubtful, so that an exact
/// computation must decide.
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
    /// Rounding errors leave the answer open: an exact computation must decide.
    Doubtful,
}

impl<T> Filtered<T> {
    /// Return `Certain(answer)` if `certain`, else `Doubtful`.
    #[inline]
    pub fn when(certain: bool, answer: T) -> Self {
        if certain {
            Self::Certain(answer)
        } else {
            Self::Doubtful
        }
    }

    /// The certain answer, or else the result of the exact computation.
    #[inline]
    pub fn or_exact(self, exact: impl FnOnce() -> T) -> T {
        match self {
            Self::Certain(answer) => answer,
            Self::Doubtful => exact(),
        }
    }

    /// This answer if it is certain, or else the answer of another filter.
    #[inline]
    pub fn or_else(self, other: impl FnOnce() -> Self) -> Self {
        match self {
            Self::Certain(_) => self,
            Self::Doubtful => other(),
        }
    }

    /// Return whether the answer is certain.
    #[inline]
    pub fn is_certain(&self) -> bool {
        matches!(self, Self::Certain(_))
    }
}
