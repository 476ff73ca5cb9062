//! The probe of fences in a kernel that traces: a small picture of a renderer that records sums in place of rays.

use super::Headless;
use super::primary::Output;
use super::recording::new_recording;
use super::renderers::RendererKey;
use crate::accel::{AccelChoice, AccelPlan};
use crate::camera::film::Film;
use crate::camera::{PinholeCamera, View};
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::self_test::{TestedProperty, fence_probe};
use crate::image::color::LinearRgb;
use crate::render::{Decision, RenderSettings};
use crate::scene::Scene;

/// Side of the picture in pixels.
const SIDE: u32 = 64;

/// The number of spheres along each side of a cube, for which a grid is worth its while.
const ALONG: u16 = 6;

impl Headless {
    /// Tests whether fences hold in a kernel that traces rays through a grid.
    pub(super) async fn probe_fences(&self) -> Result<TestedProperty, GpuError> {
        let place = |index: u16| f32::from(index) / f32::from(ALONG);
        let sphere = |index: u16| {
            let [x, y, z] =
                [index % ALONG, index / ALONG % ALONG, index / ALONG / ALONG].map(place);
            [x, y, z, 0.3 / f32::from(ALONG)]
        };
        let spheres = (0..ALONG * ALONG * ALONG).map(sphere).collect();
        // The scene and the view are good by construction.
        let invalid =
            |error: &dyn std::fmt::Display| GpuError::Device { message: error.to_string() };
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE).map_err(|error| invalid(&error))?;
        let film = Film::new(SIDE, SIDE).map_err(|error| invalid(&error))?;
        let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())
            .map_err(|error| invalid(&error))?;
        let view = View::new(&camera, film);
        let limit = self.device().limits().max_storage_buffer_binding_size;
        let plan = AccelPlan::new(scene.spheres(), AccelChoice::Grid, limit);
        let buffers = self.upload_async(&scene, &plan.build(scene.spheres()).into()).await?;
        let primary = buffers.primary_settings(&RenderSettings::default())?;
        let key = RendererKey {
            data_layers: true,
            keeps_rays: true,
            probes_fences: true,
            ..RendererKey::new(&buffers, &camera)
        };
        let mut recording = new_recording(&buffers.space, &view, primary)?;
        self.with_renderer(key, async |renderer: &Renderer| {
            let output =
                Output { image: &mut recording.image, pixels: Some(&mut recording.pixels) };
            let go_on = &mut |_: &_| Decision::GoOn;
            self.render_tiles(renderer, &buffers, &view, &primary, output, go_on).await
        })
        .await?;
        Ok(fence_probe::judge(&recording.pixels))
    }
}
