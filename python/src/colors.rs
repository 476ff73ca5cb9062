//! Names of colours.

use pinhole::LinearRgb;
use pyo3::prelude::*;

/// The colours of CSS with these names, three bytes of sRGB for each; None if any of the names is not that of a colour.
#[pyfunction]
pub(crate) fn srgb_of_names(names: Vec<String>) -> Option<Vec<u8>> {
    let colors = names.iter().map(|name| LinearRgb::from_css(name).ok().map(LinearRgb::to_srgb8));
    colors.collect::<Option<Vec<_>>>().map(|colors| colors.into_flattened())
}
