//! The renderers of a device, each of which is built when it is first needed.

#[cfg(not(target_arch = "wasm32"))]
use std::panic::resume_unwind;
#[cfg(not(target_arch = "wasm32"))]
use std::thread::JoinHandle;

use wgpu::Device;

use crate::gpu::error::GpuError;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::headless::waiting::Wait;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::profile::Profile;

/// The renderers that have been built so far.
#[derive(Debug, Default)]
pub(crate) struct Renderers {
    built: Vec<(RendererOptions, Renderer)>,
    /// Renderers that threads build ahead of their use.
    #[cfg(not(target_arch = "wasm32"))]
    ahead: Vec<(RendererOptions, JoinHandle<Result<Renderer, GpuError>>)>,
}

impl Renderers {
    /// Begins to build a renderer on a separate thread, unless it exists already or no thread can be
    /// started. [`Renderers::of`] returns the renderer, or the error of building it. Browsers build
    /// pipelines beside other work by themselves.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn begin(&mut self, device: &Device, options: RendererOptions, profile: Option<Profile>) {
        let mut known = self.built.iter().map(|(of, _)| of).chain(self.ahead.iter().map(|(of, _)| of));
        if known.any(|of| *of == options) {
            return;
        }
        let (device, wanted) = (device.clone(), options.clone());
        let build = move || {
            let _phase = profile.as_ref().map(|profile| profile.phase("create pipelines"));
            Renderer::new(&device, &wanted).wait()
        };
        let thread = std::thread::Builder::new().name("pinhole: pipelines".to_owned());
        if let Ok(thread) = thread.spawn(build) {
            self.ahead.push((options, thread));
        }
    }

    /// Waits for the thread that builds the renderer with these options, if there is one.
    #[cfg(not(target_arch = "wasm32"))]
    fn take_ahead(&mut self, options: &RendererOptions) -> Result<(), GpuError> {
        if let Some(place) = self.ahead.iter().position(|(of, _)| of == options) {
            let (options, thread) = self.ahead.swap_remove(place);
            let renderer = thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
            self.built.push((options, renderer));
        }
        Ok(())
    }

    /// Returns the renderer with these options, and builds it if necessary.
    pub(crate) async fn of(&mut self, device: &Device, options: RendererOptions) -> Result<&Renderer, GpuError> {
        #[cfg(not(target_arch = "wasm32"))]
        self.take_ahead(&options)?;
        let known = self.built.iter().position(|(of, _)| *of == options);
        let place = known.unwrap_or(self.built.len());
        if known.is_none() {
            let renderer = Renderer::new(device, &options).await?;
            self.built.push((options, renderer));
        }
        Ok(&self.built[place].1)
    }
}
