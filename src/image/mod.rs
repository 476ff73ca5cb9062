//! Pictures: linear f32 colours and data layers.

use std::ops::Range;

use bytemuck::{Pod, cast_slice, cast_slice_mut, cast_vec};

pub mod color;
pub mod denoise;
pub mod encoding;
mod ghosts;
mod layer;
pub(crate) mod outline;
mod parts;
pub mod tone;

pub use layer::{Layer, LayerSet, NO_ID, UnknownLayer};
pub use parts::DoesNotFit;

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

/// A picture with its data layers. Row 0 is the top. Pixel (i, j) is at index `j * width + i`.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    /// The words of each layer, pixel by pixel, indexed by the discriminants of [`Layer`]. There is always a colour.
    planes: [Option<Vec<u32>>; Layer::ALL.len()],
}

impl PartialEq for Image {
    /// Compares numbers, not bits. So −0 equals 0.
    fn eq(&self, other: &Self) -> bool {
        let shape = |image: &Self| (image.width, image.height, image.layers());
        let are_equal = |layer: &Layer| match layer {
            Layer::Id | Layer::Samples => self.plane::<u32>(*layer) == other.plane(*layer),
            _ => self.plane::<f32>(*layer) == other.plane(*layer),
        };
        shape(self) == shape(other) && Layer::ALL.iter().all(are_equal)
    }
}

/// An error for an image that does not fit into memory.
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
    /// An image without samples, in which every pixel is a miss over black.
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
            let (mut plane, words) = (Vec::new(), pixels.saturating_mul(layer.words()));
            plane.try_reserve_exact(words).map_err(|_| too_large)?;
            plane.resize(words, layer.miss());
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
        image.set(Layer::Color, color);
        image.set(Layer::Depth, depth);
        image.set(Layer::Normal, normal);
        image.set(Layer::Id, id);
        lengths.iter().all(|length| *length as u64 == pixels).then_some(image)
    }

    fn set<T: Pod>(&mut self, layer: Layer, values: Vec<T>) {
        self.planes[layer as usize] = Some(cast_vec(values));
    }

    fn plane<T: Pod>(&self, layer: Layer) -> Option<&[T]> {
        self.planes[layer as usize].as_deref().map(cast_slice)
    }

    fn plane_mut<T: Pod>(&mut self, layer: Layer) -> Option<&mut [T]> {
        self.planes[layer as usize].as_deref_mut().map(cast_slice_mut)
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
        self.plane(Layer::Color).unwrap_or_default()
    }

    /// Coverage of every pixel, if it was rendered; see [`Layer::Alpha`].
    #[must_use]
    pub fn alpha(&self) -> Option<&[f32]> {
        self.plane(Layer::Alpha)
    }

    /// Depth of every pixel, if it was rendered; see [`Layer::Depth`].
    #[must_use]
    pub fn depth(&self) -> Option<&[f32]> {
        self.plane(Layer::Depth)
    }

    /// Normal of every pixel, if it was rendered; see [`Layer::Normal`].
    #[must_use]
    pub fn normal(&self) -> Option<&[[f32; 3]]> {
        self.plane(Layer::Normal)
    }

    /// Hit point of every pixel in world space, if it was rendered; see [`Layer::Position`].
    #[must_use]
    pub fn position(&self) -> Option<&[[f32; 3]]> {
        self.plane(Layer::Position)
    }

    /// Surface colour of every pixel, if it was rendered; see [`Layer::Albedo`].
    #[must_use]
    pub fn albedo(&self) -> Option<&[[f32; 3]]> {
        self.plane(Layer::Albedo)
    }

    /// Sphere id of every pixel, if it was rendered; see [`Layer::Id`].
    #[must_use]
    pub fn id(&self) -> Option<&[u32]> {
        self.plane(Layer::Id)
    }

    /// Number of samples of every pixel, if it was rendered; see [`Layer::Samples`].
    #[must_use]
    pub fn samples(&self) -> Option<&[u32]> {
        self.plane(Layer::Samples)
    }

    /// Variance of the mean of every pixel, if it was rendered; see [`Layer::Variance`].
    #[must_use]
    pub fn variance(&self) -> Option<&[f32]> {
        self.plane(Layer::Variance)
    }

    /// The layers of the image.
    #[must_use]
    pub fn layers(&self) -> LayerSet {
        let has = |layer: &Layer| self.planes[*layer as usize].is_some();
        Layer::ALL.iter().copied().filter(has).collect()
    }

    /// Drops all layers except the given ones.
    pub(crate) fn keep(&mut self, layers: LayerSet) {
        for layer in Layer::ALL.iter().filter(|layer| !layers.contains(**layer)) {
            self.planes[*layer as usize] = None;
        }
    }

    pub(crate) fn color_mut(&mut self) -> &mut [[f32; 3]] {
        self.plane_mut(Layer::Color).unwrap_or_default()
    }

    pub(crate) fn alpha_mut(&mut self) -> Option<&mut [f32]> {
        self.plane_mut(Layer::Alpha)
    }

    /// The rows of a range, from top to bottom. Each can be written independently.
    pub(crate) fn rows_mut(&mut self, rows: Range<usize>) -> Vec<RowMut<'_>> {
        let height = self.height as usize;
        let mut planes = self.planes.each_mut().map(|plane| {
            let words = plane.as_ref()?.len() / height;
            Some(plane.as_mut()?[rows.start * words..rows.end * words].chunks_mut(words))
        });
        rows.map(|_| {
            let [color, alpha, depth, normal, position, albedo, id, samples, variance] =
                planes.each_mut().map(|rows| rows.as_mut()?.next());
            RowMut {
                color: color.map(cast_slice_mut).unwrap_or_default(),
                alpha: alpha.map(cast_slice_mut),
                depth: depth.map(cast_slice_mut),
                normal: normal.map(cast_slice_mut),
                position: position.map(cast_slice_mut),
                albedo: albedo.map(cast_slice_mut),
                id,
                samples,
                variance: variance.map(cast_slice_mut),
            }
        })
        .collect()
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
