//! Calls into the core: the GIL released, signals polled, panics caught.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::time::Duration;

use pyo3::prelude::*;
use rayon::ThreadPool;

use super::errors::to_python;
use super::pool::pool;
use crate::error::panics::caught;
use crate::error::{Error, Result};

/// Work on fewer elements than this is done at once, on the caller's thread.
pub const SMALL: usize = 2000;

const POLL: Duration = Duration::from_millis(50);

/// Runs work with the GIL released; an interrupt sets the flag that the work watches.
///
/// # Errors
/// What the work returns, as a Python exception; a panic as an internal error; `KeyboardInterrupt`
/// and what signal handlers raise.
pub fn run<T: Send>(
    py: Python<'_>,
    threads: usize,
    size: usize,
    work: impl FnOnce(&AtomicBool) -> Result<T> + Send,
) -> PyResult<T> {
    let cancel = AtomicBool::new(false);
    let mut raised = None;
    let result = if size < SMALL {
        py.detach(|| caught(|| work(&cancel)))
    } else {
        let pool = pool(py, threads).map_err(|e| to_python(py, &e))?;
        py.detach(|| shared(&pool, work, &cancel, &mut raised))
    };
    match raised {
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

/// Runs work in a pool and waits for it; a signal's exception is put into `raised`.
fn shared<T: Send>(
    pool: &ThreadPool,
    work: impl FnOnce(&AtomicBool) -> Result<T> + Send,
    cancel: &AtomicBool,
    raised: &mut Option<PyErr>,
) -> Result<T> {
    let (done, wait) = mpsc::channel();
    pool.in_place_scope(|scope| {
        scope.spawn(move |_| {
            let _ = done.send(caught(|| work(cancel)));
        });
        loop {
            match wait.recv_timeout(POLL) {
                Ok(result) => return result,
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(Error::internal("the work ended without an answer"));
                }
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    if let Err(e) = pending_signal() {
                        *raised = Some(e);
                        cancel.store(true, Ordering::Relaxed);
                    }
                }
            }
        }
    })
}

/// The exception of a signal that has arrived, such as `KeyboardInterrupt`.
///
/// A handler may fork. The child has the threads of the pool no more, and the work borrows from
/// this stack, so that there is no way on and none back: the child ends with a word, not by waiting.
#[expect(
    clippy::redundant_closure_for_method_calls,
    reason = "the method is bound to one lifetime, `attach` wants any"
)]
fn pending_signal() -> PyResult<()> {
    let process = std::process::id();
    let found = Python::attach(|py| py.check_signals());
    if std::process::id() != process {
        eprintln!(
            "bspcsg: a signal handler forked this process in the middle of an operation, which \
             cannot go on here; a child must end inside the handler (os._exit)"
        );
        std::process::abort();
    }
    found
}
