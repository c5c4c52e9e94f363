//! Objects that calls change or lock: what a forked process may not go on with.

use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use pyo3::prelude::*;

use super::errors::to_python;
use crate::error::{Error, ErrorKind};

/// The calls that are inside an object, counted with the GIL held, as Python forks.
///
/// A call that another thread had not ended when the process was forked never ends in the child,
/// and may have left the object locked or half changed.
#[derive(Debug, Default)]
pub struct InUse {
    process: AtomicU32,
    calls: AtomicUsize,
}

/// A call; it ends when this is dropped, with the GIL held.
#[derive(Debug)]
pub struct Call<'a>(&'a InUse);

impl InUse {
    /// Begins a call.
    ///
    /// # Errors
    /// `Forked`.
    pub fn enter(&self, py: Python<'_>) -> PyResult<Call<'_>> {
        let process = std::process::id();
        let own = self.process.load(Ordering::Relaxed) == process;
        if !own && self.calls.load(Ordering::Relaxed) > 0 {
            let text = "another thread was using the object when the process was forked; make the \
                        object anew in the child, or fork while no thread uses it";
            return Err(to_python(py, &Error::new(ErrorKind::Forked, text)));
        }
        self.process.store(process, Ordering::Relaxed);
        self.calls.fetch_add(1, Ordering::Relaxed);
        Ok(Call(self))
    }
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        self.0.calls.fetch_sub(1, Ordering::Relaxed);
    }
}
