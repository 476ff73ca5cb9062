//! The table of emissive spheres on a device: a texture, because a binding of a buffer may be as small as 128 MiB, while
//! an array of textures holds several gigabytes on every device.

use wgpu::{
    Device, Extent3d, Limits, Origin3d, Queue, TexelCopyBufferLayout, TexelCopyTextureInfo, TextureAspect,
    TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

use crate::accel::PlannedBuffer;

/// Width of the texture, the twin of `EMITTER_COLUMNS` in `shaders/scene/emitter.wgsl`. Every
/// device has textures of this size.
pub(crate) const COLUMNS: usize = 1 << 11;

/// Maximum number of rows of a layer, the twin of `EMITTER_ROWS`.
pub(crate) const ROWS: usize = 1 << 11;

const LAYER: usize = COLUMNS * ROWS;

/// The name of the table in plans.
pub(crate) const NAME: &str = "emitters";

/// The name of the table in errors.
pub(crate) const WHAT: &str = "the table of emissive spheres";

/// Width, height and number of layers of the texture for a table with this number of texels.
fn extent(texels: usize) -> Extent3d {
    let texels = texels.max(1);
    Extent3d {
        width: texels.min(COLUMNS) as u32,
        height: texels.div_ceil(COLUMNS).min(ROWS) as u32,
        depth_or_array_layers: texels.div_ceil(LAYER) as u32,
    }
}

/// The planned buffer of the table; `None` if it is empty. It is uploaded layer by layer.
pub(crate) fn planned(texels: usize) -> Option<PlannedBuffer> {
    let Extent3d { width, height, depth_or_array_layers } = extent(texels);
    let layer = 16 * u64::from(width) * u64::from(height);
    (texels > 0).then(|| PlannedBuffer {
        name: NAME,
        bytes: layer * u64::from(depth_or_array_layers),
        bytes_per_binding: layer,
    })
}

/// The largest table that a device holds, in bytes, and the name of the limit.
pub(crate) fn limit(limits: &Limits) -> (&'static str, u64) {
    let layers = u64::from(limits.max_texture_array_layers);
    ("the size of a texture with max_texture_array_layers", 16 * layers * LAYER as u64)
}

/// Creates the texture and uploads the table.
pub(crate) fn upload(device: &Device, queue: &Queue, table: &[[f32; 4]]) -> TextureView {
    let size = extent(table.len());
    let texture = device.create_texture(&TextureDescriptor {
        label: Some("pinhole emitters"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rgba32Uint,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let write = |texels: &[[f32; 4]], [row, layer]: [usize; 2]| {
        let columns = texels.len().min(COLUMNS) as u32;
        let rows = (texels.len() / columns.max(1) as usize) as u32;
        let origin = Origin3d { x: 0, y: row as u32, z: layer as u32 };
        queue.write_texture(
            TexelCopyTextureInfo { texture: &texture, mip_level: 0, origin, aspect: TextureAspect::All },
            bytemuck::cast_slice(texels),
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * columns), rows_per_image: None },
            Extent3d { width: columns, height: rows, depth_or_array_layers: 1 },
        );
    };
    for (layer, texels) in table.chunks(LAYER).enumerate() {
        // The full rows, and the rest of the last one.
        let full = texels.len() / COLUMNS * COLUMNS;
        let (rows, rest) = texels.split_at(full);
        if !rows.is_empty() {
            write(rows, [0, layer]);
        }
        if !rest.is_empty() {
            write(rest, [full / COLUMNS, layer]);
        }
    }
    texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        ..TextureViewDescriptor::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_lies_in_the_texture() {
        for texels in [0, 1, 2047, 2048, 2049, LAYER - 1, LAYER, LAYER + 1, 15_000_000] {
            let Extent3d { width, height, depth_or_array_layers } = extent(texels);
            let last = texels.max(1) - 1;
            // The same computation as in the shader.
            assert!(((last / LAYER) as u32) < depth_or_array_layers, "{texels}");
            assert!(((last / COLUMNS % ROWS) as u32) < height, "{texels}");
            assert!(((last % COLUMNS) as u32) < width && width <= 2048, "{texels}");
            let bytes = planned(texels).map_or(0, |planned| planned.bytes);
            assert!(bytes >= 16 * texels as u64, "{texels}");
        }
        let (_, most) = limit(&Limits::default());
        assert_eq!(most, 16 << 30);
    }
}
