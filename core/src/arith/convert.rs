//! Conversions whose correctness the types do not show, each with the reason.

/// Integers that have a nearest double.
pub trait Nearest {
    /// The nearest double.
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

/// The nearest double: exact for integers below 2⁵³ in magnitude, such as lattice coordinates.
#[inline]
pub fn as_double(integer: impl Nearest) -> f64 {
    integer.nearest()
}

/// A double truncated to an integer, saturated to the range.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the cast saturates")]
pub fn as_whole(x: f64) -> i64 {
    x as i64
}

/// A double truncated to a wide integer, saturated to the range.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the cast saturates")]
pub fn as_wide(x: f64) -> i128 {
    x as i128
}

/// The low limb.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "the high limb is left out")]
pub const fn low_limb(wide: u128) -> u64 {
    wide as u64
}

/// A count as a number: import ensures that there are fewer than 2³² vertices, faces and so on.
#[inline]
#[allow(clippy::cast_possible_truncation, reason = "see above")]
pub const fn as_number(count: usize) -> u32 {
    debug_assert!(count <= u32::MAX as usize, "fewer than 2^32 things");
    count as u32
}

/// The number of an item in memory as an index.
#[inline]
#[allow(
    clippy::cast_possible_truncation,
    reason = "places fit the address space"
)]
pub const fn as_place(number: u64) -> usize {
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
