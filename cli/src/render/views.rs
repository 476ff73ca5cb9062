//! The view of one picture, or the two views of a stereo camera, with everything that rendering them needs.

use crate::input::Input;
use crate::render::device::OpenDevice;
use crate::render::stop_rule::StopRule;
use crate::terminal::memory;
use pinhole::camera::View;
use pinhole::camera::film::Film;
use pinhole::image::LayerSet;
use pinhole::render::RenderSettings;
use pinhole::scene::Scene;

/// A picture to render: its input and views, the rule that stops sampling, and the device.
#[derive(Clone, Copy)]
pub(crate) struct Shot<'a> {
    pub(crate) input: &'a Input,
    /// The scene of the input, or its ghosts.
    pub(crate) scene: &'a Scene,
    pub(crate) settings: &'a RenderSettings,
    /// One view, or those of the left and of the right eye, on the same film.
    pub(crate) views: &'a [View<'a>],
    pub(crate) layers: LayerSet,
    pub(crate) stop_rule: StopRule,
    pub(crate) opened: &'a OpenDevice,
}

impl<'a> Shot<'a> {
    pub(crate) fn new(
        input: &'a Input,
        views: &'a [View<'a>],
        layers: LayerSet,
        stop_rule: StopRule,
        opened: &'a OpenDevice,
    ) -> Self {
        Self { input, scene: &input.scene, settings: &input.settings, views, layers, stop_rule, opened }
    }

    pub(crate) fn film(&self) -> Film {
        self.views[0].film
    }
}

/// The view of an input, or those of both eyes, on its film or on a part of it.
pub(crate) fn views_of(input: &Input, film: Film) -> Vec<View<'_>> {
    let cameras = input.eyes.as_ref().map_or(std::slice::from_ref(&input.camera), |eyes| eyes);
    cameras.iter().map(|camera| View::new(camera.as_ref(), film)).collect()
}

/// The bytes per pixel that are needed besides the layers of one picture.
pub(crate) fn extra_bytes_per_pixel(views: &[View<'_>], layers: LayerSet) -> u64 {
    let encoding = memory::ENCODING_BYTES_PER_PIXEL;
    match views.len() {
        1 => encoding,
        // Memory for the other picture, and for a picture of twice the width that joins both.
        _ => 3 * layers.bytes_per_pixel() + 2 * encoding,
    }
}
