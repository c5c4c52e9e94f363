//! Panics of the core become errors.

use std::panic::take_hook;

use bspcsg::error::panics::{caught, record_panics};
use bspcsg::error::{Error, ErrorKind, Result};

/// Runs work, and catches its panic without printing anything.
fn quietly<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    record_panics();
    let result = caught(work);
    let _ = take_hook();
    result
}

#[test]
fn panics_are_errors_that_say_where_on_any_thread() {
    let own = quietly(|| -> Result<u32> { panic!("the moon is {}", "blue") });
    let own = own.expect_err("it panicked");
    assert_eq!(own.kind(), ErrorKind::Internal);
    assert!(own.message().starts_with("a panic at "), "{own}");
    assert!(own.message().contains("tests/panics.rs:"), "{own}");
    assert!(own.message().ends_with(": the moon is blue"), "{own}");

    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build();
    let pool = pool.expect("a pool");
    let other = quietly(|| {
        let bad = || -> u32 { panic!("half of the moon") };
        let (left, right) = pool.install(|| rayon::join(|| 1, bad));
        Ok(left + right)
    });
    let other = other.expect_err("it panicked");
    assert!(other.message().contains("tests/panics.rs:"), "{other}");
    assert!(other.message().ends_with(": half of the moon"), "{other}");
    assert_eq!(pool.install(|| 3), 3, "the pool goes on");

    assert_eq!(quietly(|| Ok(5)), Ok(5));
    let error = Error::new(ErrorKind::TooLarge, "large");
    assert_eq!(quietly::<()>(|| Err(error.clone())), Err(error));
}
