//! Rules by which winding numbers count as inside.

/// A rule by which winding numbers count as inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// w > 0.
    Positive,
    /// w ≠ 0.
    Nonzero,
    /// w odd.
    EvenOdd,
}

impl Rule {
    /// Return whether a region with this winding number is inside.
    ///
    /// ```
    /// use bspcsg::merge::rule::Rule;
    ///
    /// let inside = |w: i32| [Rule::Positive, Rule::Nonzero, Rule::EvenOdd].map(|r| r.inside(w));
    /// assert_eq!(inside(2), [true, true, false]);
    /// assert_eq!(inside(-1), [false, true, true]);
    /// ```
    pub fn inside(self, w: i32) -> bool {
        match self {
            Self::Positive => w > 0,
            Self::Nonzero => w != 0,
            Self::EvenOdd => w % 2 != 0,
        }
    }
}
