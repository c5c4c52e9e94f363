//! Pools of threads, made anew in a process that was forked.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::places::Places;
use crate::error::{Error, ErrorKind, Result};

/// The descent is at most 162 cells deep, three frames each; stolen work nests once more per level.
const STACK_BYTES: usize = 64 << 20;

static DEFAULT_THREADS: AtomicUsize = AtomicUsize::new(0);

/// Sets the number of threads for calls that pass 0.
pub fn set_default_threads(n: usize) {
    DEFAULT_THREADS.store(n, Ordering::Relaxed);
}

/// Threads that share the work of calls.
pub struct Pool {
    pub threads: ThreadPool,
    pub places: Places,
}

/// The pools of one process, by the number of threads that was asked for.
struct Pools {
    process: u32,
    by_threads: BTreeMap<usize, Arc<Pool>>,
}

static POOLS: Mutex<Pools> = Mutex::new(Pools {
    process: 0,
    by_threads: BTreeMap::new(),
});

/// The pool of so many threads, 0 for the default.
///
/// The lock is taken with the GIL held only, as Python forks: no child finds it locked.
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
    /// Forgets the pools of the process that this one was forked from: their threads are not here.
    ///
    /// They are not dropped, which would wait for the threads.
    fn disown_if_forked(&mut self) {
        let process = std::process::id();
        if self.process != process {
            self.process = process;
            std::mem::forget(std::mem::take(&mut self.by_threads));
        }
    }
}

/// A pool of which all threads run: none is forked away while it starts.
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
