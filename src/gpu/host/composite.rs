//! Drawing pictures into a host's render pass, with the host's depth, and the options of that pass.

use wgpu::{
    BindGroup, BindGroupLayout, BlendState, Buffer, CompareFunction, Device, Queue, RenderPass, RenderPipeline,
    TextureFormat,
};

use crate::camera::{DepthOrder, HostCamera};
use crate::gpu::checks::scoped;
use crate::gpu::edit::{Edits, ShaderEdit};
use crate::gpu::error::GpuError;
use crate::gpu::host::host_view::HostView;
use crate::gpu::passes::targets::{Targets, check_texture};
use crate::gpu::resources::numbered_group;
use crate::gpu::shader::formats::{ColorTarget, DEPTH_FORMAT};
use crate::gpu::shader::layouts::uniform;
use crate::gpu::shader::{Kernel, with_constants};

/// The pipeline that draws pictures into a host's render pass. One is enough for a device and a kind of render pass.
#[derive(Debug)]
pub struct Composite {
    layout: BindGroupLayout,
    pipeline: RenderPipeline,
    source: ColorTarget,
    has_depth: bool,
}

/// A picture to be drawn: the textures of a frame, and the host's camera.
#[derive(Debug)]
pub struct CompositePicture {
    group: BindGroup,
    view: Buffer,
    size: [u32; 2],
    has_camera: bool,
}

/// Conversions from the colour of a picture to that of the host's target: the values of
/// `ENCODING` in `host/host_color.wgsl`.
pub(crate) const AS_STORED: u32 = 0;
pub(crate) const TO_LINEAR: u32 = 1;
pub(crate) const TO_SRGB: u32 = 2;

/// The vertex kernel.
pub(crate) fn cover_kernel() -> Kernel {
    Kernel::new("cover", &[])
}

/// The fragment kernel for colours stored as `source`. Without a coverage, it is for a pass without depth.
pub(crate) fn composite_kernel(source: ColorTarget, encoding: TargetEncoding, coverage: Option<Coverage>) -> Kernel {
    let stored = match source {
        ColorTarget::Srgb8 => TargetEncoding::Srgb,
        ColorTarget::Linear16 | ColorTarget::Linear32 => TargetEncoding::Linear,
    };
    let constant = match (stored, encoding) {
        (TargetEncoding::Srgb, TargetEncoding::Linear) => TO_LINEAR,
        (TargetEncoding::Linear, TargetEncoding::Srgb) => TO_SRGB,
        _ => AS_STORED,
    };
    let coverage = match coverage {
        None => return Kernel::new("overlay", &[]).with([("ENCODING", constant)]),
        Some(Coverage::Hits) => "host/picture_depth.wgsl#primary",
        Some(Coverage::Alpha) => "host/picture_depth.wgsl#lit",
    };
    Kernel::new("composite", &[("$coverage", coverage)]).with([("ENCODING", constant)])
}

impl Composite {
    /// Builds the pipeline on a device that the caller owns.
    ///
    /// # Errors
    /// If the device cannot render to these formats, or not with this number of samples.
    pub async fn new(device: &Device, options: &CompositeOptions) -> Result<Self, GpuError> {
        Self::edited(device, options, Vec::new()).await
    }

    /// Builds the pipeline like [`Composite::new`], but with edited shaders.
    #[doc(hidden)]
    pub async fn edited(device: &Device, options: &CompositeOptions, edits: Vec<ShaderEdit>) -> Result<Self, GpuError> {
        let edits = &Edits { replacements: edits, ..Edits::default() };
        let CompositeOptions { source, encoding, .. } = *options;
        let has_depth = options.depth.is_some();
        let coverage = options.depth.map(|_| options.coverage);
        let kernels = [cover_kernel().edited(edits)?, composite_kernel(source, encoding, coverage).edited(edits)?];
        let texture = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: false },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let view = wgpu::BindGroupLayoutEntry {
            visibility: wgpu::ShaderStages::VERTEX,
            ty: uniform::<HostView>(),
            ..texture(0)
        };
        let entries = [view, texture(1), texture(2)];
        let (layout, pipeline) = scoped(device, || {
            let label = Some("pinhole composite");
            let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label,
                entries: &entries[..if has_depth { 3 } else { 2 }],
            });
            let [vertex, fragment] = kernels.each_ref().map(|kernel| {
                device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label: Some(kernel.entry_point),
                    source: wgpu::ShaderSource::Wgsl(kernel.source().into()),
                })
            });
            let [vertex_constants, fragment_constants] = kernels.each_ref().map(Kernel::values_of_constants);
            let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label,
                layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label,
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                })),
                vertex: wgpu::VertexState {
                    module: &vertex,
                    entry_point: Some(kernels[0].entry_point),
                    compilation_options: with_constants(&vertex_constants),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: options.depth.map(|depth| wgpu::DepthStencilState {
                    format: depth.format,
                    depth_write_enabled: Some(depth.write),
                    depth_compare: Some(depth.compare),
                    stencil: wgpu::StencilState::default(),
                    bias: wgpu::DepthBiasState::default(),
                }),
                multisample: wgpu::MultisampleState {
                    count: options.sample_count,
                    ..wgpu::MultisampleState::default()
                },
                fragment: Some(wgpu::FragmentState {
                    module: &fragment,
                    entry_point: Some(kernels[1].entry_point),
                    compilation_options: with_constants(&fragment_constants),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: options.format,
                        blend: options.blend,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            });
            (layout, pipeline)
        })
        .await?;
        Ok(Self { layout, pipeline, source: options.source, has_depth })
    }

    /// Draws the picture into the host's render pass, over the viewport that is set there. Spheres are drawn where the
    /// depth test lets them, with the depth that the host's camera gives their points. Misses, and hits behind the far
    /// plane, leave the pixel as it is. Hits in front of the near plane get its depth. In a pass without depth, every
    /// pixel of the picture is drawn.
    ///
    /// Afterwards, the pass has the pipeline and bind group 0 of the picture. Its viewport, scissor rectangle and
    /// stencil reference stay as they are.
    ///
    /// # Errors
    /// [`GpuError::NoCamera`] if the pass has depth and the picture no camera yet.
    pub fn draw(&self, pass: &mut RenderPass<'_>, picture: &CompositePicture) -> Result<(), GpuError> {
        if self.has_depth && !picture.has_camera {
            return Err(GpuError::NoCamera);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &picture.group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

impl CompositePicture {
    /// A picture in the targets of a frame, which must have data layers if the pass has depth. The textures of colour
    /// and depth must also have the usage `TEXTURE_BINDING`. Its top left pixel is that of the host's attachments.
    ///
    /// # Errors
    /// If there are no data layers but the pass has depth, or a texture has another format or usage.
    pub async fn new(composite: &Composite, device: &Device, targets: &Targets<'_>) -> Result<Self, GpuError> {
        let mut layers = vec![("color", targets.color, composite.source.texture_format())];
        match &targets.data {
            _ if !composite.has_depth => {}
            Some(data) => layers.push(("depth", data.depth, DEPTH_FORMAT)),
            None => {
                return Err(GpuError::Target {
                    layer: "data",
                    found: "absent".to_owned(),
                    expected: "present, with the depth of every pixel".to_owned(),
                });
            }
        }
        for &(layer, view, format) in &layers {
            let usage = wgpu::TextureUsages::TEXTURE_BINDING;
            check_texture(layer, view, format, usage, "TEXTURE_BINDING")?;
        }
        let texture = targets.color.texture();
        let size = [texture.width(), texture.height()];
        let (view, group) = scoped(device, || {
            let view = HostView::buffer(device, &HostView::without_camera(size, [0, 0]));
            let textures = layers.iter().map(|(_, view, _)| wgpu::BindingResource::TextureView(view));
            let resources = std::iter::once(view.as_entire_binding()).chain(textures);
            let group = numbered_group(device, "pinhole composite", &composite.layout, resources);
            (view, group)
        })
        .await?;
        Ok(Self { group, view, size, has_camera: false })
    }

    /// Sets the camera with which the frame was rendered, on a film with y up, and the pixel of the host's attachments
    /// at which the top left pixel of the picture is drawn. The picture is never scaled.
    ///
    /// The values are queued on `queue` and take effect with its next submission.
    pub fn set_camera(&mut self, queue: &Queue, camera: &HostCamera, first_pixel: [u32; 2]) {
        let view = HostView::new(camera, self.size, first_pixel);
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        self.has_camera = true;
    }

    /// Sets the pixel of the host's attachments at which the top left pixel of the picture is drawn, for a pass without
    /// depth. A pass with depth needs a camera.
    ///
    /// The values are queued on `queue` and take effect with its next submission.
    pub fn set_place(&mut self, queue: &Queue, first_pixel: [u32; 2]) {
        let view = HostView::without_camera(self.size, first_pixel);
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        self.has_camera = false;
    }
}

/// The render pass of a host into which pictures are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CompositeOptions {
    /// Format of the colour layer of the pictures: that of the renderer.
    pub source: ColorTarget,
    /// Format of the colour attachment, which may be any that can be rendered to and takes floats.
    pub format: TextureFormat,
    /// The encoding of the numbers that the attachment takes. The device itself encodes numbers that are written to a
    /// format with sRGB in its name, so such a format takes linear light.
    pub encoding: TargetEncoding,
    /// How colours are blended with the colours in the attachment. Colours are premultiplied by alpha. Pictures of
    /// primary rays are opaque where spheres are, so `None` gives the same for them.
    pub blend: Option<BlendState>,
    /// The pixels that are drawn, if there is a depth attachment.
    pub coverage: Coverage,
    /// The depth attachment, if there is one. Without it, every pixel of the picture is
    /// drawn, even if it shows no sphere.
    pub depth: Option<CompositeDepth>,
    /// Number of samples of each pixel of the attachments: 1 or 4. All samples of a pixel get the same colour and depth.
    pub sample_count: u32,
}

/// The depth attachment of a host's render pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CompositeDepth {
    /// Format of the depth attachment.
    pub format: TextureFormat,
    /// The test that a sphere passes to be drawn: compares its depth with the depth in the attachment.
    pub compare: CompareFunction,
    /// Whether the depth of spheres is written.
    pub write: bool,
}

/// The pixels of a picture that are drawn, and their depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Coverage {
    /// Pixels whose ray through the centre hits a sphere, with the depth of the hit.
    #[default]
    Hits,
    /// Pixels whose alpha is greater than 0, with the depth of the hit of the ray through the centre. If this ray
    /// misses, as beside a silhouette, the depth is the nearest hit of the eight pixels around it. If these miss too,
    /// as in a shadow on an unseen ground, it is the far end of the range.
    Alpha,
}

/// The light that the numbers in a colour attachment represent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TargetEncoding {
    /// Linear light.
    Linear,
    /// Encoded by the transfer function of sRGB.
    Srgb,
}

impl CompositeOptions {
    /// A render pass with attachments of these formats and one sample for each pixel. Formats of normalized integers
    /// without sRGB in their name are taken to hold encoded colours, as on most screens, and others linear light.
    #[must_use]
    pub fn new(format: TextureFormat, depth: CompositeDepth) -> Self {
        Self { depth: Some(depth), ..Self::without_depth(format) }
    }

    /// A render pass like that of [`CompositeOptions::new`] but without a depth attachment, such as the pass of a
    /// window or of a toolkit.
    #[must_use]
    pub fn without_depth(format: TextureFormat) -> Self {
        let is_encoded = matches!(format, TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm);
        Self {
            source: ColorTarget::default(),
            format,
            encoding: if is_encoded { TargetEncoding::Srgb } else { TargetEncoding::Linear },
            blend: None,
            coverage: Coverage::Hits,
            depth: None,
            sample_count: 1,
        }
    }

    /// A render pass like that of [`CompositeOptions::new`] for lit pictures, which are transparent beside smooth
    /// silhouettes and where a shadow falls. They are blended with the contents of the attachment.
    #[must_use]
    pub fn lit(format: TextureFormat, depth: CompositeDepth) -> Self {
        Self {
            blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            coverage: Coverage::Alpha,
            ..Self::new(format, depth)
        }
    }
}

impl CompositeDepth {
    /// A depth attachment that spheres are tested against and written to. The nearer depth wins.
    #[must_use]
    pub fn new(format: TextureFormat, order: DepthOrder) -> Self {
        let compare = match order {
            DepthOrder::NearIsZero => CompareFunction::LessEqual,
            DepthOrder::NearIsOne => CompareFunction::GreaterEqual,
        };
        Self { format, compare, write: true }
    }
}
