//! Exact integers of fixed width, signs of numbers, residues modulo primes, and correctly rounded ratios and
//! sums.
//!
//! Nothing here knows geometry except [`bounds`], which derives how wide the
//! integers of the exact predicates have to be. Nothing allocates.

pub mod bounds;
pub mod convert;
mod double_double;
mod filtered;
mod gcd;
mod int;
pub mod leading;
mod limbs;
mod modular;
mod ops;
mod ratio;
mod round;
mod sign;
mod sum;

pub use double_double::DoubleDouble;
pub use filtered::Filtered;
pub use gcd::{gcd, gcd_u128};
pub use int::Int;
pub use modular::{inv_mod, mul_mod, reduce_mod, P1, P2};
pub use ratio::ratio_to_f64;
pub use round::mantissa_and_exponent;
pub use sign::Sign;
pub use sum::Sum;
