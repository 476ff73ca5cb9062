//! Colors of data that gives none, but says of what kinds its spheres are.

use pinhole::color_by::ColorBy;
use pinhole::load::Loaded;

use super::data::DataOptions;

/// The column that colors the spheres of a data file where neither the file nor a flag does; see [`ColorBy::of_kinds`].
pub(super) fn by_kind(loaded: &Loaded, options: &DataOptions) -> Option<ColorBy> {
    ColorBy::of_kinds(loaded).filter(|_| options.color.is_none())
}

/// The note about such colors.
pub(super) fn note(by: &ColorBy) -> String {
    let column = &by.column;
    format!(
        "there are no colors; the spheres are colored by {column}; --color CSS gives all one color"
    )
}
