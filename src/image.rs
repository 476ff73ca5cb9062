//! Linear f32 pixels and data layers.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// The id of a pixel whose ray hit nothing.
pub const NO_ID: u32 = u32::MAX;

/// One layer of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layer {
    /// Linear colour, three f32.
    Color,
    /// Distance along the ray from its origin in scene units, f32; +∞ for a miss.
    Depth,
    /// Unit normal in the world, pointing away from the sphere's centre, three f32; zero for a miss.
    Normal,
    /// Index of the sphere in input order, u32; [`NO_ID`] for a miss.
    Id,
}

impl Layer {
    /// All layers.
    pub const ALL: &'static [Self] = &[Self::Color, Self::Depth, Self::Normal, Self::Id];

    /// The name on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Id => "id",
        }
    }

    /// How many bytes a pixel of this layer takes.
    #[must_use]
    pub const fn bytes_per_pixel(self) -> u64 {
        match self {
            Self::Color | Self::Normal => 12,
            Self::Depth | Self::Id => 4,
        }
    }
}

impl fmt::Display for Layer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A text that names no layer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no layer `{name}`; the layers are color, depth, normal and id")]
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

/// Which layers to render. Colour is always among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LayerSet {
    depth: bool,
    normal: bool,
    id: bool,
}

impl LayerSet {
    /// Colour alone.
    pub const COLOR: Self = Self { depth: false, normal: false, id: false };
    /// Every layer.
    pub const ALL: Self = Self { depth: true, normal: true, id: true };

    /// The set with one more layer.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        match layer {
            Layer::Color => {}
            Layer::Depth => self.depth = true,
            Layer::Normal => self.normal = true,
            Layer::Id => self.id = true,
        }
        self
    }

    /// Whether the layer is in the set.
    #[must_use]
    pub fn contains(self, layer: Layer) -> bool {
        match layer {
            Layer::Color => true,
            Layer::Depth => self.depth,
            Layer::Normal => self.normal,
            Layer::Id => self.id,
        }
    }

    /// How many bytes a pixel of all its layers takes.
    #[must_use]
    pub fn bytes_per_pixel(self) -> u64 {
        Layer::ALL.iter().filter(|l| self.contains(**l)).map(|l| l.bytes_per_pixel()).sum()
    }
}

/// All layers of one pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// See [`Layer::Color`].
    pub color: [f32; 3],
    /// See [`Layer::Depth`].
    pub depth: f32,
    /// See [`Layer::Normal`].
    pub normal: [f32; 3],
    /// See [`Layer::Id`].
    pub id: u32,
}

/// A picture with its data layers. Row 0 is the top; pixel (i, j) is at index `j * width + i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    color: Vec<[f32; 3]>,
    depth: Option<Vec<f32>>,
    normal: Option<Vec<[f32; 3]>>,
    id: Option<Vec<u32>>,
}

/// An image does not fit into memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture of {width}x{height} needs {bytes} bytes of memory, which cannot be had; choose a smaller size"
)]
pub struct ImageTooLarge {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Bytes of all requested layers.
    pub bytes: u64,
}

impl Image {
    /// An image of misses over black.
    ///
    /// # Errors
    /// If the memory cannot be reserved.
    pub fn new(width: u32, height: u32, layers: LayerSet) -> Result<Self, ImageTooLarge> {
        let pixels = u64::from(width) * u64::from(height);
        let bytes = pixels.saturating_mul(layers.bytes_per_pixel());
        let too_large = ImageTooLarge { width, height, bytes };
        let pixels = usize::try_from(pixels).map_err(|_| too_large)?;
        let wants = |layer| layers.contains(layer);
        Ok(Self {
            width,
            height,
            color: filled(pixels, [0.0; 3]).ok_or(too_large)?,
            depth: optional(wants(Layer::Depth), pixels, f32::INFINITY).ok_or(too_large)?,
            normal: optional(wants(Layer::Normal), pixels, [0.0; 3]).ok_or(too_large)?,
            id: optional(wants(Layer::Id), pixels, NO_ID).ok_or(too_large)?,
        })
    }

    /// An image of all layers, row by row from the top. `None` if one has not as many pixels as the sides say.
    #[must_use]
    pub fn from_layers(
        [width, height]: [u32; 2],
        color: Vec<[f32; 3]>,
        depth: Vec<f32>,
        normal: Vec<[f32; 3]>,
        id: Vec<u32>,
    ) -> Option<Self> {
        let pixels = u64::from(width) * u64::from(height);
        let lengths = [color.len(), depth.len(), normal.len(), id.len()];
        lengths.iter().all(|length| *length as u64 == pixels).then_some(Self {
            width,
            height,
            color,
            depth: Some(depth),
            normal: Some(normal),
            id: Some(id),
        })
    }

    /// Width in pixels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Linear colour of every pixel.
    #[must_use]
    pub fn color(&self) -> &[[f32; 3]] {
        &self.color
    }

    /// Depth of every pixel, if it was rendered.
    #[must_use]
    pub fn depth(&self) -> Option<&[f32]> {
        self.depth.as_deref()
    }

    /// Normal of every pixel, if it was rendered.
    #[must_use]
    pub fn normal(&self) -> Option<&[[f32; 3]]> {
        self.normal.as_deref()
    }

    /// Sphere id of every pixel, if it was rendered.
    #[must_use]
    pub fn id(&self) -> Option<&[u32]> {
        self.id.as_deref()
    }

    /// Two images of the same height and layers in one, all layers alike.
    ///
    /// # Errors
    /// If the memory cannot be reserved.
    #[cfg(feature = "cli")]
    pub(crate) fn side_by_side([left, right]: [&Self; 2]) -> Result<Self, ImageTooLarge> {
        let layers = Layer::ALL.iter().filter(|layer| left.has(**layer) && right.has(**layer));
        let layers = layers.fold(LayerSet::COLOR, |layers, layer| layers.with(*layer));
        let (width, height) = (left.width + right.width, left.height.min(right.height));
        let mut both = Self::new(width, height, layers)?;
        let sides = [left.width as usize, right.width as usize];
        joined(&mut both.color, [&left.color, &right.color], sides);
        if let (Some(both), Some(a), Some(b)) = (&mut both.depth, &left.depth, &right.depth) {
            joined(both, [a, b], sides);
        }
        if let (Some(both), Some(a), Some(b)) = (&mut both.normal, &left.normal, &right.normal) {
            joined(both, [a, b], sides);
        }
        if let (Some(both), Some(a), Some(b)) = (&mut both.id, &left.id, &right.id) {
            joined(both, [a, b], sides);
        }
        Ok(both)
    }

    #[cfg(feature = "cli")]
    fn has(&self, layer: Layer) -> bool {
        match layer {
            Layer::Color => true,
            Layer::Depth => self.depth.is_some(),
            Layer::Normal => self.normal.is_some(),
            Layer::Id => self.id.is_some(),
        }
    }

    /// Some of the rows, from top to bottom, each to be written on its own.
    pub(crate) fn rows_mut(&mut self, rows: Range<usize>) -> Vec<RowMut<'_>> {
        let width = self.width as usize;
        let pixels = rows.start * width..rows.end * width;
        let mut depth = self.depth.as_mut().map(|layer| layer[pixels.clone()].chunks_mut(width));
        let mut normal = self.normal.as_mut().map(|layer| layer[pixels.clone()].chunks_mut(width));
        let mut id = self.id.as_mut().map(|layer| layer[pixels.clone()].chunks_mut(width));
        self.color[pixels.clone()]
            .chunks_mut(width)
            .map(|color| RowMut {
                color,
                depth: depth.as_mut().and_then(Iterator::next),
                normal: normal.as_mut().and_then(Iterator::next),
                id: id.as_mut().and_then(Iterator::next),
            })
            .collect()
    }
}

/// One row of an image, borrowed for writing. Layers that were not asked for are absent.
pub(crate) struct RowMut<'a> {
    pub(crate) color: &'a mut [[f32; 3]],
    pub(crate) depth: Option<&'a mut [f32]>,
    pub(crate) normal: Option<&'a mut [[f32; 3]]>,
    pub(crate) id: Option<&'a mut [u32]>,
}

impl RowMut<'_> {
    pub(crate) fn set(&mut self, column: usize, pixel: &Pixel) {
        self.color[column] = pixel.color;
        if let Some(depth) = &mut self.depth {
            depth[column] = pixel.depth;
        }
        if let Some(normal) = &mut self.normal {
            normal[column] = pixel.normal;
        }
        if let Some(id) = &mut self.id {
            id[column] = pixel.id;
        }
    }
}

/// Copies rows of the left and of the right into rows of both.
#[cfg(feature = "cli")]
fn joined<T: Copy>(both: &mut [T], [left, right]: [&[T]; 2], [a, b]: [usize; 2]) {
    let rows = left.chunks(a).zip(right.chunks(b));
    for (both, (left, right)) in both.chunks_mut(a + b).zip(rows) {
        both[..a].copy_from_slice(left);
        both[a..].copy_from_slice(right);
    }
}

/// `None` if the memory cannot be reserved.
fn filled<T: Clone>(count: usize, value: T) -> Option<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).ok()?;
    values.resize(count, value);
    Some(values)
}

/// `None` if the layer is wanted and its memory cannot be reserved.
fn optional<T: Clone>(wanted: bool, count: usize, value: T) -> Option<Option<Vec<T>>> {
    if wanted { filled(count, value).map(Some) } else { Some(None) }
}
