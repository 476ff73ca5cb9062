//! The input: from a path to a scene with its camera and settings.

use std::path::PathBuf;
use std::sync::Arc;

use super::bricks::BrickFile;
use super::report::Report;
pub(super) use crate::input::look::{FramedScene, Look};
#[cfg(feature = "gpu")]
pub(super) use crate::input::source::OpenFrames;
pub(super) use crate::input::source::{FoundFrames, Source, check_flags, default_color};
pub(super) use crate::read_file::{extension, read};
use pinhole::annotate::AnnotationPlan;
use pinhole::camera::film::Film;
use pinhole::camera::{Camera, CameraParameters, View};
use pinhole::color_by::ColorKey;
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::Encoding;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole::scene::sphere::Sphere;
use pinhole::scene_file::Data;

pub(super) mod contents;
mod load;
mod look;
mod source;

/// Everything that a render needs from its input.
pub(super) struct Input {
    pub(super) scene: Arc<Scene>,
    /// The camera; for a stereo camera, the view from the middle between the eyes.
    pub(super) camera: Box<dyn Camera>,
    /// The left and the right eye of a stereo camera.
    pub(super) eyes: Option<[Box<dyn Camera>; 2]>,
    pub(super) film: Film,
    pub(super) settings: RenderSettings,
    pub(super) encoding: Encoding,
    /// What colors mean, if a column of the data gives them.
    pub(super) color_key: Option<ColorKey>,
    /// What the scene file draws over the picture.
    pub(super) annotations: AnnotationPlan,
    /// Where the size of the picture comes from, for messages: a flag or a file.
    pub(super) size_from: String,
    pub(super) notes: Vec<String>,
    /// The file of bricks of which the scene has only the outermost spheres.
    pub(super) bricks: Option<Arc<BrickFile>>,
    /// The color of spheres without one.
    pub(super) color: LinearRgb,
    pub(super) files: Vec<PathBuf>,
    /// What the program says about the picture.
    pub(super) report: Report,
    /// The camera, with its position.
    pub(super) parameters: CameraParameters,
    /// The data with its keys and the flags about it; its path is as the program found it.
    pub(super) data: Option<Data>,
    /// The spheres of a scene file itself.
    pub(super) own_spheres: Vec<Sphere>,
    pub(super) sky_image: Option<PathBuf>,
}

impl Input {
    /// Returns the view of the camera, or of the middle between two eyes.
    pub(super) fn view(&self) -> View<'_> {
        View::new(self.camera.as_ref(), self.film)
    }
}
