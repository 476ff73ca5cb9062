//! A window's surface, and the device that draws to it.

use std::sync::Arc;

use pinhole::gpu::wgpu;
use wgpu::CurrentSurfaceTexture;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use crate::Outcome;

/// The device and queue of a host, which pinhole uses by reference.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// The format of the surface's textures.
    pub format: wgpu::TextureFormat,
}

/// The surface of a window.
#[derive(Debug)]
pub struct WindowSurface {
    window: Arc<Window>,
    instance: wgpu::Instance,
    surface: wgpu::Surface<'static>,
    configuration: wgpu::SurfaceConfiguration,
}

impl WindowSurface {
    /// Opens a device that can draw to the window, with the default limits of WebGPU and no features. The format of the
    /// surface takes linear light if `is_srgb`, and otherwise encoded colours, if the window offers both.
    pub async fn open(window: Arc<Window>, display: OwnedDisplayHandle, is_srgb: bool) -> Outcome<(Self, Gpu)> {
        let mut descriptor = wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display));
        // Validation layers are off unless WGPU_VALIDATION=1 asks for them.
        descriptor.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(descriptor.with_env());
        let surface = instance.create_surface(Arc::clone(&window))?;
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: Some(&surface),
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = instance.request_adapter(&options).await?;
        log::info!("the adapter is {}", adapter.get_info().name);
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await?;
        let size = window.inner_size();
        let configuration = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or("the adapter cannot draw to the window")?;
        let formats = surface.get_capabilities(&adapter).formats;
        let format = formats.into_iter().find(|format| format.is_srgb() == is_srgb);
        let configuration = wgpu::SurfaceConfiguration {
            format: format.unwrap_or(configuration.format),
            present_mode: wgpu::PresentMode::AutoVsync,
            ..configuration
        };
        surface.configure(&device, &configuration);
        let gpu = Gpu { device, queue, format: configuration.format };
        Ok((Self { window, instance, surface, configuration }, gpu))
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.configuration.width, self.configuration.height]
    }

    /// Takes the window's new size. A minimized window has no pixels, and keeps its old size.
    pub fn resize(&mut self, gpu: &Gpu, [width, height]: [u32; 2]) {
        if width > 0 && height > 0 {
            (self.configuration.width, self.configuration.height) = (width, height);
            self.surface.configure(&gpu.device, &self.configuration);
        }
    }

    /// The next texture to draw to; `None` if there is none now. Another redraw was then requested if that helps.
    pub fn next_texture(&mut self, gpu: &Gpu) -> Outcome<Option<wgpu::SurfaceTexture>> {
        match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(texture) => return Ok(Some(texture)),
            // The texture can still be used once. The event with the new size follows.
            CurrentSurfaceTexture::Suboptimal(texture) => return Ok(Some(texture)),
            // winit reports when the window is visible again.
            CurrentSurfaceTexture::Occluded => return Ok(None),
            CurrentSurfaceTexture::Timeout => {}
            CurrentSurfaceTexture::Outdated => {
                self.surface.configure(&gpu.device, &self.configuration);
            }
            CurrentSurfaceTexture::Lost => {
                self.surface = self.instance.create_surface(Arc::clone(&self.window))?;
                self.surface.configure(&gpu.device, &self.configuration);
            }
            CurrentSurfaceTexture::Validation => return Err("wgpu refuses the surface".into()),
        }
        self.window.request_redraw();
        Ok(None)
    }
}
