//! Runs calls of the core: releases the GIL, polls signals, catches panics.

use std::cell::{Cell, RefCell};
use std::sync::{mpsc, Arc};

use pyo3::prelude::*;

use super::ending::{attached, detached};
use super::errors::to_python;
use super::pool::{pool, Pool};
use crate::error::panics::caught;
use crate::error::{Error, Result};
use crate::interrupt::{Call, CallerHooks, Share, Task, ASK_EVERY};

/// A call with fewer array elements than this begins on the caller's thread. It uses the thread pool only for
/// steps that are long enough to gain from it.
pub const MIN_ELEMENTS_FOR_POOL: usize = 1 << 13;

/// The functions by which a call on the caller's thread checks for signals, and runs a part of its work in a
/// thread pool.
const HOOKS: CallerHooks = CallerHooks {
    wants_to_stop: signal_raised,
    hand_over,
};

thread_local! {
    /// The number of threads that this thread's call asked for, and the thread pool that does parts of its
    /// work.
    static HELPERS: RefCell<(usize, Option<Arc<Pool>>)> = const { RefCell::new((0, None)) };

    /// The exception that a signal handler raised during a call of this thread.
    static RAISED: Cell<Option<PyErr>> = const { Cell::new(None) };

    /// The Python function that is called regularly while calls of this thread run.
    static WATCHER: RefCell<Option<Py<PyAny>>> = const { RefCell::new(None) };
}

/// Registers a function that is called about twenty times a second while calls of this thread run, or None;
/// an exception of the function ends the call. Returns the function that was registered before.
#[pyfunction]
pub fn watch(watcher: Option<Py<PyAny>>) -> Option<Py<PyAny>> {
    WATCHER.replace(watcher)
}

fn tell_watcher(py: Python<'_>) -> PyResult<()> {
    let watcher = WATCHER.with_borrow(|w| w.as_ref().map(|found| found.clone_ref(py)));
    watcher.map_or(Ok(()), |found| found.call0(py).map(drop))
}

/// Runs `work` with the GIL released; an interrupt ends it at its next poll.
///
/// # Errors
/// Errors of the work as Python exceptions; a panic as an internal error; `KeyboardInterrupt` and exceptions
/// of signal handlers.
pub fn run<T: Send>(
    py: Python<'_>,
    threads: usize,
    size: usize,
    work: impl FnOnce() -> Result<T> + Send,
) -> PyResult<T> {
    RAISED.set(None);
    let call = Call::new();
    let result = if size < MIN_ELEMENTS_FOR_POOL {
        let before = HELPERS.replace((threads, None));
        let result = detached(py, || call.run_here(HOOKS, work));
        HELPERS.set(before);
        result
    } else {
        let pool = pool(py, threads).map_err(|e| to_python(py, &e))?;
        detached(py, || shared(&pool, &call, work))
    };
    match RAISED.take() {
        Some(exception) => Err(exception),
        None => result.map_err(|error| to_python(py, &error)),
    }
}

/// Runs short work at once, without releasing the GIL.
///
/// # Errors
/// As for [`run`].
pub fn here<T>(py: Python<'_>, work: impl FnOnce() -> Result<T>) -> PyResult<T> {
    caught(work).map_err(|error| to_python(py, &error))
}

/// Runs the work of a call in a pool and waits for it.
fn shared<T: Send>(pool: &Pool, call: &Call, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    let none = || Err(Error::internal("the work ended without an answer"));
    awaited(pool, call.task(), || call.run(work)).unwrap_or_else(none)
}

/// Runs a part of a call's work in the call's thread pool and waits for it.
fn hand_over(task: Task, share: Share<'_>) {
    if let Some(pool) = helpers() {
        awaited(&pool, task, || task.run(share));
    }
}

/// Returns the thread pool for the call of this thread; `None` if the pool has only one thread, or if the
/// system cannot start the threads.
fn helpers() -> Option<Arc<Pool>> {
    HELPERS.with_borrow_mut(|(threads, found)| {
        let ask = || attached(|py| pool(py, *threads).ok());
        *found = found.take().or_else(ask);
        let several = |pool: &&Arc<Pool>| pool.threads.current_num_threads() > 1;
        found.as_ref().filter(several).map(Arc::clone)
    })
}

/// Runs some work of a call in a pool and waits for it; stops it if a signal handler raises. `None` if the
/// work panicked.
fn awaited<T: Send>(pool: &Pool, task: Task, work: impl FnOnce() -> T + Send) -> Option<T> {
    let (done, wait) = mpsc::channel();
    let mut placed = pool.places.hold();
    pool.threads.in_place_scope(|scope| {
        scope.spawn(move |_| {
            let _ = done.send(work());
        });
        loop {
            match wait.recv_timeout(ASK_EVERY) {
                Ok(value) => return Some(value),
                Err(mpsc::RecvTimeoutError::Disconnected) => return None,
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    placed = None;
                    if signal_raised() {
                        task.stop();
                    }
                }
            }
        }
    })
}

/// Returns true if a signal handler or the watcher has raised an exception, such as `KeyboardInterrupt`.
///
/// A handler may fork. The child does not have the threads of the pool, and the work borrows from this
/// stack, so the child can neither go on nor return: it aborts with a message instead of hanging.
fn signal_raised() -> bool {
    let process = std::process::id();
    let raised = attached(|py| py.check_signals().and_then(|()| tell_watcher(py)).err());
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
