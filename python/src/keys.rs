//! What colours mean, as Python sees it.

use pinhole::color_by::{ColorKey, KeyKind};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A dict: `title`, the name of the column; and either `range`, `log` and the table `colors`, three bytes of sRGB for
/// each colour from the low end on, or `categories`, names with their colours.
pub(crate) fn in_python(py: Python<'_>, key: &ColorKey) -> PyResult<Py<PyAny>> {
    let found = PyDict::new(py);
    found.set_item("title", &key.title)?;
    match &key.kind {
        KeyKind::Scale(scale) => {
            let [low, high] = scale.scale().range();
            found.set_item("range", (low, high))?;
            found.set_item("log", scale.scale().is_log())?;
            found.set_item("colors", scale.colors().as_flattened())?;
        }
        KeyKind::Categories(all) => {
            let named = all.iter().map(|one| (one.name.clone(), <(u8, u8, u8)>::from(one.color)));
            let named: Vec<_> = named.collect();
            found.set_item("categories", named)?;
        }
        _ => {}
    }
    Ok(found.into_any().unbind())
}
