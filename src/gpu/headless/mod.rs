//! Rendering without a display, on a device that the library owns.
//!
//! No other file of the library submits work to a device, polls it, or waits for it.

pub(crate) mod denoise;
pub(crate) mod lit_flow;
pub(crate) mod lit_picture;
pub(crate) mod lit_recording;
mod lit_states;
pub(crate) mod measure;
pub(crate) mod one_picture;
pub(crate) mod plan;
pub(crate) mod planning;
pub(crate) mod primary;
pub(crate) mod profiling;
pub(crate) mod progress;
pub(crate) mod readback;
pub(crate) mod recording;
pub(crate) mod renderers;
pub(crate) mod tile_plan;
pub(crate) mod tiled_picture;
pub(crate) mod uploading;
pub(crate) mod waiting;

use std::convert::Infallible;
use std::sync::Arc;

use wgpu::{Adapter, AdapterInfo, CommandEncoder, Device, DeviceType, Queue};

use crate::accel::AccelChoice;
use crate::camera::{Camera, View};
use crate::gpu::adapter;
use crate::gpu::cache::Cache;
use crate::gpu::checks::Faults;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
use crate::gpu::headless::plan::{PictureRequest, RenderPlan};
use crate::gpu::headless::progress::{Picture, Watch, go_on};
use crate::gpu::headless::renderers::Renderers;
use crate::gpu::headless::waiting::Turns;
use crate::gpu::options::{HeadlessOptions, required_limits, wanted_features};
use crate::gpu::passes::lit::{LitKey, LitPasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::scene::query_structure;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::structures::with_retries;
use crate::gpu::self_test::{SelfTestExtent, SelfTestReport, SelfTestRun};
use crate::image::{Image, LayerSet};
use crate::render::{PrimarySettings, RenderSettings};
use crate::scene::Scene;
use crate::smooth::first_half;

/// A device for rendering without a display.
#[derive(Debug)]
pub struct Headless {
    info: AdapterInfo,
    device: Device,
    queue: Queue,
    /// The options that the device was opened with. Indirect dispatches are on only if the device has them.
    options: HeadlessOptions,
    faults: Arc<Faults>,
    /// The renderers that were built so far. A turn lasts during a whole render, because faults that wgpu reports cannot
    /// be attributed to a render.
    renderers: Turns<Renderers>,
    lit: Cache<LitKey, LitPasses>,
    recolor: Cache<(), Recolor>,
    /// Edits of kernels that are built where they are used.
    edits: Edits,
}

impl Headless {
    /// Opens a device on the first of [`candidates`](crate::gpu::adapter::candidates) that can open one.
    ///
    /// # Errors
    /// If there is no such adapter, or none can open a device. The error is then the error of the first adapter.
    pub async fn open(options: &HeadlessOptions) -> Result<Self, GpuError> {
        // The error of the best adapter, which is returned if all fail.
        let mut refusal = GpuError::NoAdapter;
        for adapter in &adapter::candidates(options.adapter.as_deref()).await? {
            match Self::from_adapter(adapter, options).await {
                Ok(headless) => return Ok(headless),
                Err(error) if refusal == GpuError::NoAdapter => refusal = error,
                Err(_) => {}
            }
        }
        Err(refusal)
    }

    /// Opens a device on the given adapter like [`Headless::open`]. The adapter's name in the options is ignored.
    ///
    /// # Errors
    /// If the adapter cannot open a device.
    pub async fn from_adapter(adapter: &Adapter, options: &HeadlessOptions) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let mut required_features = adapter.features() & wanted_features(info.device_type);
        let mut required_limits = required_limits(&adapter.limits(), options.limits);
        let mut experimental_features = wgpu::ExperimentalFeatures::disabled();
        if options.ray_query {
            if !adapter.features().contains(query_structure::FEATURES) {
                return Err(GpuError::NoRayQuery);
            }
            required_features |= query_structure::FEATURES;
            required_limits = required_limits.using_acceleration_structure_values(adapter.limits());
            experimental_features = query_structure::experiment();
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("pinhole"),
            required_features,
            required_limits,
            experimental_features,
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..wgpu::DeviceDescriptor::default()
        };
        let opened = adapter.request_device(&descriptor).await;
        let (device, queue) =
            opened.map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), message: error.to_string() })?;
        let faults = Arc::new(Faults::default());
        let reported = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error| {
            reported.report(GpuError::from_wgpu(&error));
        }));
        let reported = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, message| {
            reported.report(GpuError::DeviceLost { message });
        });
        let downlevel = adapter.get_downlevel_capabilities().flags;
        let has_indirect = downlevel.contains(wgpu::DownlevelFlags::INDIRECT_EXECUTION);
        let edits = Edits { replacements: options.edits.clone(), rewrite: options.rewrite.clone() };
        let info = AdapterInfo { device_type: options.device_type.unwrap_or(info.device_type), ..info };
        let options = HeadlessOptions { indirect: options.indirect && has_indirect, ..options.clone() };
        Ok(Self {
            info,
            device,
            queue,
            options,
            faults,
            renderers: Turns::default(),
            lit: Cache::default(),
            recolor: Cache::default(),
            edits,
        })
    }

    /// Returns name, driver and kind of the adapter in use.
    #[must_use]
    pub fn adapter_info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Why the CPU reference should follow the random rays of a picture in the place of this device: software devices are
    /// slower; the reference takes 0.2 to 0.8 of the time of lavapipe. `None` if it should not.
    #[must_use]
    pub fn reason_for_cpu(&self, scene: &Scene, camera: &dyn Camera, settings: &RenderSettings) -> Option<String> {
        match settings.is_random(scene, camera) {
            true if self.info.device_type == DeviceType::Cpu => Some(format!("{} is slower", self.info.name)),
            _ => None,
        }
    }

    /// Returns the device, for callers that record their own commands.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The order and the amounts of work that suit this device.
    pub(crate) fn shape(&self) -> DeviceShape {
        DeviceShape::of(self.info.device_type)
    }

    /// Returns the queue, for callers that record their own commands.
    #[must_use]
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// Tests whether the arithmetic of the device has the properties that the error bounds of the checker assume.
    ///
    /// # Errors
    /// If the device fails. A property that the device lacks is not an error, but part of the report.
    pub async fn self_test(&self, extent: SelfTestExtent) -> Result<SelfTestReport, GpuError> {
        let report = self
            .alone(async |_: &mut Renderers| {
                let run = SelfTestRun::new(&self.device, extent, &self.edits).await?;
                let mut encoder = self.encoder();
                run.record(&mut encoder);
                self.run(encoder, &run.buffers()).await?;
                run.judge()
            })
            .await?;
        Ok(match extent {
            SelfTestExtent::Quick => report,
            SelfTestExtent::Full => report.with(self.probe_fences().await?),
        })
    }

    /// Renders a picture.
    ///
    /// A picture that exceeds the device's limits is rendered in tiles, and a scene that exceeds them is divided into
    /// bricks. The picture depends on neither. If rays need too many steps in the structure that suits the data,
    /// another structure is built. A device renders one picture at a time. Other threads wait.
    ///
    /// # Errors
    /// If [`RenderSettings::check`] returns an error, if the scene or the picture does not fit into the memory of the
    /// device or of the host, or if the device fails.
    pub async fn render(
        &self,
        scene: &Scene,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        settings.check(scene)?;
        let request = PictureRequest { is_only: true, ..PictureRequest::new(scene, view, settings, layers) };
        let plan = |choice| self.plan(&request, choice);
        let picture =
            retried(plan, async |plan: &RenderPlan| self.render_planned(&request, plan, &mut go_on, &mut go_on).await);
        Ok(picture.await?.image)
    }

    /// Renders a picture of a scene that is already on this device. `watch` is called with the progress after every
    /// submission, and decides how the render continues.
    ///
    /// # Errors
    /// As for [`Headless::render`]; [`GpuError::Stopped`] if `watch` stops the render;
    /// [`GpuError::NoOccluders`] if the settings are those of a studio, some spheres are not opaque, and the scene was
    /// uploaded without the structure of the spheres that cast shadows.
    pub async fn render_uploaded(
        &self,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, GpuError> {
        if settings.integrator.is_primary() {
            let primary = scene.primary_settings(settings)?;
            let image = self.render_primary(scene, view, Some(&primary), layers, watch).await?;
            Ok(Picture::by_primary_rays(image))
        } else if let Some(smooth) = scene.smooth(view, settings) {
            settings.check_with(scene.appearance())?;
            let (layers_of_ids, is_shaded) = smooth.layers(layers);
            let (of_ids, primary) = (smooth.view_of_ids(), is_shaded.then(PrimarySettings::default));
            let mut first = first_half(watch);
            let ids = self.render_primary(scene, &of_ids, primary.as_ref(), layers_of_ids, &mut first).await?;
            drop(first);
            let _phase = self.phase("light");
            smooth.draw(ids, layers, GpuError::Stopped, watch)
        } else {
            self.render_lit(scene, view, settings, layers, watch).await
        }
    }

    pub(crate) fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Replaces an error by the loss of the device, if that is its cause: a lost device causes many kinds of errors.
    fn explained(&self, error: GpuError) -> GpuError {
        waiting::call_back(&self.device);
        match self.faults.check() {
            Err(lost @ GpuError::DeviceLost { .. }) => lost,
            _ => error,
        }
    }

    /// Calls `work` with a renderer, while nothing else uses this device.
    pub(crate) async fn with_renderer<T>(
        &self,
        options: RendererOptions,
        work: impl AsyncFnOnce(&Renderer) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(async |renderers: &mut Renderers| {
            let phase = self.phase("create pipelines");
            let renderer = renderers.of(&self.device, options).await?;
            drop(phase);
            work(renderer).await
        })
        .await
    }

    /// Calls `work` with the passes for a key, while nothing else uses this device.
    pub(crate) async fn with_lit_passes<T>(
        &self,
        key: LitKey,
        work: impl AsyncFnOnce(&LitPasses) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(async |_: &mut Renderers| {
            let phase = self.phase("create pipelines");
            let passes = self.lit.of(key, LitPasses::new(&self.device, key, &self.edits)).await?;
            drop(phase);
            work(&passes).await
        })
        .await
    }

    /// Calls `work` while nothing else uses this device.
    async fn alone<T>(&self, work: impl AsyncFnOnce(&mut Renderers) -> Result<T, GpuError>) -> Result<T, GpuError> {
        let mut turn = self.renderers.turn().await;
        self.faults.forget();
        work(&mut turn.value).await.map_err(|error| self.explained(error))
    }

    /// Submits an encoder without waiting.
    pub(crate) fn start(&self, encoder: CommandEncoder) -> wgpu::SubmissionIndex {
        let _phase = self.phase("submit");
        self.queue.submit([encoder.finish()])
    }

    /// Submits the copies that are queued, and waits until they are done and their memory is free.
    pub(crate) async fn flush(&self) -> Result<(), GpuError> {
        let submission = self.queue.submit([]);
        self.wait(&[], submission).await
    }

    /// Submits an encoder, and waits until it has finished and the buffers are mapped.
    pub(crate) async fn run(&self, encoder: CommandEncoder, mapped: &[&wgpu::Buffer]) -> Result<(), GpuError> {
        let submission = self.start(encoder);
        self.wait(mapped, submission).await
    }

    /// Waits until a submission has finished and the buffers are mapped.
    pub(crate) async fn wait(
        &self,
        mapped: &[&wgpu::Buffer],
        submission: wgpu::SubmissionIndex,
    ) -> Result<(), GpuError> {
        let _phase = self.phase("wait");
        let mut answers = Vec::new();
        for buffer in mapped {
            let (answer, to_answer) = waiting::answer();
            buffer.map_async(wgpu::MapMode::Read, .., |mapped| to_answer.give(mapped));
            answers.push(answer);
        }
        let done = waiting::until_done(&self.device, &self.queue, submission, self.options.timeout).await;
        if let Err(GpuError::Timeout { .. }) = done {
            // Dropping the last handle of a queue waits for its work, which may never end.
            std::mem::forget(self.queue.clone());
        }
        // A fault that the device reported explains more than the failure of the wait.
        self.faults.check()?;
        done?;
        for answer in answers {
            // Native devices map buffers before they report the end of the submission. Browsers promise no order.
            let mapped = match cfg!(target_arch = "wasm32") {
                true => Some(answer.await),
                false => answer.known(),
            };
            if let Some(Err(error)) = mapped {
                return Err(GpuError::Device { message: error.to_string() });
            }
        }
        self.faults.check()
    }
}

/// Calls `work` with a plan for the structures that suit a scene. If rays need too many steps in these structures,
/// calls it again with others.
async fn retried<T>(
    plan: impl Fn(AccelChoice) -> RenderPlan,
    work: impl AsyncFn(&RenderPlan) -> Result<T, GpuError>,
) -> Result<T, GpuError> {
    let work = async |plan: &RenderPlan| Ok::<_, Infallible>(work(plan).await);
    match with_retries(AccelChoice::Auto, plan, |_| {}, work).await {
        Ok(done) => done,
        Err(never) => match never {},
    }
}
