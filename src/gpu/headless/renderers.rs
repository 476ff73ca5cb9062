//! The renderers of a device, each of which is built when it is first needed.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use wgpu::Device;

use crate::accel::BrickKind;
use crate::camera::{Camera, CameraKind};
use crate::gpu::edit::ShaderEdit;
use crate::gpu::error::GpuError;
use crate::gpu::passes::lit::{AllLitPasses, LitKey, LitPasses};
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::renderer_options::{Query, RendererOptions};
use crate::gpu::scene::recolor::Recolor;
use crate::gpu::scene::scene_buffers::SceneBuffers;
use crate::gpu::shader::formats::ColorTarget;

/// The properties in which renderers of a device differ.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(in crate::gpu) struct RendererKey {
    pub(in crate::gpu) camera: CameraKind,
    /// The kinds of the scene's bricks, without repetition.
    pub(in crate::gpu) kinds: Vec<BrickKind>,
    pub(in crate::gpu) several_bricks: bool,
    pub(in crate::gpu) query: Query,
    pub(in crate::gpu) data_layers: bool,
    pub(in crate::gpu) keeps_rays: bool,
}

impl RendererKey {
    /// The key of a renderer for pictures without data layers.
    pub(in crate::gpu) fn new(scene: &SceneBuffers, camera: &dyn Camera) -> Self {
        Self {
            camera: camera.kind(),
            kinds: scene.kinds(),
            several_bricks: scene.bricks().len() > 1,
            query: Query::Nearest,
            data_layers: false,
            keeps_rays: false,
        }
    }
}

/// The renderers and passes that have been built so far.
#[derive(Debug, Default)]
pub(in crate::gpu) struct Renderers {
    built: HashMap<RendererKey, Renderer>,
    lit: AllLitPasses,
    recolor: Option<Recolor>,
    edits: Vec<ShaderEdit>,
}

impl Renderers {
    /// Creates an empty collection. All renderers will be built with these edits of their shaders.
    pub(in crate::gpu) fn new(edits: Vec<ShaderEdit>) -> Self {
        Self { built: HashMap::new(), lit: AllLitPasses::new(), recolor: None, edits }
    }

    /// Returns the renderer for a key, and builds it if necessary.
    pub(in crate::gpu) async fn of(
        &mut self,
        device: &Device,
        device_type: wgpu::DeviceType,
        key: RendererKey,
    ) -> Result<&Renderer, GpuError> {
        let RendererKey { camera, several_bricks, query, data_layers, keeps_rays, .. } = key;
        let structures: HashSet<_> = key.kinds.iter().map(|kind| kind.structure).collect();
        let primitives: HashSet<_> = key.kinds.iter().map(|kind| kind.primitive).collect();
        match self.built.entry(key) {
            Entry::Occupied(built) => Ok(built.into_mut()),
            Entry::Vacant(entry) => {
                let options = RendererOptions {
                    color: ColorTarget::Linear32,
                    data_layers,
                    cameras: vec![camera],
                    structures: structures.into_iter().collect(),
                    primitives: primitives.into_iter().collect(),
                    several_bricks,
                    query,
                    keeps_rays,
                    indirect: true,
                    device_type: Some(device_type),
                    edits: self.edits.clone(),
                };
                Ok(entry.insert(Renderer::new_async(device, &options).await?))
            }
        }
    }

    /// Returns the pass that writes new colours, and builds it if necessary.
    pub(in crate::gpu) async fn recolor(&mut self, device: &Device) -> Result<&Recolor, GpuError> {
        match &mut self.recolor {
            Some(built) => Ok(built),
            entry @ None => Ok(entry.insert(Recolor::new_async(device).await?)),
        }
    }

    /// Returns the passes of lit pictures for a key, and builds them if necessary.
    pub(in crate::gpu) async fn lit(
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
