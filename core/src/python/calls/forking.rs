//! Handles forks of the process around work that must not be interrupted by them.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use super::ending::forget_threads;

/// Registers [`settle`] to be called before each fork, and [`begin_anew`] to be called in the child process,
/// if the system has forks.
///
/// # Errors
/// The exceptions of `os.register_at_fork`.
pub fn watch(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let os = module.py().import("os")?;
    if let Some(register) = os.getattr_opt("register_at_fork")? {
        let settle = wrap_pyfunction!(settle, module)?;
        let begin_anew = wrap_pyfunction!(begin_anew, module)?;
        let options = [("before", settle), ("after_in_child", begin_anew)];
        register.call((), Some(&options.into_py_dict(module.py())?))?;
    }
    Ok(())
}

/// Resets, in a forked child, the state that depends on threads of the parent, which the child does not have.
#[pyfunction]
fn begin_anew() {
    forget_threads();
}

/// Completes the one-time setup that the first call with arrays makes.
///
/// If another thread were in the middle of this setup during the fork, the child would wait for that thread
/// for ever.
#[pyfunction]
fn settle(py: Python<'_>) -> PyResult<()> {
    if py.import("sys")?.getattr("modules")?.contains("numpy")? {
        PyArray1::from_vec(py, vec![0.0]).try_readonly()?;
    }
    Ok(())
}
