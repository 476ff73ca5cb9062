//! Rendering without a display, on a device of our own.
//!
//! The only file of the library that submits, polls, or waits for a device's work.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use wgpu::{Adapter, AdapterInfo, CommandEncoder, ComputePassDescriptor, Device, Queue};

use super::adapter;
use super::derived::Derived;
use super::error::{GpuError, scoped};
use super::faults::Faults;
use super::frame::{Frame, Part, tile_size};
use super::lit::{LitKey, LitRenderer};
use super::options::{HeadlessOptions, Progress, Watch, required_limits, wanted_features};
use super::quirks;
use super::readback::ReadableTexture;
use super::recording::ReadableTrace;
use super::renderer::{Renderer, RendererOptions};
use super::renderers::{RendererKey, Renderers};
use super::scene_buffers::{SceneBuffers, binding_limit};
use super::seen::traced_pixels;
use super::self_test::{SelfTestExtent, SelfTestReport, SelfTestRun};
use super::tile_textures::TileTextures;
use super::tiles::{Groups, tiles};
use crate::accel::{Accel, AccelChoice, AccelPlan};
use crate::camera::Camera;
use crate::film::Film;
use crate::image::{Image, LayerSet};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::verify::TracedPixel;

/// A device for rendering without a display.
#[derive(Debug)]
pub struct Headless {
    info: AdapterInfo,
    device: Device,
    queue: Queue,
    timeout: Duration,
    faults: Arc<Faults>,
    /// Locked for the whole of a render, because faults cannot be told apart by render.
    renderers: Mutex<Renderers>,
}

impl Headless {
    /// Opens the first of [`adapter::candidates`] that gives a device.
    ///
    /// # Errors
    /// If there is no such adapter, or none gives a device.
    pub fn open(options: &HeadlessOptions) -> Result<Self, GpuError> {
        // Why the best one failed, if all do.
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

    /// Opens an adapter, whatever name the options have.
    ///
    /// # Errors
    /// If it gives no device.
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
        let renderers = Mutex::new(Renderers::new(options.edits.clone()));
        Ok(Self { info, device, queue, timeout, faults, renderers })
    }

    /// Name, driver and kind of the adapter in use.
    #[must_use]
    pub fn adapter_info(&self) -> &AdapterInfo {
        &self.info
    }

    /// The device, for a caller that wants to record by itself.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The queue, for a caller that wants to record by itself.
    #[must_use]
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// What to build of a scene for this device, and for many pictures.
    #[must_use]
    pub fn plan(&self, scene: &Scene, choice: AccelChoice) -> AccelPlan {
        let binding = binding_limit(&self.device.limits());
        quirks::plan(&self.info, scene, choice, |choice| {
            AccelPlan::new(scene.spheres(), choice, binding)
        })
    }

    /// What to build of a scene for this device, and for one picture.
    #[must_use]
    pub fn plan_once(&self, scene: &Scene, choice: AccelChoice, film: &Film) -> AccelPlan {
        let binding = binding_limit(&self.device.limits());
        quirks::plan(&self.info, scene, choice, |choice| {
            AccelPlan::for_rays(scene.spheres(), choice, binding, film.pixel_count())
        })
    }

    /// Tests whether the device computes as bounds of errors assume.
    ///
    /// # Errors
    /// If the device fails. That it lacks a property is in the report.
    pub fn self_test(&self, extent: SelfTestExtent) -> Result<SelfTestReport, GpuError> {
        self.alone(|_| {
            let run = SelfTestRun::new(&self.device, extent)?;
            let mut encoder = self.encoder();
            run.record(&mut encoder);
            self.run(encoder, &run.buffers())?;
            run.judge()
        })
    }

    /// Copies a scene to the device, brick by brick.
    ///
    /// # Errors
    /// If it does not fit the device, or if the device fails.
    pub fn upload(&self, scene: &Scene, accel: &Accel) -> Result<SceneBuffers, GpuError> {
        // Layouts are all that is needed, and those of one device are the same wherever they are made.
        let options = RendererOptions {
            cameras: Vec::new(),
            structures: vec![accel.structure()],
            ..RendererOptions::default()
        };
        self.alone(|_| {
            let renderer = Renderer::new(&self.device, &options)?;
            SceneBuffers::upload(&renderer, &self.device, &self.queue, scene, accel, || {
                let submission = self.queue.submit([]);
                self.wait(&[], submission)
            })
        })
    }

    /// Renders a picture with one ray through the centre of every pixel.
    ///
    /// A picture beyond the device's limits is rendered in tiles, and a scene beyond them in bricks; the
    /// picture does not depend on them. Where rays take too many steps in the structure that suits the data,
    /// another is built. A device renders one picture at a time; other threads wait.
    ///
    /// # Errors
    /// If scene or picture do not fit the device or the host's memory, or if the device fails.
    pub fn render(
        &self,
        scene: &Scene,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        self.with_uploaded(scene, film, |buffers| {
            let go_on = &mut |_| ControlFlow::Continue(());
            self.render_uploaded(buffers, camera, film, settings, layers, go_on)
        })
    }

    /// Does something with a scene in the structure that suits it for one picture; where rays take too many
    /// steps in that, once more with another.
    pub(super) fn with_uploaded<T>(
        &self,
        scene: &Scene,
        film: &Film,
        work: impl Fn(&SceneBuffers) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let plan = |choice| self.plan_once(scene, choice, film);
        with_structures(scene, plan, |accel| {
            let buffers = self.upload(scene, &accel)?;
            drop(accel);
            work(&buffers)
        })
    }

    /// As [`Headless::render`], of a scene that is on this device already. `watch` is told of progress.
    ///
    /// # Errors
    /// As [`Headless::render`]; [`GpuError::Stopped`] if `watch` says so.
    pub fn render_uploaded(
        &self,
        scene: &SceneBuffers,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
        layers: LayerSet,
        watch: &mut Watch<'_>,
    ) -> Result<Image, GpuError> {
        let data_layers = layers != LayerSet::COLOR;
        let key = RendererKey { data_layers, ..RendererKey::new(scene, camera) };
        self.with_renderer(key, |renderer| {
            let mut image = Image::new(film.width(), film.height(), layers)?;
            let view = (camera, film, settings);
            self.render_tiles(renderer, scene, view, &mut image, None, watch)?;
            Ok(image)
        })
    }

    pub(super) fn render_tiles(
        &self,
        renderer: &Renderer,
        scene: &SceneBuffers,
        (camera, film, settings): (&dyn Camera, &Film, &Settings),
        image: &mut Image,
        mut pixels: Option<&mut Vec<TracedPixel>>,
        watch: &mut Watch<'_>,
    ) -> Result<(), GpuError> {
        let tile_size = tile_size(&self.device.limits(), film, renderer.keeps_rays);
        let textures = scoped(&self.device, || {
            TileTextures::new(&self.device, tile_size, renderer.data_layers)
        })?;
        let mut frame = Frame::new(renderer, &self.device, &textures.targets())?;
        let traced = scoped(&self.device, || ReadableTrace::new(&self.device, &frame))?;
        let total = traced_pixels(scene, camera, film, tile_size);
        let derived = Derived { camera, film, colors: scene.colors() };
        let mut progress = Progress { done: 0, total };
        for tile in tiles(film, tile_size) {
            frame.set_tile(&self.queue, scene, camera, film, tile, settings);
            let mut encoder = self.encoder();
            if renderer.keeps_rays {
                // Those that are not traced are known by having none.
                frame.record_clear(&mut encoder);
            }
            let mut unfinished = Groups::NONE;
            for part in frame.parts() {
                let mut left = vec![part.groups];
                while let Some(groups) = Groups::take(&mut left, scene.pace().groups()) {
                    frame.set_first_group(&self.queue, part.band, groups.first);
                    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                    let slice = Part { groups, ..part };
                    renderer.record_trace(&mut pass, scene, &frame, slice)?;
                    drop(pass);
                    if left.is_empty() && part.is_last {
                        // Shaded and copied in the same submission.
                        unfinished = groups;
                        break;
                    }
                    self.submit_slice(encoder, groups, scene, &[])?;
                    progress.add(groups, watch)?;
                    encoder = self.encoder();
                }
                if part.is_last_of_band {
                    let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
                    renderer.record_shade(&mut pass, scene, &frame, part.band)?;
                }
            }
            for texture in textures.all() {
                texture.record_copy(&mut encoder, tile.size);
            }
            textures.status().record_copy(&mut encoder, frame.status());
            let mut mapped: Vec<_> = textures.all().map(ReadableTexture::buffer).collect();
            mapped.push(textures.status().buffer());
            if let Some(traced) = &traced {
                traced.record_copy(&mut encoder, &frame);
                mapped.extend(traced.buffers());
            }
            self.submit_slice(encoder, unfinished, scene, &mapped)?;
            if textures.status().read(|words: &[u32]| words[0])? != 0 {
                return Err(GpuError::Steps);
            }
            textures.read_into(image, tile, &derived)?;
            if let (Some(traced), Some(pixels)) = (&traced, &mut pixels) {
                traced.read_into(pixels, film, tile)?;
            }
            progress.add(unfinished, watch)?;
        }
        Ok(())
    }

    /// Submits the tracing of some workgroups, and what comes with it, waits until it is done and the buffers
    /// are mapped, and takes note of how long it took.
    pub(super) fn submit_slice(
        &self,
        encoder: CommandEncoder,
        groups: Groups,
        scene: &SceneBuffers,
        mapped: &[&wgpu::Buffer],
    ) -> Result<Duration, GpuError> {
        let started = Instant::now();
        self.run(encoder, mapped)?;
        let elapsed = started.elapsed();
        scene.took(groups, elapsed);
        Ok(elapsed)
    }

    pub(super) fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// A lost device shows itself as all kinds of errors; this asks it first.
    fn explained(&self, error: GpuError) -> GpuError {
        // Callbacks run while polling. That the poll fails is no news here.
        let _ = self.device.poll(wgpu::PollType::Poll);
        match self.faults.check() {
            Err(lost @ GpuError::DeviceLost { .. }) => lost,
            _ => error,
        }
    }

    /// Works with the renderer that a key stands for, alone on this device.
    pub(super) fn with_renderer<T>(
        &self,
        key: RendererKey,
        work: impl FnOnce(&Renderer) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(|renderers| renderers.of(&self.device, key).and_then(work))
    }

    /// Works with the lit renderer that a key stands for, alone on this device.
    pub(super) fn with_lit_renderer<T>(
        &self,
        key: LitKey,
        work: impl FnOnce(&LitRenderer) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        self.alone(|renderers| renderers.lit(&self.device, key).and_then(work))
    }

    /// Works with the device while no other thread does.
    fn alone<T>(
        &self,
        work: impl FnOnce(&mut Renderers) -> Result<T, GpuError>,
    ) -> Result<T, GpuError> {
        let mut renderers = self.renderers.lock().unwrap_or_else(PoisonError::into_inner);
        self.faults.forget();
        work(&mut renderers).map_err(|error| self.explained(error))
    }

    /// Submits, and waits until it is done and the buffers are mapped.
    pub(super) fn run(
        &self,
        encoder: CommandEncoder,
        mapped: &[&wgpu::Buffer],
    ) -> Result<(), GpuError> {
        let submission = self.queue.submit([encoder.finish()]);
        self.wait(mapped, submission)
    }

    /// Waits until the submission is done and the buffers are mapped.
    fn wait(
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
        // What the device says of itself is more telling than that polling failed.
        self.faults.check()?;
        match polled {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => Err(GpuError::Timeout { waited: self.timeout }),
            Err(error) => Err(GpuError::Device { message: error.to_string() }),
        }
    }
}

/// Does something with a scene in the structure that is planned; where rays take too many steps in that, once more
/// with another.
pub(super) fn with_structures<T>(
    scene: &Scene,
    plan: impl Fn(AccelChoice) -> AccelPlan,
    work: impl Fn(Accel) -> Result<T, GpuError>,
) -> Result<T, GpuError> {
    let mut choice = AccelChoice::Auto;
    loop {
        let accel = plan(choice).build(scene.spheres());
        let structure = accel.structure();
        match (work(accel), structure.instead()) {
            (Err(GpuError::Steps), Some(other)) => choice = other,
            (result, _) => return result,
        }
    }
}
