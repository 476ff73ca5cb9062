//! Names that other programs have for flags, and for the frames of a file.

use std::path::Path;

/// Other names of flags.
pub(super) const SAME: &[(&str, &str)] = &[
    ("aa", "samples"),
    ("alpha", "opacity"),
    ("antialias", "samples"),
    ("bg", "background"),
    ("camera-dir", "direction"),
    ("camera-direction", "direction"),
    ("canvas-height", "height"),
    ("canvas-width", "width"),
    ("cell", "box"),
    ("cell-width", "box"),
    ("center", "focus"),
    ("centre", "focus"),
    ("color-legend", "legend"),
    ("colorbar", "legend"),
    ("colormap", "cmap"),
    ("colour", "color"),
    ("colour-by", "color-by"),
    ("coordinate-tripod", "axes"),
    ("delete", "exclude"),
    ("delete-selected", "exclude"),
    ("draw-style", "show"),
    ("drawing-method", "show"),
    ("expression", "select"),
    ("look-along", "direction"),
    ("map", "cmap"),
    ("only", "select"),
    ("out", "output"),
    ("particle-radius", "radius"),
    ("remove", "exclude"),
    ("rep", "show"),
    ("repeat", "replicate"),
    ("representation", "show"),
    ("resolution", "size"),
    ("scale", "radius-scale"),
    ("sel", "select"),
    ("selection", "select"),
    ("show-axes", "axes"),
    ("show-bonds", "bonds"),
    ("show-cell", "box"),
    ("show-unit-cell", "box"),
    ("supercell", "replicate"),
    ("tripod", "axes"),
    ("unit-cell", "box"),
    ("vectors", "arrows"),
];

/// Flags that are short for a value of another one.
pub(super) const SHORT: &[(&str, &str)] = &[
    ("clip", "select"),
    ("every", "frames"),
    ("exclude", "select"),
    ("height", "size"),
    ("slice", "select"),
    ("title", "label"),
    ("vmax", "range"),
    ("vmin", "range"),
    ("width", "size"),
];

/// The name of a flag for a name that it may have elsewhere, or the same name.
pub(super) fn same(name: &str) -> &str {
    SAME.iter().find(|(other, _)| *other == name).map_or(name, |(_, name)| name)
}

/// A file with frames after an `@`, as ASE writes them: `a.xyz@-1` is `a.xyz --frame=-1`, and `a.xyz@:` all frames. Returns the
/// file, the flag and its value.
pub(super) fn frames_of(word: &str) -> Option<(&str, &'static str, &str)> {
    let (file, frames) = word.rsplit_once('@')?;
    let is_of_frames = !frames.is_empty() && frames.bytes().all(|byte| byte.is_ascii_digit() || b":-".contains(&byte));
    let flag = if frames.contains(':') { "frames" } else { "frame" };
    (is_of_frames && !Path::new(word).exists() && Path::new(file).is_file()).then_some((file, flag, frames))
}
