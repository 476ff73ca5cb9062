//! The passes of lit pictures for hosts, which are built when they are first needed.

use std::sync::Arc;

use wgpu::{ComputePipeline, Device};

use crate::camera::View;
use crate::gpu::cache::Cache;
use crate::gpu::checks::Checks;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::{LightingData, LitKey, LitLayouts, LitPasses, LitScene, LiveKey, LivePasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::formats::ColorTarget;
use crate::gpu::shader::{Kernel, color_target_choice, pipeline_with};
use crate::render::RenderSettings;

/// A renderer, with the pipelines of lit pictures that it has built so far. All lit pictures of a device can share one.
#[derive(Debug)]
pub struct LitRenderer {
    renderer: Renderer,
    passes: Cache<LitKey, LitPasses>,
    resolve: Cache<(), ComputePipeline>,
    live: Cache<LiveKey, LivePasses>,
}

impl LitRenderer {
    /// Adds lit pictures to a renderer. Nothing is built yet.
    #[must_use]
    pub fn new(renderer: Renderer) -> Self {
        Self { renderer, passes: Cache::default(), resolve: Cache::default(), live: Cache::default() }
    }

    /// Returns the renderer of primary rays, for scenes, frames and depth tests.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Returns the renderer of primary rays, of which [`Renderer::build_next`] may have more to build.
    #[must_use]
    pub fn renderer_mut(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Builds the pipelines for lit pictures of a scene, unless they are built already.
    /// [`LitPicture::new`] and [`LitPicture::set`] do the same when they need them. If another thread
    /// calls this before, they do not hold up a frame.
    ///
    /// # Errors
    /// The errors of [`RenderSettings::check`]; [`GpuError::NoOccluders`]; an error if the device rejects a kernel,
    /// which is a defect of this crate or of the driver.
    ///
    /// [`LitPicture::new`]: crate::gpu::LitPicture::new
    /// [`LitPicture::set`]: crate::gpu::LitPicture::set
    pub async fn build(
        &self,
        device: &Device,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<(), GpuError> {
        let (.., key) = lit_key(device, scene, view, settings)?;
        self.passes(device, key).await?;
        self.resolve(device).await?;
        Ok(())
    }

    /// Returns whether the pipelines for lit pictures of a scene are built, so that
    /// [`LitPicture::set`](crate::gpu::LitPicture::set) builds none.
    ///
    /// # Errors
    /// The errors of [`RenderSettings::check`]; [`GpuError::NoOccluders`].
    pub fn is_built(
        &self,
        device: &Device,
        scene: &SceneBuffers,
        view: &View<'_>,
        settings: &RenderSettings,
    ) -> Result<bool, GpuError> {
        let (.., key) = lit_key(device, scene, view, settings)?;
        Ok(self.passes.get(&key).is_some() && self.resolve.get(&()).is_some())
    }

    pub(super) async fn passes(&self, device: &Device, key: LitKey) -> Result<Arc<LitPasses>, GpuError> {
        self.passes.of(key, LitPasses::new(device, key, &self.renderer.edits)).await
    }

    pub(super) async fn live_passes(&self, device: &Device, key: LiveKey) -> Result<Arc<LivePasses>, GpuError> {
        let Renderer { color, data_layers, layouts, edits, .. } = &self.renderer;
        let targets = (*color, *data_layers, &layouts.targets);
        self.live.of(key, LivePasses::new(device, key, targets, edits)).await
    }

    pub(super) async fn resolve(&self, device: &Device) -> Result<Arc<ComputePipeline>, GpuError> {
        let Renderer { color, layouts, edits, .. } = &self.renderer;
        let build = async {
            let checks = Checks::default();
            let kernel = resolve_kernel(*color).edited(edits)?;
            let film = checks.create(device, || LitLayouts::new(device).film);
            let groups = [Some(&film), None, Some(&layouts.targets)];
            let pipeline = pipeline_with(device, &kernel, &groups, &checks);
            checks.passed().await?;
            Ok(pipeline)
        };
        self.resolve.of((), build).await
    }
}

/// A lit picture, its light, and the key of the passes that it needs.
pub(super) fn lit_key<'a>(
    device: &Device,
    scene: &'a SceneBuffers,
    view: &'a View<'a>,
    settings: &'a RenderSettings,
) -> Result<(LitScene<'a>, LightingData, LitKey), GpuError> {
    if settings.primary().is_some() {
        return Err(GpuError::NotLit);
    }
    let scenes = LitScene::new(scene, view, settings)?;
    let lighting = scenes.lighting();
    let key = scenes.key(&lighting, &device.limits());
    Ok((scenes, lighting, key))
}

pub(crate) fn resolve_kernel(color: ColorTarget) -> Kernel {
    Kernel::new("resolve", &[color_target_choice(color)])
}
