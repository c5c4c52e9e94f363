//! Pools of threads; a forked process starts its own.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::places::Places;
use crate::error::{Error, ErrorKind, Result};

/// The stack of a thread: the descent is at most 162 cells deep, with three frames each, and stolen work may
/// nest once more at each level.
const STACK_BYTES: usize = 64 << 20;

static DEFAULT_THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets the number of threads of calls that pass 0.
pub fn set_default_threads(n: usize) {
    DEFAULT_THREADS.store(n, Ordering::Relaxed);
}

/// A pool of threads that share the work of calls.
pub struct Pool {
    pub threads: ThreadPool,
    pub places: Places,
}

/// The pools of one process, by their number of threads.
struct Pools {
    process: u32,
    by_threads: BTreeMap<usize, Arc<Pool>>,
}

static POOLS: Mutex<Pools> = Mutex::new(Pools {
    process: 0,
    by_threads: BTreeMap::new(),
});

/// Returns the pool with the given number of threads, 0 for the default; starts it if there is none.
///
/// The lock is taken only with the GIL held, as Python forks: so it is never locked in a forked child.
///
/// # Errors
/// `TooMany` if the system does not start the threads.
pub fn pool(_gil: Python<'_>, threads: usize) -> Result<Arc<Pool>> {
    let threads = match threads {
        0 => DEFAULT_THREADS.load(Ordering::Relaxed),
        n => n,
    };
    let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
    pools.disown_if_forked();
    if let Some(pool) = pools.by_threads.get(&threads) {
        return Ok(Arc::clone(pool));
    }
    let pool = Arc::new(started(threads)?);
    pools.by_threads.insert(threads, Arc::clone(&pool));
    Ok(pool)
}

impl Pools {
    /// After a fork, drops the parent's pools, whose threads this process does not have.
    ///
    /// Their memory is not released, because that would wait for the threads.
    fn disown_if_forked(&mut self) {
        let process = std::process::id();
        if self.process != process {
            self.process = process;
            std::mem::forget(std::mem::take(&mut self.by_threads));
        }
    }
}

/// Starts a pool and waits until all its threads run, so that no fork happens while it starts.
fn started(threads: usize) -> Result<Pool> {
    let built = ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(STACK_BYTES)
        .build();
    let threads = built.map_err(|e| {
        let text = format!("the system could not start {threads} threads ({e}); set fewer");
        Error::new(ErrorKind::TooMany, text)
    })?;
    let places = Places::of(&threads);
    Ok(Pool { threads, places })
}
