//! The textures that pictures are written to.

use wgpu::{Device, TextureFormat, TextureUsages, TextureView};

use crate::gpu::checks::scoped;
use crate::gpu::error::GpuError;
use crate::gpu::passes::renderer::Renderer;
use crate::gpu::resources::texture;
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
        check_texture(layer, view, format, TextureUsages::STORAGE_BINDING, "STORAGE_BINDING")?;
        let texture = view.texture();
        if texture.size() != size {
            let found = describe_size([texture.width(), texture.height()]);
            let size = describe_size([size.width, size.height]);
            let expected = format!("as large as the color target, {size}");
            return Err(GpuError::Target { layer, found, expected });
        }
    }
    Ok(wanted.into_iter().map(|(_, view, _)| view).collect())
}

/// Returns an error if a texture has another format or lacks a usage. `name` is the name of the usage.
pub(crate) fn check_texture(
    layer: &'static str,
    view: &TextureView,
    format: TextureFormat,
    usage: TextureUsages,
    name: &str,
) -> Result<(), GpuError> {
    let texture = view.texture();
    let refused = |found, expected| Err(GpuError::Target { layer, found, expected });
    if texture.format() != format {
        return refused(format!("{:?}", texture.format()), format!("{format:?}"));
    }
    if !texture.usage().contains(usage) {
        return refused(format!("{:?}", texture.usage()), format!("usable as {name}"));
    }
    Ok(())
}

pub(super) fn describe_size([width, height]: [u32; 2]) -> String {
    format!("{width}x{height}")
}

/// Textures for the targets of a frame, in the formats of a renderer. They are for hosts without suitable textures. A
/// host whose picture changes its size creates new ones.
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
    pub async fn new(renderer: &Renderer, device: &Device, size: [u32; 2]) -> Result<Self, GpuError> {
        let usage = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let texture = |label, format| {
            let texture = texture(device, label, format, size, usage);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let (color, data) = scoped(device, || {
            let color = texture("pinhole color", renderer.color.texture_format());
            let data = renderer.data_layers.then(|| {
                [("pinhole depth", DEPTH_FORMAT), ("pinhole normal", NORMAL_FORMAT), ("pinhole id", ID_FORMAT)]
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

    /// Number of columns and of rows.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }
}
