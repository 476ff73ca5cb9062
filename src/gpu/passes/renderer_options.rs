//! What a renderer is built for.

use crate::accel::{Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::edit::ShaderEdit;
use crate::gpu::shader::formats::ColorTarget;

/// What a renderer is built for. Fewer cameras are quicker to build.
#[derive(Clone, Debug)]
pub struct RendererOptions {
    /// The colour texture.
    pub color: ColorTarget,
    /// Whether depth, normal and id are written as well.
    pub data_layers: bool,
    /// The cameras that frames will use.
    pub cameras: Vec<CameraKind>,
    /// The structures that scenes will have.
    pub structures: Vec<Structure>,
    /// What scenes will consist of.
    pub primitives: Vec<Primitive>,
    /// Whether scenes may be too large for one binding, and so consist of several bricks.
    pub several_bricks: bool,
    /// What rays are asked. With [`Query::Any`] a renderer is good for measurements only.
    pub query: Query,
    /// Whether frames keep the ray of every pixel, 32 bytes each, for [`verify`](crate::verify).
    pub keeps_rays: bool,
    /// Changes of shaders; none, but in experiments and tests.
    pub edits: Vec<ShaderEdit>,
}

impl Default for RendererOptions {
    /// Eight-bit colour, no data layers, every camera, every structure that is chosen by itself.
    fn default() -> Self {
        Self {
            color: ColorTarget::default(),
            data_layers: false,
            cameras: CameraKind::ALL.to_vec(),
            structures: Structure::AUTOMATIC.to_vec(),
            primitives: vec![Primitive::Sphere],
            several_bricks: true,
            query: Query::Nearest,
            keeps_rays: false,
            edits: Vec::new(),
        }
    }
}

/// What a ray is asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Query {
    /// Which sphere is the nearest.
    #[default]
    Nearest,
    /// Whether there is any.
    Any,
}
