//! Converts core errors to Python exceptions with the attributes `code`, `where` and `message`.

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Error, ErrorKind};

create_exception!(
    bspcsg._core,
    CoreError,
    PyException,
    "An error of the core: code, where, message."
);

/// Converts a core error to a Python exception; a cancelled call becomes `KeyboardInterrupt`.
pub fn to_python(py: Python<'_>, error: &Error) -> PyErr {
    if error.kind() == ErrorKind::Cancelled {
        return PyKeyboardInterrupt::new_err(());
    }
    let exception = CoreError::new_err(error.message().to_owned());
    let value = exception.value(py);
    let set = value
        .setattr("code", error.kind().code())
        .and_then(|()| value.setattr("where", error.place().to_vec()))
        .and_then(|()| value.setattr("message", error.message()));
    match set {
        Ok(()) => exception,
        Err(failed) => failed,
    }
}

/// Adds the name of the call and its inputs to the exception of an internal error, so that the error can be
/// reported.
pub fn with_report<'py>(
    py: Python<'py>,
    error: PyErr,
    call: &str,
    inputs: impl FnOnce() -> PyResult<Bound<'py, PyDict>>,
) -> PyErr {
    let value = error.value(py);
    let code = value.getattr("code").and_then(|c| c.extract::<String>());
    if code.is_ok_and(|code| code == ErrorKind::Internal.code()) {
        // If that fails, the error is still the one to raise.
        let _ = value
            .setattr("call", call)
            .and_then(|()| value.setattr("inputs", inputs()?));
    }
    error
}
