//! Pictures: linear f32 colours and data layers.

use std::ops::Range;
use std::slice::ChunksMut;

pub mod color;
pub mod denoise;
pub mod encoding;
mod layer;
pub(crate) mod outline;
mod parts;
pub mod tone;

pub use layer::{Layer, LayerSet, UnknownLayer};
pub use parts::DoesNotFit;

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
    /// By the discriminants of [`Layer`]; there is always a colour.
    planes: [Option<Plane>; Layer::ALL.len()],
}

/// The values of a layer, one for each pixel. All planes of a layer are of one variant.
#[derive(Clone, Debug, PartialEq)]
enum Plane {
    Numbers(Vec<f32>),
    Vectors(Vec<[f32; 3]>),
    Counts(Vec<u32>),
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
        let mut image = Self { width, height, planes: [const { None }; Layer::ALL.len()] };
        for layer in layers.iter() {
            let plane = Plane::new(layer, pixels).ok_or(too_large)?;
            image.planes[layer as usize] = Some(plane);
        }
        Ok(image)
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
        let mut image = Self { width, height, planes: [const { None }; Layer::ALL.len()] };
        image.planes[Layer::Color as usize] = Some(Plane::Vectors(color));
        image.planes[Layer::Depth as usize] = Some(Plane::Numbers(depth));
        image.planes[Layer::Normal as usize] = Some(Plane::Vectors(normal));
        image.planes[Layer::Id as usize] = Some(Plane::Counts(id));
        lengths.iter().all(|length| *length as u64 == pixels).then_some(image)
    }

    fn numbers(&self, layer: Layer) -> Option<&[f32]> {
        match self.planes[layer as usize].as_ref()? {
            Plane::Numbers(values) => Some(values),
            _ => None,
        }
    }

    fn vectors(&self, layer: Layer) -> Option<&[[f32; 3]]> {
        match self.planes[layer as usize].as_ref()? {
            Plane::Vectors(values) => Some(values),
            _ => None,
        }
    }

    fn counts(&self, layer: Layer) -> Option<&[u32]> {
        match self.planes[layer as usize].as_ref()? {
            Plane::Counts(values) => Some(values),
            _ => None,
        }
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
        self.vectors(Layer::Color).unwrap_or_default()
    }

    /// Coverage of every pixel, if it was rendered; see [`Layer::Alpha`].
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        self.numbers(Layer::Alpha)
    }

    /// Depth of every pixel, if it was rendered; see [`Layer::Depth`].
    #[must_use]
    pub fn depth(&self) -> Option<&[f32]> {
        self.numbers(Layer::Depth)
    }

    /// Normal of every pixel, if it was rendered; see [`Layer::Normal`].
    #[must_use]
    pub fn normal(&self) -> Option<&[[f32; 3]]> {
        self.vectors(Layer::Normal)
    }

    /// Hit point of every pixel in world space, if it was rendered; see [`Layer::Position`].
    #[must_use]
    pub fn position(&self) -> Option<&[[f32; 3]]> {
        self.vectors(Layer::Position)
    }

    /// Surface colour of every pixel, if it was rendered; see [`Layer::Albedo`].
    #[must_use]
    pub fn albedo(&self) -> Option<&[[f32; 3]]> {
        self.vectors(Layer::Albedo)
    }

    /// Sphere id of every pixel, if it was rendered; see [`Layer::Id`].
    #[must_use]
    pub fn id(&self) -> Option<&[u32]> {
        self.counts(Layer::Id)
    }

    /// Number of samples of every pixel, if it was rendered; see [`Layer::Samples`].
    #[must_use]
    pub fn samples(&self) -> Option<&[u32]> {
        self.counts(Layer::Samples)
    }

    /// Variance of the mean of every pixel, if it was rendered; see [`Layer::Variance`].
    #[must_use]
    pub fn variance(&self) -> Option<&[f32]> {
        self.numbers(Layer::Variance)
    }

    /// The layers of the image.
    #[must_use]
    pub fn layers(&self) -> LayerSet {
        let has = |layer: &Layer| self.planes[*layer as usize].is_some();
        Layer::ALL.iter().copied().filter(has).collect()
    }

    /// Drops all layers except these.
    pub(crate) fn keep(&mut self, layers: LayerSet) {
        for layer in Layer::ALL.iter().filter(|layer| !layers.contains(**layer)) {
            self.planes[*layer as usize] = None;
        }
    }

    /// Sets colour, normal and albedo, depth and variance. Each list has as many items as the picture has pixels.
    #[cfg(feature = "run-file")]
    pub(crate) fn set_guides(
        &mut self,
        [color, normal, albedo]: [Vec<[f32; 3]>; 3],
        [depth, variance]: [Vec<f32>; 2],
    ) {
        self.planes[Layer::Color as usize] = Some(Plane::Vectors(color));
        self.planes[Layer::Normal as usize] = Some(Plane::Vectors(normal));
        self.planes[Layer::Albedo as usize] = Some(Plane::Vectors(albedo));
        self.planes[Layer::Depth as usize] = Some(Plane::Numbers(depth));
        self.planes[Layer::Variance as usize] = Some(Plane::Numbers(variance));
    }

    pub(crate) fn color_mut(&mut self) -> &mut [[f32; 3]] {
        vectors_mut(&mut self.planes[Layer::Color as usize]).unwrap_or_default()
    }

    pub(crate) fn alpha_mut(&mut self) -> Option<&mut [f32]> {
        numbers_mut(&mut self.planes[Layer::Alpha as usize])
    }
}

impl Plane {
    /// A layer in which every pixel is a miss, without samples; `None` if the memory cannot be allocated.
    fn new(layer: Layer, pixels: usize) -> Option<Self> {
        Some(match layer {
            Layer::Color | Layer::Normal | Layer::Position | Layer::Albedo => {
                Self::Vectors(filled(pixels, [0.0; 3])?)
            }
            Layer::Depth => Self::Numbers(filled(pixels, f32::INFINITY)?),
            Layer::Alpha | Layer::Variance => Self::Numbers(filled(pixels, 0.0)?),
            Layer::Id => Self::Counts(filled(pixels, NO_ID)?),
            Layer::Samples => Self::Counts(filled(pixels, 0)?),
        })
    }
}

/// A list of equal values; `None` if the memory cannot be allocated.
fn filled<T: Clone>(count: usize, value: T) -> Option<Vec<T>> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).ok()?;
    values.resize(count, value);
    Some(values)
}

fn numbers_mut(plane: &mut Option<Plane>) -> Option<&mut [f32]> {
    match plane {
        Some(Plane::Numbers(values)) => Some(values),
        _ => None,
    }
}

fn vectors_mut(plane: &mut Option<Plane>) -> Option<&mut [[f32; 3]]> {
    match plane {
        Some(Plane::Vectors(values)) => Some(values),
        _ => None,
    }
}

fn counts_mut(plane: &mut Option<Plane>) -> Option<&mut [u32]> {
    match plane {
        Some(Plane::Counts(values)) => Some(values),
        _ => None,
    }
}

/// One row of an image, borrowed for writing. Layers that were not requested are `None`.
pub(crate) struct RowMut<'a> {
    pub(crate) color: &'a mut [[f32; 3]],
    pub(crate) alpha: Option<&'a mut [f32]>,
    pub(crate) depth: Option<&'a mut [f32]>,
    pub(crate) normal: Option<&'a mut [[f32; 3]]>,
    pub(crate) position: Option<&'a mut [[f32; 3]]>,
    pub(crate) albedo: Option<&'a mut [[f32; 3]]>,
    pub(crate) id: Option<&'a mut [u32]>,
    pub(crate) samples: Option<&'a mut [u32]>,
    pub(crate) variance: Option<&'a mut [f32]>,
}

impl RowMut<'_> {
    /// The coverage of a pixel with a single ray: 1 for a hit, 0 for a miss.
    pub(crate) fn coverage(id: u32) -> f32 {
        if id == NO_ID { 0.0 } else { 1.0 }
    }

    /// Whether there is a layer that [`RowMut::set`] fills and [`RowMut::set_averages`] does not.
    pub(crate) fn has_data(&self) -> bool {
        let vectors = self.normal.is_some() || self.position.is_some();
        vectors || self.depth.is_some() || self.id.is_some()
    }

    /// Stores the result of the pixel's only ray.
    pub(crate) fn set(&mut self, column: usize, pixel: &Pixel) {
        self.color[column] = pixel.color;
        put(&mut self.alpha, column, Self::coverage(pixel.id));
        put(&mut self.depth, column, pixel.depth);
        put(&mut self.normal, column, pixel.normal);
        put(&mut self.position, column, pixel.position);
        put(&mut self.albedo, column, pixel.albedo);
        put(&mut self.id, column, pixel.id);
        put(&mut self.samples, column, 1);
        put(&mut self.variance, column, 0.0);
    }

    /// Stores the averages of a pixel's samples.
    pub(crate) fn set_averages(&mut self, column: usize, averages: &Averages) {
        self.color[column] = averages.color;
        put(&mut self.alpha, column, averages.alpha);
        put(&mut self.albedo, column, averages.albedo);
        put(&mut self.samples, column, averages.samples);
        put(&mut self.variance, column, averages.variance);
    }
}

/// Averages over the samples of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Averages {
    pub(crate) color: [f32; 3],
    pub(crate) alpha: f32,
    pub(crate) albedo: [f32; 3],
    /// The number of samples.
    pub(crate) samples: u32,
    /// The variance of the mean luminance.
    pub(crate) variance: f32,
}

pub(crate) fn put<T>(layer: &mut Option<&mut [T]>, column: usize, value: T) {
    if let Some(layer) = layer {
        layer[column] = value;
    }
}

impl Image {
    /// A range of rows, from top to bottom, each of which can be written independently.
    pub(crate) fn rows_mut(&mut self, rows: Range<usize>) -> Vec<RowMut<'_>> {
        let width = self.width as usize;
        let pixels = &(rows.start * width..rows.end * width);
        let [color, alpha, depth, normal, position, albedo, id, samples, variance] =
            self.planes.each_mut();
        let mut numbers =
            [alpha, depth, variance].map(|plane| cut(numbers_mut(plane), pixels, width));
        let mut vectors =
            [color, normal, position, albedo].map(|plane| cut(vectors_mut(plane), pixels, width));
        let mut counts = [id, samples].map(|plane| cut(counts_mut(plane), pixels, width));
        rows.map(|_| {
            let [alpha, depth, variance] = numbers.each_mut().map(next);
            let [color, normal, position, albedo] = vectors.each_mut().map(next);
            let [id, samples] = counts.each_mut().map(next);
            let color = color.unwrap_or_default();
            RowMut { color, alpha, depth, normal, position, albedo, id, samples, variance }
        })
        .collect()
    }
}

type Rows<'a, T> = Option<ChunksMut<'a, T>>;

fn cut<'a, T>(layer: Option<&'a mut [T]>, pixels: &Range<usize>, width: usize) -> Rows<'a, T> {
    layer.map(|layer| layer[pixels.clone()].chunks_mut(width))
}

fn next<'a, T>(rows: &mut Rows<'a, T>) -> Option<&'a mut [T]> {
    rows.as_mut().and_then(Iterator::next)
}
