//! The three axes of space.

/// The values of a function at the three axes, by number.
///
/// The compiler inlines this, but often not `[0, 1, 2].map`, which loops over all vertices feel.
#[inline]
pub fn each_axis<T>(mut value: impl FnMut(usize) -> T) -> [T; 3] {
    [value(0), value(1), value(2)]
}
