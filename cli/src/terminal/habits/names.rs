//! Names that other programs have for flags, and for the frames of a file.

use std::path::Path;

/// Other names of flags.
pub(super) const SAME: &[(&str, &str)] = &[
    ("aa", "samples"),
    ("alpha", "opacity"),
    ("antialias", "samples"),
    ("as", "show"),
    ("atom-scale", "radius-scale"),
    ("axes-grid", "axes"),
    ("background-color", "background"),
    ("ball-radius", "radius"),
    ("bbox", "box"),
    ("bg", "background"),
    ("bg-color", "background"),
    ("bgcolor", "background"),
    ("bounding-box", "box"),
    ("c", "color-by"),
    ("camera-dir", "direction"),
    ("camera-direction", "direction"),
    ("camera-position", "eye"),
    ("camera-target", "look-at"),
    ("camera-up", "up"),
    ("canvas-height", "height"),
    ("canvas-width", "width"),
    ("cell", "box"),
    ("cell-edges", "box"),
    ("cell-width", "box"),
    ("center", "focus"),
    ("centre", "focus"),
    ("color-bar", "legend"),
    ("color-coding", "color-by"),
    ("color-gradient", "cmap"),
    ("color-legend", "legend"),
    ("color-scale", "cmap"),
    ("colorbar", "legend"),
    ("colormap", "cmap"),
    ("colour", "color"),
    ("colour-by", "color-by"),
    ("coordinate-tripod", "axes"),
    ("delete", "exclude"),
    ("delete-selected", "exclude"),
    ("display-style", "show"),
    ("dolly", "zoom"),
    ("draw", "show"),
    ("draw-style", "show"),
    ("drawing-method", "show"),
    ("expression", "select"),
    ("expression-select", "select"),
    ("expression-selection", "select"),
    ("eye-position", "eye"),
    ("facecolor", "background"),
    ("focal-point", "look-at"),
    ("gradient", "cmap"),
    ("hide-sel", "hide"),
    ("image-size", "size"),
    ("input-format", "format"),
    ("label-text", "label"),
    ("look-along", "direction"),
    ("magnify", "zoom"),
    ("map", "cmap"),
    ("only", "select"),
    ("out", "output"),
    ("palette", "cmap"),
    ("particle-radius", "radius"),
    ("particle-scale", "radius-scale"),
    ("pbc-box", "box"),
    ("periodic-box", "box"),
    ("projection", "camera"),
    ("ray", "size"),
    ("remove", "exclude"),
    ("rep", "show"),
    ("repeat", "replicate"),
    ("representation", "show"),
    ("resolution", "size"),
    ("scalar-bar", "legend"),
    ("scalar-field", "color-by"),
    ("scale", "radius-scale"),
    ("scalebar", "scale-bar"),
    ("sel", "select"),
    ("selection", "select"),
    ("show-axes", "axes"),
    ("show-bonds", "bonds"),
    ("show-cell", "box"),
    ("show-unit-cell", "box"),
    ("simulation-box", "box"),
    ("simulation-cell", "box"),
    ("spectrum", "color-by"),
    ("sphere-radius", "radius"),
    ("sphere-scale", "radius-scale"),
    ("supercell", "replicate"),
    ("target", "look-at"),
    ("tripod", "axes"),
    ("unit-cell", "box"),
    ("vectors", "arrows"),
    ("view-direction", "direction"),
    ("view-up", "up"),
    ("viewpoint", "view"),
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

/// Flags of one letter that other programs have, and what to type in their place.
const SAID: &[(&str, &str)] = &[
    ("-b", "--bonds draws bonds"),
    ("-f", "name the file alone; --format says what it is, and --frame which part of a trajectory"),
    ("-H", "--height PIXELS is the height, and --size WIDTHxHEIGHT both"),
    ("-c", "--color-by COLUMN colors by a column, and --color CSS all alike"),
    ("-d", "--dpi N is the resolution of texts, and --size WIDTHxHEIGHT that of the picture"),
    ("-i", "name the file alone; --frame -1 chooses a frame"),
    ("-n", "--frame -1 chooses a frame"),
    ("-r", "--replicate 2,2,1 repeats the cell, --size WIDTHxHEIGHT is the resolution, and --radius R the radius"),
    ("-t", "--transparent leaves out the background"),
    ("-v", "--view says from where; what the program does is always said, and --quiet says less"),
    ("-w", "--width PIXELS is the width, and --size WIDTHxHEIGHT both"),
    ("-W", "--width PIXELS is the width, and --size WIDTHxHEIGHT both"),
    ("-x", "--columns x,y,z names columns of a table without a header; leave it out"),
    ("-y", "-o replaces a picture that is there, and --columns names columns; leave it out"),
    ("-z", "--columns x,y,z names columns of a table without a header; leave it out"),
];

/// Words about a flag of one letter that the program does not have.
pub(super) fn said(flag: &str) -> Option<&'static str> {
    SAID.iter().find(|(other, _)| *other == flag).map(|(_, words)| *words)
}

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
