//! Turns panics into errors: a defect of this library becomes an `Internal` error and crashes nothing.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{catch_unwind, set_hook, AssertUnwindSafe, PanicHookInfo};
use std::sync::Mutex;

use super::{Error, Result};

/// The number of panics whose source positions are stored, for threads that catch them later.
const MAX_PANICS_REMEMBERED: usize = 8;

/// The message of a panic, and its position in the source.
struct RecordedPanic {
    message: String,
    place: String,
}

static RECORDED: Mutex<VecDeque<RecordedPanic>> = Mutex::new(VecDeque::new());

/// Records where panics happen instead of printing them; the code that catches a panic reports it.
pub fn record_panics() {
    set_hook(Box::new(remember));
}

/// Returns the result of work, or the error that its panic becomes.
///
/// # Errors
/// The errors that the work returns or unwinds with; `Internal` for a panic, also for one on another thread
/// of the pool.
pub fn caught<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    // Data that the work left half done are not read again, or are only replaced as a whole.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let unwound = panic.downcast::<Error>();
        Err(unwound.map_or_else(|panic| error(&*panic), |known| *known))
    })
}

fn error(panic: &(dyn Any + Send)) -> Error {
    let message = words(panic);
    let place = place_of(message).unwrap_or_else(|| "an unknown place".to_owned());
    Error::internal(format!("a panic at {place}: {message}"))
}

fn words(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

// Neither function below waits for the lock: a panic must end, and a forked process may find it locked.

fn remember(info: &PanicHookInfo<'_>) {
    let message = words(info.payload()).to_owned();
    let place = info
        .location()
        .map_or_else(String::new, ToString::to_string);
    if let Ok(mut seen) = RECORDED.try_lock() {
        seen.truncate(MAX_PANICS_REMEMBERED - 1);
        seen.push_front(RecordedPanic { message, place });
    }
}

fn place_of(message: &str) -> Option<String> {
    let seen = RECORDED.try_lock().ok()?;
    let found = seen.iter().find(|seen| seen.message == message)?;
    Some(found.place.clone())
}
