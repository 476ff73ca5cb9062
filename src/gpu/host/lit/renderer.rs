//! The passes of lit pictures for hosts, which are built when they are first needed.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use wgpu::{ComputePipeline, Device};

use super::resolve::resolve_pipeline;
use crate::camera::View;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::{LightingData, LitKey, LitPasses, LitScene, LiveKey, LivePasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::render::RenderSettings;

/// A renderer, with the pipelines of lit pictures that it has built so far. All lit pictures of a device can share one.
#[derive(Debug)]
pub struct LitRenderer {
    renderer: Renderer,
    passes: Mutex<HashMap<LitKey, Arc<LitPasses>>>,
    resolve: Mutex<Option<ComputePipeline>>,
    live: Mutex<HashMap<LiveKey, Arc<LivePasses>>>,
}

impl LitRenderer {
    /// Adds lit pictures to a renderer. Nothing is built yet.
    #[must_use]
    pub fn new(renderer: Renderer) -> Self {
        Self {
            renderer,
            passes: Mutex::default(),
            resolve: Mutex::default(),
            live: Mutex::default(),
        }
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

    /// Builds the pipelines for lit pictures of a scene, unless they are built already. [`LitPicture::new`] and
    /// [`LitPicture::set`] do the same when they need them; calling this on another thread before keeps them from
    /// holding up a frame.
    ///
    /// # Errors
    /// The errors of [`RenderSettings::check`]; [`GpuError::NoOccluders`]; an error if the device rejects a kernel,
    /// which is a defect of this crate or of the driver.
    ///
    /// [`LitPicture::new`]: crate::gpu::LitPicture::new
    /// [`LitPicture::set`]: crate::gpu::LitPicture::set
    pub async fn build_async(
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
        Ok(self.built_passes(&key).is_some() && self.built_resolve().is_some())
    }

    fn built_passes(&self, key: &LitKey) -> Option<Arc<LitPasses>> {
        self.passes.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned()
    }

    fn built_resolve(&self) -> Option<ComputePipeline> {
        self.resolve.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(super) async fn passes(
        &self,
        device: &Device,
        key: LitKey,
    ) -> Result<Arc<LitPasses>, GpuError> {
        if let Some(passes) = self.built_passes(&key) {
            return Ok(passes);
        }
        // The lock is not held while they are built. If two threads build them, one of the two is dropped.
        let built = Arc::new(LitPasses::new(device, key, &self.renderer.edits).await?);
        let mut passes = self.passes.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(passes.entry(key).or_insert(built)))
    }

    pub(in crate::gpu::host) async fn live_passes(
        &self,
        device: &Device,
        key: LiveKey,
    ) -> Result<Arc<LivePasses>, GpuError> {
        let built = self.live.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        if let Some(passes) = built {
            return Ok(passes);
        }
        let Renderer { color, data_layers, layouts, .. } = &self.renderer;
        let targets = (*color, *data_layers, &layouts.targets);
        let built = LivePasses::new(device, key, targets, &self.renderer.edits).await?;
        let mut live = self.live.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Arc::clone(live.entry(key).or_insert(Arc::new(built))))
    }

    pub(super) async fn resolve(&self, device: &Device) -> Result<ComputePipeline, GpuError> {
        if let Some(pipeline) = self.built_resolve() {
            return Ok(pipeline);
        }
        let Renderer { color, layouts, .. } = &self.renderer;
        let built =
            resolve_pipeline(device, *color, &layouts.targets, &self.renderer.edits).await?;
        let mut resolve = self.resolve.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(resolve.insert(built).clone())
    }
}

/// A lit picture, its light, and the key of the passes that it needs.
pub(in crate::gpu::host) fn lit_key<'a>(
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
