//! The Python module `bspcsg._core`: arrays in, GIL released, errors mapped, arrays out.
#![allow(
    missing_docs,
    clippy::needless_pass_by_value,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

mod arrays;
mod errors;
mod ray_tree;
mod rays;
mod run;
mod tree;

use pyo3::prelude::*;

/// Sets how many threads operations use that do not say so; 0 means one for each processor.
#[pyfunction]
fn set_threads(n: usize) {
    run::set_default_threads(n);
}

#[pymodule(gil_used = true)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CoreError", module.py().get_type::<errors::CoreError>())?;
    module.add_class::<tree::Tree>()?;
    module.add_class::<ray_tree::RayTree>()?;
    module.add_class::<rays::RayScene>()?;
    module.add_function(wrap_pyfunction!(set_threads, module)?)?;
    Ok(())
}
