//! The input: from a path to a scene with its camera and settings.

use std::path::PathBuf;
use std::sync::Arc;

use crate::bricks::BrickFile;
pub(crate) use crate::input::look::{FramedScene, Look};
pub(crate) use crate::input::read_file::{extension, read};
#[cfg(feature = "gpu")]
pub(crate) use crate::input::source::OpenFrames;
pub(crate) use crate::input::source::{FoundFrames, Source, default_color};
use crate::output::report::Report;
use pinhole::camera::film::Film;
use pinhole::camera::{Camera, CameraParameters, View};
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::Encoding;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;
use pinhole_data::added::ArrowKey;
use pinhole_figure::annotate::AnnotationPlan;
use pinhole_figure::color_by::ColorKey;
use pinhole_figure::scene_file::{Data, SceneFile};

pub(crate) mod contents;
pub(crate) mod data;
pub(crate) mod kinds;
mod load;
mod look;
pub(crate) mod read_file;
mod source;

/// Everything that a render needs from its input.
pub(crate) struct Input {
    pub(crate) scene: Arc<Scene>,
    /// The camera; for a stereo camera, the view from the middle between the eyes.
    pub(crate) camera: Box<dyn Camera>,
    /// The left and the right eye of a stereo camera.
    pub(crate) eyes: Option<[Box<dyn Camera>; 2]>,
    pub(crate) film: Film,
    pub(crate) settings: RenderSettings,
    pub(crate) encoding: Encoding,
    /// What colors mean, if a column of the data gives them.
    pub(crate) color_key: Option<ColorKey>,
    /// The meaning of arrows, if there are any.
    pub(crate) arrow_key: Option<ArrowKey>,
    /// What the scene file draws over the picture.
    pub(crate) annotations: AnnotationPlan,
    /// Where the size of the picture comes from, for messages: a flag or a file.
    pub(crate) size_from: String,
    pub(crate) notes: Vec<String>,
    /// The file of bricks of which the scene has only the outermost spheres.
    pub(crate) bricks: Option<Arc<BrickFile>>,
    /// The color of spheres without one.
    pub(crate) color: LinearRgb,
    pub(crate) files: Vec<PathBuf>,
    /// What the program says about the picture.
    pub(crate) report: Report,
    /// The camera, with its position.
    pub(crate) parameters: CameraParameters,
    /// The data with its keys and the flags about it; its path is as the program found it.
    pub(crate) data: Option<Data>,
    /// The settings.
    pub(crate) file: Arc<SceneFile>,
    pub(crate) sky_image: Option<PathBuf>,
    /// The files of cylinders and cones, in the order of their tables.
    pub(crate) cone_files: Vec<PathBuf>,
}

impl Input {
    /// Returns the view of the camera, or of the middle between two eyes.
    pub(crate) fn view(&self) -> View<'_> {
        View::new(self.camera.as_ref(), self.film)
    }

    /// Returns true if light of the picture is sampled at random.
    pub(crate) fn has_random_light(&self) -> bool {
        self.settings.is_random(&self.scene, self.camera.as_ref())
    }
}
