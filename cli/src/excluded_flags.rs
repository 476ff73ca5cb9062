//! Arguments that exclude others of `certify` and `verify`.

/// Arguments of `verify` that say nothing about a picture that was written.
pub(super) fn not_of_pictures() -> impl IntoIterator<Item = &'static str> {
    RENDERING.into_iter().chain(CAMERA).filter(|id| *id != "path").chain(["report"])
}

/// Arguments that describe the camera and the size of the picture.
pub(super) const CAMERA: [&str; 21] = [
    "size",
    "camera",
    "eye",
    "look_at",
    "direction",
    "view",
    "turn",
    "margin",
    "zoom",
    "up",
    "fov",
    "distance",
    "half_extent",
    "aperture_radius",
    "f_stop",
    "focal_length",
    "focus_distance",
    "focus_on",
    "angle",
    "separation",
    "convergence",
];

/// The other arguments of `verify` that describe the picture and the device. A recording contains both, so `--replay`
/// excludes them, as it does those of the camera.
pub(super) const RENDERING: [&str; 13] = [
    "path",
    "format",
    "radius",
    "color",
    "frame",
    "topology",
    "columns",
    "adapter",
    "limits",
    "accel",
    "paths",
    "save",
    "tile_seed",
];
