//! The three axes of space.

/// The values of a function at the axis numbers 0, 1 and 2.
///
/// The compiler inlines this function, but often not `[0, 1, 2].map`, which slows down loops over all
/// vertices.
#[inline]
pub fn each_axis<T>(mut value: impl FnMut(usize) -> T) -> [T; 3] {
    [value(0), value(1), value(2)]
}
