//! Colours as Python sees them: their names, and what they mean.

use pyo3::prelude::*;
use pyo3::types::PyDict;

use pinhole::LinearRgb;
use pinhole::color_by::{ColorKey, KeyKind};

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

/// The colours of CSS with these names, three bytes of sRGB for each; None if any of the names is not that of a colour.
#[pyfunction]
pub(crate) fn srgb_of_names(names: Vec<String>) -> Option<Vec<u8>> {
    let colors = names.iter().map(|name| LinearRgb::from_css(name).ok().map(LinearRgb::to_srgb8));
    colors.collect::<Option<Vec<_>>>().map(|colors| colors.into_flattened())
}
