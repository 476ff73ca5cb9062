//! The compiled half of the Python package `pinhole`: arrays, files, rendering and verification. The other half, in
//! `python/pinhole/`, checks arguments and writes settings as the text of a scene file.

#![allow(clippy::needless_pass_by_value, reason = "functions of Python own what PyO3 makes of their arguments")]

use pinhole_figure::settings::flags::{FLAGS, Flag, Group};
use pyo3::prelude::*;

mod arrays;
mod certificate;
mod cones;
mod derived;
mod device;
mod fault;
mod files;
mod given;
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

/// The keys of a table of a scene file; of the file itself for an empty text.
#[pyfunction]
fn keys_of(table: &str) -> Vec<&'static str> {
    pinhole_figure::settings::keys_of(table)
}

/// The keys at the top of a scene file that apply to its data.
#[pyfunction]
fn keys_of_data() -> Vec<&'static str> {
    pinhole_figure::scene_file::KEYS_OF_DATA.to_vec()
}

/// The flags that give a key of a table at the top of a scene file: their names, the table and the key.
#[pyfunction]
fn short_forms() -> Vec<(String, &'static str, &'static str)> {
    let groups = [Group::Look, Group::Output, Group::Annotation];
    let flags = FLAGS.iter().filter(|flag| groups.contains(&flag.group));
    let form = |flag: &'static Flag| {
        let (table, key) = flag.key.split_once('.').filter(|(_, key)| !key.contains('.'))?;
        Some((flag.name().replace('-', "_"), table, key))
    };
    flags.filter_map(form).collect()
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
    module.add_class::<files::JoinedFrames>()?;
    module.add_class::<spheres::SphereData>()?;
    module.add_function(wrap_pyfunction!(given::of_arrays, module)?)?;
    module.add_function(wrap_pyfunction!(derived::restyled, module)?)?;
    module.add_function(wrap_pyfunction!(derived::taken, module)?)?;
    module.add_function(wrap_pyfunction!(derived::mask, module)?)?;
    module.add_function(wrap_pyfunction!(derived::column_of, module)?)?;
    module.add_function(wrap_pyfunction!(device::adapters, module)?)?;
    module.add_function(wrap_pyfunction!(device::use_adapter, module)?)?;
    module.add_function(wrap_pyfunction!(spheres::check_view, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::is_color_map, module)?)?;
    module.add_function(wrap_pyfunction!(arrays::srgb_of_names, module)?)?;
    module.add_function(wrap_pyfunction!(image::png_of, module)?)?;
    module.add_function(wrap_pyfunction!(worker::wait_for_threads, module)?)?;
    module.add_function(wrap_pyfunction!(keys_of, module)?)?;
    module.add_function(wrap_pyfunction!(keys_of_data, module)?)?;
    module.add_function(wrap_pyfunction!(short_forms, module)?)?;
    module.add_function(wrap_pyfunction!(panic_for_tests, module)?)?;
    Ok(())
}
