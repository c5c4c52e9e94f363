//! Handles the end of the Python interpreter: threads that are then inside the core wait there for ever.
//!
//! `CPython` before 3.14 unwinds the stack of a thread that takes the GIL while the interpreter ends; if
//! frames of Rust are on this stack, the process aborts. Only daemon threads are still alive at that time.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// True as soon as the interpreter begins to end.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// The number of threads that wait for the GIL and will get it before the interpreter ends.
static RETURNING: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// True for the thread that ends the Python interpreter; other threads must not leave the core after
    /// that.
    static ENDS_IT: Cell<bool> = const { Cell::new(false) };
}

/// Registers [`end`] to be called when the interpreter begins to end.
///
/// # Errors
/// The exceptions of `atexit.register`.
pub fn watch(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let atexit = module.py().import("atexit")?;
    atexit.call_method1("register", (wrap_pyfunction!(end, module)?,))?;
    Ok(())
}

/// Marks the interpreter as ending, so that no other thread leaves the core, and waits for the threads that
/// are just leaving it.
#[pyfunction]
fn end(py: Python<'_>) {
    ENDS_IT.set(true);
    IS_ENDING.store(true, SeqCst);
    py.detach(|| {
        while RETURNING.load(SeqCst) > 0 {
            thread::sleep(Duration::from_millis(1));
        }
    });
}

/// Resets the count of waiting threads in a forked process, which does not have these threads.
pub fn forget_threads() {
    RETURNING.store(0, SeqCst);
}

/// Runs `work` with the GIL released.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    let result = py.detach(|| {
        let result = work();
        announce_return();
        result
    });
    RETURNING.fetch_sub(1, SeqCst);
    result
}

/// Runs `work` with the GIL, in a thread that has released it.
pub fn attached<T>(work: impl FnOnce(Python<'_>) -> T) -> T {
    announce_return();
    Python::attach(|py| {
        RETURNING.fetch_sub(1, SeqCst);
        work(py)
    })
}

/// Counts this thread as waiting for the GIL; never returns if the interpreter is ending.
fn announce_return() {
    RETURNING.fetch_add(1, SeqCst);
    if IS_ENDING.load(SeqCst) && !ENDS_IT.get() {
        RETURNING.fetch_sub(1, SeqCst);
        loop {
            thread::park();
        }
    }
}
