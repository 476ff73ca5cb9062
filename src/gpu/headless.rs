//! Rendering without a display, on a device of our own.
//!
//! The only file of the library that submits, polls, or waits for a device's work.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use wgpu::{Adapter, AdapterInfo, Device, Queue};

use super::adapter;
use super::error::{GpuError, scoped};
use super::frame::Frame;
use super::renderer::{ColorTarget, Renderer, RendererOptions};
use super::scene_buffers::SceneBuffers;
use super::tile_textures::TileTextures;
use super::tiles::{tile_size, tiles};
use crate::camera::{Camera, CameraKind};
use crate::film::Film;
use crate::image::{Image, LayerSet};
use crate::scene::Scene;
use crate::settings::Settings;

/// How long one submission may take before it is given up.
const MAX_WAIT: Duration = Duration::from_secs(600);

/// A device for rendering without a display.
#[derive(Debug)]
pub struct Headless {
    info: AdapterInfo,
    device: Device,
    queue: Queue,
    faults: Arc<Faults>,
    /// Locked for the whole of a render, because faults cannot be told apart by render.
    renderers: Mutex<Renderers>,
}

/// What has been built so far, by camera and whether there are data layers.
type Renderers = HashMap<(CameraKind, bool), Renderer>;

/// What wgpu reported outside any call.
#[derive(Debug, Default)]
struct Faults {
    first: Mutex<Option<GpuError>>,
}

impl Faults {
    /// Keeps the first fault, unless this one explains it: what follows a lost device is noise.
    fn report(&self, fault: GpuError) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() || matches!(fault, GpuError::DeviceLost { .. }) {
            *first = Some(fault);
        }
    }

    /// Forgets what an earlier render or the caller's own commands met; a lost device stays lost.
    fn forget(&self) {
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        first.take_if(|fault| !matches!(fault, GpuError::DeviceLost { .. }));
    }

    fn check(&self) -> Result<(), GpuError> {
        match self.first.lock().unwrap_or_else(PoisonError::into_inner).clone() {
            Some(fault) => Err(fault),
            None => Ok(()),
        }
    }
}

impl Headless {
    /// Opens the first of [`adapter::candidates`] that gives a device.
    ///
    /// # Errors
    /// If there is no such adapter, or none gives a device.
    pub fn open(adapter_name: Option<&str>) -> Result<Self, GpuError> {
        // Why the best one failed, if all do.
        let mut refusal = GpuError::NoAdapter;
        for adapter in &adapter::candidates(adapter_name)? {
            match Self::from_adapter(adapter) {
                Ok(headless) => return Ok(headless),
                Err(error) if refusal == GpuError::NoAdapter => refusal = error,
                Err(_) => {}
            }
        }
        Err(refusal)
    }

    /// Opens an adapter.
    ///
    /// # Errors
    /// If it gives no device.
    pub fn from_adapter(adapter: &Adapter) -> Result<Self, GpuError> {
        let info = adapter.get_info();
        let available = adapter.limits();
        // WebGPU's limits, where the adapter has them, so that a picture does not depend on more; and
        // all that it has of what bounds the size of pictures and scenes.
        let mut required_limits = wgpu::Limits::default()
            .or_worse_values_from(&available)
            .using_resolution(available.clone());
        required_limits.max_buffer_size = available.max_buffer_size;
        required_limits.max_storage_buffer_binding_size = available.max_storage_buffer_binding_size;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("pinhole"),
            required_limits,
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
        Ok(Self { info, device, queue, faults, renderers: Mutex::default() })
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

    /// Renders a picture with one ray through the centre of every pixel.
    ///
    /// A picture beyond the device's limits is rendered in tiles; it does not depend on them. A device
    /// renders one picture at a time; other threads wait.
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
        let mut renderers = self.renderers.lock().unwrap_or_else(PoisonError::into_inner);
        self.faults.forget();
        self.renderer(&mut renderers, camera.kind(), layers != LayerSet::COLOR)
            .and_then(|renderer| self.render_with(renderer, scene, camera, film, settings, layers))
            .map_err(|error| self.explained(error))
    }

    fn render_with(
        &self,
        renderer: &Renderer,
        scene: &Scene,
        camera: &dyn Camera,
        film: &Film,
        settings: &Settings,
        layers: LayerSet,
    ) -> Result<Image, GpuError> {
        let mut image = Image::new(film.width(), film.height(), layers)?;
        let scene_buffers = SceneBuffers::new(renderer, &self.device, &self.queue, scene)?;
        let side_limit = self.device.limits().max_texture_dimension_2d;
        let tile_size = tile_size(film, side_limit, scene.len());
        let textures = scoped(&self.device, || {
            TileTextures::new(&self.device, tile_size, renderer.data_layers)
        })?;
        let mut frame = Frame::new(renderer, &self.device, &textures.targets())?;
        for tile in tiles(film, tile_size) {
            frame.set_tile(&self.queue, &scene_buffers, camera, film, tile, settings);
            let mut encoder =
                self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            renderer.record(&mut encoder, &scene_buffers, &frame)?;
            for texture in textures.all() {
                texture.record_copy(&mut encoder, tile.size);
            }
            let submission = self.queue.submit([encoder.finish()]);
            self.wait(&textures, submission)?;
            textures.read_into(&mut image, tile)?;
        }
        Ok(image)
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

    fn renderer<'a>(
        &self,
        renderers: &'a mut Renderers,
        camera: CameraKind,
        data_layers: bool,
    ) -> Result<&'a Renderer, GpuError> {
        match renderers.entry((camera, data_layers)) {
            Entry::Occupied(built) => Ok(built.into_mut()),
            Entry::Vacant(place) => {
                let color = ColorTarget::Linear32;
                let options = RendererOptions { color, data_layers, cameras: vec![camera] };
                Ok(place.insert(Renderer::new(&self.device, &options)?))
            }
        }
    }

    /// Waits until the submission is done and its textures' buffers are mapped.
    fn wait(
        &self,
        textures: &TileTextures,
        submission: wgpu::SubmissionIndex,
    ) -> Result<(), GpuError> {
        for texture in textures.all() {
            let faults = Arc::clone(&self.faults);
            texture.buffer().map_async(wgpu::MapMode::Read, .., move |mapped| {
                if let Err(error) = mapped {
                    faults.report(GpuError::Device { message: error.to_string() });
                }
            });
        }
        let polled = self.device.poll(wgpu::PollType::Wait {
            submission_index: Some(submission),
            timeout: Some(MAX_WAIT),
        });
        // What the device says of itself is more telling than that polling failed.
        self.faults.check()?;
        match polled {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => Err(GpuError::Timeout { waited: MAX_WAIT }),
            Err(error) => Err(GpuError::Device { message: error.to_string() }),
        }
    }
}
