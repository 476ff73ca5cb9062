//! The formats of the textures that kernels write.

use wgpu::TextureFormat;

pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::R32Float;
pub(crate) const NORMAL_FORMAT: TextureFormat = TextureFormat::Rgba32Float;
pub(crate) const ID_FORMAT: TextureFormat = TextureFormat::R32Uint;

/// The format of the colour texture. Every WebGPU device supports all variants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColorTarget {
    /// sRGB in the format `Rgba8Unorm`. A flat colour is written as exactly the bytes that were given. To sample the
    /// texture as linear light, create a view with the format `Rgba8UnormSrgb`.
    #[default]
    Srgb8,
    /// Linear light in the format `Rgba16Float`.
    Linear16,
    /// Linear light in the format `Rgba32Float`.
    Linear32,
}

impl ColorTarget {
    /// All variants.
    pub const ALL: &'static [Self] = &[Self::Srgb8, Self::Linear16, Self::Linear32];

    /// Returns the format that the caller's texture must have.
    #[must_use]
    pub const fn texture_format(self) -> TextureFormat {
        match self {
            Self::Srgb8 => TextureFormat::Rgba8Unorm,
            Self::Linear16 => TextureFormat::Rgba16Float,
            Self::Linear32 => TextureFormat::Rgba32Float,
        }
    }
}
