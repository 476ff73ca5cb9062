//! The options of a renderer of primary rays.

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::edit::{KernelRewrite, ShaderEdit};
use crate::gpu::shader::formats::ColorTarget;

/// The cameras, structures and targets that a renderer is built for. A renderer with fewer cameras is built more
/// quickly.
#[derive(Clone, Debug, PartialEq)]
pub struct RendererOptions {
    /// Format of the colour texture.
    pub color: ColorTarget,
    /// Whether depth, normal and id are also written.
    pub data_layers: bool,
    /// The cameras that frames will use.
    pub cameras: Vec<CameraKind>,
    /// The structures that the spheres of scenes will have.
    pub structures: Vec<Structure>,
    /// The structures that the cones and cylinders of scenes will have. Without any, scenes may have spheres only.
    pub cone_structures: Vec<Structure>,
    /// Whether scenes may be too large for one binding, so that they consist of several bricks. The same pipelines end
    /// rays at a host's depth, see [`Renderer::record_with_depth`](crate::gpu::Renderer::record_with_depth).
    pub several_bricks: bool,
    /// Whether frames keep the ray of every pixel, in 32 bytes each, for [`verify`](crate::verify).
    pub keeps_rays: bool,
    /// Whether lit pictures use indirect dispatches, so that the device traces only paths that continue. All adapters
    /// of this crate support them. The pictures do not depend on this option.
    pub indirect: bool,
    /// The type of device whose order and sizes of submissions are used; `None` is the type of the adapter. Only
    /// experiments and tests choose another. The pictures do not depend on this option.
    pub device_type: Option<wgpu::DeviceType>,
    /// Edits of the shader source. Only experiments and tests have any.
    pub edits: Vec<ShaderEdit>,
    /// A function that returns what the device gets in place of each kernel. Only tests set it.
    pub rewrite: Option<KernelRewrite>,
}

impl RendererOptions {
    /// The kinds of bricks for which there are pipelines.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = BrickKind> {
        let of_spheres = BrickKind::of(&self.structures, &[Primitive::Sphere]);
        of_spheres.chain(BrickKind::of(&self.cone_structures, &[Primitive::Cone]))
    }

    /// The options for bricks of these kinds.
    pub(crate) fn with_kinds(self, kinds: &[BrickKind]) -> Self {
        let structures_of = |primitive: Primitive| {
            let of_shapes = kinds.iter().filter(|kind| kind.primitive == primitive);
            // Sorted, so that equal options have equal lists.
            let mut structures: Vec<Structure> = of_shapes.map(|kind| kind.structure).collect();
            structures.sort_by_key(|structure| structure.name());
            structures.dedup();
            structures
        };
        let [structures, cone_structures] = [Primitive::Sphere, Primitive::Cone].map(structures_of);
        Self { structures, cone_structures, ..self }
    }

    /// The primitives of these bricks.
    pub(crate) fn primitives(&self) -> impl Iterator<Item = Primitive> {
        let of_cones = (!self.cone_structures.is_empty()).then_some(Primitive::Cone);
        (!self.structures.is_empty()).then_some(Primitive::Sphere).into_iter().chain(of_cones)
    }
}

impl Default for RendererOptions {
    /// Returns options for eight-bit colour without data layers, all cameras, and all structures that are chosen
    /// automatically.
    fn default() -> Self {
        Self {
            color: ColorTarget::default(),
            data_layers: false,
            cameras: CameraKind::ALL.to_vec(),
            structures: Structure::ALL.to_vec(),
            cone_structures: Vec::new(),
            several_bricks: true,
            keeps_rays: false,
            indirect: true,
            device_type: None,
            edits: Vec::new(),
            rewrite: None,
        }
    }
}
