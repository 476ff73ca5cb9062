//! The blocking forms of everything that waits. Browsers cannot block, so they do not exist for `wasm32`.

use wgpu::Adapter;

use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::headless::Headless;
use crate::gpu::headless::lit_recording::{EachSample, LitPart};
use crate::gpu::headless::plan::{RenderPlan, StructurePlans};
use crate::gpu::headless::progress::{Picture, UploadWatch, Watch};
use crate::gpu::headless::timer::TraceTime;
use crate::gpu::options::HeadlessOptions;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::structures::Structures;
use crate::gpu::self_test::{SelfTestExtent, SelfTestReport};
use crate::gpu::waiting::block_on;
use crate::image::{Image, LayerSet};
use crate::render::{Nearest, RenderSettings};
use crate::scene::{Scene, SceneUpdate};
use crate::verify::{Certificate, Recording};

impl Headless {
    /// Opens a device on the first of [`candidates`](crate::gpu::adapter::candidates) that can open one.
    ///
    /// # Errors
    /// If there is no such adapter, or if none can open a device; the error is then that of the first.
    pub fn open(options: &HeadlessOptions) -> Result<Self, GpuError> {
        block_on(Self::open_async(options))
    }

    /// Opens a device on the given adapter. The adapter's name in the options is ignored.
    ///
    /// # Errors
    /// If the adapter cannot open a device.
    pub fn from_adapter(adapter: &Adapter, options: &HeadlessOptions) -> Result<Self, GpuError> {
        block_on(Self::from_adapter_async(adapter, options))
    }

    /// Tests whether the arithmetic of the device has the properties that the error bounds of the checker assume.
    ///
    /// # Errors
    /// If the device fails. A property that the device lacks is not an error; the report contains it.
    pub fn self_test(&self, extent: SelfTestExtent) -> Result<SelfTestReport, GpuError> {
        block_on(self.self_test_async(extent))
    }

    /// Copies a scene to the device, brick by brick, with the structures that were built for it. They come from
    /// [`RenderPlan::build`](crate::gpu::RenderPlan::build), or from a single [`Accel`](crate::accel::Accel).
    ///
    /// # Errors
    /// If the scene does not fit into the device's memory or limits, or if the device fails.
    pub fn upload(&self, scene: &Scene, structures: &Structures) -> Result<SceneBuffers, GpuError> {
        block_on(self.upload_async(scene, structures))
    }

    /// Builds the planned structures of a scene and copies them to the device, brick by brick. Each brick is dropped
    /// before the next is built, so that this needs less memory than [`Headless::upload`]. `watch` is called before each
    /// step. The plans come from [`RenderPlan::structures`](crate::gpu::RenderPlan::structures).
    ///
    /// # Errors
    /// If the scene does not fit into the device's memory or limits, or if the device fails; [`GpuError::Stopped`] if
    /// `watch` stops the copy.
    pub fn upload_planned(
        &self,
        scene: &Scene,
        plans: &StructurePlans,
        watch: &mut UploadWatch<'_>,
    ) -> Result<SceneBuffers, GpuError> {
        block_on(self.upload_planned_async(scene, plans, watch))
    }

    /// Renders a picture.
    ///
    /// A picture that exceeds the device's limits is rendered in tiles, and a scene that exceeds them is divided into
    /// bricks; the picture depends on neither. If rays need too many steps in the structure that suits the data,
    /// another structure is built. A device renders one picture at a time; other threads wait.
    ///
    /// # Errors
    /// If [`RenderSettings::check`] returns an error, if the scene or the picture does not fit into the memory of the
    /// device or of the host, or if the device fails.
    pub fn render(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        block_on(self.render_async(scene, view, settings, layers))
    }

    /// Builds the planned structures of a scene and renders one picture, like [`Headless::upload_planned`] and
    /// [`Headless::render_uploaded`], which call the two callbacks.
    ///
    /// If a picture by primary rays is a single tile and the scene has several bricks, each brick is traced as soon as
    /// it is on the device, and dropped. Bricks that the picture does not show are not built.
    ///
    /// # Errors
    /// The same as for [`Headless::upload_planned`] and [`Headless::render_uploaded`].
    pub fn render_planned(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watches: (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Picture, GpuError> {
        block_on(self.render_planned_async(scene, plan, view, settings, layers, watches))
    }

    /// Renders a picture by primary rays of a part of a scene ([`Scene::part`]), with what is needed to put it together
    /// with those of the other parts. Each planned brick is built, traced and dropped before the next. A large picture is
    /// rendered in tiles, for each of which the bricks are built again.
    ///
    /// # Errors
    /// The same as for [`Headless::render_planned`]; [`GpuError::NotPrimary`] for settings with light.
    pub fn render_nearest(
        &self,
        scene: &Scene,
        plan: &RenderPlan,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watches: (&mut UploadWatch<'_>, &mut Watch<'_>),
    ) -> Result<Nearest, GpuError> {
        block_on(self.render_nearest_async(scene, plan, view, settings, layers, watches))
    }

    /// Completes a picture that was rendered with [`RenderSettings::unfinished`] and has the layers
    /// [`RenderSettings::layers_for`]: removes noise and draws outlines, as `settings` ask for, and keeps `layers`. The
    /// result is that of [`Headless::render`] with `settings` on this device, to the bit.
    ///
    /// # Errors
    /// If noise is to be removed and the picture lacks a layer that guides it, or the device fails.
    pub fn finish(
        &self,
        image: Image,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        block_on(self.finish_async(image, settings, layers))
    }

    /// Renders a picture of a scene that is already on this device. `watch` is called with the progress after every
    /// submission, and decides how the render continues.
    ///
    /// # Errors
    /// The same as for [`Headless::render`]; [`GpuError::Stopped`] if `watch` stops the render;
    /// [`GpuError::NoOccluders`] if the settings are those of a studio, some spheres are not opaque, and the scene was
    /// uploaded without the structure of the spheres that cast shadows.
    pub fn render_uploaded(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        block_on(self.render_uploaded_async(scene, view, settings, layers, watch))
    }

    /// Applies an update to a scene on this device. The update must already have been applied to the host's scene with
    /// [`Scene::apply`].
    ///
    /// If only colours change, they are written to the existing buffers. If spheres move or change their radius, a new
    /// structure of the same kind is built on the host and copied to the device; the views of frames that show the
    /// scene must then be set again with [`Frame::set_view`](crate::gpu::Frame::set_view). `docs/performance.md` lists
    /// the cost of both.
    ///
    /// # Errors
    /// If the scene does not fit on the device, or if the device fails. The scene must then be uploaded again.
    pub fn update(
        &self,
        buffers: &mut SceneBuffers,
        scene: &Scene,
        update: &SceneUpdate<'_>,
    ) -> Result<(), GpuError> {
        block_on(self.update_async(buffers, scene, update))
    }

    /// Returns a picture with less noise: light is averaged over pixels of similar shape and colour, in five passes.
    ///
    /// # Errors
    /// If the picture lacks one of the layers in [`crate::image::denoise::GUIDES`], or if the device fails.
    pub fn denoise(&self, image: &Image) -> Result<Image, GpuError> {
        block_on(self.denoise_async(image))
    }

    /// Traces a ray through the centre of every pixel and discards the hits, to measure the time that this takes.
    ///
    /// # Errors
    /// The same as for [`Headless::render`].
    pub fn measure(&self, scene: &SceneBuffers, view: &View<'_>) -> Result<TraceTime, GpuError> {
        block_on(self.measure_async(scene, view))
    }

    /// Renders a picture of primary rays with all layers and keeps the ray and the hit of every pixel, from which
    /// [`Checker::certify`](crate::verify::Checker::certify) judges the device.
    ///
    /// # Errors
    /// The same as for [`Headless::render_uploaded`]; [`GpuError::NotPrimary`] if the settings are those of a lit
    /// picture. [`Headless::record_lit`] records such pictures.
    pub fn record(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        block_on(self.record_async(scene, view, settings, watch))
    }

    /// Records a picture like [`Headless::record`], and renders the view a second time with
    /// [`Headless::render_uploaded`], whose kernels keep no rays, to compare both pictures in [`Recording::rendered`].
    ///
    /// # Errors
    /// The same as for [`Headless::record`].
    pub fn record_and_render(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        watch: &mut Watch<'_>,
    ) -> Result<Recording, GpuError> {
        block_on(self.record_and_render_async(scene, view, settings, watch))
    }

    /// Takes some samples of a lit picture one by one and records the state of every path, or of every ray of a studio,
    /// after every pass, from which [`Checker::certify_lit`](crate::verify::Checker::certify_lit) judges the device.
    /// `each` is called with the recording of each sample; the sums of pixels go on from one to the next. If a side of
    /// the film has more than 256 pixels, only a rectangle in the middle of the film is recorded, and in a studio with
    /// many lights or directions of ambient light a smaller one. The passes are those that take samples step by step.
    ///
    /// # Errors
    /// [`GpuError::NotLit`] if the integrator is `primary`; the same errors as for [`Headless::render_uploaded`];
    /// [`GpuError::Stopped`] if `watch` finishes or stops the recording.
    pub fn record_lit(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        samples: &[u32],
        callbacks: (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        block_on(self.record_lit_async(scene, view, settings, samples, callbacks))
    }

    /// Records samples like [`Headless::record_lit`], in a part of the film. Nothing is recorded if there is no such part.
    ///
    /// # Errors
    /// The same as for [`Headless::record_lit`].
    pub fn record_lit_part(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        part_and_samples: (LitPart, &[u32]),
        callbacks: (&mut EachSample<'_>, &mut Watch<'_>),
    ) -> Result<(), GpuError> {
        block_on(self.record_lit_part_async(scene, view, settings, part_and_samples, callbacks))
    }

    /// Renders a picture of primary rays and decides whether a conforming device may have produced it. Both the kernels
    /// of [`Headless::render`] and those of [`Headless::record`] are checked, the latter stage by stage.
    ///
    /// # Errors
    /// If the picture cannot be rendered, as for [`Headless::record`], or if there is not enough memory to check it. A
    /// picture that is not legal is not an error.
    pub fn verify(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<Certificate, GpuError> {
        block_on(self.verify_async(scene, view, settings))
    }
}
