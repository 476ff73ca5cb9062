//! A scene with the camera, the film and the settings for one picture of it.

use pinhole::camera::Camera;
use pinhole::{Film, Image, LayerSet, RenderSettings, Scene, cpu};
use pinhole_figure::scene_file::{IntegratorKind, SceneFile};

/// A scene with the camera, the film and the settings for one picture of it.
#[derive(Debug)]
pub(crate) struct View {
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
    pub(crate) settings: RenderSettings,
}

impl View {
    /// The view of a scene file without data.
    pub(crate) fn from_toml(text: &str) -> Self {
        let file = SceneFile::parse(text).unwrap();
        let scene = file.scene().unwrap();
        let camera = file.camera(&file.film, &scene).unwrap();
        let settings = file.settings(IntegratorKind::Primary, &scene, camera.as_ref(), None);
        Self { scene, camera, film: file.film, settings: settings.unwrap() }
    }

    /// The scene of `pinhole demo`.
    pub(crate) fn three_spheres() -> Self {
        Self::from_toml(include_str!("../../examples/three-spheres.toml"))
    }

    /// The same scene with an orthographic camera.
    pub(crate) fn three_spheres_orthographic() -> Self {
        Self::from_toml(include_str!("../../examples/three-spheres-orthographic.toml"))
    }

    /// The camera and the film.
    pub(crate) fn seen(&self) -> pinhole::View<'_> {
        pinhole::View::new(self.camera.as_ref(), self.film)
    }

    /// The picture of the CPU reference.
    pub(crate) fn reference(&self) -> Image {
        cpu::render(&self.scene, &self.seen(), &self.settings, LayerSet::ALL).unwrap()
    }
}
