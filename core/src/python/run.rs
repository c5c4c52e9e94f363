//! Long work off the interpreter: the GIL released, signals polled, a pool with deep stacks.

use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::errors::to_python;
use crate::error::{Error, Result};

/// Work on fewer elements than this is done at once, on the caller's thread.
pub const SMALL: usize = 2000;

/// The descent is at most 162 cells deep, three frames each; stolen work nests once more per level.
const STACK: usize = 64 << 20;

const POLL: Duration = Duration::from_millis(50);

static DEFAULT_THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets the number of threads for calls that pass 0.
pub fn set_default_threads(n: usize) {
    DEFAULT_THREADS.store(n, Ordering::Relaxed);
}

fn pool(threads: usize) -> Result<Arc<ThreadPool>> {
    static POOLS: OnceLock<Mutex<HashMap<usize, Arc<ThreadPool>>>> = OnceLock::new();
    let threads = if threads == 0 {
        DEFAULT_THREADS.load(Ordering::Relaxed)
    } else {
        threads
    };
    let pools = POOLS.get_or_init(Mutex::default);
    let mut pools = pools
        .lock()
        .map_err(|_| Error::internal("the table of pools is poisoned"))?;
    if let Some(pool) = pools.get(&threads) {
        return Ok(Arc::clone(pool));
    }
    let built = ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK)
        .build();
    let pool = Arc::new(built.map_err(|e| Error::internal(e.to_string()))?);
    pools.insert(threads, Arc::clone(&pool));
    Ok(pool)
}

/// Runs work with the GIL released; an interrupt sets the flag that the work watches.
///
/// # Errors
/// What the work returns, as a Python exception; `KeyboardInterrupt` and what signal handlers raise.
pub fn run<T: Send>(
    py: Python<'_>,
    threads: usize,
    size: usize,
    work: impl FnOnce(&AtomicBool) -> Result<T> + Send,
) -> PyResult<T> {
    let cancel = AtomicBool::new(false);
    let mut raised = None;
    let result = py.detach(|| {
        if size < SMALL {
            return work(&cancel);
        }
        let pool = pool(threads)?;
        let (done, wait) = mpsc::channel();
        let flag = &cancel;
        let raised = &mut raised;
        pool.in_place_scope(|scope| {
            scope.spawn(move |_| {
                let _ = done.send(work(flag));
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
                            flag.store(true, Ordering::Relaxed);
                        }
                    }
                }
            }
        })
    });
    match (result, raised) {
        (_, Some(exception)) => Err(exception),
        (Ok(value), None) => Ok(value),
        (Err(error), None) => Err(to_python(py, &error)),
    }
}

/// The exception of a signal that has arrived, such as `KeyboardInterrupt`.
#[expect(
    clippy::redundant_closure_for_method_calls,
    reason = "the method is bound to one lifetime, `attach` wants any"
)]
fn pending_signal() -> PyResult<()> {
    Python::attach(|py| py.check_signals())
}
