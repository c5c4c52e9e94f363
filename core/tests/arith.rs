//! Fixed-width arithmetic against arbitrary-precision integers, at the exact limits of each width.

use bspcsg::arith::{gcd_u128, inv_mod, mul_mod, ratio_to_f64, Int, P1, P2};
use num_bigint::BigInt;
use num_integer::Integer;
use proptest::prelude::*;

fn big<const N: usize>(x: &Int<N>) -> BigInt {
    let bytes: Vec<u8> = x.limbs().iter().flat_map(|l| l.to_le_bytes()).collect();
    BigInt::from_signed_bytes_le(&bytes)
}

/// The integer congruent to `x` modulo the width.
fn wrapped<const N: usize>(x: &BigInt) -> Int<N> {
    let fill = if *x < BigInt::ZERO { 0xff } else { 0 };
    let mut bytes = x.to_signed_bytes_le();
    bytes.resize(bytes.len().max(8 * N), fill);
    let limb = |i: usize| bytes[8 * i..8 * i + 8].try_into().map(u64::from_le_bytes);
    Int::from_limbs(std::array::from_fn(|i| limb(i).unwrap()))
}

fn fits<const N: usize>(x: &BigInt) -> bool {
    big(&wrapped::<N>(x)) == *x
}

fn power(exponent: u32) -> BigInt {
    BigInt::from(1) << exponent
}

/// Limbs at which carries and guesses of quotients are hardest, and random ones.
fn limb() -> impl Strategy<Value = u64> {
    let corner = prop::sample::select(vec![0, 1, u64::MAX, u64::MAX - 1, 1 << 63, (1 << 63) - 1]);
    prop_oneof![3 => corner, 3 => any::<u64>(), 1 => (any::<u64>(), 0u32..64).prop_map(|(x, s)| x >> s)]
}

/// Integers of every length and both signs, with the extreme ones, but not the least.
fn int<const N: usize>() -> impl Strategy<Value = Int<N>> {
    let bits = prop_oneof![2 => Just(Int::<N>::BITS - 1), 1 => 0..Int::<N>::BITS];
    (prop::collection::vec(limb(), N), bits, any::<bool>()).prop_map(|(limbs, bits, negative)| {
        let limbs: [u64; N] = limbs.try_into().unwrap();
        let magnitude = big(&Int::from_limbs(limbs)).mod_floor(&power(bits));
        wrapped(&if negative { -magnitude } else { magnitude })
    })
}

fn positive<const N: usize>() -> impl Strategy<Value = Int<N>> {
    int::<N>().prop_map(|x| if x.is_zero() { Int::ONE } else { x.abs() })
}

fn divisor() -> impl Strategy<Value = u128> {
    let shift = prop_oneof![Just(0u32), 0u32..128];
    (limb(), limb(), shift)
        .prop_map(|(high, low, shift)| (u128::from(high) << 64 | u128::from(low)) >> shift)
        .prop_map(|divisor| divisor.max(1))
}

/// A double, by its bits, as a multiple of 2^-1074; infinity is the value after the largest double.
fn double_in_least_steps(bits: u64) -> BigInt {
    let (exponent, fraction) = (bits >> 52, bits & ((1 << 52) - 1));
    match u32::try_from(exponent).unwrap() {
        0 => BigInt::from(fraction),
        exponent => BigInt::from(fraction | 1 << 52) << (exponent - 1),
    }
}

/// Returns true if `value` is the double nearest to `numerator / denominator`, the even one of two.
fn is_nearest(value: f64, numerator: &BigInt, denominator: &BigInt) -> bool {
    if (*numerator < BigInt::ZERO) != value.is_sign_negative() {
        return false;
    }
    let bits = value.abs().to_bits();
    let target = BigInt::from(numerator.magnitude().clone()) << 1075u32;
    let middle =
        |low: u64| (double_in_least_steps(low) + double_in_least_steps(low + 1)) * denominator;
    let tie_is_ours = bits.is_multiple_of(2);
    let above = bits == 0 || middle(bits - 1) < target || tie_is_ours && middle(bits - 1) == target;
    let below =
        value.is_infinite() || target < middle(bits) || tie_is_ours && middle(bits) == target;
    above && below
}

/// Makes the tests of the laws for each width.
macro_rules! width_laws {
    ($($name:ident: $n:literal),*) => {$(
        mod $name {
            use super::*;
            const N: usize = $n;

            #[test]
            fn extremes() {
                let largest: BigInt = power(Int::<N>::BITS - 1) - 1;
                for value in [largest.clone(), -largest, BigInt::from(0), BigInt::from(-1)] {
                    let x = wrapped::<N>(&value);
                    assert_eq!(big(&x), value);
                    assert_eq!(big(&-x), -&value);
                    assert_eq!(u64::from(x.bit_length()), value.bits());
                    assert_eq!(big(&x.mul::<N, { 2 * N }>(&x)), &value * &value);
                    assert!(is_nearest(x.to_f64(), &value, &1.into()));
                }
            }

            proptest! {
                #[test]
                fn sums(a in int::<N>(), b in int::<N>()) {
                    let (sum, difference) = (big(&a) + big(&b), big(&a) - big(&b));
                    if fits::<N>(&sum) {
                        prop_assert_eq!(big(&(a + b)), sum);
                    }
                    if fits::<N>(&difference) {
                        prop_assert_eq!(big(&(a - b)), difference);
                    }
                }

                #[test]
                fn sign_and_order(a in int::<N>(), b in int::<N>()) {
                    let (x, y) = (big(&a), big(&b));
                    prop_assert_eq!(a.cmp(&b), x.cmp(&y));
                    prop_assert_eq!(a.sign().order(), x.cmp(&BigInt::ZERO));
                    prop_assert_eq!(a.is_zero(), x == BigInt::ZERO);
                    prop_assert_eq!(a.is_negative(), x < BigInt::ZERO);
                    prop_assert_eq!(big(&a.abs()), BigInt::from(x.magnitude().clone()));
                    prop_assert_eq!(u64::from(a.bit_length()), x.bits());
                    prop_assert_eq!(format!("{a:?}"), format!("{x:#x}"));
                }

                #[test]
                fn widths(a in int::<N>(), bits in 0..Int::<N>::BITS) {
                    let x: BigInt = big(&a) >> bits;
                    let a = wrapped::<N>(&x);
                    prop_assert_eq!(big(&a.widen::<{ N + 2 }>()), x.clone());
                    prop_assert_eq!(a.widen::<{ N + 2 }>().narrow::<N>(), Some(a));
                    prop_assert_eq!(a.narrow::<2>().map(|low| big(&low)), fits::<2>(&x).then(|| x.clone()));
                    prop_assert_eq!(a.to_i128(), i128::try_from(&x).ok());
                }

                #[test]
                fn small_values(x in any::<i64>(), y in any::<i128>()) {
                    prop_assert_eq!(big(&Int::<N>::from_i64(x)), x.into());
                    prop_assert_eq!(Int::<N>::from_i128(y).to_i128(), Some(y));
                }

                #[test]
                fn products(a in int::<N>(), b in int::<2>(), c in int::<3>(), d in int::<N>()) {
                    prop_assert_eq!(big(&a.mul::<2, { N + 2 }>(&b)), big(&a) * big(&b));
                    prop_assert_eq!(big(&b.mul::<N, { N + 2 }>(&a)), big(&a) * big(&b));
                    prop_assert_eq!(big(&a.mul::<3, { N + 4 }>(&c)), big(&a) * big(&c));
                    prop_assert_eq!(big(&a.mul::<N, { 2 * N }>(&d)), big(&a) * big(&d));
                    prop_assert_eq!(big(&a.mul::<N, { 2 * N + 3 }>(&d)), big(&a) * big(&d));
                }

                #[test]
                fn products_in_fewer_limbs(a in int::<N>(), b in int::<2>(), room in 0u32..3) {
                    let spare = (Int::<N>::BITS - 1).saturating_sub(b.bit_length() + room);
                    let x = big(&a) >> (Int::<N>::BITS - 1 - spare);
                    let product = x.clone() * big(&b);
                    prop_assume!(product.bits() < Int::<N>::BITS.into());
                    prop_assert_eq!(big(&wrapped::<N>(&x).mul::<2, N>(&b)), product);
                }

                #[test]
                fn small_factors(a in int::<N>(), x in any::<i64>(), y in any::<i128>()) {
                    prop_assert_eq!(big(&a.mul_i64::<{ N + 1 }>(x)), big(&a) * x);
                    prop_assert_eq!(big(&a.mul_i128::<{ N + 2 }>(y)), big(&a) * y);
                }

                #[test]
                fn residues(a in int::<N>(), m in divisor()) {
                    for p in [P1, P2] {
                        prop_assert_eq!(BigInt::from(a.rem_u61(p)), big(&a).mod_floor(&p.into()));
                    }
                    prop_assert_eq!(BigInt::from(a.rem_u128(m)), big(&a.abs()) % m);
                }

                #[test]
                fn exact_quotients(a in int::<N>(), m in divisor()) {
                    let quotient = big(&a) / m;
                    let multiple = wrapped::<N>(&(quotient.clone() * m));
                    prop_assert_eq!(multiple.rem_u128(m), 0);
                    prop_assert_eq!(big(&multiple.div_exact_u128(m)), quotient);
                }

                #[test]
                fn nearest_double(a in int::<N>()) {
                    prop_assert!(is_nearest(a.to_f64(), &big(&a), &1.into()));
                }

                #[test]
                fn nearest_ratio(a in int::<N>(), b in positive::<N>(), c in positive::<6>()) {
                    prop_assert!(is_nearest(ratio_to_f64(&a, &b), &big(&a), &big(&b)));
                    prop_assert!(is_nearest(ratio_to_f64(&a, &c), &big(&a), &big(&c)));
                    let a = a + Int::from_i64(i64::from(a.is_zero()));
                    prop_assert!(is_nearest(ratio_to_f64(&c, &a.abs()), &big(&c), &big(&a.abs())));
                }

                /// Ratios at, just below and just above the middle between two doubles.
                #[test]
                fn ties(m in 1i64 << 53..1 << 54, b in positive::<N>(), nudge in -1i64..=1) {
                    let a = b.mul_i64::<{ N + 2 }>(m | 1) + Int::from_i64(nudge);
                    prop_assert!(is_nearest(ratio_to_f64(&a, &b), &big(&a), &big(&b)));
                }
            }
        }
    )*};
}

width_laws!(two: 2, three: 3, four: 4, six: 6, eight: 8, twelve: 12, eighteen: 18);

#[test]
fn the_least_number_multiplies_right() {
    let least = |bits: u32| -power(bits);
    let (a, b) = (wrapped::<6>(&least(383)), wrapped::<2>(&least(127)));
    assert_eq!(big(&a.mul::<2, 8>(&b)), power(510));
    assert_eq!(big(&a.mul::<6, 12>(&a)), power(766));
    assert_eq!(a.bit_length(), 384);
    assert_eq!(b.to_i128(), Some(i128::MIN));
}

#[test]
fn one_limb_is_enough_for_small_numbers() {
    let x = Int::<1>::from_i64(i64::MAX);
    assert_eq!(x.to_i128(), Some(i64::MAX.into()));
    assert_eq!(
        x.mul::<1, 2>(&x).to_i128(),
        Some(i128::from(i64::MAX).pow(2))
    );
    assert_eq!(Int::<1>::from_i64(-7).rem_u61(P1), P1 - 7);
}

mod overflow {
    use super::*;

    #[test]
    #[should_panic(expected = "a sum exceeds")]
    fn of_a_sum() {
        let _ = wrapped::<3>(&(power(191) - 1)) + Int::ONE;
    }

    #[test]
    #[should_panic(expected = "a difference exceeds")]
    fn of_a_difference() {
        let _ = wrapped::<3>(&-power(191)) - Int::ONE;
    }

    // Found: wide products could wrap in silence.
    #[test]
    #[should_panic(expected = "a product exceeds")]
    fn of_a_product() {
        let _: Int<2> = Int::<2>::from_i128(1 << 64).mul(&Int::<2>::from_i128(1 << 63));
    }
}

#[test]
fn ratios_at_the_ends_of_the_doubles() {
    let least = f64::from_bits(1);
    let infinity = f64::INFINITY;
    let cases: [(BigInt, BigInt, f64); 12] = [
        (0.into(), 1.into(), 0.0),
        (1.into(), power(1074), least),
        (1.into(), power(1075), 0.0),
        (3.into(), power(1075), 2.0 * least),
        (power(20) + 1, power(1095), least),
        (power(70) + 1, power(1145), least),
        ((-1).into(), power(1074), -least),
        (power(54) - 1, power(1076), f64::MIN_POSITIVE),
        (power(1024) - power(971), 1.into(), f64::MAX),
        (power(1024) - power(970), 1.into(), infinity),
        (power(1024) - power(970) - 1, 1.into(), f64::MAX),
        (-power(1100), 1.into(), -infinity),
    ];
    for (numerator, denominator, expected) in cases {
        let value = ratio_to_f64(&wrapped::<18>(&numerator), &wrapped::<18>(&denominator));
        assert_eq!(value.to_bits(), expected.to_bits());
    }
}

proptest! {
    #[test]
    fn subnormal_ratios(num in positive::<2>(), den in positive::<2>(), shift in 880u32..1020) {
        let den = big(&den) << shift;
        let value = ratio_to_f64(&num, &wrapped::<18>(&den));
        prop_assert!(is_nearest(value, &big(&num), &den));
    }

    /// Ratios between two doubles whose excess over the middle lies far below the quotient's last bit.
    #[test]
    fn ties_of_long_numerators(m in 1u64 << 53..1 << 54, shift in 1u32..1000, nudge in -1..=1) {
        let num = (BigInt::from(m | 1) << shift) + nudge;
        let a = wrapped::<18>(&num);
        prop_assert!(is_nearest(ratio_to_f64(&a, &Int::<2>::ONE), &num, &1.into()));
        prop_assert!(is_nearest(a.to_f64(), &num, &1.into()));
    }

    #[test]
    fn gcd(a in divisor(), b in divisor(), c in divisor()) {
        prop_assert_eq!(gcd_u128(a, b), a.gcd(&b));
        let c = (c >> 64).max(1);
        let (a, b) = ((a >> 64) * c, (b >> 64) * c);
        prop_assert_eq!(gcd_u128(a, b), a.gcd(&b));
    }

    #[test]
    fn residue_products(a in 0..P2, b in 0..P2) {
        for p in [P1, P2] {
            let product = u128::from(a) * u128::from(b) % u128::from(p);
            prop_assert_eq!(u128::from(mul_mod(a, b, p)), product);
        }
    }

    #[test]
    fn inverses(a in 1..P2, shift in 0u32..61) {
        let a = (a >> shift).max(1);
        for p in [P1, P2] {
            prop_assert!(inv_mod(a, p) < p);
            prop_assert_eq!(mul_mod(inv_mod(a, p), a, p), 1);
            prop_assert_eq!(mul_mod(inv_mod(p - a, p), p - a, p), 1);
        }
    }
}

#[test]
fn gcd_of_special_pairs() {
    assert_eq!(gcd_u128(0, 0), 0);
    assert_eq!(gcd_u128(0, u128::MAX), u128::MAX);
    assert_eq!(gcd_u128(u128::MAX, u128::MAX), u128::MAX);
    assert_eq!(gcd_u128(12 << 100, 18 << 90), 3 << 91);
    let (mut a, mut b) = (1u128, 1u128);
    while let Some(next) = a.checked_add(b) {
        (a, b) = (next, a);
        assert_eq!(gcd_u128(a, b), 1);
    }
}

#[test]
fn residues_at_the_ends() {
    for p in [P1, P2] {
        assert_eq!(inv_mod(0, p), 0);
        assert_eq!(inv_mod(1, p), 1);
        assert_eq!(inv_mod(p - 1, p), p - 1);
        assert_eq!(mul_mod(p - 1, p - 1, p), 1);
        assert_eq!(Int::<2>::from_i128(-i128::from(p)).rem_u61(p), 0);
    }
}

/// Return whether `n` passes the Miller–Rabin test for the bases that decide it below 2^64.
fn is_prime(n: u64) -> bool {
    let times = |a: u64, b: u64| u128::from(a) * u128::from(b) % u128::from(n);
    let times = |a: u64, b: u64| u64::try_from(times(a, b)).unwrap();
    let power = |base: u64, exponent: u64| {
        (0..64).rev().fold(1, |x, bit| {
            let square = times(x, x);
            if exponent >> bit & 1 == 1 {
                times(square, base)
            } else {
                square
            }
        })
    };
    let twos = (n - 1).trailing_zeros();
    [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37]
        .into_iter()
        .all(|base| {
            let first = power(base, (n - 1) >> twos);
            let mut squares = std::iter::successors(Some(first), |&x| Some(times(x, x)));
            first == 1 || squares.by_ref().take(twos as usize).any(|x| x == n - 1)
        })
}

#[test]
fn the_moduli_are_the_two_largest_primes_below_two_to_the_61() {
    let primes: Vec<u64> = (P2..1 << 61).rev().filter(|&n| is_prime(n)).collect();
    assert_eq!(primes, [P1, P2]);
}
