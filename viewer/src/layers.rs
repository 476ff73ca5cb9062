//! The textures of a quick picture.

use eframe::wgpu;
use pinhole::gpu::{DataTargets, RendererOptions, Targets};
use wgpu::{TextureFormat, TextureUsages, TextureView};

/// Textures of one size for colors and data.
pub(crate) struct Layers {
    pub(crate) color: TextureView,
    depth: TextureView,
    normal: TextureView,
    id: TextureView,
}

impl Layers {
    pub(crate) fn new(device: &wgpu::Device, [width, height]: [u32; 2]) -> Self {
        let layer = |format| {
            let usage = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING;
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("quick picture"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let color = layer(RendererOptions::default().color.texture_format());
        let data = [TextureFormat::R32Float, TextureFormat::Rgba32Float, TextureFormat::R32Uint];
        let [depth, normal, id] = data.map(layer);
        Self { color, depth, normal, id }
    }

    pub(crate) fn targets(&self) -> Targets<'_> {
        let data = DataTargets { depth: &self.depth, normal: &self.normal, id: &self.id };
        Targets { color: &self.color, data: Some(data) }
    }
}
