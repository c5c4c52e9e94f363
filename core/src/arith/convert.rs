//! Conversions between number types that may round, saturate or truncate; each function states why this is
//! right.

/// Integers that have a nearest double.
pub trait Nearest {
    /// The double nearest to the integer.
    fn nearest(self) -> f64;
}

macro_rules! nearest {
    ($($integer:ty),*) => {$(
        impl Nearest for $integer {
            #[inline]
            #[allow(clippy::cast_precision_loss, reason = "rounding is what is asked for")]
            fn nearest(self) -> f64 {
                self as f64
            }
        }
    )*};
}

nearest!(i64, u64, i128, u128, usize);

/// The double nearest to an integer; exact for integers below 2⁵³ in magnitude, such as lattice coordinates.
#[inline]
pub fn as_double(integer: impl Nearest) -> f64 {
    integer.nearest()
}

/// A double truncated to an `i64`, saturated to the range of `i64`.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the cast saturates")]
pub fn as_whole(x: f64) -> i64 {
    x as i64
}

/// A double truncated to an `i128`, saturated to the range of `i128`.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the cast saturates")]
pub fn as_wide(x: f64) -> i128 {
    x as i128
}

/// The low 64 bits of a 128-bit integer.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the high limb is left out")]
pub const fn low_limb(wide: u128) -> u64 {
    wide as u64
}

/// A count as a `u32`: import ensures that there are fewer than 2³² vertices, faces and so on.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "see above")]
pub const fn as_number(count: usize) -> u32 {
    debug_assert!(count <= u32::MAX as usize, "fewer than 2^32 things");
    count as u32
}

/// The 64-bit number of an item in memory as a `usize` index.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "places fit the address space"
)]
pub const fn as_index(number: u64) -> usize {
    number as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_are_the_nearest_ones() {
        let largest = (1i64 << 53) - 1;
        assert_eq!(as_whole(as_double(largest)), largest);
        assert_eq!(
            as_whole(as_double(largest + 2)),
            largest + 1,
            "a tie goes to the even one"
        );
    }

    #[test]
    fn whole_numbers_saturate() {
        assert_eq!([-1.9, 1.9].map(as_whole), [-1, 1]);
        assert_eq!(as_whole(1e300), i64::MAX);
        assert_eq!(as_wide(-1e300), i128::MIN);
    }

    #[test]
    fn the_low_limb_is_left() {
        assert_eq!(low_limb((7 << 64) | 3), 3);
    }
}
