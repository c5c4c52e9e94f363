//! Work that must not be half done when the process is forked.

use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;

use super::ending::forget_threads;

/// Has Python call [`settle`] before each fork and [`begin_anew`] in the child, if there are forks.
///
/// # Errors
/// What Python raises.
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

/// Forgets the other threads of the process that was forked.
#[pyfunction]
fn begin_anew() {
    forget_threads();
}

/// Completes what the first call that takes arrays sets up once for the process.
///
/// Another thread may be at it; a child that was forked meanwhile would wait for it for ever.
#[pyfunction]
fn settle(py: Python<'_>) -> PyResult<()> {
    if py.import("sys")?.getattr("modules")?.contains("numpy")? {
        PyArray1::from_vec(py, vec![0.0]).try_readonly()?;
    }
    Ok(())
}
