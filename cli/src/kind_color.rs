//! Colors of data that gives none, but says of what kinds its spheres are.

use pinhole::color_by::ColorBy;
use pinhole::load::Loaded;

use super::data::DataOptions;

/// Names of the columns of kinds, of which the first is taken.
const KINDS: [&str; 2] = ["species", "type"];

/// More kinds than this cannot be told apart by color.
const MOST_KINDS: usize = 32;

/// The column that colors the spheres of a data file where neither the file nor a flag does: that of their kinds, if there
/// is one, it is text, and there are some to tell apart.
pub(super) fn by_kind(loaded: &Loaded, options: &DataOptions) -> Option<ColorBy> {
    if loaded.colors.is_some() || options.color.is_some() {
        return None;
    }
    let are_kinds = |name: &&str| {
        loaded.labels(name).is_some_and(|labels| (2..=MOST_KINDS).contains(&labels.names.len()))
    };
    KINDS.into_iter().find(are_kinds).map(ColorBy::column)
}

/// The note about such colors.
pub(super) fn note(by: &ColorBy) -> String {
    let column = &by.column;
    format!(
        "there are no colors; the spheres are colored by {column}; --color CSS gives all one color"
    )
}
