//! Rendering without a display, on a device that the library owns.
//!
//! No other file of the library submits work to a device, polls it, or waits for it.

pub(in crate::gpu) mod denoise;
pub(in crate::gpu) mod derived;
pub(in crate::gpu) mod lit_flow;
pub(in crate::gpu) mod lit_picture;
pub(in crate::gpu) mod measure;
pub(in crate::gpu) mod path_recording;
pub(in crate::gpu) mod plan;
pub(in crate::gpu) mod planning;
pub(in crate::gpu) mod primary;
pub(in crate::gpu) mod progress;
pub(in crate::gpu) mod readable_trace;
pub(in crate::gpu) mod readback;
pub(in crate::gpu) mod recording;
pub(in crate::gpu) mod renderers;
pub(in crate::gpu) mod submission_size;
pub(in crate::gpu) mod tile_textures;
pub(in crate::gpu) mod timer;

use std::convert::Infallible;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use wgpu::{Adapter, AdapterInfo, CommandEncoder, Device, Queue};

use crate::accel::{Accel, AccelChoice};
use crate::camera::View;
use crate::gpu::adapter;
use crate::gpu::error::GpuError;
use crate::gpu::faults::Faults;
use crate::gpu::headless::plan::RenderPlan;
use crate::gpu::headless::progress::{Picture, Watch, go_on};
use crate::gpu::headless::renderers::{RendererKey, Renderers};
use crate::gpu::options::{HeadlessOptions, required_limits, wanted_features};
use crate::gpu::passes::lit::{LitKey, LitPasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
use crate::gpu::passes::tiles::Groups;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::gpu::scene::shape_ids::ShapeIds;
use crate::gpu::scene::structures::{Structures, with_retries};
use crate::gpu::self_test::{SelfTestExtent, SelfTestReport, SelfTestRun};
use crate::image::{Image, LayerSet};
use crate::render::RenderSettings;
use crate::scene::Scene;

/// A device for rendering without a display.
#[derive(Debug)]
pub struct Headless {
    info: AdapterInfo,
    device: Device,
    queue: Queue,
    timeout: Duration,
    is_indirect: bool,
    is_one_pass: bool,
    faults: Arc<Faults>,
    /// The renderers that were built so far. The mutex is locked during a whole render, because faults that wgpu
    /// reports cannot be attributed to a render.
    renderers: Mutex<Renderers>,
}

impl Headless {
    /// Opens a device on the first of [`adapter::candidates`] that can open one.
    ///
    /// # Errors
    /// If there is no such adapter, or if none can open a device; the error is then that of the first.
    pub fn open(options: &HeadlessOptions) -> Result<Self, GpuError> {
        // The error of the best adapter, which is returned if all fail.
        let mut refusal = GpuError::NoAdapter;
        for adapter in &adapter::candidates(options.adapter.as_deref())? {
            match Self::from_adapter(adapter, options) {
                Ok(headless) => return Ok(headless),
                Err(error) if refusal == GpuError::NoAdapter => refusal = error,
                Err(_) => {}
            }
        }
        Err(refusal)
    }

    /// Opens a device on the given adapter. The adapter's name in the options is ignored.
    ///
    /// # Errors
    /// If the adapter cannot open a device.
    pub fn from_adapter(adapter: &Adapter, options: &HeadlessOptions) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("pinhole"),
            required_features: adapter.features() & wanted_features(info.device_type),
            required_limits: required_limits(&adapter.limits(), options.limits),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..wgpu::DeviceDescriptor::default()
        }))
        .map_err(|error| GpuError::NoDevice {
            adapter: info.name.clone(),
            message: error.to_string(),
        })?;
        let faults = Arc::new(Faults::default());
        let reported = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error| {
            reported.report(GpuError::from_wgpu(&error));
        }));
        let reported = Arc::clone(&faults);
        device.set_device_lost_callback(move |_, message| {
            reported.report(GpuError::DeviceLost { message });
        });
        let timeout = options.timeout;
        let downlevel = adapter.get_downlevel_capabilities().flags;
        let is_indirect =
            options.indirect && downlevel.contains(wgpu::DownlevelFlags::INDIRECT_EXECUTION);
        let renderers = Mutex::new(Renderers::new(options.edits.clone()));
        let is_one_pass = options.one_pass;
        Ok(Self { info, device, queue, timeout, is_indirect, is_one_pass, faults, renderers })
    }

    /// Returns name, driver and kind of the adapter in use.
    #[must_use]
    pub fn adapter_info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Returns the device, for callers that record their own commands.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// Whether indirect dispatches are used, which read the number of workgroups from a buffer.
    pub(in crate::gpu) fn is_indirect(&self) -> bool {
        self.is_indirect
    }

    /// Whether one pass takes whole samples where it can.
    pub(in crate::gpu) fn is_one_pass(&self) -> bool {
        self.is_one_pass
    }

    /// Returns the queue, for callers that record their own commands.
    #[must_use]
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// Tests whether the arithmetic of the device has the properties that the error bounds of the checker assume.
    ///
    /// # Errors
    /// If the device fails. A property that the device lacks is not an error; the report contains it.
    pub fn self_test(&self, extent: SelfTestExtent) -> Result<SelfTestReport, GpuError> {
        self.alone(|_| {
            let run = SelfTestRun::new(&self.device, extent)?;
            let mut encoder = self.encoder();
            run.record(&mut encoder);
            self.run(encoder, &run.buffers())?;
            run.judge()
        })
    }

    /// Copies a scene to the device, brick by brick, with the structures that were built for it. They come from
    /// [`RenderPlan::build`](crate::gpu::RenderPlan::build), or from a single [`Accel`].
    ///
    /// # Errors
    /// If the scene does not fit into the device's memory or limits, or if the device fails.
    pub fn upload(&self, scene: &Scene, structures: &Structures) -> Result<SceneBuffers, GpuError> {
        let Structures { accel, occluders } = structures;
        // This renderer only provides the bind group layouts. Equal layouts of one device are compatible.
        let options = RendererOptions {
            cameras: Vec::new(),
            structures: [accel].into_iter().chain(occluders).map(Accel::structure).collect(),
            ..RendererOptions::default()
        };
        self.alone(|_| {
            let renderer = Renderer::new(&self.device, &options)?;
            let (device, queue) = (&self.device, &self.queue);
            let upload = |summary, accel, ids: &ShapeIds| {
                SceneBuffers::upload(&renderer, device, queue, summary, accel, ids, || {
                    let submission = queue.submit([]);
                    self.wait(&[], submission)
                })
            };
            let ids = ShapeIds::of_all(scene, accel);
            let all = upload(SceneSummary::of(scene), accel, &ids)?;
            let of_occluders = |accel| {
                upload(SceneSummary::of_occluders(scene), accel, &ShapeIds::of_opaque(scene))
            };
            Ok(all.with_occluders(occluders.as_ref().map(of_occluders).transpose()?))
        })
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
        settings.check(scene)?;
        let plan = |choice| self.plan(scene, view, settings, layers, choice, 0);
        let picture = self.with_uploaded(scene, plan, |buffers| {
            self.render_uploaded(buffers, view, settings, layers, &mut go_on)
        })?;
        Ok(picture.image)
    }

    /// Uploads a scene in the structures that suit it and calls `work` with it. If rays need too many steps in these
    /// structures, this is repeated with others.
    pub(in crate::gpu) fn with_uploaded<T>(
        &self,
        scene: &Scene,
        plan: impl Fn(AccelChoice) -> RenderPlan,
        work: impl Fn(&SceneBuffers) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let done: Result<_, Infallible> = with_retries(
            AccelChoice::Auto,
            plan,
            |_| {},
            |plan| {
                let structures = plan.build(scene);
                let buffers = self.upload(scene, &structures);
                drop(structures);
                Ok(buffers.and_then(|buffers| work(&buffers)))
            },
        );
        match done {
            Ok(done) => done,
            Err(never) => match never {},
        }
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
        if settings.integrator.is_primary() {
            let primary = scene.primary_settings(settings)?;
            let image = self.render_primary(scene, view, &primary, layers, watch)?;
            Ok(Picture { image, samples: 1, noise: None, hits: None })
        } else {
            self.render_lit(scene, view, settings, layers, watch)
        }
    }

    /// Submits an encoder that traces some workgroups, waits until it has finished and the buffers are mapped, and
    /// records the elapsed time for the size of the next submission.
    pub(in crate::gpu) fn submit_slice(
        &self,
        encoder: CommandEncoder,
        groups: Groups,
        scene: &SceneBuffers,
        mapped: &[&wgpu::Buffer],
    ) -> Result<Duration, GpuError> {
        let started = Instant::now();
        self.run(encoder, mapped)?;
        let elapsed = started.elapsed();
        scene.adapt_submission_size(groups, elapsed);
        Ok(elapsed)
    }

    pub(in crate::gpu) fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Replaces an error by the loss of the device, if that is its cause: a lost device causes many kinds of errors.
    fn explained(&self, error: GpuError) -> GpuError {
        // Callbacks run while polling. The result of the poll itself does not matter here.
        let _ = self.device.poll(wgpu::PollType::Poll);
        match self.faults.check() {
            Err(lost @ GpuError::DeviceLost { .. }) => lost,
            _ => error,
        }
    }

    /// Calls `work` with the renderer for a key, while no other thread uses this device.
    pub(in crate::gpu) fn with_renderer<T>(
        &self,
        key: RendererKey,
        work: impl FnOnce(&Renderer) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(|renderers| renderers.of(&self.device, key).and_then(work))
    }

    /// Calls `work` with the passes for a key, while no other thread uses this device.
    pub(in crate::gpu) fn with_lit_passes<T>(
        &self,
        key: LitKey,
        work: impl FnOnce(&LitPasses) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(|renderers| renderers.lit(&self.device, key).and_then(work))
    }

    /// Calls `work` with the pass that writes new colours, while no other thread uses this device.
    pub(in crate::gpu) fn with_recolor<T>(
        &self,
        work: impl FnOnce(&Recolor) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(|renderers| renderers.recolor(&self.device).and_then(work))
    }

    /// Calls `work` while no other thread uses this device.
    fn alone<T>(
        &self,
        work: impl FnOnce(&mut Renderers) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let mut renderers = self.renderers.lock().unwrap_or_else(PoisonError::into_inner);
        self.faults.forget();
        work(&mut renderers).map_err(|error| self.explained(error))
    }

    /// Submits an encoder without waiting.
    pub(in crate::gpu) fn start(&self, encoder: CommandEncoder) -> wgpu::SubmissionIndex {
        self.queue.submit([encoder.finish()])
    }

    /// Submits an encoder, and waits until it has finished and the buffers are mapped.
    pub(in crate::gpu) fn run(
        &self,
        encoder: CommandEncoder,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        let submission = self.start(encoder);
        self.wait(mapped, submission)
    }

    /// Waits until a submission has finished and the buffers are mapped.
    pub(in crate::gpu) fn wait(
        &self,
        mapped: &[&wgpu::Buffer],
        submission: wgpu::SubmissionIndex,
    ) -> Result<(), GpuError> {
        for buffer in mapped {
            let faults = Arc::clone(&self.faults);
            buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
                if let Err(error) = mapped {
                    faults.report(GpuError::Device { message: error.to_string() });
                }
            });
        }
        let polled = self.device.poll(wgpu::PollType::Wait {
            submission_index: Some(submission),
            timeout: Some(self.timeout),
        });
        // A fault that the device reported explains more than the failure of the poll.
        self.faults.check()?;
        match polled {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => Err(GpuError::Timeout { waited: self.timeout }),
            Err(error) => Err(GpuError::Device { message: error.to_string() }),
        }
    }
}
