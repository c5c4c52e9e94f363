//! The Python module `bspcsg._core`: arrays in, GIL released, errors mapped, arrays out.
#![allow(
    missing_docs,
    clippy::needless_pass_by_value,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss
)]

mod arrays;
mod calls;
mod embedding;
mod fragments;
mod hulls;
mod hyperplanes;
mod numbers;
mod rays;
mod sets;
mod surfaces;
mod tree;

use numpy::{PyArray1, PyArrayMethods};
use pyo3::panic::PanicException;
use pyo3::prelude::*;

use self::calls::{ending, errors, forking, pool, run};
use self::rays::scene::RayScene;
use self::rays::tree::RayTree;
use self::sets::objects::ObjectTree;
use crate::error::{panics, Error};
use crate::mesh::grid::Pitch;

/// Set the number of threads for operations called without a number of threads; 0 means one for each
/// processor.
#[pyfunction]
fn set_threads(n: usize) {
    pool::set_default_threads(n);
}

/// Return the pitch (the exponent of the lattice step) that suits coordinates of at most `largest` in
/// magnitude that extend over `extent`.
#[pyfunction]
fn suited_pitch(py: Python<'_>, largest: f64, extent: f64) -> PyResult<i64> {
    run::here(py, || Ok(Pitch::suited(largest, extent)?.exponent()))
}

/// Look up numpy's functions, which otherwise the first call with an array would do.
///
/// This runs while modules are imported, because signals are not handled then; an interrupt during the
/// look-up would cause a panic.
#[pyfunction]
fn find_numpy(py: Python<'_>) {
    let _ = PyArray1::<f64>::zeros(py, 0, false).readonly();
}

/// Fail like a defect, for tests of how defects are reported.
#[pyfunction]
fn fail_on_purpose(py: Python<'_>, panic: bool, size: usize) -> PyResult<()> {
    run::run(py, 0, size, || {
        assert!(!panic, "a panic on purpose");
        Err(Error::internal("a failure on purpose"))
    })
}

/// Return the largest number of bits of a half-space's normal in a dimension.
#[pyfunction]
fn normal_bits(dimension: usize) -> u32 {
    match dimension {
        1 => 1,
        2 => crate::arith::bounds::LINE_NORMAL_BITS,
        _ => crate::arith::bounds::HALF_SPACE_NORMAL_BITS,
    }
}

#[pymodule(gil_used = true)]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    panics::record_panics();
    forking::watch(module)?;
    ending::watch(module)?;
    module.add("CoreError", module.py().get_type::<errors::CoreError>())?;
    let panic = module.py().get_type::<PanicException>();
    module.add("PanicException", panic)?;
    module.add_class::<tree::Tree>()?;
    module.add_class::<fragments::PyFragmentTree>()?;
    module.add_class::<ObjectTree>()?;
    module.add_class::<RayTree>()?;
    module.add_class::<RayScene>()?;
    module.add_function(wrap_pyfunction!(embedding::mesh_faults, module)?)?;
    module.add_function(wrap_pyfunction!(embedding::mesh_moved, module)?)?;
    module.add_function(wrap_pyfunction!(embedding::mesh_in_single, module)?)?;
    module.add_function(wrap_pyfunction!(hulls::hull_mesh, module)?)?;
    module.add_function(wrap_pyfunction!(set_threads, module)?)?;
    module.add_function(wrap_pyfunction!(run::watch, module)?)?;
    module.add_function(wrap_pyfunction!(find_numpy, module)?)?;
    module.add_function(wrap_pyfunction!(normal_bits, module)?)?;
    module.add_function(wrap_pyfunction!(fail_on_purpose, module)?)?;
    module.add_function(wrap_pyfunction!(suited_pitch, module)?)?;
    module.add_function(wrap_pyfunction!(numbers::numbers_in_rows, module)?)?;
    module.add_function(wrap_pyfunction!(numbers::whole_numbers_in_rows, module)?)?;
    module.add_function(wrap_pyfunction!(numbers::are_words, module)?)?;
    module.add_function(wrap_pyfunction!(numbers::are_triangles, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::welded_points, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::outline_triangles, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::surfaces_of, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::mesh_counts, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::mesh_measures, module)?)?;
    module.add_function(wrap_pyfunction!(surfaces::mesh_moments, module)?)?;
    Ok(())
}
