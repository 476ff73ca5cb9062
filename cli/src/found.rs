//! What is found in the files of an input.

use std::path::PathBuf;

use pinhole::camera::Viewpoint;
use pinhole::color_by::{ColorBy, ColorKey};
use pinhole::image::color::LinearRgb;
use pinhole::light::environment::Environment;
use pinhole::scene_file::{DEFAULT_COLOR, DataSpheres};

/// The data of a scene file.
pub(super) struct FoundData {
    pub(super) spheres: DataSpheres,
    /// What colors mean, if a column gives them.
    pub(super) color_key: Option<ColorKey>,
    /// The color of spheres without one.
    pub(super) color: LinearRgb,
    pub(super) notes: Vec<String>,
    pub(super) has_atoms: bool,
}

/// What was found beside the spheres.
pub(super) struct Found {
    pub(super) notes: Vec<String>,
    pub(super) files: Vec<PathBuf>,
    /// The image of the sky, and its path.
    pub(super) sky: Option<Environment>,
    pub(super) sky_image: Option<PathBuf>,
    pub(super) has_atoms: bool,
    /// Where the camera stands if no flag says it; `None` leaves that to the scene file.
    pub(super) facing: Option<Viewpoint>,
    pub(super) color_key: Option<ColorKey>,
    /// The colors by kind that no flag asked for.
    pub(super) kinds: Option<ColorBy>,
}

pub(super) fn default_color() -> LinearRgb {
    LinearRgb::from_srgb8(DEFAULT_COLOR)
}
