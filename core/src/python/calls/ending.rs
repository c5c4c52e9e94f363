//! The end of the interpreter: threads that are inside the core then stay there.
//!
//! `CPython` before 3.14 ends a thread that takes the GIL of an ending interpreter by unwinding its
//! stack, and a stack with Rust's frames aborts the process. Only daemon threads live so long.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// True from the moment at which the interpreter begins to end.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// The number of threads that wait for the GIL and were not told that the interpreter ends.
static RETURNING: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// True for the thread that ends the interpreter.
    static ENDS_IT: Cell<bool> = const { Cell::new(false) };
}

/// Has Python call [`end`] when it begins to end.
///
/// # Errors
/// What Python raises.
pub fn watch(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let atexit = module.py().import("atexit")?;
    atexit.call_method1("register", (wrap_pyfunction!(end, module)?,))?;
    Ok(())
}

/// Keeps other threads inside the core from now on, and waits for those on their way out.
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

/// Forgets the threads that a forked process does not have.
pub fn forget_threads() {
    RETURNING.store(0, SeqCst);
}

/// Does some work with the GIL released.
pub fn detached<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    let result = py.detach(|| {
        let result = work();
        announce_return();
        result
    });
    RETURNING.fetch_sub(1, SeqCst);
    result
}

/// Does some work with the GIL taken, in a thread that has released it.
pub fn attached<T>(work: impl FnOnce(Python<'_>) -> T) -> T {
    announce_return();
    Python::attach(|py| {
        RETURNING.fetch_sub(1, SeqCst);
        work(py)
    })
}

/// Counts this thread as one that waits for the GIL; does not return if the interpreter ends.
fn announce_return() {
    RETURNING.fetch_add(1, SeqCst);
    if IS_ENDING.load(SeqCst) && !ENDS_IT.get() {
        RETURNING.fetch_sub(1, SeqCst);
        loop {
            thread::park();
        }
    }
}
