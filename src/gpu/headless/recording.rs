//! Recording primary rays for the checker: the rays and hits that the device computed, and its inputs.

use crate::accel::{AccelChoice, AccelPlan};
use crate::camera::film::Film;
use crate::camera::{Camera, PinholeCamera, View};
use crate::gpu::edit::ShaderEdit;
use crate::gpu::error::{GpuError, check_whole};
use crate::gpu::headless::plan::{PictureRequest, RenderPlan};
use crate::gpu::headless::primary::Output;
use crate::gpu::headless::progress::{Watch, go_on};
use crate::gpu::headless::readback::ReadBack;
use crate::gpu::headless::{Headless, retried};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::self_test::{TestedProperty, fence_probe};
use crate::gpu::shader::records::{self, SceneSpace};
use crate::image::color::LinearRgb;
use crate::image::{Image, LayerSet, NO_ID};
use crate::recording::{NO_HIT, PlainRender, Recording, RequestedCamera, TracedPixel, UploadedView};
use crate::render::{PrimarySettings, RenderSettings};
use crate::scene::Scene;
use crate::verify::{Certificate, Checker};

/// Returns a camera together with the numbers that are uploaded for it and for the scene's bounds.
pub(crate) fn requested_view(space: &SceneSpace, camera: &dyn Camera) -> (RequestedCamera, UploadedView) {
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

/// Creates a recording in which no pixel has been traced.
fn new_recording(space: &SceneSpace, view: &View<'_>, primary: PrimarySettings) -> Result<Recording, GpuError> {
    let (requested, uploaded) = requested_view(space, view.camera);
    let film = view.film;
    let image = Image::new(film.width(), film.height(), LayerSet::DATA)?;
    let untraced = TracedPixel { ray: None, t: NO_HIT, id: NO_ID, shading_ray: None };
    Ok(Recording {
        camera: requested,
        uploaded,
        film,
        primary,
        pixels: vec![untraced; image.color().len()],
        image,
        rendered: PlainRender::None,
    })
}

impl Headless {
    /// Renders a picture of primary rays with all layers and keeps the ray and the hit of every pixel, from which
    /// [`Checker::certify`](crate::verify::Checker::certify) judges the device.
    ///
    /// # Errors
    /// As for [`Headless::render_uploaded`]; [`GpuError::NotPrimary`] if the settings are those of a lit
    /// picture. [`Headless::record_lit`] records such pictures.
    pub async fn record(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        check_whole(&view.film)?;
        self.recorded(scene, view, scene.primary_settings(settings)?, None, watch).await
    }

    /// A recording by kernels with an additional edit.
    async fn recorded(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        primary: PrimarySettings,
        edit: Option<ShaderEdit>,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let options = self.options_for(scene, view.camera);
        let edits = edit.into_iter().chain(options.edits).collect();
        let options = RendererOptions { data_layers: true, keeps_rays: true, edits, ..options };
        self.with_renderer(options, async |renderer: &Renderer| {
            let mut recording = new_recording(&scene.space, view, primary)?;
            let Recording { image, pixels, .. } = &mut recording;
            let output = Output { image, pixels: Some(pixels) };
            self.render_tiles(renderer, scene, view, (&primary, ReadBack::Layers), output, watch).await?;
            Ok(recording)
        })
        .await
    }

    /// Records a picture like [`Headless::record`], and renders the view a second time with
    /// [`Headless::render_uploaded`], whose kernels keep no rays, to compare both pictures in [`Recording::rendered`].
    ///
    /// # Errors
    /// As for [`Headless::record`].
    pub async fn record_and_render(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        let mut recording = self.record(scene, view, settings, watch).await?;
        let layers = LayerSet::DATA;
        let picture = self.render_uploaded(scene, view, settings, layers, watch).await?;
        recording.compare(picture.image);
        Ok(recording)
    }

    /// Renders the view of a recording as [`Headless::render`] does, if a single picture does not need the structure of
    /// the recording, and compares both pictures in [`Recording::rendered`].
    ///
    /// # Errors
    /// As for [`Headless::render`].
    pub async fn compare_single(
        &self,
        recording: &mut Recording,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let request = PictureRequest { is_only: true, ..PictureRequest::new(scene, view, settings, LayerSet::DATA) };
        let plan = self.plan(&request, AccelChoice::Auto);
        if plan.by_tiles {
            match self.render_planned(&request, &plan, &mut go_on, watch).await {
                // Such pictures are rendered with the structure.
                Err(GpuError::Steps) => {}
                picture => recording.compare(picture?.image),
            }
        }
        Ok(())
    }

    /// Renders a picture of primary rays and decides whether a conforming device may have produced it. Checks the
    /// kernels of [`Headless::render`] and the kernels of [`Headless::record`], the latter stage by stage.
    ///
    /// # Errors
    /// If the picture cannot be rendered, as for [`Headless::record`], or if there is not enough memory to check it. A
    /// picture that is not legal is not an error.
    pub async fn verify(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<Certificate, GpuError> {
        if !settings.integrator.is_primary() {
            return Err(GpuError::NotPrimary { integrator: settings.integrator.name() });
        }
        let plan = |choice: AccelChoice| self.plan_record(scene, view, choice, 0);
        let recording = retried(plan, async |plan: &RenderPlan| {
            let buffers = self.upload_planned(scene, &plan.structures(), &mut go_on).await?;
            self.record_and_render(&buffers, view, settings, &mut go_on).await
        });
        let mut recording = recording.await?;
        self.compare_single(&mut recording, scene, view, settings, &mut go_on).await?;
        Ok(Checker::new(scene)?.certify(&recording))
    }
}

/// Side of the picture in pixels.
const SIDE: u32 = 64;

/// Number of spheres along each side of a cube. A grid suits this many.
const ALONG: u16 = 6;

impl Headless {
    /// Tests whether fences hold in a kernel that traces rays through a grid.
    pub(super) async fn probe_fences(&self) -> Result<TestedProperty, GpuError> {
        let place = |index: u16| f32::from(index) / f32::from(ALONG);
        let sphere = |index: u16| {
            let [x, y, z] = [index % ALONG, index / ALONG % ALONG, index / ALONG / ALONG].map(place);
            [x, y, z, 0.3 / f32::from(ALONG)]
        };
        let spheres = (0..ALONG * ALONG * ALONG).map(sphere).collect();
        // The scene and the view are valid by construction.
        let scene = Scene::from_f32(spheres, LinearRgb::WHITE)?;
        let film = Film::new(SIDE, SIDE)?;
        let camera = PinholeCamera::framing_from_the_front(scene.subject(), film.aspect())
            .map_err(|error| GpuError::Device { message: error.to_string() })?;
        let view = View::new(&camera, film);
        let limit = self.device().limits().max_storage_buffer_binding_size;
        let plan = AccelPlan::new(scene.spheres(), AccelChoice::Grid, limit);
        let buffers = self.upload(&scene, &plan.build(scene.spheres()).into()).await?;
        let primary = buffers.primary_settings(&RenderSettings::default())?;
        let edit = Some(fence_probe::edit());
        let recording = self.recorded(&buffers, &view, primary, edit, &mut go_on).await?;
        Ok(fence_probe::judge(&recording.pixels))
    }
}
