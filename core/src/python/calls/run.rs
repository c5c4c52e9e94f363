//! Calls into the core: the GIL released, signals polled, panics caught.

use std::cell::{Cell, RefCell};
use std::sync::mpsc;
use std::time::Duration;

use pyo3::prelude::*;
use rayon::ThreadPool;

use super::errors::to_python;
use super::pool::pool;
use crate::error::panics::caught;
use crate::error::{Error, Result};
use crate::interrupt::Call;

/// Work on fewer elements than this is done at once, on the caller's thread.
pub const SMALL: usize = 2000;

const POLL: Duration = Duration::from_millis(50);

thread_local! {
    /// The exception that a signal handler raised while this thread waited or worked.
    static RAISED: Cell<Option<PyErr>> = const { Cell::new(None) };

    /// The callable that is called while this thread's calls run.
    static WATCHER: RefCell<Option<Py<PyAny>>> = const { RefCell::new(None) };
}

/// Has a function called about twenty times a second while calls of this thread run, or none; what
/// it raises ends the call. Returns the one before.
#[pyfunction]
pub fn watch(watcher: Option<Py<PyAny>>) -> Option<Py<PyAny>> {
    WATCHER.replace(watcher)
}

fn tell_watcher(py: Python<'_>) -> PyResult<()> {
    let watcher = WATCHER.with_borrow(|w| w.as_ref().map(|found| found.clone_ref(py)));
    watcher.map_or(Ok(()), |found| found.call0(py).map(drop))
}

/// Runs work with the GIL released; an interrupt ends it at its next poll.
///
/// # Errors
/// What the work returns, as a Python exception; a panic as an internal error; `KeyboardInterrupt`
/// and what signal handlers raise.
pub fn run<T: Send>(
    py: Python<'_>,
    threads: usize,
    size: usize,
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    RAISED.set(None);
    let call = Call::new();
    let result = if size < SMALL {
        py.detach(|| call.run_asking(signal_raised, work))
    } else {
        let pool = pool(py, threads).map_err(|e| to_python(py, &e))?;
        py.detach(|| shared(&pool, &call, work))
    };
    match RAISED.take() {
        Some(exception) => Err(exception),
        None => result.map_err(|error| to_python(py, &error)),
    }
}

/// Runs short work at once, with the GIL.
///
/// # Errors
/// As for [`run`].
pub fn here<T>(py: Python<'_>, work: impl FnOnce() -> Result<T>) -> PyResult<T> {
    caught(work).map_err(|error| to_python(py, &error))
}

/// Has a pool do the work of a call and waits for it; stops it when a signal's handler raises.
fn shared<T: Send>(
    pool: &ThreadPool,
    call: &Call,
    work: impl FnOnce() -> Result<T> + Send,
) -> Result<T> {
    let (done, wait) = mpsc::channel();
    pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            let _ = done.send(call.run(work));
        });
        loop {
            match wait.recv_timeout(POLL) {
                Ok(result) => return result,
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(Error::internal("the work ended without an answer"));
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    if signal_raised() {
                        call.stop();
                    }
                }
            }
        }
    })
}

/// Return whether a signal has arrived of which the handler raised an exception, such as
/// `KeyboardInterrupt`, or the watcher raised one.
///
/// A handler may fork. The child has the threads of the pool no more, and the work borrows from
/// this stack, so that there is no way on and none back: the child ends with a word, not by waiting.
fn signal_raised() -> bool {
    let process = std::process::id();
    let raised = Python::attach(|py| py.check_signals().and_then(|()| tell_watcher(py)).err());
    if std::process::id() != process {
        eprintln!(
            "bspcsg: a signal handler forked this process in the middle of an operation, which \
             cannot go on here; a child must end inside the handler (os._exit)"
        );
        std::process::abort();
    }
    let found = raised.is_some();
    if found {
        RAISED.set(raised);
    }
    found
}
