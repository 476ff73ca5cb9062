//! The compiled half of the Python package `pinhole`: arrays, files, rendering and verification. The other half, in
//! `python/pinhole/`, checks arguments and writes settings as the text of a scene file.

#![allow(
    clippy::needless_pass_by_value,
    reason = "functions of Python own what PyO3 makes of their arguments"
)]

use pyo3::prelude::*;

mod arrays;
mod certificate;
mod device;
mod fault;
mod files;
mod image;
mod look;
mod render;
mod scene;
mod spheres;
mod worker;

/// Panics during work, so that tests can check the exception.
#[pyfunction]
fn panic_for_tests(py: Python<'_>, index: usize) -> PyResult<u8> {
    Ok(worker::run(py, None, move |_| Ok([1, 2, 3][index]))?)
}

/// The compiled half of pinhole. Use the package `pinhole` instead.
#[pymodule]
fn _pinhole(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // The message of a panic becomes an exception.
    std::panic::set_hook(Box::new(|_| {}));
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<certificate::CertificateData>()?;
    module.add_class::<files::FileData>()?;
    module.add_class::<image::Picture>()?;
    module.add_class::<files::FrameKeys>()?;
    module.add_class::<spheres::SphereData>()?;
    module.add_function(wrap_pyfunction!(device::adapters, module)?)?;
    module.add_function(wrap_pyfunction!(device::use_adapter, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::srgb_of_names, module)?)?;
    module.add_function(wrap_pyfunction!(image::png_of, module)?)?;
    module.add_function(wrap_pyfunction!(worker::wait_for_threads, module)?)?;
    module.add_function(wrap_pyfunction!(panic_for_tests, module)?)?;
    Ok(())
}
