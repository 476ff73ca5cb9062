//! The textures that kernels write.

use wgpu::TextureFormat;

pub(in crate::gpu) const DEPTH_FORMAT: TextureFormat = TextureFormat::R32Float;
pub(in crate::gpu) const NORMAL_FORMAT: TextureFormat = TextureFormat::Rgba32Float;
pub(in crate::gpu) const ID_FORMAT: TextureFormat = TextureFormat::R32Uint;

/// The texture that colour is written to. All of them work on every WebGPU device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColorTarget {
    /// `Rgba8Unorm`, holding sRGB: a flat colour comes out as exactly its bytes. To sample it as
    /// linear light, view the texture as `Rgba8UnormSrgb`.
    #[default]
    Srgb8,
    /// `Rgba16Float`, holding linear light.
    Linear16,
    /// `Rgba32Float`, holding linear light.
    Linear32,
}

impl ColorTarget {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Srgb8, Self::Linear16, Self::Linear32];

    /// The format that the caller's texture must have.
    #[must_use]
    pub const fn texture_format(self) -> TextureFormat {
        match self {
            Self::Srgb8 => TextureFormat::Rgba8Unorm,
            Self::Linear16 => TextureFormat::Rgba16Float,
            Self::Linear32 => TextureFormat::Rgba32Float,
        }
    }
}
