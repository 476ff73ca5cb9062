//! The renderers of a device, each of which is built when it is first needed.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
#[cfg(not(target_arch = "wasm32"))]
use std::panic::resume_unwind;
#[cfg(not(target_arch = "wasm32"))]
use std::thread::JoinHandle;

use wgpu::Device;

use crate::accel::BrickKind;
use crate::camera::{Camera, CameraKind};
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::headless::waiting::Wait;
use crate::gpu::passes::lit::{AllLitPasses, LitKey, LitPasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::RendererOptions;
#[cfg(not(target_arch = "wasm32"))]
use crate::gpu::profile::Profile;
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::self_test::fence_probe;
use crate::gpu::shader::formats::ColorTarget;
use crate::image::LayerSet;

/// The properties in which renderers of a device differ.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct RendererKey {
    pub(crate) camera: CameraKind,
    /// The kinds of the scene's bricks, without repetition.
    pub(crate) kinds: Vec<BrickKind>,
    pub(crate) several_bricks: bool,
    pub(crate) data_layers: bool,
    pub(crate) keeps_rays: bool,
    /// Whether it records sums in place of rays, for the self-test.
    pub(crate) probes_fences: bool,
}

impl RendererKey {
    /// The key of a renderer for pictures without data layers.
    pub(crate) fn new(scene: &SceneBuffers, camera: &dyn Camera) -> Self {
        Self::of_picture(scene.kinds(), scene.bricks.len() > 1, camera, LayerSet::COLOR)
    }

    /// The key of a renderer for pictures of bricks of these kinds, of which there may be several.
    pub(crate) fn of_picture(
        kinds: Vec<BrickKind>,
        several_bricks: bool,
        camera: &dyn Camera,
        layers: LayerSet,
    ) -> Self {
        Self {
            camera: camera.kind(),
            kinds,
            several_bricks,
            data_layers: layers != LayerSet::COLOR,
            keeps_rays: false,
            probes_fences: false,
        }
    }
}

/// The renderers and passes that have been built so far.
#[derive(Debug, Default)]
pub(crate) struct Renderers {
    built: HashMap<RendererKey, Renderer>,
    /// Renderers that threads build ahead of their use.
    #[cfg(not(target_arch = "wasm32"))]
    ahead: HashMap<RendererKey, JoinHandle<Result<Renderer, GpuError>>>,
    lit: AllLitPasses,
    recolor: Option<Recolor>,
    edits: Edits,
}

impl Renderers {
    /// Creates an empty collection. All renderers will be built with these edits of their shaders.
    pub(crate) fn new(edits: Edits) -> Self {
        Self { edits, ..Self::default() }
    }

    fn options(&self, device_type: wgpu::DeviceType, key: &RendererKey) -> RendererOptions {
        let RendererKey { camera, several_bricks, data_layers, keeps_rays, .. } = *key;
        let structures: HashSet<_> = key.kinds.iter().map(|kind| kind.structure).collect();
        let primitives: HashSet<_> = key.kinds.iter().map(|kind| kind.primitive).collect();
        let probe = key.probes_fences.then(fence_probe::edit);
        RendererOptions {
            color: ColorTarget::Linear32,
            data_layers,
            cameras: vec![camera],
            structures: structures.into_iter().collect(),
            primitives: primitives.into_iter().collect(),
            several_bricks,
            keeps_rays,
            indirect: true,
            device_type: Some(device_type),
            edits: probe.into_iter().chain(self.edits.replacements.clone()).collect(),
            rewrite: self.edits.rewrite.clone(),
        }
    }

    /// Begins to build the renderer for a key on a thread of its own, if there is none and a thread can be started. It is
    /// taken by [`Renderers::of`], which also returns the error of building it. Browsers build pipelines beside other
    /// work by themselves.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn begin(
        &mut self,
        device: &Device,
        device_type: wgpu::DeviceType,
        key: RendererKey,
        profile: Option<Profile>,
    ) {
        if self.built.contains_key(&key) || self.ahead.contains_key(&key) {
            return;
        }
        let (device, options) = (device.clone(), self.options(device_type, &key));
        let build = move || {
            let _phase = profile.as_ref().map(|profile| profile.phase("create pipelines"));
            Renderer::new(&device, &options).wait()
        };
        let thread = std::thread::Builder::new().name("pinhole: pipelines".to_owned());
        if let Ok(thread) = thread.spawn(build) {
            self.ahead.insert(key, thread);
        }
    }

    /// Waits for the renderer that a thread builds for a key, if one does.
    #[cfg(not(target_arch = "wasm32"))]
    fn take_ahead(&mut self, key: &RendererKey) -> Result<(), GpuError> {
        if let Some(thread) = self.ahead.remove(key) {
            let renderer = thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
            self.built.insert(key.clone(), renderer);
        }
        Ok(())
    }

    /// Returns the renderer for a key, and builds it if necessary.
    pub(crate) async fn of(
        &mut self,
        device: &Device,
        device_type: wgpu::DeviceType,
        key: RendererKey,
    ) -> Result<&Renderer, GpuError> {
        #[cfg(not(target_arch = "wasm32"))]
        self.take_ahead(&key)?;
        let options = self.options(device_type, &key);
        match self.built.entry(key) {
            Entry::Occupied(built) => Ok(built.into_mut()),
            Entry::Vacant(entry) => Ok(entry.insert(Renderer::new(device, &options).await?)),
        }
    }

    /// Returns the pass that writes new colours, and builds it if necessary.
    pub(crate) async fn recolor(&mut self, device: &Device) -> Result<&Recolor, GpuError> {
        match &mut self.recolor {
            Some(built) => Ok(built),
            entry @ None => Ok(entry.insert(Recolor::new(device).await?)),
        }
    }

    /// Returns the passes of lit pictures for a key, and builds them if necessary.
    pub(crate) async fn lit(
        &mut self,
        device: &Device,
        key: LitKey,
    ) -> Result<&LitPasses, GpuError> {
        match self.lit.entry(key) {
            Entry::Occupied(built) => Ok(built.into_mut()),
            Entry::Vacant(entry) => {
                Ok(entry.insert(LitPasses::new(device, key, &self.edits).await?))
            }
        }
    }
}
