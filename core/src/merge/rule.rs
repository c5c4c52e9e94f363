//! Rules that say which winding numbers are inside.

/// A rule that says which winding numbers w are inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// Inside is w > 0.
    Positive,
    /// Inside is w ≠ 0.
    Nonzero,
    /// Inside is an odd w.
    EvenOdd,
}

impl Rule {
    /// Returns true if a region with winding number `w` is inside by this rule.
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
