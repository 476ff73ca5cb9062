//! Pictures: linear f32 colours and data layers.

pub mod color;
pub mod denoise;
pub mod encoding;
mod join;
mod layer;
pub(crate) mod outline;
mod parts;
mod rows;
pub mod tone;

pub use layer::{Layer, LayerSet, UnknownLayer};
pub use parts::DoesNotFit;
pub(crate) use rows::{Averages, RowMut};

/// The id of a pixel whose ray hit nothing.
pub const NO_ID: u32 = u32::MAX;

/// The result of one ray through the centre of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// See [`Layer::Color`].
    pub color: [f32; 3],
    /// See [`Layer::Depth`].
    pub depth: f32,
    /// See [`Layer::Normal`].
    pub normal: [f32; 3],
    /// See [`Layer::Position`].
    pub position: [f32; 3],
    /// See [`Layer::Albedo`].
    pub albedo: [f32; 3],
    /// See [`Layer::Id`].
    pub id: u32,
}

impl Pixel {
    /// The pixel of a ray that hit nothing.
    #[must_use]
    pub const fn miss(background: [f32; 3]) -> Self {
        let zero = [0.0; 3];
        let depth = f32::INFINITY;
        Self { color: background, depth, normal: zero, position: zero, albedo: zero, id: NO_ID }
    }
}

/// A picture with its data layers. Row 0 is the top; pixel (i, j) is at index `j * width + i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    color: Vec<[f32; 3]>,
    alpha: Option<Vec<f32>>,
    depth: Option<Vec<f32>>,
    normal: Option<Vec<[f32; 3]>>,
    position: Option<Vec<[f32; 3]>>,
    albedo: Option<Vec<[f32; 3]>>,
    id: Option<Vec<u32>>,
    samples: Option<Vec<u32>>,
    variance: Option<Vec<f32>>,
}

/// An image does not fit into memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture of {width}x{height} needs {bytes} bytes of memory, which cannot be allocated; choose a smaller size"
)]
pub struct ImageTooLarge {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Bytes of all requested layers together.
    pub bytes: u64,
}

impl Image {
    /// An image in which every pixel is a miss over black, without samples.
    ///
    /// # Errors
    /// Returns an error if the memory cannot be reserved.
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
            alpha: optional(wants(Layer::Alpha), pixels, 0.0).ok_or(too_large)?,
            depth: optional(wants(Layer::Depth), pixels, f32::INFINITY).ok_or(too_large)?,
            normal: optional(wants(Layer::Normal), pixels, [0.0; 3]).ok_or(too_large)?,
            position: optional(wants(Layer::Position), pixels, [0.0; 3]).ok_or(too_large)?,
            albedo: optional(wants(Layer::Albedo), pixels, [0.0; 3]).ok_or(too_large)?,
            id: optional(wants(Layer::Id), pixels, NO_ID).ok_or(too_large)?,
            samples: optional(wants(Layer::Samples), pixels, 0).ok_or(too_large)?,
            variance: optional(wants(Layer::Variance), pixels, 0.0).ok_or(too_large)?,
        })
    }

    /// An image of the layers [`LayerSet::DATA`], each row by row from the top. `None` unless every layer has `width *
    /// height` pixels.
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
            alpha: None,
            depth: Some(depth),
            normal: Some(normal),
            position: None,
            albedo: None,
            id: Some(id),
            samples: None,
            variance: None,
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

    /// Linear colour of every pixel; see [`Layer::Color`].
    #[must_use]
    pub fn color(&self) -> &[[f32; 3]] {
        &self.color
    }

    /// Coverage of every pixel, if it was rendered; see [`Layer::Alpha`].
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        self.alpha.as_deref()
    }

    /// Depth of every pixel, if it was rendered; see [`Layer::Depth`].
    #[must_use]
    pub fn depth(&self) -> Option<&[f32]> {
        self.depth.as_deref()
    }

    /// Normal of every pixel, if it was rendered; see [`Layer::Normal`].
    #[must_use]
    pub fn normal(&self) -> Option<&[[f32; 3]]> {
        self.normal.as_deref()
    }

    /// Hit point of every pixel in world space, if it was rendered; see [`Layer::Position`].
    #[must_use]
    pub fn position(&self) -> Option<&[[f32; 3]]> {
        self.position.as_deref()
    }

    /// Surface colour of every pixel, if it was rendered; see [`Layer::Albedo`].
    #[must_use]
    pub fn albedo(&self) -> Option<&[[f32; 3]]> {
        self.albedo.as_deref()
    }

    /// Sphere id of every pixel, if it was rendered; see [`Layer::Id`].
    #[must_use]
    pub fn id(&self) -> Option<&[u32]> {
        self.id.as_deref()
    }

    /// Number of samples of every pixel, if it was rendered; see [`Layer::Samples`].
    #[must_use]
    pub fn samples(&self) -> Option<&[u32]> {
        self.samples.as_deref()
    }

    /// Variance of the mean of every pixel, if it was rendered; see [`Layer::Variance`].
    #[must_use]
    pub fn variance(&self) -> Option<&[f32]> {
        self.variance.as_deref()
    }

    /// The layers of the image.
    #[must_use]
    pub fn layers(&self) -> LayerSet {
        let has = |layer: &Layer| match layer {
            Layer::Color => true,
            Layer::Alpha => self.alpha.is_some(),
            Layer::Depth => self.depth.is_some(),
            Layer::Normal => self.normal.is_some(),
            Layer::Position => self.position.is_some(),
            Layer::Albedo => self.albedo.is_some(),
            Layer::Id => self.id.is_some(),
            Layer::Samples => self.samples.is_some(),
            Layer::Variance => self.variance.is_some(),
        };
        Layer::ALL.iter().copied().filter(has).collect()
    }
}

/// Methods for renderers that average several samples for each pixel.
impl Image {
    /// Drops all layers except these.
    pub(crate) fn keep(&mut self, layers: LayerSet) {
        let wants = |layer| layers.contains(layer);
        self.alpha = self.alpha.take().filter(|_| wants(Layer::Alpha));
        self.depth = self.depth.take().filter(|_| wants(Layer::Depth));
        self.normal = self.normal.take().filter(|_| wants(Layer::Normal));
        self.position = self.position.take().filter(|_| wants(Layer::Position));
        self.albedo = self.albedo.take().filter(|_| wants(Layer::Albedo));
        self.id = self.id.take().filter(|_| wants(Layer::Id));
        self.samples = self.samples.take().filter(|_| wants(Layer::Samples));
        self.variance = self.variance.take().filter(|_| wants(Layer::Variance));
    }

    /// Sets colour, normal and albedo, depth and variance. Each list has as many items as the picture has pixels.
    #[cfg(feature = "run-file")]
    pub(crate) fn set_guides(
        &mut self,
        [color, normal, albedo]: [Vec<[f32; 3]>; 3],
        [depth, variance]: [Vec<f32>; 2],
    ) {
        (self.color, self.normal, self.albedo) = (color, Some(normal), Some(albedo));
        (self.depth, self.variance) = (Some(depth), Some(variance));
    }

    pub(crate) fn color_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.color
    }

    pub(crate) fn alpha_mut(&mut self) -> Option<&mut [f32]> {
        self.alpha.as_deref_mut()
    }
}

/// A list of equal values; `None` if the memory cannot be allocated.
fn filled<T: Clone>(count: usize, value: T) -> Option<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).ok()?;
    values.resize(count, value);
    Some(values)
}

/// A list of equal values if the layer is wanted; `None` if its memory cannot be allocated.
fn optional<T: Clone>(wanted: bool, count: usize, value: T) -> Option<Option<Vec<T>>> {
    if wanted { filled(count, value).map(Some) } else { Some(None) }
}
