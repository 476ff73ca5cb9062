//! Textures that a host has only for the pictures of spheres.

use wgpu::{Device, TextureUsages, TextureView};

use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::passes::targets::{DataTargets, Targets};
use crate::gpu::resources::texture;
use crate::gpu::shader::formats::{DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};

/// Textures for the targets of a frame, in the formats of a renderer. They are for hosts that have no textures of their
/// own to be written to; a host whose picture changes its size makes new ones.
///
/// Each has the usages `STORAGE_BINDING`, `TEXTURE_BINDING` and `COPY_SRC`, so that [`Composite`](crate::gpu::Composite)
/// can draw them, [`Picker`](crate::gpu::Picker) can copy from them, and the host can do both.
#[derive(Clone, Debug)]
pub struct TargetTextures {
    color: TextureView,
    /// Depth, normal and id.
    data: Option<[TextureView; 3]>,
    size: [u32; 2],
}

impl TargetTextures {
    /// Creates textures of `size`, in columns and rows. There are data layers if the renderer has them.
    ///
    /// # Errors
    /// If the size is zero or more than the device allows, or if the device has no memory left.
    pub async fn new_async(
        renderer: &Renderer,
        device: &Device,
        size: [u32; 2],
    ) -> Result<Self, GpuError> {
        let usage = TextureUsages::STORAGE_BINDING
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC;
        let texture = |label, format| {
            let texture = texture(device, label, format, size, usage);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (color, data) = scoped(device, || {
            let color = texture("pinhole color", renderer.color.texture_format());
            let data = renderer.data_layers.then(|| {
                [
                    ("pinhole depth", DEPTH_FORMAT),
                    ("pinhole normal", NORMAL_FORMAT),
                    ("pinhole id", ID_FORMAT),
                ]
                .map(|(label, format)| texture(label, format))
            });
            (color, data)
        })
        .await?;
        Ok(Self { color, data, size })
    }

    /// The targets, for frames, composites and picks.
    #[must_use]
    pub fn targets(&self) -> Targets<'_> {
        let data = self.data.as_ref();
        let data = data.map(|[depth, normal, id]| DataTargets { depth, normal, id });
        Targets { color: &self.color, data }
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}
