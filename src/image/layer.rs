//! The layers of a picture: its colour, and data about each pixel.

use std::fmt;
use std::str::FromStr;

/// The id of a pixel whose ray hit nothing.
pub const NO_ID: u32 = u32::MAX;

/// One layer of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Layer {
    /// Linear colour, three f32. Over a black background it is premultiplied by [`Layer::Alpha`].
    Color,
    /// The fraction of the pixel that spheres cover, f32 from 0 to 1.
    Alpha,
    /// Distance along the ray from its origin in scene units, f32. +∞ for a miss.
    Depth,
    /// Unit normal in world space, pointing away from the sphere's centre, three f32. Zero for a miss.
    Normal,
    /// The hit point in world space, in scene units, three f32. Zero for a miss. Use [`Layer::Alpha`] or [`Layer::Id`]
    /// to tell a miss from a hit at the origin.
    Position,
    /// Surface colour in linear light, without lighting, three f32. Zero for a miss.
    Albedo,
    /// Index of the sphere in input order, u32. [`NO_ID`] for a miss.
    Id,
    /// Number of samples of the pixel, u32.
    Samples,
    /// Estimated variance of the pixel's mean luminance, f32. Zero for a single sample, which allows no estimate.
    Variance,
}

impl Layer {
    /// All layers.
    pub const ALL: &'static [Self] = &[
        Self::Color,
        Self::Alpha,
        Self::Depth,
        Self::Normal,
        Self::Position,
        Self::Albedo,
        Self::Id,
        Self::Samples,
        Self::Variance,
    ];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Alpha => "alpha",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Position => "position",
            Self::Albedo => "albedo",
            Self::Id => "id",
            Self::Samples => "samples",
            Self::Variance => "variance",
        }
    }

    /// Returns true if values belong to the ray through a pixel's centre, even if other layers are means over samples.
    #[must_use]
    pub const fn is_of_one_ray(self) -> bool {
        matches!(self, Self::Depth | Self::Normal | Self::Id | Self::Position)
    }

    /// The number of bytes per pixel of this layer.
    #[must_use]
    pub const fn bytes_per_pixel(self) -> u64 {
        match self {
            Self::Color | Self::Normal | Self::Position | Self::Albedo => 12,
            Self::Alpha | Self::Depth | Self::Id | Self::Samples | Self::Variance => 4,
        }
    }

    /// The number of 4-byte words per pixel.
    pub(super) const fn words(self) -> usize {
        self.bytes_per_pixel() as usize / 4
    }

    /// The word of a pixel whose ray hit nothing, before it has samples.
    pub(super) const fn miss(self) -> u32 {
        match self {
            Self::Depth => f32::INFINITY.to_bits(),
            Self::Id => NO_ID,
            _ => 0,
        }
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// An error for a text that is not the name of a layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no layer `{name}`; the layers are {}", LayerSet::ALL)]
pub struct UnknownLayer {
    /// The text as given.
    pub name: String,
}

impl FromStr for Layer {
    type Err = UnknownLayer;

    fn from_str(name: &str) -> Result<Self, UnknownLayer> {
        Self::ALL
            .iter()
            .copied()
            .find(|layer| layer.name() == name)
            .ok_or_else(|| UnknownLayer { name: name.to_owned() })
    }
}

/// The set of layers to render. Colour is always in the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct LayerSet {
    /// The bits. Bit n stands for the layer with discriminant n.
    bits: u16,
}

impl LayerSet {
    /// Colour alone.
    pub const COLOR: Self = Self { bits: 1 << Layer::Color as u16 };
    /// The layers that a renderer with one ray per pixel fills without further work: colour, depth, normal and id.
    pub const DATA: Self = Self::COLOR.with(Layer::Depth).with(Layer::Normal).with(Layer::Id);
    /// All layers.
    pub const ALL: Self = {
        let (mut set, mut next) = (Self::COLOR, 0);
        while next < Layer::ALL.len() {
            set = set.with(Layer::ALL[next]);
            next += 1;
        }
        set
    };

    /// The set with one more layer.
    #[must_use]
    pub const fn with(self, layer: Layer) -> Self {
        Self { bits: self.bits | 1 << layer as u16 }
    }

    /// Returns true if the layer is in the set.
    #[must_use]
    pub const fn contains(self, layer: Layer) -> bool {
        self.bits & 1 << layer as u16 != 0
    }

    /// The layers of the set, in the order of [`Layer::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Layer> {
        Layer::ALL.iter().copied().filter(move |layer| self.contains(*layer))
    }

    /// The number of bytes per pixel of all layers in the set.
    #[must_use]
    pub fn bytes_per_pixel(self) -> u64 {
        self.iter().map(Layer::bytes_per_pixel).sum()
    }
}

impl Default for LayerSet {
    /// Colour alone.
    fn default() -> Self {
        Self::COLOR
    }
}

impl FromIterator<Layer> for LayerSet {
    /// The set of the given layers and colour.
    fn from_iter<I: IntoIterator<Item = Layer>>(layers: I) -> Self {
        layers.into_iter().fold(Self::COLOR, Self::with)
    }
}

/// Writes the names as a list in words, for example `color, depth and id`.
impl fmt::Display for LayerSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.iter().map(Layer::name).collect();
        match names.split_last() {
            Some((last, [])) => f.write_str(last),
            Some((last, others)) => write!(f, "{} and {last}", others.join(", ")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_is_what_was_put_in() {
        let set = LayerSet::COLOR.with(Layer::Id).with(Layer::Alpha).with(Layer::Id);
        assert_eq!(set.iter().collect::<Vec<_>>(), [Layer::Color, Layer::Alpha, Layer::Id]);
        assert_eq!(set.to_string(), "color, alpha and id");
        assert_eq!((set.bytes_per_pixel(), LayerSet::COLOR.bytes_per_pixel()), (20, 12));
        assert_eq!(LayerSet::default(), LayerSet::COLOR);
        assert_eq!([Layer::Depth, Layer::Id, Layer::Normal].into_iter().collect::<LayerSet>(), LayerSet::DATA);
        assert_eq!((LayerSet::DATA.bytes_per_pixel(), LayerSet::ALL.bytes_per_pixel()), (32, 68));
    }

    #[test]
    fn every_layer_is_found_by_its_name() {
        for layer in Layer::ALL.iter().copied() {
            assert_eq!(layer.name().parse(), Ok(layer));
            assert!(LayerSet::ALL.contains(layer));
            assert_eq!(LayerSet::COLOR.contains(layer), layer == Layer::Color);
        }
        let unknown = "depht".parse::<Layer>().unwrap_err().to_string();
        assert_eq!(
            unknown,
            "there is no layer `depht`; the layers are color, alpha, depth, normal, position, albedo, id, samples \
             and variance"
        );
    }
}
