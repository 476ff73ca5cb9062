//! The textures of the caller that pictures are written to.

use wgpu::TextureView;

use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::shader::formats::{DEPTH_FORMAT, ID_FORMAT, NORMAL_FORMAT};

/// Textures of the caller that a picture is written to. All must be two-dimensional, of the same size, and have the
/// usage `STORAGE_BINDING`.
#[derive(Clone, Copy, Debug)]
pub struct Targets<'a> {
    /// Texture for the colour, in the format of the renderer's [`ColorTarget`](crate::gpu::ColorTarget).
    pub color: &'a TextureView,
    /// Textures for the data layers. They must be given if and only if the renderer was built with `data_layers`.
    pub data: Option<DataTargets<'a>>,
}

/// Textures for the data layers.
#[derive(Clone, Copy, Debug)]
pub struct DataTargets<'a> {
    /// Texture for the distance along the ray in scene units, in the format `R32Float`. A miss is 1e30.
    pub depth: &'a TextureView,
    /// Texture for the unit normal in world space, which points away from the sphere's centre, in the format
    /// `Rgba32Float`. A miss is zero.
    pub normal: &'a TextureView,
    /// Texture for the index of the sphere in input order, in the format `R32Uint`. A miss is `u32::MAX`.
    pub id: &'a TextureView,
}

/// Returns the targets in the order of their bindings, or an error if the renderer cannot write to them.
pub(super) fn checked_targets<'a>(
    renderer: &Renderer,
    targets: &Targets<'a>,
) -> Result<Vec<&'a TextureView>, GpuError> {
    let mut wanted = vec![("color", targets.color, renderer.color.texture_format())];
    match targets.data {
        Some(data) if renderer.data_layers => wanted.extend([
            ("depth", data.depth, DEPTH_FORMAT),
            ("normal", data.normal, NORMAL_FORMAT),
            ("id", data.id, ID_FORMAT),
        ]),
        None if !renderer.data_layers => {}
        found => {
            let state = |present| if present { "present" } else { "absent" }.to_owned();
            return Err(GpuError::Target {
                layer: "data",
                found: state(found.is_some()),
                expected: state(renderer.data_layers) + ", as in the renderer's options",
            });
        }
    }
    let size = targets.color.texture().size();
    for &(layer, view, format) in &wanted {
        let texture = view.texture();
        let refused =
            |found: String, expected: String| Err(GpuError::Target { layer, found, expected });
        if texture.format() != format {
            return refused(format!("{:?}", texture.format()), format!("{format:?}"));
        }
        if !texture.usage().contains(wgpu::TextureUsages::STORAGE_BINDING) {
            return refused(format!("{:?}", texture.usage()), "usable as STORAGE_BINDING".into());
        }
        if texture.size() != size {
            return refused(
                describe_size([texture.width(), texture.height()]),
                format!(
                    "as large as the color target, {}",
                    describe_size([size.width, size.height])
                ),
            );
        }
    }
    Ok(wanted.into_iter().map(|(_, view, _)| view).collect())
}

pub(super) fn describe_size([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}
