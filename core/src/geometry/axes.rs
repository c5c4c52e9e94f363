//! The three axes of space.

/// The values of a function at the three axes, by number.
///
/// The compiler inlines this; `[0, 1, 2].map` it often does not, and loops over all vertices feel it.
#[inline]
pub fn each_axis<T>(mut value: impl FnMut(usize) -> T) -> [T; 3] {
    [value(0), value(1), value(2)]
}
