//! Objects that calls change or lock, which a forked process may not use if a call was interrupted.

use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

use pyo3::prelude::*;

use super::errors::to_python;
use crate::error::{Error, ErrorKind};

/// The number of calls that are using an object. It changes only with the GIL held, which Python also holds
/// while it forks.
///
/// A call of another thread that was running when the process was forked never ends in the child, and may
/// have left the object locked or half changed.
#[derive(Debug, Default)]
pub struct InUse {
    process: AtomicU32,
    calls: AtomicUsize,
}

/// A call that uses an object; it ends when this value is dropped, with the GIL held.
#[derive(Debug)]
pub struct Call<'a>(&'a InUse);

impl InUse {
    /// Counts a call that begins to use the object.
    ///
    /// # Errors
    /// `Forked` if another thread was using the object when the process was forked.
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
