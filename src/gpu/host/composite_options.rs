//! What a host's render pass is like.

use wgpu::{BlendState, CompareFunction, TextureFormat};

use crate::camera::DepthOrder;
use crate::gpu::shader::formats::ColorTarget;

/// The render pass of a host into which pictures are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CompositeOptions {
    /// Format of the colour layer of the pictures: that of the renderer.
    pub source: ColorTarget,
    /// Format of the colour attachment, which may be any that can be rendered to and takes floats.
    pub format: TextureFormat,
    /// Which numbers the attachment takes. The device encodes those that are written to a format with sRGB in its name,
    /// so these take linear light.
    pub encoding: TargetEncoding,
    /// How colours are joined with what the attachment contains. Colours have alpha multiplied in. Pictures of primary
    /// rays are opaque where spheres are, so `None` gives the same for them.
    pub blend: Option<BlendState>,
    /// Which pixels are drawn, if there is a depth attachment.
    pub coverage: Coverage,
    /// The depth attachment, if there is one. Without it every pixel of the picture is drawn, also where there is no
    /// sphere.
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
    /// When a sphere is drawn: by its depth, compared with the depth that is there.
    pub compare: CompareFunction,
    /// Whether the depth of spheres is written.
    pub write: bool,
}

/// Which pixels of a picture are drawn, and with which depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Coverage {
    /// Those whose ray through the centre hits a sphere, with the depth of the hit.
    #[default]
    Hits,
    /// Those whose alpha is greater than 0. Their depth is that of the hit of the ray through their centre. If it misses,
    /// the depth is the nearest one of the hits of the eight pixels around, as beside a silhouette; and if these miss as
    /// well, it is the far end of the range, as in the shadow on a ground that is not itself seen.
    Alpha,
}

/// How numbers in a colour attachment stand for light.
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

    /// A render pass like that of [`CompositeOptions::new`] without a depth attachment, such as that of a window or of a
    /// toolkit.
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

    /// A render pass like that of [`CompositeOptions::new`] for lit pictures, which are transparent in parts: beside
    /// silhouettes, which are smooth, and where a shadow falls. They are blended with what the attachment contains.
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
    /// A depth attachment that spheres are tested against, the nearer one winning, and written to.
    #[must_use]
    pub fn new(format: TextureFormat, order: DepthOrder) -> Self {
        let compare = match order {
            DepthOrder::NearIsZero => CompareFunction::LessEqual,
            DepthOrder::NearIsOne => CompareFunction::GreaterEqual,
        };
        Self { format, compare, write: true }
    }
}
