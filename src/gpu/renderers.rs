//! The renderers of a device, each built when it is first wanted.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

use wgpu::Device;

use super::edit::ShaderEdit;
use super::error::GpuError;
use super::formats::ColorTarget;
use super::lit::{AllLitPasses, LitKey, LitPasses};
use super::recolor::Recolor;
use super::renderer::Renderer;
use super::renderer_options::{Query, RendererOptions};
use super::scene_buffers::SceneBuffers;
use crate::accel::BrickKind;
use crate::camera::{Camera, CameraKind};

/// What they differ in.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct RendererKey {
    pub(super) camera: CameraKind,
    /// Of the scene's bricks, each once.
    pub(super) kinds: Vec<BrickKind>,
    pub(super) several_bricks: bool,
    pub(super) query: Query,
    pub(super) data_layers: bool,
    pub(super) keeps_rays: bool,
}

impl RendererKey {
    /// Pictures of colour alone.
    pub(super) fn new(scene: &SceneBuffers, camera: &dyn Camera) -> Self {
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

/// What has been built so far.
#[derive(Debug)]
pub(super) struct Renderers {
    built: HashMap<RendererKey, Renderer>,
    lit: AllLitPasses,
    recolor: Option<Recolor>,
    edits: Vec<ShaderEdit>,
}

impl Renderers {
    /// None yet; all will be built with these changes of their shaders.
    pub(super) fn new(edits: Vec<ShaderEdit>) -> Self {
        Self { built: HashMap::new(), lit: AllLitPasses::new(), recolor: None, edits }
    }

    /// The renderer that a key stands for.
    pub(super) fn of(&mut self, device: &Device, key: RendererKey) -> Result<&Renderer, GpuError> {
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
                    edits: self.edits.clone(),
                };
                Ok(entry.insert(Renderer::new(device, &options)?))
            }
        }
    }

    /// The pass that writes new colours.
    pub(super) fn recolor(&mut self, device: &Device) -> Result<&Recolor, GpuError> {
        match &mut self.recolor {
            Some(built) => Ok(built),
            entry @ None => Ok(entry.insert(Recolor::new(device)?)),
        }
    }

    /// The passes of lit pictures that a key stands for.
    pub(super) fn lit(&mut self, device: &Device, key: LitKey) -> Result<&LitPasses, GpuError> {
        match self.lit.entry(key) {
            Entry::Occupied(built) => Ok(built.into_mut()),
            Entry::Vacant(entry) => Ok(entry.insert(LitPasses::new(device, key, &self.edits)?)),
        }
    }
}
