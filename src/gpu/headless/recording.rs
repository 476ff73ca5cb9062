//! What a device did, for the checker: rays and hits on their way back to the host, and the numbers that the
//! device was given.

use crate::accel::AccelChoice;
use crate::camera::{Camera, View};
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::primary::Output;
use crate::gpu::headless::progress::{Watch, go_on};
use crate::gpu::headless::renderers::RendererKey;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::records::{self, SceneSpace};
use crate::image::{Image, LayerSet, NO_ID};
use crate::render::{PrimarySettings, RenderSettings};
use crate::scene::Scene;
use crate::verify::{
    Certificate, Checker, NO_HIT, Recording, Rendered, RequestedCamera, TracedPixel, UploadedView,
};

/// A camera, and the numbers that kernels get of it and of the scene's box.
pub(in crate::gpu) fn requested_view(
    space: &SceneSpace,
    camera: &dyn Camera,
) -> (RequestedCamera, UploadedView) {
    let requested = RequestedCamera::of(camera);
    let records::Camera { origin, advance, right, up, forward, first, second, third } =
        records::Camera::new(&requested, space);
    let uploaded = UploadedView {
        origin,
        advance,
        right,
        up,
        forward,
        numbers: [first, second, third],
        scene_min: space.min.to_array(),
        scene_max: space.max.to_array(),
    };
    (requested, uploaded)
}

/// A recording in which nothing is traced yet.
fn new_recording(
    space: &SceneSpace,
    view: &View<'_>,
    primary: PrimarySettings,
) -> Result<Recording, GpuError> {
    let (requested, uploaded) = requested_view(space, view.camera);
    let film = view.film;
    let image = Image::new(film.width(), film.height(), LayerSet::DATA)?;
    let untraced = TracedPixel { ray: None, t: NO_HIT, id: NO_ID };
    Ok(Recording {
        camera: requested,
        uploaded,
        film,
        primary,
        pixels: vec![untraced; image.color().len()],
        image,
        rendered: Rendered::None,
    })
}

impl Headless {
    /// As [`Headless::render_uploaded`] of primary rays, with all layers, and with the ray and the hit of every pixel:
    /// everything by which [`Checker::certify`] judges the device.
    ///
    /// # Errors
    /// As [`Headless::render_uploaded`]; [`GpuError::NotPrimary`] if the settings are of a lit picture, whose paths
    /// [`Headless::record_paths`] records.
    pub fn record(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let primary = scene.primary_settings(settings)?;
        let key = RendererKey {
            data_layers: true,
            keeps_rays: true,
            ..RendererKey::new(scene, view.camera)
        };
        self.with_renderer(key, |renderer| {
            let mut recording = new_recording(scene.space(), view, primary)?;
            let Recording { image, pixels, .. } = &mut recording;
            let output = Output { image, pixels: Some(pixels) };
            self.render_tiles(renderer, scene, view, &primary, output, watch)?;
            Ok(recording)
        })
    }

    /// As [`Headless::record`], and renders the view once more as [`Headless::render_uploaded`] does, with kernels
    /// that keep no rays, for [`Recording::rendered`].
    ///
    /// # Errors
    /// As [`Headless::record`].
    pub fn record_and_render(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let mut recording = self.record(scene, view, settings, watch)?;
        let picture = self.render_uploaded(scene, view, settings, LayerSet::DATA, watch)?;
        recording.compare(picture.image);
        Ok(recording)
    }

    /// Renders a picture of primary rays and decides whether it is one that a conforming device may have made: as
    /// [`Headless::render`] makes it, and as [`Headless::record`] does, stage by stage.
    ///
    /// # Errors
    /// If it cannot be rendered, as with [`Headless::record`], or if there is no memory to check it. That a picture
    /// is not legal is not an error.
    pub fn verify(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<Certificate, GpuError> {
        if !settings.integrator.is_primary() {
            return Err(GpuError::NotPrimary { integrator: settings.integrator.name() });
        }
        let plan = |choice: AccelChoice| self.plan_record(scene, view, choice, 0);
        let recording = self.with_uploaded(scene, plan, |buffers| {
            self.record_and_render(buffers, view, settings, &mut go_on)
        })?;
        Ok(Checker::new(scene)?.certify(&recording))
    }
}
