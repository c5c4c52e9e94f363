//! Greatest common divisors.

use super::convert::low_limb;

/// The greatest common divisor of two 128-bit integers; `gcd_u128(a, 0)` is `a`.
#[inline]
pub fn gcd_u128(a: u128, b: u128) -> u128 {
    let (small, large) = if a <= b { (a, b) } else { (b, a) };
    match u64::try_from(small) {
        Ok(0) => large,
        Ok(1) => 1,
        Ok(short) => u128::from(gcd(short, low_limb(large % small))),
        Err(_) => gcd_long(small, large),
    }
}

/// The greatest common divisor of two nonzero integers, by the binary algorithm.
fn gcd_long(a: u128, b: u128) -> u128 {
    let twos = (a | b).trailing_zeros();
    let (mut a, mut b) = (a >> a.trailing_zeros(), b >> b.trailing_zeros());
    while (a | b) >> 64 != 0 {
        if a == b {
            return a << twos;
        }
        let difference = a.abs_diff(b);
        a = a.min(b);
        b = difference >> difference.trailing_zeros();
    }
    u128::from(gcd_odd(low_limb(a), low_limb(b))) << twos
}

/// The greatest common divisor of two 64-bit integers; `gcd(a, 0)` is `a`.
#[inline]
pub fn gcd(a: u64, b: u64) -> u64 {
    if a == 0 || b == 0 {
        return a | b;
    }
    let twos = (a | b).trailing_zeros();
    gcd_odd(a >> a.trailing_zeros(), b >> b.trailing_zeros()) << twos
}

/// The greatest common divisor of two odd integers, by the binary algorithm.
#[inline]
fn gcd_odd(mut a: u64, mut b: u64) -> u64 {
    while a != b {
        let difference = a.abs_diff(b);
        a = a.min(b);
        b = difference >> difference.trailing_zeros();
    }
    a
}
