//! One picture to be made.

use pinhole::camera::Camera;
use pinhole::{Film, Image, LayerSet, RenderSettings, Scene, cpu};
use pinhole_figure::scene_file::{IntegratorKind, SceneFile};

/// One picture to be made.
#[derive(Debug)]
pub(crate) struct View {
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
    pub(crate) settings: RenderSettings,
}

impl View {
    /// What a scene file without data shows.
    pub(crate) fn from_toml(text: &str) -> Self {
        let file = SceneFile::parse(text).unwrap();
        let scene = file.scene(&[]).unwrap();
        let camera = file.camera(&file.film, &scene).unwrap();
        let settings = file.settings(IntegratorKind::Primary, &scene, camera.as_ref(), None);
        Self { scene, camera, film: file.film, settings: settings.unwrap() }
    }

    /// The scene of `pinhole demo`.
    pub(crate) fn three_spheres() -> Self {
        Self::from_toml(include_str!("../../examples/three-spheres.toml"))
    }

    /// The same scene, seen in parallel.
    pub(crate) fn three_spheres_orthographic() -> Self {
        Self::from_toml(include_str!("../../examples/three-spheres-orthographic.toml"))
    }

    /// Its camera and film.
    pub(crate) fn seen(&self) -> pinhole::View<'_> {
        pinhole::View::new(self.camera.as_ref(), self.film)
    }

    /// As the CPU reference sees it.
    pub(crate) fn reference(&self) -> Image {
        cpu::render(&self.scene, &self.seen(), &self.settings, LayerSet::ALL).unwrap()
    }
}
